// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** What people do to the page: buttons, keys, clicks on the picture, files that are dropped. */

import { copyLink, recordClip, savePicture, saveTree } from "./keepsake.js";
import { toast } from "./notices.js";
import { OwnLine } from "./own_line.js";
import { element } from "./panel.js";

/** Largest movement of a pointer in a click [px]. */
const STILL = 4;

/** Listen to buttons, keys and pointers. @param {import("./view.js").View} view @param {string | null} token of the stream */
export function listen(view, token) {
  const { scene, stream, hands } = view;
  const { canvas } = scene;
  /** @type {HTMLDialogElement} */
  const help = element("keys");
  /** Actions of the buttons, by their ids, and of the keys that their elements name. @type {Record<string, () => unknown>} */
  const actions = {
    home: () => scene.camera.home(),
    leaves: () => scene.hasLeaves && scene.dress({ leavesShown: !scene.leavesShown }),
    theme: () => view.setDay(),
    season: () => scene.dress({ isAutumn: !scene.isAutumn }),
    picture: () => savePicture(view),
    clip: () => {
      view.endClip?.();
      view.endClip = view.endClip ? null : recordClip(canvas, view.treeName);
    },
    glb: () => saveTree("glb", view.treeName, token),
    html: () => saveTree("html", view.treeName, token),
    link: () => copyLink(view),
    full: () => (document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen?.()),
    help: () => help.showModal(),
    retry: () => stream.open(),
    close: () => help.close(),
    "sensor-here": () => stream.set("sensor_at", `segment:${view.pointedAt}`),
    pull: async () => (hands.drag ??= new (await import("./drag.js")).Drag(scene, stream)).toggle(),
    sound: async () => (hands.sound ??= new (await import("./sound.js")).Sound()).toggle(),
    "own-camera": async () => (hands.film ??= new (await import("./hand_camera.js")).HandCamera(view)).toggle(),
    headset: async () => {
      hands.headset ??= new (await import("./headset.js")).Headset(scene, stream);
      await hands.headset.toggle(() => view.showButtons());
    },
  };
  /** @type {Record<string, () => unknown>} */
  const keys = {
    m: () => (scene.hasPerson = !scene.hasPerson),
    " ": () => element("control-pause")?.click(),
    "[": () => view.pickNext(-1), "]": () => view.pickNext(1), escape: () => view.pick(-1),
  };
  for (const [id, action] of Object.entries(actions)) {
    const act = async () => {
      if (/** @type {HTMLButtonElement} */ (element(id)).disabled) return;
      try {
        await action();
      } catch (error) {
        toast(/** @type {Error} */ (error).message);
      }
      view.showButtons();
    };
    element(id).onclick = act;
    keys[element(id).dataset.key ?? id] = act;
  }
  document.onkeydown = (event) => {
    const target = /** @type {HTMLElement} */ (event.target);
    if (target.closest("input[type='text'], select, dialog") || event.ctrlKey || event.metaKey) return;
    const own = target.matches("button, summary") ? /^( |Enter)$/ : target.matches("input") ? /^(Arrow|Home|End|Page)/ : /^$/;
    if (own.test(event.key)) return;
    // The camera listens to the picture, also while a button that was clicked has the focus.
    if (target !== canvas) canvas.dispatchEvent(new KeyboardEvent("keydown", event));
    else keys[event.key.toLowerCase()]?.();
  };
  navigator.xr?.isSessionSupported("immersive-vr").then((/** @type {boolean} */ isSo) => (element("headset").hidden = !isSo), () => undefined);
  let pressed = [0, 0];
  canvas.addEventListener("pointerdown", (event) => (pressed = [event.clientX, event.clientY]));
  canvas.addEventListener("click", (event) => {
    if (Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > STILL) return;
    if (!scene.description) return;
    const { branch, segment } = scene.under(event);
    view.pick(branch, segment);
  });
  view.shown.onchange = () => view.pick(scene.picked);
  element("time").oninput = ({ target }) => view.goBack(-Number(/** @type {any} */ (target).value));
  element("language").onchange = ({ target }) => view.speak(/** @type {any} */ (target).value);
  // A button of the bar that the keyboard reaches comes into the bar whole.
  element("tools").addEventListener("focusin", ({ target }) => /** @type {Element} */ (target).scrollIntoView({ inline: "center", block: "nearest" }));

  document.ondragover = (event) => event.preventDefault();
  document.ondrop = (event) => {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    const { connection } = stream;
    if (file && connection instanceof OwnLine) connection.take(file).catch((error) => toast(error.message));
  };
  scene.camera.listen(canvas);
}
