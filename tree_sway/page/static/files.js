// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Reads the files beside the modules: texts, tables, looks of species, shaders. */

/** Text of a file, or of its copy inside a page that is one file. @param {string} name @returns {Promise<string>} */
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
