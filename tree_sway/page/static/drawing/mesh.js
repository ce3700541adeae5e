// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The shape of a kind of tree at rest, and the mesh of its bark: a tube for each branch. Every vertex belongs to
 * a segment, whose pose the vertex shader looks up and applies. */

import { AT_ORIGIN, KindPlacer, STRIDE } from "../placing.js";
import { between, turned } from "../quaternions.js";
import { numbers } from "./looks.js";
import { crownShade } from "./shade.js";

const {
  /** Least spacing of the rings of a tube [points of the picture]. */
  RING_SPACING,
  /** Least radius of wood on the screen [px]. */
  LEAST_RADIUS,
  /** Height of the picture of bark on a stem [m]. */
  BARK_TILE,
  /** Heights of the rings at the foot of a stem, over its radius. */
  FOOT_RINGS,
  /** Places of the rings along a segment, over its length. */
  BENDS,
  /** How far the rings of wood lie beside its axis, over their radius; less on a stem. */
  CROOKED,
  /** Roots that spread from the foot of a stem. */
  ROOTS,
  /** Radius of wood from which on it shows the bark of the stem, over the height of the tree. */
  BARKED,
} = /** @type {Record<string, any>} */ (numbers.bark);
/** Numbers per vertex of bark. */
const PER_VERTEX = 8;
/** Sides of what is drawn as a flat ribbon: twigs. */
const RIBBON = 2;

/** The lowest and the highest corner of a box of points. @param {ArrayLike<number>[]} points */
export const boxOf = (points) => [Math.min, Math.max].map((of) =>
  [0, 1, 2].map((c) => points.reduce((most, each) => of(most, each[c]), points[0][c])));

/** A kind at rest: poses, bounding box, highest segment, light in the crown. @param {Kind} kind */
export function shapeOf(kind) {
  const rest = new Float32Array(STRIDE * kind.nSegments);
  const still = new Float32Array(kind.nCoordinates);
  new KindPlacer(kind).place(still, 0, AT_ORIGIN, kind.nBranches, rest, 0);
  const nodes = Array.from({ length: kind.nSegments }, (_, s) => rest.subarray(STRIDE * s));
  const [low, high] = boxOf(nodes);
  const highest = nodes.findIndex((node) => node[2] === high[2]);
  const { leaf_segment: carrier, leaf_size: sizes } = kind.arrays;
  const places = Array.from(carrier ?? [], (_, i) => leafPlace(kind, rest, i));
  const areas = Array.from(sizes ?? [], (size) => 0.25 * Math.PI * size * size);
  return {
    kind, rest, low, high, highest, shade: crownShade(places, areas, low, high),
    placer: new KindPlacer(kind, branchOrder(kind, highest)),
  };
}

/** Branches, those that cover most of a picture first, and none before its parent; the chain that carries the
 * highest segment leads. @param {Kind} kind @param {number} highest segment */
function branchOrder({ arrays, nBranches }, highest) {
  const { branch_first: first, branch_parent: parents } = arrays;
  const isTop = new Uint8Array(nBranches);
  for (let top = first.findIndex((from) => from > highest) - 1; top >= 0; top = parents[top]) isTop[top] = 1;
  const area = new Float64Array(nBranches);
  for (let b = 0; b < nBranches; b++) {
    const own = isTop[b] ? Infinity : reachOf(arrays, b) * arrays.segment_radius[2 * first[b]];
    area[b] = parents[b] < 0 ? Infinity : Math.min(own, area[parents[b]]);
  }
  return Int32Array.from(parents, (_, b) => b).sort((a, b) => area[b] - area[a] || a - b);
}

/** Length of a branch [m]. @param {Kind["arrays"]} arrays @param {number} branch */
export const reachOf = ({ branch_first: first, segment_length: length }, branch) =>
  Array.from(length.subarray(first[branch], first[branch + 1])).reduce((sum, each) => sum + each, 0);

/** Place of a cluster of leaves at rest [m]. @param {Kind} kind @param {Float32Array} rest @param {number} i */
export function leafPlace({ arrays }, rest, i) {
  const o = STRIDE * arrays.leaf_segment[i];
  const offset = Array.from(arrays.leaf_offset.subarray(3 * i, 3 * i + 3));
  return turned(rest, offset, o + 4).map((each, c) => each + rest[o + c]);
}

/** Mesh of the bark of some branches. A vertex has the row of its segment, its place in the frame of that
 * segment (along, and two across), its thickness over that of a stem, its place on the picture of bark (2) and
 * how open the crown is there. In a ribbon its thickness is less by 2, by which the shader knows it.
 * @param {Shape} shape @param {Int32Array} branches @param {number} pixels height of the tree on the
 * screen @param {number} [fineness] of the picture, points per pixel @returns {Mesh} */
