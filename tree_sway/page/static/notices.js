// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Texts of the page: in their elements, in the notice over the picture, in a line that goes away. */

import { element } from "./panel.js";

let toastTimer = 0;

/** Write texts that have changed. @param {Record<string, string>} texts by the id of their element */
export function write(texts) {
  for (const [id, text] of Object.entries(texts)) {
    if (element(id).textContent !== text) element(id).textContent = text;
  }
}

/** @param {string} title @param {string} text @param {boolean} [canRetry] */
export function notice(title, text, canRetry = false) {
  element("notice").hidden = false;
  write({ "notice-title": title, "notice-text": text });
  element("retry").hidden = !canRetry;
}

/** Show why nothing can be drawn, and stop there. @param {string} title @param {string} text
 * @returns {Promise<never>} */
export function giveUp(title, text) {
  notice(title, text);
  return new Promise(() => undefined);
}

/** @param {string} text @param {boolean} [isProblem] @param {boolean} [isLasting] until the next one */
export function toast(text, isProblem = true, isLasting = false) {
  write({ toast: text });
  element("toast").classList.toggle("problem", isProblem);
  element("toast").hidden = false;
  clearTimeout(toastTimer);
  if (!isLasting) toastTimer = setTimeout(() => (element("toast").hidden = true), 6000);
}
