// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Frames of the wind alone, to whole ones: a page that solves the scene by itself. */

import { PART, PAUSED, RESTARTED } from "./protocol.js";

/** Steps that a gap between two frames is bridged by, at most. */
const MOST_STEPS = 60;
const NEWEST = 0.05;

/** Solves a stand by the wind of each frame, and follows the states among them; a frame that is lost is
 * bridged by a wind between the two that came. tree_sway/stream/by_wind.py does the same. */
export class ByWind {
  /** @param {import("./sway.js").Stand} stand */
  constructor(stand) {
    this.stand = stand;
    this._last = /** @type {Frame | null} */ (null);
    this._spacing = stand.dt;
    this._heard = 0;
    /** States that the stand was brought to, and the largest change by one over full scale. */
    this.corrections = 0;
    this.largest = 0;
  }

  /** Go on to a frame. @param {Frame} frame @returns {Frame | null} whole; null before the first state */
  take(frame) {
    const { stand, _last: last } = this;
    const { coordinates: values, flags, first } = frame;
    const isWhole = values.length > 0 && !(flags & PART);
    if (!last && !isWhole) return null;
    if (!last) {
      stand.correct(values);
      const missed = (frame.sequence - this._heard) >>> 0;
      for (let i = missed > MOST_STEPS ? 0 : missed; i > 0; i--) stand.gusts.push(...frame.wind);
    } else if (flags & RESTARTED) stand.reset();
    else if (!(flags & PAUSED)) this._step(last, frame);
    if (last && values.length) {
      const span = (frame.stamp - last.stamp) / 1000;
      const change = stand.correct(values, first, !this.corrections && isWhole && span > 0 ? span / stand.dt : Infinity);
      if (this.corrections++) this.largest = Math.max(this.largest, change);
    }
    this._last = frame;
    return { ...frame, flags: flags & ~PART, coordinates: stand.state() };
  }

  /** Feel the wind that was on its way before the first frame. @param {Recent} gusts */
  goOn(gusts) {
    this.stand.gusts.goOn(gusts);
    this._heard = gusts.sequence;
  }

  /** Go on by the steps between two frames. @param {Frame} last @param {Frame} frame */
  _step(last, frame) {
    const { stand } = this;
    const count = Math.max((frame.sequence - last.sequence) >>> 0, 1);
    const spacing = (frame.stamp - last.stamp) / 1000 / count;
    this._spacing += NEWEST * (Math.min(Math.max(spacing, 0), 1) - this._spacing);
    const steps = Math.min(count * Math.max(1, Math.round(this._spacing / stand.dt)), MOST_STEPS);
    for (let step = 1; step <= steps; step++) {
      const [x, y, z] = last.wind.map((each, c) => each + (step / steps) * (frame.wind[c] - each));
      stand.step(x, y, z);
    }
  }
}
