// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** What is left out without a graphics unit: first pixels, then frames, then grass, then leaves; none grows
 * instead. */

/** Frames per second from which more pixels are tried, those that they must leave, those that fewer are drawn for,
 * and those that leaves are left out for. */
const [WANTED, KEPT, FEW, LEAST] = [58.5, 57, 50, 24];
/** Until more pixels are tried, and at most after they cost frames [ms]. */
const [PATIENCE, LONGEST] = [8000, 120000];
/** Pixels per pixel of the page each way, and the share of leaves, that are drawn at least. */
export const COARSEST = 0.5;
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
    [this._from, this._frames] = [now, 0];
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

  /** What is left out, for people: shares of pixels and leaves in percent; null if nothing. */
  get leftOut() {
    if (this.fineness > 0.99 && this.density > 0.99) return null;
    return { pixels: Math.round(100 * this.fineness ** 2), leaves: Math.round(100 * this.density) };
  }
}
