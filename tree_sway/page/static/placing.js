// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** From streamed coordinates to poses, by the native core: it is given the arrays of some branches of a kind as a model
 * (doc/streaming.md, "From a frame to poses"). */

import { need } from "./checks.js";
import { Block, core, Model, owned } from "./core.js";

/** Numbers per pose: x y z [m] of the root-side node, the tree's scale, then the quaternion x y z w. */
export const STRIDE = 8;

export const AT_ORIGIN = [0, 0, 0, 0, 1];

/** Largest memory for the turns of the segments of a kind [bytes]. */
const MOST_MEMORY = 512 * 2 ** 20;

/** Place in the scene of a point of a kind. @param {number[]} place @param {ArrayLike<number>} point */
export function placed([x, y, z, yaw, scale], point) {
  const c = scale * Math.cos(yaw), s = scale * Math.sin(yaw);
  return [x + c * point[0] - s * point[1], y + s * point[0] + c * point[1], z + scale * point[2]];
}

/** Rotations of pulled branches beyond the coordinates [rad], by the number of the key rotation; they follow the
 * coordinates of a state. @param {ArrayLike<number>} values @param {number} count of coordinates */
export function beyond(values, count) {
  /** @type {Map<number, number>} */
  const turns = new Map();
  for (let i = count; i < values.length; i += 2) turns.set(values[i], values[i + 1]);
  return turns;
}

/** @type {Map<number, number>} */
const NONE = new Map();
/** Coordinates of the tree that is placed. */
const own = new Block(Float32Array, 65536);

/** Places all segments of a scene, tree after tree. */
export class Placer {
  /** @param {Description} description */
  constructor(description) {
    this.description = description;
    this.poses = new Float32Array(STRIDE * description.nSegments);
    this._placers = description.kinds.map((kind) => new KindPlacer(kind));
    // Those of a kind one after another: its arrays stay in the caches.
    this._trees = [...description.trees].sort((one, other) => one.kind - other.kind);
  }

  /** Rebuild the poses, the same array each time. @param {Float32Array} coordinates */
  place(coordinates) {
    const turns = beyond(coordinates, this.description.nCoordinates);
    for (const { kind, place, firstSegment, firstCoordinate, firstKey } of this._trees) {
      const placer = this._placers[kind];
      placer.place(coordinates, firstCoordinate, place, placer.order.length, this.poses, firstSegment, turns, firstKey);
    }
    return this.poses;
  }
}

/** Places trees of one kind, or the first of their branches. */
export class KindPlacer {
  /** @type {Map<number, Part>} */
  _parts = new Map();

  /** @param {Kind} kind @param {Int32Array | null} [order] of its branches, parents before their children */
  constructor(kind, order = null) {
    const { arrays: { branch_first: first }, nBranches } = kind;
    this.kind = kind;
    this.order = order ?? Int32Array.from({ length: nBranches }, (_, i) => i);
    /** Row of each segment when branches are placed in this order. */
    this.slots = new Int32Array(kind.nSegments);
    /** Number of segments of the first branches of the order. */
    this.reached = new Int32Array(this.order.length + 1);
    this.order.forEach((branch, i) => {
      for (let s = first[branch]; s < first[branch + 1]; s++) this.slots[s] = this.reached[i] + s - first[branch];
      this.reached[i + 1] = this.reached[i] + first[branch + 1] - first[branch];
    });
  }

  /** Place a tree. @param {Float32Array | Float64Array} coordinates of all trees @param {number} from its first
   * @param {number[]} place of the tree @param {number} count of branches, in the order
   * @param {Float32Array} poses written @param {number} to row of its first segment
   * @param {Map<number, number>} [turns] `beyond` @param {number} [firstKey] its first there */
  place(coordinates, from, [x, y, z, yaw, scale], count, poses, to, turns = NONE, firstKey = 0) {
    const part = this._parts.get(count) ?? new Part(this.kind, this.order.subarray(0, count), this.reached);
    this._parts.set(count, part);
    own.values.set(coordinates.subarray(from, from + this.kind.nCoordinates));
    const { turned, count: nTurned } = turns.size ? part.turnedBy(turns, firstKey) : { turned: 0, count: 0 };
    core.page_place(part.at, own.at, x, y, z, yaw, scale, turned, nTurned, part.poses.at);
    poses.set(part.poses.values, STRIDE * to);
  }
}

/** The first branches of an order, as a model of the core. */
class Part {
  /** @type {Block<Float64Array> | null} */
  _turned = null;

  /** @param {Kind} kind @param {Int32Array} branches @param {Int32Array} reached number of segments of the first of them */
  constructor(kind, branches, reached) {
    /** Key rotations of the kind that the model has, in its own order. */
    this._keys = rows(branches, kind.arrays.branch_coordinate, (branch) => kind.arrays.branch_keys[branch]);
    this._model = new Model(arraysOf(kind, branches, reached, this._keys));
    this.at = owned(this, core.page_placer_open(this._model.at), "page_placer_close");
    this.poses = new Block(Float32Array, STRIDE * reached[branches.length]);
  }

