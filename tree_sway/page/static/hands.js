// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** What people do beyond looking: pull a branch, listen, put a headset on. Each is loaded when it is asked for. */

/** Of the browser; `any`, as TypeScript's own library has none of it. */
export const xr = /** @type {any} */ (navigator).xr;

export class Hands {
  /** @param {import("./drawing/scene.js").Scene} scene @param {import("./client.js").TreeStream} stream
   * @param {() => void} onEnd what is done when a headset ends by itself */
  constructor(scene, stream, onEnd) {
    this.scene = scene;
    this.stream = stream;
    this.drag = /** @type {import("./drag.js").Drag | null} */ (null);
    this.sound = /** @type {import("./sound.js").Sound | null} */ (null);
    this.headset = /** @type {import("./headset.js").Headset | null} */ (null);
    this._onEnd = onEnd;
    this._tip = [0, 0, 0];
    this._at = performance.now();
  }

  async togglePull() {
    this.drag ??= new (await import("./drag.js")).Drag(this.scene, this.stream);
    this.drag.isOn = !this.drag.isOn;
  }

  async toggleSound() {
    this.sound ??= new (await import("./sound.js")).Sound();
    await this.sound.toggle();
  }

  async toggleHeadset() {
    this.headset ??= new (await import("./headset.js")).Headset(this.scene, this.stream);
    await this.headset.toggle(this._onEnd);
  }

  /** Which of them are on. */
  get areOn() {
    return { pull: this.drag?.isOn ?? false, sound: this.sound?.isOn ?? false, headset: Boolean(this.headset?.session) };
  }

  /** Go on with what is drawn. */
  frame() {
    const { scene, stream } = this;
    this.drag?.frame();
    const now = performance.now();
    const tip = scene.tip();
    const motion = Math.hypot(...tip.map((each, c) => each - this._tip[c])) / Math.max(0.001, (now - this._at) / 1000);
    [this._tip, this._at] = [tip, now];
    this.sound?.follow(Math.hypot(...stream.playout.wind), scene.leavesShown && scene.hasLeaves, motion);
  }
}
