// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Files beside the modules that are no modules: words, looks of species, programs of shaders. */

/** Text of a file; a page that is one file has it in `treeSwayFiles`. @param {string} name
 * @returns {Promise<string>} */
export async function textOf(name) {
  const own = /** @type {any} */ (globalThis).treeSwayFiles?.[name];
  if (own !== undefined) return own;
  const answer = await fetch(new URL(name, import.meta.url));
  if (!answer.ok) throw new Error(`${name} cannot be read: ${answer.status}`);
  return answer.text();
}
