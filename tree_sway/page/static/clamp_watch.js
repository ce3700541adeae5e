// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Finds trees whose steps stay clamped, which are then reset with fewer coordinates, as in
 * tree_sway/core/run/clamp_watch.py. */

/** Longest time in which steps may be clamped; free steps in between are subtracted [s]. */
const LONGEST_CLAMPED = 1;
/** Smallest number of coordinates. */
const FEWEST = 3;

/** Sums the time for which the steps of a tree were clamped. */
export class ClampWatch {
  _seconds = 0;
  _last = 0;

  /** Note a clamped step; steps that are not clamped need no call. @param {number} step its number
   * @param {number} dt [s] @returns {boolean} whether the tree has been clamped for too long */
  isStuck(step, dt) {
    this._seconds = Math.max(this._seconds - (step - this._last - 1) * dt, 0) + dt;
    this._last = step;
    if (this._seconds < LONGEST_CLAMPED) return false;
    this._seconds = 0;
    return true;
  }
}

/** The next smaller number of coordinates, two thirds of a count. @param {number} count */
export const fewer = (count) => Math.min(count, Math.max(FEWEST, Math.floor((2 * count) / 3)));
