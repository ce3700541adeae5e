// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Playout buffer: turns frames that arrive irregularly into smooth motion. States are shown a little late, on a
 * Catmull-Rom curve through them. Where frames are close together, the next one is predicted on the parabola of
 * the last three, since a tree has inertia. The last minute is kept to look back at. */

import { PAUSED, RESTARTED, WIND_LOST } from "./protocol.js";

/** Initial and longest playout delay [ms]. The delay is the spacing of frames and their largest lateness, which
 * decays with the time constant below. */
const DELAY = 150;
/** Time constant of the largest lateness [ms]: the age of the connection, at least and at most this. */
const YOUNGEST = 250, CALMS = 12000;
/** Fastest change of the delay, down and up, per time that passes [-]. */
const DOWN = 0.05, UP = 0.2;
/** Frames closer together than this are continued by a predicted one [ms]. */
const PREDICTED = 30;
/** Time in which the quickest frame gives the offset of the clocks [ms]. */
const WINDOW = 30000;
/** Frames further apart than this are not joined by a curve [ms]. */
const LONGEST_GAP = 500;
/** Time over which the picture is blended after such a gap [ms]. */
const BLEND = 400;
/** How long frames are kept [ms], and how many of their numbers at most. */
const KEPT = 62000, MOST_NUMBERS = 8e6;

/** Offset of two clocks from one-way times. Arrival less stamp is offset plus travel time; its least value in the
 * last half minute is the offset plus the quickest travel. */
class ClockOffset {
  _least = /** @type {{at: number, value: number}[]} */ ([]);

  /** @param {number} stamp sender's clock [ms] @param {number} arrival own clock [ms] */
  add(stamp, arrival) {
    const value = arrival - stamp;
    // The sender has started again, or its clock was set.
    if (Math.abs(value - this.value) > 5000) this._least.length = 0;
    this._least = this._least.filter((each) => each.value < value && each.at >= arrival - WINDOW);
    this._least.push({ at: arrival, value });
  }

  /** Own clock less the sender's, and the quickest travel [ms]. */
  get value() {
    return this._least[0]?.value ?? 0;
  }
}

/** Buffer of the newest frames, and the state to draw at a time. */
export class Playout {
  /** Mean spacing of frames, their largest lateness, the age of the connection [ms]. */
  _spacing = 0;
  _jitter = DELAY / 2;
  _age = YOUNGEST;
  /** How far a predicted frame is ahead [ms]; 0 without. */
  _ahead = 0;
  clock = new ClockOffset();
  /** @type {Frame[]} */
  _frames = [];
  /** Index of the first frame since the last gap; those before it are for looking back. */
  _first = 0;
  received = 0;
  /** Number of frames that came too late to be shown. */
  late = 0;
  /** Travel time of the newest frame beyond the quickest [ms]. */
  lateness = 0;
  /** @type {Float32Array | null} */
  _shown = null;
  _cutAt = 0;
  /** @type {[number, number, number]} */
  wind = [0, 0, 0];
  isPaused = false;
  /** Whether no sample of the wind is in use. */
  isWindLost = true;
  /** How far to look back from `_from` [ms]; 0 follows the stream. */
  back = 0;
  /** Stamp of the newest frame when looking back began [ms]. */
  _from = 0;

  /** @param {number} [delay] fixed [ms]; adapted to the connection if left out */
  constructor(delay) {
    this.delay = delay ?? DELAY;
    this._adapts = delay === undefined;
    /** State shown before the last gap, and the time when frames came again [ms]. */
    this._before = this._shown;
  }

  /** Look back from the newest frame. @param {number} back how far [ms]; 0 follows the stream */
  lookBack(back) {
    if (!this.back) this._from = this.newest;
    this.back = back;
  }

