// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A branch pulled by hand: a spring to the pointer, and the pull test when it is let go. */

import { STRIDE } from "./placing.js";
import { word } from "./words.js";
import { saveFile } from "./keepsake.js";
import { chainTo } from "./touch.js";

/** Modulus of green wood [Pa], for a spring about as stiff as what it pulls at. */
const MODULUS = 8e9;
const RENEW_EVERY = 100;
/** A free decay is recorded for this time [s], and offered from the other on. */
const [RECORDED, OFFERED] = [30, 3];

/** Stiffness of a cantilever of what bears a segment [N/m].
 * @param {import("./drawing/scene.js").Scene} scene @param {number} segment of the watched tree */
function stiffnessAt(scene, segment) {
  const { kind, rest, place } = scene.watched;
  const { branch_first: first, segment_length: length, segment_radius: radius } = kind.arrays;
  let compliance = 0;
  for (const branch of chainTo(kind, segment)) {
    for (let s = first[branch]; s < Math.min(first[branch + 1], segment); s++) {
      const away = Math.hypot(...[0, 1, 2].map((c) => rest[STRIDE * segment + c] - rest[STRIDE * s + c]));
      compliance += (away ** 2 * length[s]) / ((MODULUS * Math.PI * radius[2 * s] ** 4) / 4);
    }
  }
  return Math.min(1e6, place[4] / Math.max(compliance, 1e-9));
}

/** The hand at a branch: where it was, what it pulls by, and what came of it. */
export class Pull {
  /** @param {import("./drawing/scene.js").Scene} scene @param {import("./client.js").TreeStream} stream
   * @param {number} segment of the watched tree */
  constructor(scene, stream, segment) {
    this.scene = scene;
    this.stream = stream;
    this.segment = segment;
    this.stiffness = stiffnessAt(scene, segment);
    this.to = scene.position(segment);
    this._sentAt = -Infinity;
    /** Time [s] and displacement [m] since it was let go. @type {number[][]} */
    this.record = [];
    this._from = 0;
    this.isHeld = true;
  }

  /** What the spring pulls by [N]. */
  get force() {
    const at = this.scene.position(this.segment);
    return this.isHeld ? this.stiffness * Math.hypot(...this.to.map((each, c) => each - at[c])) : 0;
  }

  /** Pull on, now and then. @param {number} now [ms] */
  renew(now) {
    if (!this.isHeld || now - this._sentAt < RENEW_EVERY) return;
    this._sentAt = now;
    this._say(this.stiffness);
  }

  /** Let go. @param {number} now [ms] */
  release(now) {
    this.isHeld = false;
    this._from = now;
    this._say(0);
  }

  /** Note where it is. @param {number} now [ms] */
  note(now) {
    const time = (now - this._from) / 1000;
    if (this.isHeld || time > RECORDED) return;
    const rest = this.scene.restPosition(this.segment);
    this.record.push([time, ...this.scene.position(this.segment).map((each, c) => each - rest[c])]);
  }

  /** How long the record is [s]. */
  get seconds() {
    return this.record.at(-1)?.[0] ?? 0;
  }

  /** The free decay as `tree-sway calibrate --record` reads it. */
  csv() {
    const rows = this.record.map((row) => row.map((each) => each.toFixed(6)).join(","));
    return ["time [s],x [m],y [m],z [m]", ...rows, ""].join("\n");
  }

  /** @param {number} stiffness */
  _say(stiffness) {
    this.stream.pull({ segment: this.scene.watched.firstSegment + this.segment, to: this.to, stiffness });
  }
}

/** Drags on the canvas. */
export class Drag {
  /** @param {import("./drawing/scene.js").Scene} scene @param {import("./client.js").TreeStream} stream */
  constructor(scene, stream) {
    this.scene = scene;
    this.stream = stream;
    this.isOn = true;
    /** @type {Pull | null} */
    this.pull = null;
    this._pointer = -1;
    const box = (/** @type {string} */ tag, /** @type {string} */ id) =>
      Object.assign(document.body.appendChild(document.createElement(tag)), { id, hidden: true });
    this._line = box("i", "pull-line");
    this._label = box("output", "pull-force");
    this._save = box("button", "pull-save");
    this._save.addEventListener("click", () => this.save());
    const listen = (/** @type {"pointerdown" | "pointermove" | "pointerup" | "pointercancel"} */ type,
      /** @type {(event: PointerEvent) => void} */ act) => scene.canvas.addEventListener(type, (event) => {
      if (type === "pointerdown" ? !this.isOn || !this._grab(event) : event.pointerId !== this._pointer) return;
      event.stopImmediatePropagation();
      act(event);
    }, { capture: true });
    listen("pointerdown", (event) => scene.canvas.setPointerCapture(event.pointerId));
    listen("pointermove", (event) => this._move(event));
    for (const type of /** @type {const} */ (["pointerup", "pointercancel"])) listen(type, () => this._release());
  }

  /** @param {PointerEvent} event */
  _grab({ pointerId, clientX, clientY }) {
    const { clientWidth: wide, clientHeight: high } = this.scene.canvas;
    const segment = this._pointer < 0 ? this.scene.nearest(clientX / wide, clientY / high).segment : -1;
    if (segment < 0) return false;
    this.pull = new Pull(this.scene, this.stream, segment);
    this._pointer = pointerId;
    return true;
  }

  /** @param {PointerEvent} event */
  _move({ clientX, clientY }) {
    if (!this.pull) return;
    const { canvas, camera } = this.scene;
    this.pull.to = camera.under(clientX / canvas.clientWidth, clientY / canvas.clientHeight, this.pull.to);
  }

  _release() {
    this._pointer = -1;
    this.pull?.release(this.stream.playout.shown);
  }

  /** Go on with what is drawn. */
  frame() {
    const { pull, scene: { camera, canvas }, _line: line, _label: label } = this;
    line.hidden = label.hidden = !pull?.isHeld;
    if (!pull) return;
    pull.renew(performance.now());
    pull.note(this.stream.playout.shown);
    this._save.hidden = pull.isHeld || pull.seconds < OFFERED;
    this._save.textContent = word("decay", pull.seconds.toFixed(0));
    if (!pull.isHeld) return;
    const [[x, y], [u, v]] = [this.scene.position(pull.segment), pull.to].map((each) =>
      camera.project(each).map((share, c) => share * (c ? canvas.clientHeight : canvas.clientWidth)));
    line.style.cssText = `left:${x}px;top:${y}px;width:${Math.hypot(u - x, v - y)}px;`
      + `rotate:${Math.atan2(v - y, u - x)}rad`;
    label.style.cssText = `left:${u + 14}px;top:${v - 14}px`;
    label.textContent = `${Number(pull.force.toPrecision(3))} N`;
  }

  /** Take the free decay away. */
  save() {
    if (this.pull) saveFile(new Blob([this.pull.csv()], { type: "text/csv" }), "pull_test.csv");
  }
}
