// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** From streamed coordinates to poses: coordinates -> key rotations -> bent branches -> segments, from the root on. The
 * law is the solver's own (doc/streaming.md, "From a frame to poses"). */

import { addTurned, fromHalf, multiply } from "./quaternions.js";

/** Work arrays: a place, half a rotation vector, the quaternions of a bend and of a segment. */
const [at, half, turn, whole] = [3, 3, 4, 4].map((size) => new Float64Array(size));
/** Squared angles [rad^2] up to which a slope is stretched, and between which the shape blends into that of a load at
 * the tip. */
const [STRETCH_TO, BLEND_FROM, BLEND_TO] = [2, 6, 4].map((part) => (Math.PI / part) ** 2);

/** Half of the slope over the angle of a branch. @param {number} square of the angle @param {number} skew */
const stretch = (square, skew) => 0.5 * (1 + Math.min(square, STRETCH_TO) * skew);

/** Numbers per pose: x y z [m] of the root-side node, the tree's scale, then the quaternion x y z w. */
export const STRIDE = 8;

export const AT_ORIGIN = [0, 0, 0, 0, 1];

/** Place in the scene of a point of a kind. @param {number[]} place @param {ArrayLike<number>} point */
export function placed([x, y, z, yaw, scale], point) {
  const [c, s] = [scale * Math.cos(yaw), scale * Math.sin(yaw)];
  return [x + c * point[0] - s * point[1], y + s * point[0] + c * point[1], z + scale * point[2]];
}

/** Rotations of pulled branches beyond the coordinates [rad], by the number of the key rotation; they follow the
 * coordinates of a state. @param {ArrayLike<number>} values @param {number} count of coordinates */
export function beyond(values, count) {
  const turns = /** @type {Map<number, number>} */ (new Map());
  for (let i = count; i < values.length; i += 2) turns.set(values[i], values[i + 1]);
  return turns;
}

const NONE = /** @type {Map<number, number>} */ (new Map());

/** Places all segments of a scene, tree after tree. */
export class Placer {
  /** @param {Description} description */
  constructor(description) {
    this.description = description;
    this.poses = new Float32Array(STRIDE * description.nSegments);
    this._placers = description.kinds.map((kind) => new KindPlacer(kind));
  }

  /** Rebuild the poses, the same array each time. @param {ArrayLike<number>} coordinates */
  place(coordinates) {
    const turns = beyond(coordinates, this.description.nCoordinates);
    for (const { kind, place, firstSegment, firstCoordinate, firstKey } of this.description.trees) {
      const placer = this._placers[kind];
      placer.place(coordinates, firstCoordinate, place, placer.order.length, this.poses, firstSegment, turns, firstKey);
    }
    return this.poses;
  }
}

/** Places trees of one kind, or the first of their branches. */
export class KindPlacer {
  /** @param {Kind} kind @param {Int32Array | null} [order] of its branches, parents before their children */
  constructor(kind, order = null) {
    const { arrays, nBranches } = kind;
    this.kind = kind;
    this.order = order ?? Int32Array.from({ length: nBranches }, (_, i) => i);
    /** Row of each segment when branches are placed in this order. */
    this.slots = new Int32Array(kind.nSegments);
    /** Number of segments of the first branches of the order. */
    this.reached = new Int32Array(nBranches + 1);
    this.order.forEach((branch, i) => {
      const [from, end] = [arrays.branch_first[branch], arrays.branch_first[branch + 1]];
      for (let s = from; s < end; s++) this.slots[s] = this.reached[i] + s - from;
      this.reached[i + 1] = this.reached[i] + end - from;
    });
    const { segment_rest: rest } = arrays; // w x y z
    this._rest = Float32Array.from(rest, (_, i) => rest[i % 4 < 3 ? i + 1 : i - 3]);
    /** Key rotations [rad], and the rotation of each branch at its base. */
    this._keys = new Float32Array(kind.nKeys);
    this._bases = new Float64Array(4 * nBranches);
  }

