// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Chooses the level of detail of each tree within a budget: a small tree is a picture of its kind, a larger one has its
 * thickest branches, one out of sight is not drawn. */

import { textOf } from "../files.js";

/** For a few trees and for a crowd, whose many kinds take memory, first with a graphics unit, then without: largest number of
 * segments and of cards of leaves per tree, and of both in all trees; height on the screen from which on a tree has all of
 * its cards, and below which it is a picture [px]. @type {Budget[][]} */
export const BUDGETS = JSON.parse(await textOf("drawing/budgets.json"));

/** @typedef {{segments: number, cards: number, all: number, near: number, far: number}} Budget */

/** Area on the screen per segment [px^2]. */
const AREA = 80;
/** Height for which the finest level is made, at least [px]. */
const NEAR = 800;
const FEWEST_CARDS = 40;
/** Least size for which levels are chosen, over the real one; a smaller budget is spent on near trees only. */
const SMALLEST = 0.2;

/** Levels of a kind. The first is its picture, of which only the top is placed; each further one has about twice the
 * segments of the one before. @param {import("../placing.js").KindPlacer} placer @param {number} highest segment,
 * which all of these have @param {{segments: number, cards: number, near: number, far: number}} most segments and
 * cards, the height from which on a tree has all of them, and below which it is a picture [px]
 * @returns {Level[]} */
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
  /** Number of segments that are placed. */
  segments = 0;

  /** @param {Tree[]} trees @param {Level[][]} levels of each kind @param {number[]} radii of the
   * bounding sphere of each kind [m] @param {number} watched tree that is always placed
   * @param {number} [card] cost of a card over that of a segment */
  constructor(trees, levels, radii, watched, card = 1) {
    this.trees = trees;
    this.levels = levels;
    this._radii = radii;
    this._card = card;
    this.watched = watched;
    /** Trees, the largest on the screen first. */
    this.order = Uint32Array.from(trees, (_, t) => t);
    /** Level of each tree; -1 out of sight. */
    this.level = new Int8Array(trees.length).fill(-1);
    /** Row of its first segment. */
    this.start = new Uint32Array(trees.length);
  }

  /** Choose the levels; if the budget is too small, all trees are treated as smaller.
   * @param {Float32Array} camera matrix from the scene to clip space @param {number} height of the picture
   * [px] @param {number} budget segments and cards beyond those of far trees */
  choose(camera, height, budget) {
    const pixels = this.trees.map((tree) => this._height(tree, camera, height));
    this.order.sort((a, b) => pixels[b] - pixels[a]);
    for (let size = 1; this._spend(pixels, size, budget) && size > SMALLEST; size *= 0.85);
  }

  /** Set the level of each tree, the nearest first; none is a picture that is as large as the first mesh. @param {number[]} pixels height of each @param {number} size
   * for which they are chosen, over the real one @param {number} budget
   * @returns {boolean} whether the budget lowered any */
  _spend(pixels, size, budget) {
    let spent = 0;
    let isSpent = false;
    this.segments = 0;
    for (const t of this.order) {
      const levels = this.levels[this.trees[t].kind];
      const cost = (/** @type {number} */ level) => (level ? levels[level].segments + this._card * levels[level].cards : 0);
      const least = t === this.watched || pixels[t] > 2 * levels[1].from ? 1 : pixels[t] ? 0 : -1;
      let level = pixels[t] ? levels.length - 1 : least;
      while (level > least && levels[level].from > (level > 1 ? size : 1) * pixels[t]) level--;
      for (; level > least && spent + cost(level) > budget; level--) isSpent = true;
      this.level[t] = Math.max(level, least);
      this.start[t] = this.segments;
      spent += cost(Math.max(level, 0));
      this.segments += levels[this.level[t]]?.segments ?? 0;
    }
    return isSpent;
  }

  /** Level of a tree; undefined out of sight. @param {number} tree its number */
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
