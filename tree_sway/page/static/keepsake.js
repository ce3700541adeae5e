// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** What people take with them: a picture, and a link that keeps the camera and the view. */

/** @typedef {import("./drawing/scene.js").Scene} Scene */

/** Save what is seen as PNG, in full.
 * @param {Scene} scene @param {string} name @param {() => void} draw a frame */
export function savePicture(scene, name, draw) {
  const { fineness, density } = scene.quality;
  [scene.quality.fineness, scene.quality.density] = [1, 1];
  draw();
  scene.canvas.toBlob((blob) => {
    if (!blob) return;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = `${name.replace(/[^\p{L}\p{N}]+/gu, "_")}.png`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
  [scene.quality.fineness, scene.quality.density] = [fineness, density];
}

/** The view as the end of an address.
 * @param {Scene} scene @param {Record<string, string | number | boolean>} settings */
export function viewLink(scene, settings) {
  const { azimuth, elevation, distance, target } = scene.camera;
  const view = [azimuth, elevation, distance, ...target].map((each) => Number(each.toPrecision(5)));
  const all = { view: view.join("_"), ...settings };
  return `#${new URLSearchParams(Object.entries(all).map(([key, value]) => [key, String(value)]))}`;
}

/** The settings of a link, and its camera where it has one. @param {string} hash */
export function readLink(hash) {
  const settings = Object.fromEntries(new URLSearchParams(hash.slice(1)));
  const view = (settings.view ?? "").split("_").map(Number);
  return { settings, view: view.length === 6 && view.every(Number.isFinite) ? view : null };
}
