// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Reads the files beside the modules: texts, tables, looks of species, shaders, the native core. */

/** Content of a file, or of its copy inside a page that is one file. Bundlers follow an address that a module writes out.
 * @param {string} name @param {() => URL} [address] @returns {Promise<Response>} */
async function fileOf(name, address = () => new URL(name, import.meta.url)) {
  const own = /** @type {any} */ (globalThis).treeSwayFiles?.[name];
  if (own !== undefined) return new Response(own);
  const url = address();
  // In Node.js, which fetches no files.
  if (url.protocol === "file:") return new Response(await (await import(/** @type {any} */ ("node:fs/promises"))).readFile(url));
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${name} cannot be read: ${answer.status}`);
  return answer;
}

/** @param {string} name @param {() => URL} [address] */
export const textOf = async (name, address) => (await fileOf(name, address)).text();

/** @param {string} name @param {() => URL} [address] */
export const bytesOf = async (name, address) => (await fileOf(name, address)).arrayBuffer();
