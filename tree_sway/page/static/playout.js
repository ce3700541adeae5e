// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** From frames that arrive when they will to a smooth motion: shown a little late, on a curve through the
 * states (Catmull-Rom); where they are close together one more is expected on the parabola of the last three, as
 * a tree has inertia. The last minute is kept to look back at. */

import { PAUSED, RESTARTED } from "./protocol.js";

/** Longest playout delay, and that of the beginning [ms]. */
export const DELAY = 150;
/** The delay is what frames were late by, forgotten in CALMS [ms], at first in FIRST and then in as long as
 * the line is known, and a frame; it goes up and down by these shares of the time. */
const [CALMS, FIRST] = [12000, 250];
const [DOWN, UP] = [0.05, 0.2];
/** Spacing of states up to which one more is expected [ms]. */
const AHEAD = 30;
/** Of the clocks, the longest gap, of the blend after one [ms]. */
const [WINDOW, LONGEST_GAP, BLEND] = [30000, 500, 400];
/** How long states are kept [ms], and how many numbers of theirs at most. */
const [KEPT, MOST_NUMBERS] = [62000, 8e6];

/** Difference of two clocks from one-way times: arrival less stamp is offset plus travel, so the least of
 * the last half minute is the offset and the quickest travel. */
export class ClockOffset {
  _least = /** @type {{at: number, value: number}[]} */ ([]);

  /** @param {number} stamp sender's clock [ms] @param {number} arrival own clock [ms] */
  add(stamp, arrival) {
    const value = arrival - stamp;
    // A sender whose clock was set back or that started again is another clock.
    if (Math.abs(value - this.value) > 5000) this._least.length = 0;
    this._least = this._least.filter((each) => each.value < value && each.at >= arrival - WINDOW);
    this._least.push({ at: arrival, value });
  }

  /** Own clock less the sender's, and the quickest travel [ms]. */
  get value() {
    return this._least[0]?.value ?? 0;
  }
}

/** The newest states, and what to draw of them. */
export class Playout {
  /** @param {number} [delay] [ms]; as the line asks for if left out */
  constructor(delay) {
    this.delay = delay ?? DELAY;
    this._adapts = delay === undefined;
    this._spacing = 0;
    this._jitter = DELAY / 2;
    this._age = FIRST;
    this._ahead = 0;
    this.clock = new ClockOffset();
    this._frames = /** @type {Frame[]} */ ([]);
    /** The first since the stream was cut; those before it are for looking back. */
    this._first = 0;
    this.received = 0;
    /** Frames that came after they were to be shown. */
    this.late = 0;
    /** Age of the newest frame when it came, over the quickest [ms]. */
    this.lateness = 0;
    this._shown = /** @type {Float32Array | null} */ (null);
    /** What was drawn when the stream was cut, and the time of that [ms]. */
    this._before = this._shown;
    this._cutAt = 0;
    /** @type {[number, number, number]} */
    this.wind = [0, 0, 0];
    this.isPaused = false;
    this._back = 0;
    /** Stamp of the newest frame when people began to look back [ms]. */
    this._from = 0;
  }

  /** How long before the moment that people began to look back at [ms]; 0 follows the stream. */
  get back() {
    return this._back;
  }

  set back(back) {
    if (!this._back) this._from = this.newest;
    this._back = back;
  }

  /** Forget everything: another tree comes. */
  clear() {
    this._frames.length = this._first = 0;
    this._before = this._shown = null;
  }

  /** Take a frame. @param {Frame} frame @param {number} arrival [ms] */
  push(frame, arrival) {
    const frames = this._frames;
    const last = frames.at(-1);
    const span = frame.stamp - (last?.stamp ?? -Infinity);
    if (span <= 0 && span > -1000) return; // twice, or out of order
    if (span <= 0) frames.length = 0;
    if (last && (span <= 0 || span > LONGEST_GAP || frame.flags & RESTARTED)) {
      [this._before, this._cutAt, this._first] = [this._shown?.slice() ?? null, arrival, frames.length];
    }
    this.received++;
    this.clock.add(frame.stamp, arrival);
    this.lateness = arrival - frame.stamp - this.clock.value;
    if (this.lateness > this.delay + this._ahead) this.late++;
    if (this._adapts && last && this._first < frames.length) {
      this._spacing += 0.1 * (span - this._spacing);
      this._age += span;
      this._jitter = Math.max(this.lateness, this._jitter * Math.exp(-span / Math.min(this._age, CALMS)));
      this._ahead = this._spacing < AHEAD ? this._spacing : 0;
      const change = Math.min(this._spacing - this._ahead + this._jitter, DELAY) - this.delay;
      this.delay += Math.min(Math.max(change, -DOWN * span), UP * span);
    }
    frames.push(frame);
    const most = Math.max(64, MOST_NUMBERS / frame.coordinates.length);
    while (frames[0].stamp < frame.stamp - KEPT || frames.length > most) {
      frames.shift();
      this._first = Math.max(this._first - 1, 0);
    }
  }

