// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Starts a page that is one file: unpacks its modules and registers them under the names that they import. */

(async () => {
  /** Unpack the content of an element. @param {string} id */
  const unpacked = (id) => {
    const text = document.getElementById(id)?.textContent ?? "";
    const packed = new Blob([Uint8Array.from(atob(text), (each) => each.charCodeAt(0))]);
    return new Response(packed.stream().pipeThrough(new DecompressionStream("gzip")));
  };
  const { modules, files } = await unpacked("modules").json();
  files["sway.wasm"] = await unpacked("core").arrayBuffer();
  Object.assign(window, { treeSwayFiles: files, treeSwayScene: () => unpacked("scene").arrayBuffer() });
  const imports = Object.entries(modules).map(([name, source]) =>
    [name, `data:text/javascript;charset=utf-8,${encodeURIComponent(source)}`]);
  const map = document.createElement("script");
  map.type = "importmap";
  map.textContent = JSON.stringify({ imports: Object.fromEntries(imports) });
  document.head.append(map);
  await import(/** @type {any} */ ("tree-sway/app.js"));
})().catch((error) => {
  const notice = /** @type {HTMLElement} */ (document.getElementById("notice"));
  notice.hidden = false;
  notice.textContent = `This file is damaged, or this browser is older than Chrome 91, Safari 16.4 and Firefox 113 `
    + `(${error}). Get the file again from where it came, or take a newer browser.`;
});
