// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** What people do beyond looking: pull a branch, put a headset on, listen. Each is loaded when it is asked for. */

/** @typedef {{scene: import("./drawing/scene.js").Scene, stream: import("./client.js").TreeStream}} Shown */

const PULL = '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M3 3v14M5 10h11M12 6l4 4-4 4" /></svg>';
const HEADSET = '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M2 6h16v8h-5l-2-2H9l-2 2H2zM6 9h2M12 9h2" /></svg>';

export class Hands {
  /** @param {Shown} shown @param {(text: string) => void} complain */
  constructor(shown, complain) {
    this.drag = /** @type {import("./drag.js").Drag | null} */ (null);
    this.headset = /** @type {import("./headset.js").Headset | null} */ (null);
    this.sound = /** @type {import("./sound.js").Sound | null} */ (null);
    const { scene, stream } = shown;
    this._tip = scene.tip();
    this._at = performance.now();
    this._pull = button("pull", PULL, async () => {
      this.drag ??= new (await import("./drag.js")).Drag(scene, stream);
      return (this.drag.isOn = !this.drag.isOn);
    }, complain);
    button("sound", "♪", async () => {
      this.sound ??= new (await import("./sound.js")).Sound();
      return this.sound.toggle();
    }, complain).hidden = false;
    const enter = button("headset", HEADSET, async () => {
      this.headset ??= new (await import("./headset.js")).Headset(scene, stream);
      return this.headset.toggle((isIn) => enter.setAttribute("aria-pressed", String(isIn)));
    }, complain);
    xr?.isSessionSupported("immersive-vr").then((/** @type {boolean} */ isSo) => (enter.hidden = !isSo), () => undefined);
  }

  /** Whether branches may be pulled here. @param {boolean} isSo */
  set canPull(isSo) {
    this._pull.hidden = !isSo;
  }

  /** Go on with what is drawn. @param {Shown} shown */
  frame({ scene, stream }) {
    this.drag?.frame();
    const now = performance.now();
    const tip = scene.tip();
    const motion = Math.hypot(...tip.map((each, c) => each - this._tip[c])) / Math.max(0.001, (now - this._at) / 1000);
    [this._tip, this._at] = [tip, now];
    this.sound?.follow(Math.hypot(...stream.playout.wind), scene.leavesShown && scene.hasLeaves, motion);
  }

  /** Whether a headset has the picture. */
  get isAway() {
    return Boolean(this.headset?.session);
  }
}

/** Of the browser; `any`, as TypeScript's own library has none of it. */
export const xr = /** @type {any} */ (navigator).xr;

/** A button among the tools that is pressed or not, hidden at first. @param {string} name also its word
 * @param {string} sign in HTML @param {() => Promise<boolean>} act
 * @param {(text: string) => void} complain */
function button(name, sign, act, complain) {
  const made = document.createElement("button");
  Object.assign(made, { type: "button", id: name, innerHTML: sign, hidden: true });
  made.dataset.word = name;
  made.setAttribute("aria-pressed", "false");
  made.addEventListener("click", () => act().then(
    (isOn) => made.setAttribute("aria-pressed", String(isOn)), (error) => complain(error.message)));
  document.getElementById("tools")?.append(made);
  return made;
}
