// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Gusts over the ground. The mean wind carries turbulence (Taylor 1938), so a gust at the trees was upwind before and is
 * downwind later. For a simulated or recorded wind the gusts to come are known. */

/** Number of places along the wind. */
export const PLACES = 48;
/** Interval and length of the record of speeds [s]. */
const EVERY = 0.1, KEPT = 30;
const SLOTS = KEPT / EVERY;

export class Gusts {
  /** Speeds [m/s] from the farthest place upwind to the farthest downwind. */
  speeds = new Float32Array(PLACES);
  _past = new Float32Array(SLOTS);
  _newest = 0;
  /** Speeds to come: time of the first [s], spacing [s], speeds [m/s]. */
  _from = 0;
  _spacing = 1;
  _coming = /** @type {number[]} */ ([]);

  /** Take the wind of a time. @param {number} time [s] @param {number} speed [m/s] */
  add(time, speed) {
    const now = Math.floor(time / EVERY);
    if (now - this._newest > SLOTS || now < this._newest) this._newest = now - SLOTS;
    while (this._newest < now) this._past[++this._newest % SLOTS] = speed;
    this._past[now % SLOTS] = speed;
  }

  /** Take the speeds to come. @param {number} time of the first speed [s] @param {{every: number,
   * speeds: number[]}} [ahead] spacing [s] and speeds [m/s]; absent for a measured wind */
  foresee(time, { every, speeds } = { every: 1, speeds: [] }) {
    [this._from, this._spacing, this._coming] = [time, every, speeds];
  }

  /** Speed at the trees at a time; the mean where it is not known. @param {number} time [s]
   * @param {number} mean [m/s] */
  at(time, mean) {
    const slot = Math.floor(time / EVERY);
    if (slot <= this._newest) return slot > this._newest - SLOTS && slot >= 0 ? this._past[slot % SLOTS] : mean;
    const place = Math.max(0, (time - this._from) / this._spacing);
    const [low, high] = [Math.floor(place), Math.floor(place) + 1].map((i) => this._coming[i] ?? mean);
    return low + (place % 1) * (high - low);
  }

  /** Find the speeds along the wind now. @param {number} time [s] @param {number} mean [m/s]
   * @param {number} reach how far up and down the wind [m] */
  spread(time, mean, reach) {
    for (let i = 0; i < PLACES; i++) {
      const far = reach * ((2 * i) / (PLACES - 1) - 1);
      this.speeds[i] = this.at(time - far / Math.max(mean, 0.5), mean);
    }
  }
}
