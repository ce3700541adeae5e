// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Pulls a branch by hand: a spring to the pointer, then the free decay as a pull test. */

import { save } from "./keepsake.js";
import { element } from "./panel.js";
import { STRIDE } from "./placing.js";
import { distance } from "./quaternions.js";
import { chainTo, Touch } from "./touch.js";
import { word } from "./words.js";

/** Young's modulus where the description has none [Pa]. */
const MODULUS = 8e9;
/** Interval at which a pull is renewed [ms]. */
const RENEW_EVERY = 100;
/** Growth of the stiffness of a spring that is too weak, and its largest value [N/m]. */
const HARDER = 1.4, STIFFEST = 1e5;
/** Length of the record of a free decay, and the length from which on it can be saved [s]. */
const RECORDED = 30, OFFERED = 3;
/** Time after which a release has surely reached the server [ms]. */
const RELEASED = 250;
/** Movement of the hand per key press, over the size of the picture, and its directions. */
const KEY_STEP = 0.02;
/** @type {Record<string, number[]>} */
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
/** Gap between frames above which the solver did not catch up [s]. */
const WAITED = 0.25;
/** Number of trees that are searched for a branch, the largest on the screen first. */
const MOST_TREES = 60;

/** Stiffness of the wood that carries a segment [N/m]: a spring as stiff bends a branch half of the way.
 * @param {Scene} scene @param {number} segment of the watched tree */
function stiffnessAt(scene, segment) {
  const { kind, rest, place } = scene.watched;
  const { branch_first: first, segment_length: length, segment_radius: radius } = kind.arrays;
  let compliance = 0;
  for (const branch of chainTo(kind, segment)) {
    for (let s = first[branch]; s < Math.min(first[branch + 1], segment); s++) {
      const away = distance(rest.subarray(STRIDE * segment), rest.subarray(STRIDE * s));
      compliance += (away ** 2 * length[s]) / ((kind.modulus ?? MODULUS) * 0.25 * Math.PI * radius[2 * s] ** 4);
    }
  }
  return Math.min(STIFFEST, place[4] / Math.max(compliance, 1e-9));
}

/** A force in words, to three digits. @param {number} force [N] */
export function forceText(force) {
  const rounded = Number(force.toPrecision(3));
  return rounded < 1000 ? `${rounded} N` : `${Number((rounded / 1000).toPrecision(3))} kN`;
}

/** One pull at a branch: its spring, then the record of the free decay. */
export class Pull {
  _sentAt = -Infinity;
  /** Time [s] and displacement [m] since the release. @type {number[][]} */
  record = [];
  _from = Infinity;
  isHeld = true;
  /** @type {Touch | null} */
  _touch = null;
  /** Newest frame of the record. @type {Frame | null} */
  _last = null;

  /** @param {Scene} scene @param {TreeStream} stream @param {number} segment of the watched tree */
  constructor(scene, stream, segment) {
    this.scene = scene;
    this.stream = stream;
    this.segment = segment;
    this.stiffness = stiffnessAt(scene, segment);
    this.to = scene.position(segment);
  }

  /** Force of the spring [N]. */
  get force() {
    return this.isHeld ? this.stiffness * distance(this.to, this.scene.position(this.segment)) : 0;
  }

  /** Renew the pull at its interval, with a stiffer spring until the branch comes half of the way. @param {number} now [ms] */
  renew(now) {
    if (!this.isHeld || now - this._sentAt < RENEW_EVERY) return;
    this._sentAt = now;
    const whole = distance(this.to, this.scene.restPosition(this.segment));
    const isFar = this.force > 0.5 * this.stiffness * whole;
    if (isFar) this.stiffness = Math.min(HARDER * this.stiffness, STIFFEST);
    this._say(this.stiffness);
  }

  /** Release; the free decay begins with the next state. */
  release() {
    this.isHeld = false;
    this._from = this.stream.playout.newest + RELEASED;
    this._say(0);
  }

