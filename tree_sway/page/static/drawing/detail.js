// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** How much of each tree is placed and drawn: a small one is a picture of its kind, a larger one has its
 * thickest branches, one out of sight nothing; all within a budget. */

/** Area of the screen [px^2] that a segment is worth. */
const AREA = 80;
/** Height [px] that the finest level is shaped for. */
const NEAR = 800;
const FEWEST_CARDS = 40;
/** As small as a tree may be drawn, over its own size, before the far ones lose more than the near ones. */
const SMALLEST = 0.2;

/** Levels of a kind: its picture, of which the top alone is placed; then each of about twice the segments
 * of the one before. @param {import("../placing.js").KindPlacer} placer @param {number} highest segment,
 * which is of every other level @param {{segments: number, cards: number, near: number, far: number}} most segments,
 * cards of leaves; and the heights [px] from which it has all of them, and below which it is drawn as a
 * picture @returns {Level[]} */
export function levelsOf({ reached, order, slots }, highest, most) {
  let branches = 0;
  while (reached[branches] <= slots[highest]) branches++;
  const whole = Math.max(Math.min(most.segments, reached[order.length]), reached[branches]);
  /** @type {Level[]} */
  const levels = [{ branches: 0, segments: 1, cards: 0, pixels: most.far, from: 0 }];
  for (let pixels = most.far; ; pixels *= Math.SQRT2) {
    const wanted = Math.min((pixels * pixels) / AREA, whole);
    while (branches < order.length && reached[branches] < wanted) branches++;
    const segments = reached[branches];
    const from = levels.length === 1 ? most.far : Math.max(most.far, pixels / 2 ** 0.25);
    const isFinest = segments >= whole && pixels >= most.near;
    const cards = isFinest ? most.cards : Math.round(most.cards * Math.min(1, (pixels / most.near) ** 1.3));
    levels.push({ branches, segments, pixels: isFinest ? Math.max(pixels, NEAR) : pixels, from, cards: Math.max(FEWEST_CARDS, cards) });
    if (isFinest) break;
  }
  return levels;
}

export class Detail {
  /** @param {Tree[]} trees @param {Level[][]} levels of each kind @param {number[]} radii of a ball about
   * the middle of each kind [m] @param {number} watched tree that is always placed
   * @param {number} [card] what a card costs over what a segment does */
  constructor(trees, levels, radii, watched, card = 1) {
    this.trees = trees;
    this.levels = levels;
    this._radii = radii;
    this._card = card;
    this.watched = watched;
    /** Trees, the largest on the screen first. */
    this.order = Uint32Array.from(trees, (_, t) => t);
    /** Level of each tree; -1 of one that is out of sight. */
    this.level = new Int8Array(trees.length).fill(-1);
    /** Row of its first segment. */
    this.start = new Uint32Array(trees.length);
    /** Segments of all trees that are placed. */
    this.segments = 0;
  }

  /** Choose again: where the budget is too small, all trees are drawn as if they were smaller.
   * @param {Float32Array} camera matrix from the scene to clip space @param {number} height of the picture
   * [px] @param {number} budget segments and cards beyond those of far trees */
  choose(camera, height, budget) {
    const pixels = this.trees.map((tree) => this._height(tree, camera, height));
    this.order.sort((a, b) => pixels[b] - pixels[a]);
    for (let size = 1; this._spend(pixels, size, budget) && size > SMALLEST; size *= 0.85);
  }

  /** Give trees their levels, the nearest first. @param {number[]} pixels height of each @param {number} size
   * that they are drawn for, over their own @param {number} budget
   * @returns {boolean} whether any has a lower one than it should */
  _spend(pixels, size, budget) {
    let spent = 0;
    let isSpent = false;
    this.segments = 0;
    for (const t of this.order) {
      const levels = this.levels[this.trees[t].kind];
      const cost = (/** @type {number} */ level) => (level ? levels[level].segments + this._card * levels[level].cards : 0);
      const least = t === this.watched ? 1 : pixels[t] ? 0 : -1;
      let level = pixels[t] ? levels.length - 1 : least;
      while (level > least && levels[level].from > size * pixels[t]) level--;
      for (; level > least && spent + cost(level) > budget; level--) isSpent = true;
      this.level[t] = Math.max(level, least);
      this.start[t] = this.segments;
      spent += cost(Math.max(level, 0));
      this.segments += levels[this.level[t]]?.segments ?? 0;
    }
    return isSpent;
  }

  /** The level of a tree; none of one that is out of sight. @param {number} tree its number */
  levelOf(tree) {
    return this.levels[this.trees[tree].kind][this.level[tree]];
  }

  /** Height of a tree on the screen [px]; 0 out of sight. @param {Tree} tree @param {Float32Array} m
   * matrix of the camera @param {number} height of the picture */
  _height({ place: [x, y, z, , scale], kind, height: tall }, m, height) {
    const middle = [x, y, z + tall / 2, 1];
    const radius = this._radii[kind] * scale;
    const [cx, cy, w] = [0, 1, 3].map((row) => middle.reduce((sum, each, c) => sum + m[4 * c + row] * each, 0));
    const [wide, high] = [0, 1].map((row) => Math.hypot(m[row], m[4 + row], m[8 + row]));
    const isSeen = w > -radius && Math.abs(cx) < w + radius * (1 + wide) && Math.abs(cy) < w + radius * (1 + high);
    return isSeen ? (tall * high * height) / (2 * Math.max(w, 0.5 * radius)) : 0;
  }
}
