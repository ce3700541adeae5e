// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Files beside the modules that are no modules: words, tables, looks of species, programs of shaders. */

/** Text of a file; a page that is one file has it itself. @param {string} name @returns {Promise<string>} */
export async function textOf(name) {
  const own = /** @type {any} */ (globalThis).treeSwayFiles?.[name];
  if (own !== undefined) return own;
  const url = new URL(name, import.meta.url);
  // In Node.js, which fetches no files.
  if (url.protocol === "file:") return (await import(/** @type {any} */ ("node:fs/promises"))).readFile(url, "utf8");
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${name} cannot be read: ${answer.status}`);
  return answer.text();
}
