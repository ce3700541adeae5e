// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/**
 * From the state to poses: state -> key rotations -> curves of branches -> segments, joined from
 * the root. The law is the solver's own (doc/streaming.md, "From a frame to poses").
 */

const STRETCH_TO = (Math.PI / 2) ** 2;
const BLEND_FROM = (Math.PI / 6) ** 2;
const BLEND_TO = (Math.PI / 4) ** 2;

/** Numbers per pose: x y z [m] of the root-side node, 0, then the quaternion x y z w. */
export const STRIDE = 8;

/** Places the segments of a described scene. */
export class Placer {
  /**
   * @param {import("./protocol.js").Description} description
   * @param {Int32Array | null} [branches] those to place, parents before their children; all if null
   */
  constructor(description, branches = null) {
    this.description = description;
    this.branches = branches ?? Int32Array.from({ length: description.nBranches }, (_, i) => i);
    /** Key rotations [rad]. */
    this.rotations = new Float32Array(description.nKeys);
    this.poses = new Float32Array(STRIDE * description.nSegments);
    this._base = new Float32Array(4 * description.nBranches); // w x y z
    this._half = new Float32Array(256); // half of each key rotation of a branch, stretched
    this._rows = rowsOf(description, this.branches);
  }

  /**
   * Rebuild the poses.
   *
   * @param {ArrayLike<number>} coordinates
   * @returns {Float32Array} the poses, the same array each time
   */
  place(coordinates) {
    this._expand(coordinates);
    for (const branch of this.branches) this._placeBranch(branch);
    return this.poses;
  }

  /** @param {ArrayLike<number>} coordinates */
  _expand(coordinates) {
    const matrix = this.description.arrays.basis_matrix;
    const { _rows: rows, rotations: out } = this;
    for (let r = 0; r < rows.length; r += 4) {
      let at = rows[r + 1];
      let sum = 0;
      for (let c = rows[r + 2]; c < rows[r + 3]; c++) sum += matrix[at++] * coordinates[c];
      out[rows[r]] = sum;
    }
  }

