// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The words of the page, in English, German, French and Japanese. */

import { textOf } from "./files.js";

const LANGUAGES = ["en", "de", "fr", "ja"];

/** Texts by key, in each language. @type {Record<string, string[]>} */
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

/** A text in the chosen language; the key if there is none. @param {string} key
 * @param {...(string | number)} values in place of {0}, {1} */
export function word(key, ...values) {
  return (WORDS[key]?.[chosen] ?? key).replace(/\{(\d)\}/g, (_, i) => String(values[i]));
}

/** The text of a key, or another one if there is none. @param {string} key @param {string} other */
export const wordOr = (key, other) => (key in WORDS ? word(key) : other);

/** Direction that a wind comes from, as everywhere on the page: compass point, and degrees clockwise from north; empty in
 * calm. @param {Numbers} wind to east and north [m/s] */
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

/** Age of a reading in words; empty for the present. @param {number} age [s] */
function ago(age) {
  if (age < 10) return "";
  if (age < 90) return word("seconds_ago", Math.round(age));
  return age < 5400 ? word("minutes_ago", Math.round(age / 60)) : word("hours_ago", Math.round(age / 3600));
}

/** A live source: its name, its newest reading and how old it is. @param {WindStatus} source */
function liveSource({ name = "", rate, state = "", speed, wind = [0, 0], age = 0, is_mean, lacks_direction }) {
  const parts = [rate ? `${name}, ${Math.round(rate)} Hz` : name];
  if (Number.isFinite(speed)) {
    parts.push(`${Number(speed).toFixed(1)} m/s ${windFrom(wind)}`.trim(), ago(age));
    if (is_mean) parts.push(word("wind_gusts"));
    if (lacks_direction) parts.push(word("wind_assumed"));
    if (state === "stale") parts.push(word("wind_stale"));
  } else if (state) parts.push(word(state === "unknown" ? "wind_unknown" : "wind_awaited"));
  return word("wind_live", parts.filter(Boolean).join(", "));
}

/** Source of the wind. @param {WindStatus} [source] of a status */
export function windSource(source = {}) {
  const { kind = "", name = "" } = source;
  if (kind === "recorded") return name ? word("wind_recorded", name) : word("wind_recorded_unnamed");
  if (kind === "live") return liveSource(source);
  return wordOr(`wind_${kind}`, "");
}

/** Sentences of a server: the key of a text and its values each, or a text that is shown as it is. @param {string[][]} [sentences] */
export const sentences = (sentences = []) => sentences.map(([key, ...values]) => word(String(key), ...values)).join("\n");
