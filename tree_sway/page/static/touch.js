// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Pushes and springs on trees that are solved here, as of tree_sway/core/simulator/touch.py: a force f at
 * a place p does (dp/dc)^T f to the coordinates c of the description, found by differences. */

import { KindPlacer, STRIDE } from "./placing.js";

/** Time after which the lever of a push is found again [s], and share of full scale for differences. */
const [RENEWED, SHARE] = [0.1, 0.01];
const MOST_PUSHES = 64;

/** Branches from the root to that of a segment. @param {Kind} kind @param {number} segment */
export function chainTo({ arrays, nBranches }, segment) {
  const { branch_first: first, branch_parent: parent } = arrays;
  const chain = [];
  let branch = nBranches - 1;
  while (first[branch] > segment) branch--;
  for (; branch >= 0; branch = parent[branch]) chain.unshift(branch);
  return Int32Array.from(chain);
}

/** Pushes on one tree. */
export class Touch {
  /** @param {Description} description @param {number} tree its number */
  constructor(description, tree) {
    this.description = description;
    this.tree = description.trees[tree];
    this.kind = description.kinds[this.tree.kind];
    /** @type {Map<number, {push: Push, left: number, renewedIn: number, placer: KindPlacer, lever: Float64Array}>} */
    this._pushes = new Map();
  }

  /** Begin a push, or change that on the same segment. @param {Push} push @param {number} seconds */
  add(push, seconds) {
    const segment = push.segment - this.tree.firstSegment;
    const placer = this._pushes.get(segment)?.placer ?? new KindPlacer(this.kind, chainTo(this.kind, segment));
    const before = this._pushes.get(segment) ?? { renewedIn: 0, lever: new Float64Array(0) };
    if (this._pushes.size < MOST_PUSHES || this._pushes.has(segment)) {
      this._pushes.set(segment, { ...before, placer, push, left: seconds });
    }
  }

  /** Where the root side of a segment is [m]. @param {KindPlacer} placer @param {number} segment
   * @param {Float64Array} coordinates of this tree */
  place(placer, segment, coordinates) {
    const count = placer.order.length;
    const poses = new Float32Array(STRIDE * placer.reached[count]);
    placer.place(coordinates, 0, this.tree.place, count, poses, 0);
    return poses.subarray(STRIDE * placer.slots[segment], STRIDE * placer.slots[segment] + 3);
  }

  /** Push for a step that was just made. @param {import("./sway.js").TreeState} state
   * @param {Float64Array} coordinates of the description of this tree @param {Float64Array} half
   * @param {Float64Array} whole @param {number} dt [s] @returns {boolean} whether anybody pushes on */
  step(state, coordinates, half, whole, dt) {
    const { m, scratch: [, , , diagonal] } = state.table;
    const size = this.tree.place[4] ** 3;
    for (const [segment, each] of this._pushes) {
      const at = this.place(each.placer, segment, coordinates);
      if (each.renewedIn <= 0) this._renew(segment, each, state.table, coordinates);
      const { lever, push } = each;
      // The step was implicit in the damping of each coordinate.
      const soft = diagonal.map((own, i) => 1 / (1 - own * half[6 * i + 5]) / size);
      const give = [0, 1, 2].map((a) => [0, 1, 2].map((b) => {
        let sum = 0;
        for (let i = 0; i < m; i++) sum += whole[6 * i + 2] * soft[i] * lever[3 * i + a] * lever[3 * i + b];
        return sum;
      }));
      const share = Math.min(1, each.left / dt);
      const [x, y, z] = push.to ? pull(at, push.to, share * (push.stiffness ?? 0), give)
        : (push.force ?? [0, 0, 0]).map((f) => share * f);
      for (let i = 0; i < m; i++) {
        const f = soft[i] * (x * lever[3 * i] + y * lever[3 * i + 1] + z * lever[3 * i + 2]);
        state.eta[i] += whole[6 * i + 2] * f;
        state.rate[i] += whole[6 * i + 5] * f;
        state.force[i] += f;
      }
      each.left -= dt;
      each.renewedIn -= dt;
      if (each.left <= 1e-9) this._pushes.delete(segment);
    }
    return this._pushes.size > 0;
  }

  /** Find how a segment moves with each modal coordinate. @param {number} segment
   * @param {{placer: KindPlacer, lever: Float64Array, renewedIn: number}} push
   * @param {import("./sway.js").Table} table @param {Float64Array} coordinates */
  _renew(segment, push, { m, n, state: matrix }, coordinates) {
    push.lever = new Float64Array(3 * m);
    push.renewedIn = RENEWED;
    for (let k = 0; k < n; k++) {
      const by = SHARE * this.description.scale[this.tree.firstCoordinate + k];
      const [there, back] = [by, -by].map((step) =>
        this.place(push.placer, segment, coordinates.map((c, j) => (j === k ? c + step : c))));
      for (let a = 0; a < 3; a++) {
        const slope = by > 0 ? (there[a] - back[a]) / (2 * by) : 0;
        for (let i = 0; i < m; i++) push.lever[3 * i + a] += slope * matrix[i * n + k];
      }
    }
  }
}

/** Force of a spring by where it is at the end of the step, and no stiffer than a step can follow.
 * @param {ArrayLike<number>} at @param {number[]} to @param {number} stiffness @param {number[][]} give
 * [m/N] */
function pull(at, to, stiffness, give) {
  const k = Math.min(stiffness, 0.5 / (give[0][0] + give[1][1] + give[2][2]));
  const [a, b, c] = give.map((row, i) => row.map((g, j) => k * g + (i === j ? 1 : 0)));
  const f = to.map((each, i) => k * (each - at[i]));
  const cross = (/** @type {number[]} */ u, /** @type {number[]} */ v) =>
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const dot = (/** @type {number[]} */ u, /** @type {number[]} */ v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  // Its matrix is symmetric: rows are columns.
  const all = dot(a, cross(b, c));
  return [dot(f, cross(b, c)) / all, dot(a, cross(f, c)) / all, dot(a, cross(b, f)) / all];
}
