// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/**
 * How much of each tree is placed and drawn: of a tree that is small on the screen its thickest
 * branches, of one that is out of sight nothing, and of all together no more than a budget.
 */

/** Area of the screen [px^2] that a segment is worth. */
const AREA = 80;
/** Height [px] that the finest level is shaped for. */
const NEAR = 800;
const FEWEST_CARDS = 40;
/** Share of the wanted segments that is drawn at least where the budget is short. */
const COARSEST = 1e-4;

/** @typedef {import("./mesh.js").Level} Level */

/** Levels of a kind: its picture, then each of about twice the segments of the one before.
 * @param {import("../placing.js").KindPlacer} placer
 * @param {number} highest segment, which is of every level @param {number} mostSegments
 * @param {number} mostCards of its leaves
 * @param {number} far height [px] below which a tree is drawn as a picture @returns {Level[]} */
export function levelsOf(placer, highest, mostSegments, mostCards, far) {
  const { reached, order, slots } = placer;
  let branches = 0;
  while (reached[branches] <= slots[highest]) branches++;
  const whole = Math.max(Math.min(mostSegments, reached[order.length]), reached[branches]);
  /** @type {Level[]} */
  const levels = [
    { branches, segments: reached[branches], cards: 0, pixels: far, from: 0, isImpostor: true },
  ];
  for (let wanted = (far * far) / AREA; ; wanted *= 2) {
    while (branches < order.length && reached[branches] < Math.min(wanted, whole)) branches++;
    const segments = reached[branches];
    const pixels = Math.sqrt(AREA * segments);
    const from = levels.length === 1 ? far : Math.max(far, pixels / 2 ** 0.25);
    const cards = Math.round(mostCards * Math.min(1, (pixels / NEAR) ** 1.3));
    levels.push({ branches, segments, pixels, from, isImpostor: false, cards: Math.max(FEWEST_CARDS, cards) });
    if (segments >= whole) break;
  }
  const finest = levels[levels.length - 1];
  finest.pixels = Math.max(finest.pixels, NEAR);
  finest.cards = mostCards;
  return levels;
}

/** The level of every tree of a scene. */
export class Detail {
  /** @param {import("../protocol.js").Tree[]} trees @param {Level[][]} levels of each kind
   * @param {number[]} radii of a ball about the middle of each kind [m]
   * @param {number} watched tree that is always placed */
  constructor(trees, levels, radii, watched) {
    this.trees = trees;
    this.levels = levels;
    this._radii = radii;
    this._watched = watched;
    this._wanted = new Float32Array(trees.length);
    /** Level of each tree; -1 of one that is out of sight. */
    this.level = new Int8Array(trees.length).fill(-1);
    /** Row of its first segment. */
    this.start = new Uint32Array(trees.length);
    /** Segments of all trees that are placed. */
    this.segments = 0;
    /** Share of the wanted segments that the budget allows. */
    this.share = 1;
  }

  /** Choose again.
   * @param {Float32Array} camera matrix from the scene to clip space
   * @param {number} height of the picture [px]
   * @param {number} budget segments and cards beyond those of the coarsest level */
  choose(camera, height, budget) {
    this._see(camera, height);
    this.share = 1;
    if (this._total(1) > budget) {
      let [low, high] = [COARSEST, 1];
      for (let i = 0; i < 14; i++) {
        const middle = Math.sqrt(low * high);
        if (this._total(middle) > budget) high = middle;
        else low = middle;
      }
      this.share = low;
    }
    this.segments = 0;
    for (let t = 0; t < this.trees.length; t++) {
      this.level[t] = this._levelOf(t, this.share);
      this.start[t] = this.segments;
      if (this.level[t] >= 0) {
        this.segments += this.levels[this.trees[t].kind][this.level[t]].segments;
      }
    }
  }

  /** Area of the screen that each tree is worth [px^2]; none out of sight.
   * @param {Float32Array} m @param {number} height */
  _see(m, height) {
    const wide = Math.hypot(m[0], m[4], m[8]);
    const high = Math.hypot(m[1], m[5], m[9]);
    for (let t = 0; t < this.trees.length; t++) {
      const { place, kind, height: tall } = this.trees[t];
      const [x, y] = place;
      const z = place[2] + tall / 2;
      const radius = this._radii[kind] * place[4];
      const w = m[3] * x + m[7] * y + m[11] * z + m[15];
      const cx = m[0] * x + m[4] * y + m[8] * z + m[12];
      const cy = m[1] * x + m[5] * y + m[9] * z + m[13];
      const isSeen = w > -radius && Math.abs(cx) < w + radius * (1 + wide)
        && Math.abs(cy) < w + radius * (1 + high);
      const pixels = (tall * high * height) / (2 * Math.max(w, 0.5 * radius));
      this._wanted[t] = isSeen || t === this._watched ? pixels * pixels : 0;
    }
  }

  /** Segments and cards beyond those of the coarsest level. @param {number} share */
  _total(share) {
    let total = 0;
    for (let t = 0; t < this.trees.length; t++) {
      const level = this._levelOf(t, share);
      const levels = this.levels[this.trees[t].kind];
      if (level > 0) total += levels[level].segments + levels[level].cards - levels[0].segments;
    }
    return total;
  }

  /** @param {number} tree @param {number} share */
  _levelOf(tree, share) {
    if (!this._wanted[tree]) return -1;
    const levels = this.levels[this.trees[tree].kind];
    const most = share * this._wanted[tree];
    let level = 0;
    while (level + 1 < levels.length && levels[level + 1].from ** 2 <= most) level++;
    return level;
  }
}
