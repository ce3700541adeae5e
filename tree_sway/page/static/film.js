// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Draws the states that `tree-sway render` sends, and returns a picture of each. */

/** @returns {any} */
const page = () => /** @type {any} */ (window).treeSway;
while (!page()?.connection.description) await new Promise((done) => setTimeout(done, 20));
const { scene, connection } = page();
connection.close();
window.requestAnimationFrame = () => 0; // nothing else is drawn from now on
Object.assign(scene.canvas.style, Object.fromEntries(new URLSearchParams(location.search)));
// The cards of the page are not in the picture.
scene.camera.room = () => [0, 0, 1, 1];
scene.resize();
scene.camera.home();

/** @type {Blob | null} */
let picture = null;
for (;;) {
  const { time, wind, coordinates } = await (await fetch("/", { method: "POST", body: picture })).json();
  scene.wind = wind;
  scene.draw(new Float32Array(coordinates), time, false);
  picture = await new Promise((done) => scene.canvas.toBlob(done));
}

export {};