  /** Stamp of the newest frame [ms]; 0 before the first. */
  get newest() {
    return this._frames.at(-1)?.stamp ?? 0;
  }

  /** Frames that came after one. @param {number} stamp of that one [ms] */
  since(stamp) {
    return this._frames.filter((frame) => frame.stamp > stamp);
  }

  /** The state to draw; null before the first frame. @param {number} now own clock [ms]
   * @returns {Float32Array | null} the same array each time */
  sample(now) {
    let frames = this._frames;
    if (!frames.length) return this._shown;
    const time = this._back ? this._from - this._back : now - this.clock.value - this.delay;
    const first = this._back ? 0 : this._first;
    const [x, y, z] = frames.slice(Math.max(first, frames.length - 3));
    if (this._ahead && !this._back && z && time > y.stamp && z.stamp - y.stamp < AHEAD) frames = [...frames, expected(x, y, z)];
    let i2 = frames.length - 1;
    while (i2 > first + 1 && frames[i2 - 1].stamp > time) i2--;
    const i1 = Math.max(i2 - 1, first);
    const [a, b] = [frames[i1], frames[i2]];
    // A jump is shown as one: nothing lies between its ends.
    const isJump = Boolean(b.flags & RESTARTED) || b.stamp - a.stamp > LONGEST_GAP;
    const share = isJump ? Number(time >= b.stamp) : (time - a.stamp) / (b.stamp - a.stamp);
    const u = i1 === i2 || a.stamp === b.stamp ? 1 : Math.min(Math.max(share, 0), 1);
    if (this._shown?.length !== b.coordinates.length) this._shown = new Float32Array(b.coordinates.length);
    catmullRom(frames[Math.max(i1 - 1, first)], a, b, frames[Math.min(i2 + 1, frames.length - 1)], u, this._shown);
    for (let c = 0; c < 3; c++) this.wind[c] = a.wind[c] + u * (b.wind[c] - a.wind[c]);
    this.isPaused = (b.flags & PAUSED) !== 0;
    if (!this._back) this._blend(now, this._shown);
    return this._shown;
  }

  /** @param {number} now @param {Float32Array} shown */
  _blend(now, shown) {
    const u = (now - this._cutAt) / BLEND;
    if (u >= 1 || this._before?.length !== shown.length) this._before = null;
    if (!this._before) return;
    const share = u * u * (3 - 2 * u);
    for (let i = 0; i < shown.length; i++) shown[i] = this._before[i] + share * (shown[i] - this._before[i]);
  }
}

/** What is next on a parabola. @param {Frame} a @param {Frame} b @param {Frame} c @returns {Frame} */
function expected(a, b, c) {
  if (new Set([a, b, c].map(({ coordinates }) => coordinates.length)).size > 1) return c;
  const [span, before] = [c.stamp - b.stamp, b.stamp - a.stamp];
  const coordinates = c.coordinates.map((each, i) => {
    const [by, slower] = [each - b.coordinates[i], ((b.coordinates[i] - a.coordinates[i]) * span) / before];
    return each + by + ((2 * span) / (span + before)) * (by - slower);
  });
  return { ...c, stamp: c.stamp + span, flags: c.flags & PAUSED, coordinates };
}

/** The curve through b and c whose slopes there come from the neighbours. @param {Frame} a @param {Frame} b
 * @param {Frame} c @param {Frame} d @param {number} u from b to c, 0 to 1 @param {Float32Array} out */
export function catmullRom(a, b, c, d, u, out) {
  const [span, before, behind] = [c.stamp - b.stamp, c.stamp - a.stamp, d.stamp - b.stamp];
  const [u2, u3] = [u * u, u * u * u];
  const [hb, hc] = [2 * u3 - 3 * u2 + 1, 3 * u2 - 2 * u3];
  const sb = before > 0 ? ((u3 - 2 * u2 + u) * span) / before : 0;
  const sc = behind > 0 ? ((u3 - u2) * span) / behind : 0;
  // One may have more: what is pulled.
  const count = Math.min(...[a, b, c, d].map(({ coordinates }) => coordinates.length));
  for (let i = count; i < out.length; i++) out[i] = c.coordinates[i];
  for (let i = 0; i < count; i++) {
    out[i] = hb * b.coordinates[i] + hc * c.coordinates[i]
      + sb * (c.coordinates[i] - a.coordinates[i]) + sc * (d.coordinates[i] - b.coordinates[i]);
  }
}
