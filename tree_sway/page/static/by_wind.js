// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Solves the scene on the page where frames carry the wind alone. */

import { PART, PAUSED, RESTARTED } from "./protocol.js";

/** Most steps by which a gap between two frames is bridged. */
const MOST_STEPS = 60;
/** Weight of the newest spacing of frames in their mean. */
const NEWEST = 0.05;

/** Steps a stand by the wind of each frame, and corrects it by the states that come now and then. Over a lost frame the
 * wind is interpolated. tree_sway/stream/by_wind.py does the same. */
export class ByWind {
  /** @type {Frame | null} */
  _last = null;
  _heard = 0;
  /** Number of corrections by states, and the largest over full scale. */
  corrections = 0;
  largest = 0;

  /** @param {import("./sway.js").Stand} stand */
  constructor(stand) {
    this.stand = stand;
    this._spacing = stand.dt;
  }

  /** Step to a frame. @param {Frame} frame @returns {Frame | null} with all coordinates; null before the first state */
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

  /** Take the wind that was under way before the first frame. @param {Recent} gusts */
  goOn(gusts) {
    this.stand.gusts.goOn(gusts);
    this._heard = gusts.sequence;
  }

  /** Make the steps between two frames. @param {Frame} last @param {Frame} frame */
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