  /** Forget all frames, as another tree comes. */
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
    const isOtherClock = span <= 0;
    if (isOtherClock) frames.length = 0;
    if (last && (isOtherClock || span > LONGEST_GAP || frame.flags & RESTARTED)) {
      this._before = this._shown?.slice() ?? null;
      this._cutAt = arrival;
      this._first = frames.length;
    }
    this.received++;
    this.clock.add(frame.stamp, arrival);
    this.lateness = arrival - frame.stamp - this.clock.value;
    if (this.lateness > this.delay + this._ahead) this.late++;
    const isFirst = !last || this._first === frames.length;
    if (this._adapts && !isFirst) this._adaptDelay(span);
    frames.push(frame);
    const most = Math.max(64, MOST_NUMBERS / frame.coordinates.length);
    while (frames[0].stamp < frame.stamp - KEPT || frames.length > most) {
      frames.shift();
      this._first = Math.max(this._first - 1, 0);
    }
  }

  /** Move the delay towards what the connection needs. @param {number} span time since the last frame [ms] */
  _adaptDelay(span) {
    this._spacing += 0.1 * (span - this._spacing);
    this._age += span;
    this._jitter = Math.max(this.lateness, this._jitter * Math.exp(-span / Math.min(this._age, CALMS)));
    this._ahead = this._spacing < PREDICTED ? this._spacing : 0;
    const change = Math.min(this._spacing - this._ahead + this._jitter, DELAY) - this.delay;
    this.delay += Math.min(Math.max(change, -DOWN * span), UP * span);
  }

  /** Stamp of the newest frame [ms]; 0 before the first. */
  get newest() {
    return this._frames.at(-1)?.stamp ?? 0;
  }

  /** Frames with a later stamp. @param {number} stamp [ms] */
  since(stamp) {
    return this._frames.filter((frame) => frame.stamp > stamp);
  }

  /** The state to draw; null before the first frame. @param {number} now own clock [ms]
   * @returns {Float32Array | null} the same array each time */
  sample(now) {
    let frames = this._frames;
    if (!frames.length) return this._shown;
    const isBack = this.back > 0;
    const time = isBack ? this._from - this.back : now - this.clock.value - this.delay;
    const first = isBack ? 0 : this._first;
    const [x, y, z] = frames.slice(Math.max(first, frames.length - 3));
    const isPredicted = this._ahead > 0 && !isBack && z && time > y.stamp && z.stamp - y.stamp < PREDICTED;
    if (isPredicted) frames = [...frames, predicted(x, y, z)];
    let next = frames.length - 1;
    while (next > first + 1 && frames[next - 1].stamp > time) next--;
    const before = Math.max(next - 1, first);
    const a = frames[before], b = frames[next];
    // Nothing lies between the two sides of a restart or a gap.
    const isJump = Boolean(b.flags & RESTARTED) || b.stamp - a.stamp > LONGEST_GAP;
    const share = isJump ? Number(time >= b.stamp) : (time - a.stamp) / (b.stamp - a.stamp);
    const u = before === next || a.stamp === b.stamp ? 1 : Math.min(Math.max(share, 0), 1);
    if (this._shown?.length !== b.coordinates.length) this._shown = new Float32Array(b.coordinates.length);
    catmullRom(frames[Math.max(before - 1, first)], a, b, frames[Math.min(next + 1, frames.length - 1)], u, this._shown);
    for (let c = 0; c < 3; c++) this.wind[c] = a.wind[c] + u * (b.wind[c] - a.wind[c]);
    this.isPaused = (b.flags & PAUSED) !== 0;
    this.isWindLost = (b.flags & WIND_LOST) !== 0;
    if (!isBack) this._blend(now, this._shown);
    return this._shown;
  }

  /** Blend from the state before a gap. @param {number} now @param {Float32Array} shown changed in place */
  _blend(now, shown) {
    const u = (now - this._cutAt) / BLEND;
    if (u >= 1 || this._before?.length !== shown.length) this._before = null;
    if (!this._before) return;
    const share = u * u * (3 - 2 * u);
    for (let i = 0; i < shown.length; i++) shown[i] = this._before[i] + share * (shown[i] - this._before[i]);
  }
}

/** The frame that follows three on the parabola through them. @param {Frame} a @param {Frame} b @param {Frame} c
 * @returns {Frame} */
function predicted(a, b, c) {
  if (new Set([a, b, c].map(({ coordinates }) => coordinates.length)).size > 1) return c;
  const span = c.stamp - b.stamp, before = b.stamp - a.stamp;
  const coordinates = c.coordinates.map((each, i) => {
    const step = each - b.coordinates[i];
    const lastStep = ((b.coordinates[i] - a.coordinates[i]) * span) / before;
    return each + step + ((2 * span) / (span + before)) * (step - lastStep);
  });
  return { ...c, stamp: c.stamp + span, flags: c.flags & (PAUSED | WIND_LOST), coordinates };
}

/** Catmull-Rom curve from b to c; its slopes there are those from a to c and from b to d. @param {Frame} a @param {Frame} b
 * @param {Frame} c @param {Frame} d @param {number} u from b to c, 0 to 1 @param {Float32Array} out */
function catmullRom(a, b, c, d, u, out) {
  const span = c.stamp - b.stamp, aToC = c.stamp - a.stamp, bToD = d.stamp - b.stamp;
  const u2 = u * u, u3 = u * u * u;
  const atB = 2 * u3 - 3 * u2 + 1, atC = 3 * u2 - 2 * u3; // Hermite polynomials
  const slopeAtB = aToC > 0 ? ((u3 - 2 * u2 + u) * span) / aToC : 0;
  const slopeAtC = bToD > 0 ? ((u3 - u2) * span) / bToD : 0;
  // A frame may be longer by the rotations of pulled branches, which are not interpolated.
  const count = Math.min(...[a, b, c, d].map(({ coordinates }) => coordinates.length));
  for (let i = count; i < out.length; i++) out[i] = c.coordinates[i];
  for (let i = 0; i < count; i++) {
    out[i] = atB * b.coordinates[i] + atC * c.coordinates[i]
      + slopeAtB * (c.coordinates[i] - a.coordinates[i]) + slopeAtC * (d.coordinates[i] - b.coordinates[i]);
  }
}
