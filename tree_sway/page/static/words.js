// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The words of the page, in English, German, French and Japanese. */

import { textOf } from "./files.js";

export const LANGUAGES = ["en", "de", "fr", "ja"];

/** @type {Record<string, string[]>} a word in each language */
const WORDS = JSON.parse(await textOf("words.json"));

let chosen = 0;

/** @param {string} language */
export function setLanguage(language) {
  chosen = Math.max(0, LANGUAGES.indexOf(language));
  document.documentElement.lang = LANGUAGES[chosen];
  for (const each of document.querySelectorAll("[data-word]")) {
    const text = word(/** @type {HTMLElement} */ (each).dataset.word ?? "");
    if (each.matches("#tools button, input")) Object.assign(each, { title: text, ariaLabel: text });
    else each.textContent = text;
  }
}

export const language = () => LANGUAGES[chosen];

/** A word in the language that is chosen; the key where there is none. @param {string} key
 * @param {...(string | number)} values in place of {0}, {1} */
export function word(key, ...values) {
  const text = WORDS[key]?.[chosen] ?? key;
  return text.replace(/\{(\d)\}/g, (_, i) => String(values[i]));
}

/** Whether there is a word of a key. @param {string} key */
export const hasWord = (key) => key in WORDS;

/** Where a wind comes from: the one convention of the page. @param {Numbers} wind to east and north [m/s] */
export function windFrom([x, y]) {
  if (Math.hypot(x, y) < 0.05) return "";
  const degrees = (((Math.atan2(-x, -y) * 180) / Math.PI) + 360) % 360;
  return word("from", `${word("points").split(" ")[Math.round(degrees / 45) % 8]} (${Math.round(degrees)}°)`);
}
