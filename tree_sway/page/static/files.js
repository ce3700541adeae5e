// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Reads the files beside the modules: texts, tables, looks of species, shaders, the native core. */

/** Content of a file, or of its copy inside a page that is one file. @param {string} name @returns {Promise<Response>} */
async function fileOf(name) {
  const own = /** @type {any} */ (globalThis).treeSwayFiles?.[name];
  if (own !== undefined) return new Response(own);
  const url = new URL(name, import.meta.url);
  // In Node.js, which fetches no files.
  if (url.protocol === "file:") return new Response(await (await import(/** @type {any} */ ("node:fs/promises"))).readFile(url));
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${name} cannot be read: ${answer.status}`);
  return answer;
}

/** @param {string} name */
export const textOf = async (name) => (await fileOf(name)).text();

/** @param {string} name */
export const bytesOf = async (name) => (await fileOf(name)).arrayBuffer();
