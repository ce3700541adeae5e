// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/**
 * From the state to poses: state -> key rotations -> curves of branches -> segments, joined from
 * the root. The law is the solver's own (doc/streaming.md, "From a frame to poses").
 */

const STRETCH_TO = (Math.PI / 2) ** 2;
const BLEND_FROM = (Math.PI / 6) ** 2;
const BLEND_TO = (Math.PI / 4) ** 2;

/** Numbers per pose: x y z [m] of the root-side node, the tree's scale, then the quaternion x y z w. */
export const STRIDE = 8;

const AT_ORIGIN = [0, 0, 0, 0, 1];

/** Places the segments of a described scene, all of them, tree after tree. */
export class Placer {
  /** @param {import("./protocol.js").Description} description */
  constructor(description) {
    this.description = description;
    this.poses = new Float32Array(STRIDE * description.nSegments);
    this._placers = description.kinds.map((kind) => new KindPlacer(kind));
  }

  /** Rebuild the poses.
   * @param {ArrayLike<number>} coordinates
   * @returns {Float32Array} the poses, the same array each time */
  place(coordinates) {
    for (const { kind, place, firstSegment, firstCoordinate } of this.description.trees) {
      const placer = this._placers[kind];
      const count = placer.order.length;
      placer.place(coordinates, firstCoordinate, place, count, this.poses, firstSegment);
    }
    return this.poses;
  }
}

/** Places trees of one kind, or the first of their branches. */
export class KindPlacer {
  /** @param {import("./protocol.js").Kind} kind
   * @param {Int32Array | null} [order] of its branches, parents before their children */
  constructor(kind, order = null) {
    const { arrays, nBranches } = kind;
    this.kind = kind;
    this.order = order ?? Int32Array.from({ length: nBranches }, (_, i) => i);
    /** Row of each segment when branches are placed in this order. */
    this.slots = new Int32Array(kind.nSegments);
    /** Rows of the first branches of the order together. */
    this.reached = new Int32Array(nBranches + 1);
    this.order.forEach((branch, i) => {
      const [from, end] = [arrays.branch_first[branch], arrays.branch_first[branch + 1]];
      for (let s = from; s < end; s++) this.slots[s] = this.reached[i] + s - from;
      this.reached[i + 1] = this.reached[i] + end - from;
    });
    /** Key rotations [rad]. */
    this._rotations = new Float32Array(kind.nKeys);
    this._base = new Float32Array(4 * nBranches); // w x y z
    this._half = new Float32Array(256); // half of each key rotation of a branch, stretched
  }

  /** Poses of the whole tree at rest, segment after segment as they are described. */
  rest() {
    const poses = new Float32Array(STRIDE * this.kind.nSegments);
    const still = new Float32Array(this.kind.nCoordinates);
    new KindPlacer(this.kind).place(still, 0, AT_ORIGIN, this.kind.nBranches, poses, 0);
    return poses;
  }

  /** Place a tree.
   * @param {ArrayLike<number>} coordinates of all trees @param {number} from its first
   * @param {ArrayLike<number>} place as of a tree
   * @param {number} count how many branches, in the order @param {Float32Array} poses written
   * @param {number} to row of its first segment */
  place(coordinates, from, place, count, poses, to) {
    for (let i = 0; i < count; i++) {
      this._expand(this.order[i], coordinates, from);
      this._placeBranch(this.order[i], place, poses, to);
    }
  }

  /** Key rotations of a branch.
   * @param {number} branch @param {ArrayLike<number>} coordinates @param {number} from */
  _expand(branch, coordinates, from) {
    const { arrays, nCoordinates } = this.kind;
    const matrix = arrays.basis_matrix;
    const first = arrays.branch_coordinate[branch];
    const end = first + arrays.branch_keys[branch];
    let at = first * nCoordinates;
    for (let key = first; key < end; key++) {
      let sum = 0;
      for (let c = 0; c < nCoordinates; c++) sum += matrix[at++] * coordinates[from + c];
      this._rotations[key] = sum;
    }
  }