export function barkMesh(shape, branches, pixels, fineness = 1) {
  const height = Math.max(shape.high[2] - shape.low[2], 0.1);
  const pixel = height / pixels;
  const mesh = { values: [], indices: [] };
  for (const branch of branches) addTube(mesh, shape, branch, height, pixel, pixel / fineness);
  return mesh;
}

/** Add a branch: rings of vertices, each joined to the one before.
 * @param {Mesh} mesh @param {Shape} shape @param {number} branch @param {number} height of the tree [m]
 * @param {number} pixel size of a pixel at the tree [m] @param {number} point size of a point drawn there [m] */
function addTube({ values, indices }, { kind: { arrays }, placer, rest, shade }, branch, height, pixel, point) {
  const { branch_first: first, branch_parent: parents, segment_radius: radius, segment_length: length } = arrays;
  const from = first[branch];
  const end = first[branch + 1];
  const baseRadius = radius[2 * from];
  const isStem = parents[branch] < 0;
  const thin = arrays.branch_base_segment.includes(end - 1) ? 1 : 0.4;
  const points = baseRadius / point; // of its radius on the picture
  const sides = points > 8 ? 16 : points > 2 ? 6 : RIBBON;
  const corners = sides === RIBBON ? 2 : sides + 1; // a tube is closed by a second first corner
  const thickness = Math.min(1, baseRadius / (BARKED * height));
  const tilesAround = Math.max(1, Math.round((2 * Math.PI * baseRadius) / Math.min(BARK_TILE, 0.06 * height)));
  let twist = 0; // of the segment about the branch, which the rings undo
  let climbed = 0; // length from the base of the branch
  let ringAt = -Infinity; // the same of the last ring
  // At a joint both segments agree on the radius: no steps in the bark. What carries nothing at its end ends thin.
  const radiusAt = (/** @type {number} */ s) => (s === end ? thin * radius[2 * s - 1] : radius[2 * s]);
  for (let s = from; s < end; s++) {
    const long = length[s];
    const turnTo = (/** @type {number} */ other) => between(rest, STRIDE * s + 4, rest, STRIDE * other + 4);
    const last = turnTo(s > from ? s - 1 : isStem ? s : arrays.branch_base_segment[branch]);
    // Wood bends evenly from the direction of the segment before, at a fork that of the parent, to that of the next one.
    const [before, after] = [last, turnTo(Math.min(s + 1, end - 1))].map((turn) => turned(turn, [1, 0, 0]));
    twist -= 2 * Math.atan2(last[0], last[3]);
    const { open } = shade(rest.subarray(STRIDE * s));
    const shares = isStem && s === from ? FOOT_RINGS.map((/** @type {number} */ each) => (each * baseRadius) / long) : BENDS;
    for (const share of s === end - 1 ? [...shares, 1] : shares) {
      const at = climbed + share * long;
      if (share > 1 || (share < 1 && at - ringAt < RING_SPACING * point)) continue;
      ringAt = at;
      const above = at / baseRadius;
      const flare = isStem ? Math.exp(-0.7 * above) : 0;
      const wide = (1 - share) * radiusAt(s) + share * radiusAt(s + 1);
      const ringRadius = Math.max(wide, LEAST_RADIUS * pixel) * (1 + 0.8 * flare);
      const drift = ringRadius * (isStem ? 0.3 : 1) * CROOKED * Math.sin(0.31 * above);
      const [aside, upwards] = [Math.cos, Math.sin].map((of, c) => drift * of(0.19 * above - twist)
        + 0.5 * long * share * (1 - share) * ((1 - share) * before[c + 1] - share * after[c + 1]));
      for (let k = 0; k < corners; k++) {
        const angle = (2 * Math.PI * k) / sides - twist;
        // At the foot of a stem rings bulge into roots.
        const bulge = 1 + 0.3 * flare * Math.cos(ROOTS * angle + Math.sin(angle));
        const corner = sides === RIBBON ? [k ? -ringRadius : ringRadius, upwards, thickness - 2]
          : [ringRadius * bulge * Math.cos(angle) + aside, ringRadius * bulge * Math.sin(angle) + upwards, thickness];
        values.push(placer.slots[s], share * long, ...corner);
        values.push((tilesAround * k) / sides, (above * tilesAround) / (2 * Math.PI), open);
      }
      if (!at) continue;
      // Two triangles between each pair of corners of this ring and of the one before.
      const ring = values.length / PER_VERTEX - corners;
      for (let above = ring; above < ring + corners - 1; above++) {
        const below = above - corners;
        indices.push(below, below + 1, above, below + 1, above + 1, above);
      }
    }
    climbed += long;
  }
}
