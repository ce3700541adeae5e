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

/** Direction that a wind comes from, the one convention of the page: its point, and degrees clockwise from
 * north; empty in calm. @param {Numbers} wind to east and north [m/s] */
export function windPoint([x, y]) {
  if (Math.hypot(x, y) < 0.05) return "";
  const degrees = Math.round(((Math.atan2(-x, -y) * 180) / Math.PI) + 360) % 360;
  return `${word("points").split(" ")[Math.round(degrees / 45) % 8]} (${degrees}°)`;
}

/** The same in a sentence. @param {Numbers} wind to east and north [m/s] */
export function windFrom(wind) {
  const point = windPoint(wind);
  return point && word("from", point);
}

/** Source of the wind. @param {{kind?: string, name?: string, rate?: number}} [source] of a status */
export function windSource({ kind = "", name = "", rate } = {}) {
  if (kind === "recorded") return name ? word("wind_recorded", name) : word("wind_recorded_unnamed");
  if (kind === "live") return word("wind_live", rate ? `${name}, ${Math.round(rate)} Hz` : name);
  return hasWord(`wind_${kind}`) ? word(`wind_${kind}`) : "";
}
