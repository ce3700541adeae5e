// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Quality of the drawing without a graphics unit. As the frame rate falls, first pixels are saved, then grass, then
 * leaves. */

/** Frames per second: above the first more pixels are tried, and kept if the second remains; below the third fewer are
 * drawn, below the last grass and leaves are left out. */
const WANTED = 58.5, KEPT = 57, FEW = 50, LEAST = 24;
/** Wait before more pixels are tried, doubled with each failure up to LONGEST [ms]. */
const PATIENCE = 8000, LONGEST = 120000;
/** Fewest pixels per pixel of the page, each way. */
export const COARSEST = 0.5;
/** Smallest share of the leaves. */
const THINNEST = 0.4;

export class Quality {
  /** Pixels of the picture per pixel of the page, each way. */
  fineness = 1;
  /** Share of the leaves that is drawn. */
  density = 1;
  /** Whether there is time for grass. */
  hasGrass = true;
  _from = 0;
  _frames = 0;
  _last = 0;
  _coarsened = 0;
  _patience = PATIENCE;
  /** Fineness before more pixels were tried; 0 once they are kept. */
  _before = 0;

  /** Count a frame. @param {number} now [ms] @param {boolean} hasLeaves whether there are any to leave out */
  count(now, hasLeaves) {
    // A page that was hidden was not slow.
    if (now - this._last > 1500) [this._from, this._frames] = [now, -1];
    this._last = now;
    this._frames++;
    if (now - this._from < 700 || this._frames < 3) return;
    const fps = (1000 * this._frames) / (now - this._from);
    this._from = now;
    this._frames = 0;
    if (this._before && fps < KEPT) {
      this.fineness = this._before;
      this._patience = Math.min(LONGEST, 2 * this._patience);
      this._coarsened = now;
      this._before = 0;
      return;
    }
    this._before = 0;
    if (fps < FEW && this.fineness > COARSEST) {
      this.fineness = Math.max(COARSEST, this.fineness * Math.max(0.75, Math.sqrt(fps / WANTED)));
      this._coarsened = now;
    } else if (fps < LEAST && this.hasGrass) {
      this.hasGrass = false;
      this._coarsened = now;
    } else if (fps < LEAST && hasLeaves) {
      this.density = Math.max(THINNEST, this.density * 0.85);
    } else if (fps > WANTED && this.fineness < 1 && now - this._coarsened > this._patience) {
      this._before = this.fineness;
      this.fineness = Math.min(1, this.fineness * 1.06);
    } else if (fps > LEAST + 6 && this.density < 1) {
      this.density = Math.min(1, this.density * 1.05);
    } else if (fps > LEAST + 6 && !this.hasGrass && now - this._coarsened > PATIENCE) {
      this.hasGrass = true;
    }
  }

  /** Percentage of pixels and leaves that are drawn; null if all are. */
  get leftOut() {
    if (this.fineness > 0.99 && this.density > 0.99) return null;
    return { pixels: Math.round(100 * this.fineness ** 2), leaves: Math.round(100 * this.density) };
  }
}