  /** @param {number} branch */
  _placeBranch(branch) {
    const { arrays } = this.description;
    const { rotations: x, poses, _base: bases, _half: half } = this;
    const parent = arrays.branch_parent[branch];
    const offset = arrays.branch_offset;
    let px = offset[3 * branch];
    let py = offset[3 * branch + 1];
    let pz = offset[3 * branch + 2];
    let bw = 1;
    let bx = 0;
    let by = 0;
    let bz = 0;
    if (parent >= 0) {
      const p = 4 * parent;
      [bw, bx, by, bz] = [bases[p], bases[p + 1], bases[p + 2], bases[p + 3]];
      if (this._baseTurn(branch, parent)) {
        const { w, i, j, k } = turnOf;
        const qw = bw * w - bx * i - by * j - bz * k;
        const qx = bw * i + bx * w + by * k - bz * j;
        const qy = bw * j - bx * k + by * w + bz * i;
        bz = bw * k + bx * j - by * i + bz * w;
        [bw, bx, by] = [qw, qx, qy];
      }
      const under = STRIDE * arrays.branch_base_segment[branch];
      const sx = poses[under + 4];
      const sy = poses[under + 5];
      const sz = poses[under + 6];
      const sw = poses[under + 7];
      const tx = 2 * (sy * pz - sz * py);
      const ty = 2 * (sz * px - sx * pz);
      const tz = 2 * (sx * py - sy * px);
      px += poses[under] + sw * tx + sy * tz - sz * ty;
      py += poses[under + 1] + sw * ty + sz * tx - sx * tz;
      pz += poses[under + 2] + sw * tz + sx * ty - sy * tx;
    }
    const own = 4 * branch;
    bases[own] = bw;
    bases[own + 1] = bx;
    bases[own + 2] = by;
    bases[own + 3] = bz;

    const first = arrays.branch_coordinate[branch];
    const count = first < 0 ? 0 : arrays.branch_keys[branch];
    const turn = arrays.turn;
    let row = arrays.branch_turn[branch];
    let blend = 0;
    let wx = 0;
    let wy = 0;
    let wz = 0;
    if (count > 0) {
      const f = 9 * branch;
      const frame = arrays.branch_frame;
      const kx = x[first];
      const ky = x[first + 1];
      const t = kx * kx + ky * ky;
      blend = Math.min(Math.max((t - BLEND_FROM) / (BLEND_TO - BLEND_FROM), 0), 1);
      const skew = arrays.branch_skew[2 * branch];
      const skewHere = skew + blend * (arrays.branch_skew[2 * branch + 1] - skew);
      const stretched = 0.5 * (1 + Math.min(t, STRETCH_TO) * skewHere);
      wx = stretched * (kx * frame[f + 6] - ky * frame[f + 3]);
      wy = stretched * (kx * frame[f + 7] - ky * frame[f + 4]);
      wz = stretched * (kx * frame[f + 8] - ky * frame[f + 5]);
      for (let c = 0; c < count; c++) half[c] = (c < 2 ? stretched : 0.5) * x[first + c];
    }

    const slope = arrays.segment_slope;
    const chord = arrays.segment_chord;
    const rest = arrays.segment_rest;
    const end = arrays.branch_first[branch + 1];
    for (let s = arrays.branch_first[branch]; s < end; s++) {
      let qw = bw;
      let qx = bx;
      let qy = by;
      let qz = bz;
      if (count > 0) {
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
        qw = bw * w - bx * i - by * j - bz * k;
        qx = bw * i + bx * w + by * k - bz * j;
        qy = bw * j - bx * k + by * w + bz * i;
        qz = bw * k + bx * j - by * i + bz * w;
      }
      const r = 4 * s;
      const rw = rest[r];
      const rx = rest[r + 1];
      const ry = rest[r + 2];
      const rz = rest[r + 3];
      const o = STRIDE * s;
      poses[o] = px;
      poses[o + 1] = py;
      poses[o + 2] = pz;
      poses[o + 4] = qw * rx + qx * rw + qy * rz - qz * ry;
      poses[o + 5] = qw * ry - qx * rz + qy * rw + qz * rx;
      poses[o + 6] = qw * rz + qx * ry - qy * rx + qz * rw;
      poses[o + 7] = qw * rw - qx * rx - qy * ry - qz * rz;
      const cx = chord[3 * s];
      const cy = chord[3 * s + 1];
      const cz = chord[3 * s + 2];
      const tx = 2 * (qy * cz - qz * cy);
      const ty = 2 * (qz * cx - qx * cz);
      const tz = 2 * (qx * cy - qy * cx);
      px += cx + qw * tx + qy * tz - qz * ty;
      py += cy + qw * ty + qz * tx - qx * tz;
      pz += cz + qw * tz + qx * ty - qy * tx;
    }
  }

  /**
   * How a branch's base is turned by the branch it sits on, in `turnOf`; false if not at all.
   *
   * @param {number} branch
   * @param {number} parent
   */
  _baseTurn(branch, parent) {
    const { arrays } = this.description;
    const x = this.rotations;
    const first = arrays.branch_coordinate[parent];
    if (first < 0) return false;
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
    return true;
  }
}

/** Result of `halfTurn`; one object, as a million are made in a second. */
const turnOf = { w: 1, i: 0, j: 0, k: 0 };

/**
 * Quaternion of half a rotation vector, into `turnOf`.
 *
 * @param {number} hx
 * @param {number} hy
 * @param {number} hz
 */
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

/**
 * The rows of the basis that some branches need: key rotation, where its row begins in the matrix,
 * first coordinate, one past the last.
 *
 * @param {import("./protocol.js").Description} description
 * @param {Int32Array} branches
 */
function rowsOf(description, branches) {
  const { arrays } = description;
  const blocks = arrays.basis_block;
  /** @type {number[]} */
  const rows = [];
  let block = 0;
  for (const branch of branches) {
    const first = arrays.branch_coordinate[branch];
    if (first < 0) continue;
    while (first >= blocks[block + 1]) block += 5;
    while (first < blocks[block]) block -= 5;
    const width = blocks[block + 3] - blocks[block + 2];
    const count = arrays.branch_keys[branch];
    for (let key = first; key < first + count; key++) {
      const at = blocks[block + 4] + (key - blocks[block]) * width;
      rows.push(key, at, blocks[block + 2], blocks[block + 3]);
    }
  }
  return Int32Array.from(rows);
}