  /** Write what some key rotations are turned by. @param {Map<number, number>} turns @param {number} first key of the tree */
  turnedBy(turns, first) {
    this._turned ??= new Block(Float64Array, 2 * this._keys.length);
    const found = Array.from(this._keys, (key, i) => [i, turns.get(first + key) ?? 0]).filter(([, turn]) => turn);
    this._turned.values.set(found.flat());
    return { turned: this._turned.at, count: found.length };
  }
}

/** Rows that belong to branches, one branch after the other. @param {Int32Array} branches
 * @param {ArrayLike<number>} first row of each branch @param {(branch: number) => number} count its rows */
const rows = (branches, first, count) =>
  Array.from(branches, (branch) => Array.from({ length: count(branch) }, (_, i) => first[branch] + i)).flat();

/** Arrays of doc/sway_model.md of some branches of a kind, and its basis in place of the shapes of coordinates.
 * @param {Kind} kind @param {Int32Array} branches parents before their children @param {Int32Array} reached number of
 * segments of the first of them @param {number[]} keyRows its key rotations */
function arraysOf({ arrays, nCoordinates: m, nBranches }, branches, reached, keyRows) {
  const { branch_first: first, branch_keys: keys, branch_parent: parents, turn, branch_frame: frame } = arrays;
  const segmentRows = rows(branches, first, (branch) => first[branch + 1] - first[branch]);
  const b = branches.length, n = segmentRows.length;
  const room = branches.reduce((most, branch) => Math.max(most, keys[branch]), 2);
  need(48 * room * n <= MOST_MEMORY, "size of a kind when laid out");
  const numbers = new Int32Array(nBranches).fill(-1);
  branches.forEach((branch, i) => (numbers[branch] = i));
  /** @param {ArrayLike<number>} values @param {number} [size] */
  const whole = (values, size) => ({ values: BigInt64Array.from(Array.from(values, BigInt)), shape: [size ?? values.length] });
  /** @param {number[]} shape */
  const zeros = (...shape) => ({ values: new Float64Array(shape.reduce((a, c) => a * c)), shape });
  /** @param {string} name @param {ArrayLike<number>} chosen rows @param {number[]} shape of a row */
  const of = (name, chosen, ...shape) => {
    const found = zeros(chosen.length, ...shape);
    const width = found.values.length / Math.max(chosen.length, 1);
    for (let i = 0; i < chosen.length; i++) {
      found.values.set(arrays[name].subarray(width * chosen[i], width * (chosen[i] + 1)), width * i);
    }
    return found;
  };
  const twist = zeros(b, room, 6), turns = zeros(n, room, 3);
  branches.forEach((branch, i) => {
    const parent = parents[branch], base = arrays.branch_base_turn[branch], bend = arrays.branch_turn[branch];
    for (let k = 0; base >= 0 && k < keys[parent]; k++) {
      twist.values.set(turn.subarray(3 * (base + k), 3 * (base + k + 1)), 6 * (room * i + k) + 3);
    }
    for (let row = reached[i], s = first[branch]; row < reached[i + 1]; row++, s++) {
      for (let k = 0; bend >= 0 && k < keys[branch]; k++) {
        const from = 3 * (bend + (s - first[branch]) * keys[branch] + k);
        turns.values.set(turn.subarray(from, from + 3), 3 * (room * row + k));
      }
      // Without rows of its own it bends about the two axes across its chord.
      for (let c = 0; bend < 0 && c < 3; c++) {
        turns.values[3 * room * row + c] = arrays.segment_slope[s] * frame[9 * branch + 6 + c];
        turns.values[3 * room * row + 3 + c] = -arrays.segment_slope[s] * frame[9 * branch + 3 + c];
      }
    }
  });
  let key = 0;
  return {
    tree_start: zeros(n, 3), tree_end: zeros(n, 3), tree_base_diameter: zeros(n), tree_tip_diameter: zeros(n),
    branch_first: whole(reached.subarray(0, b + 1)),
    branch_parent: whole(branches.map((branch) => (parents[branch] < 0 ? -1 : numbers[parents[branch]]))),
    branch_base_segment: whole(branches.map((branch) => {
      const parent = parents[branch];
      return parent < 0 ? -1 : reached[numbers[parent]] + arrays.branch_base_segment[branch] - first[parent];
    })),
    branch_coordinate: whole(branches.map((branch) => (key += keys[branch]) - keys[branch])),
    branch_keys: whole(branches.map((branch) => keys[branch])),
    branch_frame: of("branch_frame", branches, 3, 3), branch_skew: of("branch_skew", branches, 2),
    branch_offset: of("branch_offset", branches, 3), branch_twist: twist,
    segment_slope: of("segment_slope", segmentRows), segment_tip_slope: of("segment_tip_slope", segmentRows),
    segment_chord: of("segment_chord", segmentRows, 3), segment_rest: of("segment_rest", segmentRows, 4),
    segment_turn: turns, shapes: of("basis_matrix", keyRows, m), stiffness: zeros(m),
  };
}