  /** Record the place of the segment in the frames that have come. */
  note() {
    const { description, playout } = this.stream;
    if (this.isHeld || !description || this.seconds > RECORDED) return;
    this._touch ??= new Touch(description, this.scene.watched.number);
    const { firstCoordinate: first } = this._touch.tree;
    const rest = this.scene.restPosition(this.segment);
    for (const frame of playout.since(this._last?.stamp ?? this._from)) {
      const own = Float64Array.from(frame.coordinates.subarray(first, first + this._touch.kind.nCoordinates));
      const at = this._touch.place(this.segment, own);
      const last = this._last ?? frame;
      const count = Math.max(1, (frame.sequence - last.sequence) >>> 0);
      let span = (frame.stamp - last.stamp) / 1000;
      // On a busy machine the solver stood still in the meantime, and the tree with it.
      if (span > WAITED * count) span = (count * this.seconds) / this.record.length;
      this.record.push([this.seconds + span, ...rest.map((each, c) => at[c] - each)]);
      this._last = frame;
    }
  }

  /** Length of the record [s]. */
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

export class Drag {
  isOn = false;
  /** @type {Pull | null} */
  pull = null;
  _pointer = -1;

  /** @param {Scene} scene @param {TreeStream} stream */
  constructor(scene, stream) {
    this.scene = scene;
    const [line, label, saving] = ["pull-line", "pull-force", "pull-save"].map(element);
    this._shown = { line, label, saving };
    saving.onclick = () => save(new Blob([this.pull?.csv() ?? ""]), "pull_test", "csv");
    /** Handlers, which return whether the event was for them. @type {Record<string, (event: any) => boolean>} */
    const takers = {
      pointerdown: (event) => {
        const segment = this.isOn && this._pointer < 0 ? this._under(event) : -1;
        if (segment < 0) return false;
        this.pull = new Pull(scene, stream, segment);
        this._pointer = event.pointerId;
        scene.canvas.setPointerCapture(event.pointerId);
        return true;
      },
      pointermove: (event) => {
        if (!this.pull || event.pointerId !== this._pointer) return false;
        this.pull.to = scene.camera.under(scene.placeOf(event), this.pull.to);
        return true;
      },
      pointerup: (event) => this._release(event), pointercancel: (event) => this._release(event),
      // Arrows pull the tip that is followed, Enter releases.
      keydown: (event) => {
        const { key } = event;
        if (!this.isOn || !(key in WAYS || (key === "Enter" && this.pull?.isHeld))) return false;
        event.preventDefault();
        if (key === "Enter") return this._release({ pointerId: this._pointer });
        if (!this.pull?.isHeld) this.pull = new Pull(scene, stream, scene.followed);
        const [u, v] = scene.camera.project(this.pull.to);
        this.pull.to = scene.camera.under([u + KEY_STEP * WAYS[key][0], v + KEY_STEP * WAYS[key][1]], this.pull.to);
        return true;
      },
    };
    for (const [type, take] of Object.entries(takers)) {
      scene.canvas.addEventListener(type, (event) => take(event) && event.stopImmediatePropagation(), true);
    }
  }

  toggle() {
    this.isOn = !this.isOn;
  }

  /** Segment under the pointer, or -1; its tree is the watched one from then on. @param {PointerEvent} event */
  _under(event) {
    const { scene, scene: { detail } } = this;
    const before = detail.watched;
    for (const tree of [before, ...detail.order.subarray(0, MOST_TREES)]) {
      detail.watched = tree;
      const { segment } = detail.level[tree] > 0 ? scene.under(event) : { segment: -1 };
      if (segment >= 0 && tree !== before) scene.picked = -1;
      if (segment >= 0) return segment;
    }
    detail.watched = before;
    return -1;
  }

  /** @param {{pointerId: number}} event */
  _release({ pointerId }) {
    if (pointerId !== this._pointer) return false;
    this._pointer = -1;
    this.pull?.release();
    return true;
  }

  frame() {
    const { pull, scene: { camera, canvas }, _shown: { line, label, saving } } = this;
    line.hidden = label.hidden = !pull?.isHeld;
    if (!pull) return;
    pull.renew(performance.now());
    pull.note();
    saving.hidden = pull.isHeld || pull.seconds < OFFERED;
    saving.textContent = word("decay", pull.seconds.toFixed(0));
    if (!pull.isHeld) return;
    const [[x, y], [u, v]] = [this.scene.position(pull.segment), pull.to].map((each) =>
      camera.project(each).map((share, c) => share * (c ? canvas.clientHeight : canvas.clientWidth)));
    line.style.cssText = `left:${x}px;top:${y}px;width:${Math.hypot(u - x, v - y)}px;`
      + `rotate:${Math.atan2(v - y, u - x)}rad`;
    label.style.cssText = `left:${u + 14}px;top:${v - 14}px`;
    label.textContent = forceText(pull.force);
  }
}