  /** @param {number} branch @param {ArrayLike<number>} place @param {Float32Array} poses
   * @param {number} to */
  _placeBranch(branch, place, poses, to) {
    const { arrays } = this.kind;
    const { _rotations: x, _base: bases, _half: half, slots } = this;
    const parent = arrays.branch_parent[branch];
    const offset = arrays.branch_offset;
    const scale = place[4];
    let px = place[0];
    let py = place[1];
    let pz = place[2];
    let bw = 1;
    let bx = 0;
    let by = 0;
    let bz = 0;
    if (parent < 0) {
      bw = Math.cos(place[3] / 2);
      bz = Math.sin(place[3] / 2);
    } else {
      const p = 4 * parent;
      bw = bases[p];
      bx = bases[p + 1];
      by = bases[p + 2];
      bz = bases[p + 3];
      this._baseTurn(branch, parent);
      const { w, i, j, k } = turnOf;
      const qw = bw * w - bx * i - by * j - bz * k;
      const qx = bw * i + bx * w + by * k - bz * j;
      const qy = bw * j - bx * k + by * w + bz * i;
      bz = bw * k + bx * j - by * i + bz * w;
      bw = qw;
      bx = qx;
      by = qy;
      const under = STRIDE * (to + slots[arrays.branch_base_segment[branch]]);
      const sx = poses[under + 4];
      const sy = poses[under + 5];
      const sz = poses[under + 6];
      const sw = poses[under + 7];
      const ox = scale * offset[3 * branch];
      const oy = scale * offset[3 * branch + 1];
      const oz = scale * offset[3 * branch + 2];
      const tx = 2 * (sy * oz - sz * oy);
      const ty = 2 * (sz * ox - sx * oz);
      const tz = 2 * (sx * oy - sy * ox);
      px = poses[under] + ox + sw * tx + sy * tz - sz * ty;
      py = poses[under + 1] + oy + sw * ty + sz * tx - sx * tz;
      pz = poses[under + 2] + oz + sw * tz + sx * ty - sy * tx;
    }
    const own = 4 * branch;
    bases[own] = bw;
    bases[own + 1] = bx;
    bases[own + 2] = by;
    bases[own + 3] = bz;

    const first = arrays.branch_coordinate[branch];
    const count = arrays.branch_keys[branch];
    const turn = arrays.turn;
    let row = arrays.branch_turn[branch];
    const f = 9 * branch;
    const frame = arrays.branch_frame;
    const kx = x[first];
    const ky = x[first + 1];
    const t = kx * kx + ky * ky;
    const blend = Math.min(Math.max((t - BLEND_FROM) / (BLEND_TO - BLEND_FROM), 0), 1);
    const skew = arrays.branch_skew[2 * branch];
    const skewHere = skew + blend * (arrays.branch_skew[2 * branch + 1] - skew);
    const stretched = 0.5 * (1 + Math.min(t, STRETCH_TO) * skewHere);
    const wx = stretched * (kx * frame[f + 6] - ky * frame[f + 3]);
    const wy = stretched * (kx * frame[f + 7] - ky * frame[f + 4]);
    const wz = stretched * (kx * frame[f + 8] - ky * frame[f + 5]);
    for (let c = 0; c < count; c++) half[c] = (c < 2 ? stretched : 0.5) * x[first + c];

    const slope = arrays.segment_slope;
    const chord = arrays.segment_chord;
    const rest = arrays.segment_rest;
    const end = arrays.branch_first[branch + 1];
    const begin = arrays.branch_first[branch];
    let o = STRIDE * (to + slots[begin]);
    for (let s = begin; s < end; s++, o += STRIDE) {
      // By one slope about the axes across its chord, or by every key rotation in its own way.
      const far = blend * (arrays.segment_tip_slope[s] - slope[s]);
      const main = row < 0 ? slope[s] + far : far;
      let hx = main * wx;
      let hy = main * wy;
      let hz = main * wz;
      if (row >= 0) {
        for (let c = 0; c < count; c++, row++) {
          hx += half[c] * turn[3 * row];
          hy += half[c] * turn[3 * row + 1];
          hz += half[c] * turn[3 * row + 2];
        }
      }
      halfTurn(hx, hy, hz);
      const { w, i, j, k } = turnOf;
      const qw = bw * w - bx * i - by * j - bz * k;
      const qx = bw * i + bx * w + by * k - bz * j;
      const qy = bw * j - bx * k + by * w + bz * i;
      const qz = bw * k + bx * j - by * i + bz * w;
      const r = 4 * s;
      const rw = rest[r];
      const rx = rest[r + 1];
      const ry = rest[r + 2];
      const rz = rest[r + 3];
      poses[o] = px;
      poses[o + 1] = py;
      poses[o + 2] = pz;
      poses[o + 3] = scale;
      poses[o + 4] = qw * rx + qx * rw + qy * rz - qz * ry;
      poses[o + 5] = qw * ry - qx * rz + qy * rw + qz * rx;
      poses[o + 6] = qw * rz + qx * ry - qy * rx + qz * rw;
      poses[o + 7] = qw * rw - qx * rx - qy * ry - qz * rz;
      const cx = scale * chord[3 * s];
      const cy = scale * chord[3 * s + 1];
      const cz = scale * chord[3 * s + 2];
      const tx = 2 * (qy * cz - qz * cy);
      const ty = 2 * (qz * cx - qx * cz);
      const tz = 2 * (qx * cy - qy * cx);
      px += cx + qw * tx + qy * tz - qz * ty;
      py += cy + qw * ty + qz * tx - qx * tz;
      pz += cz + qw * tz + qx * ty - qy * tx;
    }
  }

  /** How a branch's base is turned by the branch it sits on, in `turnOf`.
   * @param {number} branch @param {number} parent */
  _baseTurn(branch, parent) {
    const { arrays } = this.kind;
    const x = this._rotations;
    const first = arrays.branch_coordinate[parent];
    const count = arrays.branch_keys[parent];
    const turn = arrays.turn;
    const t = Math.min(x[first] ** 2 + x[first + 1] ** 2, STRETCH_TO);
    const stretched = 0.5 * (1 + t * arrays.branch_skew[2 * parent]);
    let at = 3 * arrays.branch_base_turn[branch];
    let hx = 0;
    let hy = 0;
    let hz = 0;
    for (let c = 0; c < count; c++, at += 3) {
      const half = (c < 2 ? stretched : 0.5) * x[first + c];
      hx += half * turn[at];
      hy += half * turn[at + 1];
      hz += half * turn[at + 2];
    }
    halfTurn(hx, hy, hz);
  }
}

/** Result of `halfTurn`; one object, as a million are made in a second. */
const turnOf = { w: 1, i: 0, j: 0, k: 0 };

/** Quaternion of half a rotation vector, into `turnOf`.
 * @param {number} hx @param {number} hy @param {number} hz */
function halfTurn(hx, hy, hz) {
  const square = hx * hx + hy * hy + hz * hz;
  let cosine = 1 - square / 2;
  let sinc = 1 - square / 6;
  if (square > 1e-8) {
    const angle = Math.sqrt(square);
    cosine = Math.cos(angle);
    sinc = Math.sin(angle) / angle;
  }
  turnOf.w = cosine;
  turnOf.i = sinc * hx;
  turnOf.j = sinc * hy;
  turnOf.k = sinc * hz;
}
