// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A kind at rest, and the mesh of its bark. Each vertex hangs on a segment, whose row is its first number,
 * and moves with it. A branch is one tube: a ring between two segments is of both. */

import { AT_ORIGIN, KindPlacer, STRIDE } from "../placing.js";
import { between, turned } from "../quaternions.js";
import { crownShade } from "./shade.js";

/** Least spacing of rings of bark on the screen [px], height of the picture of bark on a stem [m]. */
const [RING_SPACING, BARK_TILE] = [6, 0.6];
/** Roots that spread from the foot of a stem. */
const ROOTS = 5;
/** Radius of wood that shows the bark of the stem, over the height of the tree. */
const BARKED = 0.005;

/** The lowest and the highest corner of a box of points. @param {ArrayLike<number>[]} points */
export const boxOf = (points) => [Math.min, Math.max].map((of) =>
  [0, 1, 2].map((c) => points.reduce((most, each) => of(most, each[c]), points[0][c])));

/** A kind at rest: its poses, its box, its highest segment, how open its crown is. @param {Kind} kind */
export function shapeOf(kind) {
  const rest = new Float32Array(STRIDE * kind.nSegments);
  const still = new Float32Array(kind.nCoordinates);
  new KindPlacer(kind).place(still, 0, AT_ORIGIN, kind.nBranches, rest, 0);
  const nodes = Array.from({ length: kind.nSegments }, (_, s) => rest.subarray(STRIDE * s));
  const [low, high] = boxOf(nodes);
  const highest = nodes.findIndex((node) => node[2] === high[2]);
  const { leaf_segment: carrier, leaf_size: sizes } = kind.arrays;
  const places = Array.from(carrier ?? [], (_, i) => leafPlace(kind, rest, i));
  const shade = crownShade(places, Array.from(sizes ?? [], (size) => 0.25 * Math.PI * size * size), low, high);
  const placer = new KindPlacer(kind, branchOrder(kind, highest));
  return { kind, placer, rest, low, high, highest, shade };
}

/** Branches by what they cover of a picture, parents before their children; what carries the highest
 * segment comes first. @param {Kind} kind @param {number} highest */
function branchOrder({ arrays, nBranches }, highest) {
  const { branch_first: first, branch_parent: parents } = arrays;
  const isTop = new Uint8Array(nBranches);
  for (let top = first.findIndex((from) => from > highest) - 1; top >= 0; top = parents[top]) isTop[top] = 1;
  const weight = new Float64Array(nBranches);
  for (let b = 0; b < nBranches; b++) {
    const length = Array.from(arrays.segment_length.subarray(first[b], first[b + 1])).reduce((a, c) => a + c);
    const own = isTop[b] ? Infinity : length * arrays.segment_radius[2 * first[b]];
    weight[b] = parents[b] < 0 ? Infinity : Math.min(own, weight[parents[b]]);
  }
  return Int32Array.from(parents, (_, b) => b).sort((a, b) => weight[b] - weight[a] || a - b);
}

/** Where a cluster of leaves is at rest. @param {Kind} kind @param {Float32Array} rest @param {number} i */
export function leafPlace({ arrays }, rest, i) {
  const o = STRIDE * arrays.leaf_segment[i];
  const offset = Array.from(arrays.leaf_offset.subarray(3 * i, 3 * i + 3));
  return turned(rest, offset, o + 4).map((each, c) => each + rest[o + c]);
}

/** The bark: rings of [along, across cosine, across sine, thickness], joined to tubes; of twigs two edges
 * of a ribbon, [along, across, 0, thickness - 2]; then [place on the bark (2), openness].
 * @param {Shape} shape @param {Int32Array} branches @param {number} pixels height of the tree on the
 * screen @param {number} [fineness] of the picture, points per pixel @returns {Mesh} */
export function barkMesh({ kind, placer, rest, low, high, shade }, branches, pixels, fineness = 1) {
  const { branch_first: first, branch_parent: parents, segment_radius: radius, segment_length: length } = kind.arrays;
  const size = Math.max(high[2] - low[2], 0.1);
  const pixel = size / pixels;
  const point = pixel / fineness;
  const tile = Math.min(BARK_TILE, 0.06 * size);
  const values = /** @type {number[]} */ ([]);
  const indices = /** @type {number[]} */ ([]);
  for (const branch of branches) {
    const [from, end] = [first[branch], first[branch + 1]];
    const thick = radius[2 * from];
    const sides = thick > 4.8 * point ? 12 : thick > 2 * point ? 6 : 2;
    const corners = sides === 2 ? 2 : sides + 1;
    const thickness = Math.min(1, thick / (BARKED * size));
    const around = Math.max(1, Math.round((2 * Math.PI * thick) / tile));
    let [turn, risen, drawn] = [0, 0, 0];
    for (let s = from; s <= end; s++) {
      const segment = Math.min(s, end - 1);
      const isLast = s === end;
      if (s > from) risen += length[s - 1];
      if (s > from && !isLast) {
        const twist = between(rest, STRIDE * (s - 1) + 4, rest, STRIDE * s + 4);
        turn += 2 * Math.atan2(twist[0], twist[3]);
        if (risen - drawn < RING_SPACING * point) continue;
      }
      drawn = risen;
      // At a joint both segments agree on the thickness: no steps in the bark.
      const joined = s > from ? 0.5 * (radius[2 * s] + radius[2 * s - 1]) : thick;
      let r = Math.max(isLast ? radius[2 * segment + 1] : joined, 0.56 * pixel);
      // The foot of the stem spreads into roots.
      const foot = parents[branch] < 0 ? Math.exp(-risen / (1.3 * thick)) : 0;
      r *= 1 + 0.7 * foot;
      const { open } = shade(rest.subarray(STRIDE * segment, STRIDE * segment + 3));
      const up = (risen * around) / (2 * Math.PI * thick);
      for (let k = 0; k < corners; k++) {
        const angle = (2 * Math.PI * k) / sides - turn;
        const round = r * (1 + 0.2 * foot * Math.cos(ROOTS * angle));
        const ring = sides === 2 ? [k ? -r : r, 0, thickness - 2]
          : [round * Math.cos(angle), round * Math.sin(angle), thickness];
        values.push(placer.slots[segment], isLast ? length[segment] : 0, ...ring, (around * k) / sides, up, open);
      }
      if (s === from) continue;
      const ring = values.length / 8 - corners;
      for (let k = 0; k < corners - 1; k++) {
        const a = ring - corners + k;
        indices.push(a, a + 1, ring + k, a + 1, ring + k + 1, ring + k);
      }
    }
  }
  return { values, indices };
}