  /** Place a tree. @param {ArrayLike<number>} coordinates of all trees @param {number} from its first
   * @param {ArrayLike<number>} place of the tree @param {number} count of branches, in the order
   * @param {Float32Array} poses written @param {number} to row of its first segment
   * @param {Map<number, number>} [turns] `beyond` @param {number} [firstKey] its first there */
  place(coordinates, from, place, count, poses, to, turns = NONE, firstKey = 0) {
    const { arrays, nCoordinates } = this.kind;
    const { basis_matrix: matrix, branch_coordinate: first, branch_keys: keys } = arrays;
    for (const branch of this.order.subarray(0, count)) {
      let entry = first[branch] * nCoordinates;
      for (let key = first[branch]; key < first[branch] + keys[branch]; key++) {
        let sum = (turns.size && turns.get(firstKey + key)) || 0;
        for (let c = 0; c < nCoordinates; c++) sum += matrix[entry++] * coordinates[from + c];
        this._keys[key] = sum;
      }
      this._placeBase(branch, place, poses, to);
      this._placeSegments(branch, place[4], poses, to);
    }
  }

  /** Add half the rotation vector that the key rotations of a branch give at a place. @param {number} branch
   * @param {number} stretched `stretch` of the first two @param {number} row of the place in `turn` */
  _addTurns(branch, stretched, row) {
    const { turn: turns, branch_coordinate: first, branch_keys: keys } = this.kind.arrays;
    for (let k = 0; k < keys[branch]; k++, row++) {
      const own = (k < 2 ? stretched : 0.5) * this._keys[first[branch] + k];
      for (let c = 0; c < 3; c++) half[c] += own * turns[3 * row + c];
    }
  }

  /** Find the base of a branch and its rotation there, by the branch that carries it.
   * @param {number} branch @param {ArrayLike<number>} place @param {Float32Array} poses @param {number} to */
  _placeBase(branch, place, poses, to) {
    const { kind: { arrays }, _bases: bases, _keys: keys } = this;
    const parent = arrays.branch_parent[branch];
    if (parent < 0) {
      for (let c = 0; c < 3; c++) at[c] = place[c];
      bases[4 * branch + 2] = Math.sin(place[3] / 2);
      bases[4 * branch + 3] = Math.cos(place[3] / 2);
      return;
    }
    const first = arrays.branch_coordinate[parent];
    half.fill(0);
    const stretched = stretch(keys[first] ** 2 + keys[first + 1] ** 2, arrays.branch_skew[2 * parent]);
    this._addTurns(parent, stretched, arrays.branch_base_turn[branch]);
    fromHalf(half, turn);
    multiply(bases, 4 * parent, turn, 0, bases, 4 * branch);
    const under = STRIDE * (to + this.slots[arrays.branch_base_segment[branch]]);
    for (let c = 0; c < 3; c++) at[c] = poses[under + c];
    addTurned(poses, under + 4, arrays.branch_offset, 3 * branch, place[4], at);
  }

  /** Place the segments of a branch from its base on: bent by one slope about the axes across its chord, or by all key
   * rotations. @param {number} branch @param {number} scale @param {Float32Array} poses
   * @param {number} to */
  _placeSegments(branch, scale, poses, to) {
    const { kind: { arrays }, _bases: bases, _rest: rest, _keys: keys } = this;
    const { branch_frame: frame, branch_skew: skews, segment_slope: slope, segment_chord: chord } = arrays;
    const first = arrays.branch_coordinate[branch];
    const [kx, ky] = [keys[first], keys[first + 1]];
    const t = kx * kx + ky * ky;
    const blend = Math.min(Math.max((t - BLEND_FROM) / (BLEND_TO - BLEND_FROM), 0), 1);
    const stretched = stretch(t, skews[2 * branch] + blend * (skews[2 * branch + 1] - skews[2 * branch]));
    const [sx, sy, f] = [stretched * kx, stretched * ky, 9 * branch];
    const [begin, end] = [arrays.branch_first[branch], arrays.branch_first[branch + 1]];
    const row = arrays.branch_turn[branch];
    let o = STRIDE * (to + this.slots[begin]);
    for (let s = begin; s < end; s++, o += STRIDE) {
      const far = blend * (arrays.segment_tip_slope[s] - slope[s]);
      const main = row < 0 ? slope[s] + far : far;
      for (let c = 0; c < 3; c++) half[c] = main * (sx * frame[f + 6 + c] - sy * frame[f + 3 + c]);
      if (row >= 0) this._addTurns(branch, stretched, row + (s - begin) * arrays.branch_keys[branch]);
      fromHalf(half, turn);
      multiply(bases, 4 * branch, turn, 0, whole);
      for (let c = 0; c < 3; c++) poses[o + c] = at[c];
      poses[o + 3] = scale;
      multiply(whole, 0, rest, 4 * s, poses, o + 4);
      addTurned(whole, 0, chord, 3 * s, scale, at);
    }
  }
}
