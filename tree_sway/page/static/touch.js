// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Pushes and springs on trees that are solved here, as in tree_sway/core/run/pushes.py. A force at a point p adds
 * (dp/dc)^T f to the streamed coordinates c; the derivative is found by differences. The coordinates cannot
 * represent all of a local bend: the compliance that is left over turns the branches from the point to the root. */

import { KindPlacer, STRIDE } from "./placing.js";

/** Interval at which the lever of a push is found again [s]. */
const RENEWED = 0.1;
/** Rotation for differences [rad]. */
const TURN = 0.01;
/** Time constant of the bend beyond the coordinates [s], and its rotation that is no longer seen [rad]. */
const SETTLES = 0.05, GONE = 1e-3;
const MOST_PUSHES = 64;

/** Branches from the root to the one of a segment. @param {Kind} kind @param {number} segment */
export function chainTo({ arrays, nBranches }, segment) {
  const { branch_first: first, branch_parent: parent } = arrays;
  const chain = [];
  let branch = nBranches - 1;
  while (first[branch] > segment) branch--;
  for (; branch >= 0; branch = parent[branch]) chain.unshift(branch);
  return Int32Array.from(chain);
}

/** Dot product. @param {ArrayLike<number>} u @param {number[]} v @param {number} [from] where v begins in u */
const dot = (u, v, from = 0) => v.reduce((sum, each, i) => sum + u[from + i] * each, 0);

/** Work of a unit force along an axis: displacement of its point per modal coordinate (`lever`) and per key
 * rotation (`keyLever`) [m], and the key rotations per force beyond the coordinates (`residual`) [rad/N].
 * @typedef {{lever: number[], keyLever: number[], residual: number[]}} Axis
 * @typedef {{push: Push, left: number, renewedIn: number, keys: number[], axes: Axis[]}} Pushed */

/** Pushes on one tree. */
export class Touch {
  /** @type {Map<number, Pushed>} */
  _pushes = new Map();
  /** @type {Map<number, KindPlacer>} */
  _placers = new Map();
  /** Key rotations beyond the coordinates [rad], by their numbers. @type {Map<number, number>} */
  _turns = new Map();

  /** @param {Description} description @param {number} tree its number */
  constructor(description, tree) {
    this.tree = description.trees[tree];
    this.kind = description.kinds[this.tree.kind];
  }

  /** Begin a push, or change the one on the same segment. @param {Push} push @param {number} seconds */
  add(push, seconds) {
    const segment = push.segment - this.tree.firstSegment;
    const before = this._pushes.get(segment) ?? { renewedIn: 0, keys: [], axes: [] };
    if (this._pushes.size >= MOST_PUSHES && !this._pushes.has(segment)) return;
    this._pushes.set(segment, { ...before, push, left: seconds });
  }

  /** Numbers that follow the coordinates in a state, as `beyond` of placing.js reads them. */
  get beyond() {
    return [...this._turns].flatMap(([key, turn]) => [this.tree.firstKey + key, turn]);
  }

  /** Place of the root-side end of a segment [m]. @param {number} segment @param {Float64Array} coordinates
   * @param {Map<number, number>} [turns] of key rotations beyond them */
  place(segment, coordinates, turns = this._turns) {
    const placer = this._placers.get(segment) ?? new KindPlacer(this.kind, chainTo(this.kind, segment));
    this._placers.set(segment, placer);
    const count = placer.order.length;
    const poses = new Float32Array(STRIDE * placer.reached[count]);
    placer.place(coordinates, 0, this.tree.place, count, poses, 0, turns);
    return Array.from(poses.subarray(STRIDE * placer.slots[segment], STRIDE * placer.slots[segment] + 3));
  }

  /** Add the pushes to a step that was just made. @param {() => ReturnType<import("./sway.js").Stand["rows"]>} rowsNow
   * the state @param {import("./sway.js").Table} table @param {Float64Array} coordinates streamed ones of this tree
   * @param {ReturnType<import("./sway.js").Table["steps"]>} steps as of the step @param {number} dt [s]
   * @returns {boolean} whether any push is left */
  step(rowsNow, table, coordinates, { whole, half, width }, dt) {
    const { _turns: turns, tree: { place: { 4: scale } } } = this;
    const [byForce, rateByForce] = [2, 5].map((row) => whole.subarray(row * width));
    const settled = 1 - Math.exp(-dt / SETTLES);
    const settledTurn = settled / scale ** 3; // share of the residual rotation in this step
    // Per force; the step was implicit in the damping of each coordinate.
    const accelerations = rowsNow().diagonal.slice(0, table.m)
      .map((own, i) => 1 / (1 - own * half[5 * width + i]) / scale ** 3);
    const displacements = accelerations.map((each, i) => byForce[i] * each);
    for (const [key, turn] of turns) turns.set(key, (1 - settled) * turn);
    /** @type {number[][]} */
    const added = [];
    for (const [segment, each] of this._pushes) {
      const at = this.place(segment, coordinates);
      if (each.renewedIn <= 0) this._renew(segment, each, table, coordinates);
      const { keys, axes, push } = each;
      const share = Math.min(1, each.left / dt); // of the step, in which it acts
      const force = push.to ? springForce(at, push.to, push.stiffness ?? 0, share, axes, displacements, settledTurn)
        : (push.force ?? [0, 0, 0]).map((f) => share * f);
      const state = rowsNow();
      accelerations.forEach((acceleration, i) => {
        const f = acceleration * dot(force, axes.map(({ lever }) => lever[i]));
        state.eta[i] += byForce[i] * f;
        state.rate[i] += rateByForce[i] * f;
        state.force[i] += f;
      });
      added.push(...keys.map((key, i) => [key, settledTurn * dot(force, axes.map(({ residual }) => residual[i]))]));
      each.left -= dt;
      each.renewedIn -= dt;
      if (each.left <= 1e-9) this._pushes.delete(segment);
    }
    for (const [key, turn] of added) turns.set(key, (turns.get(key) ?? 0) + turn);
    return this._pushes.size > 0 || [...turns.values()].some((turn) => Math.abs(turn) > GONE);
  }

  /** Find the axes of a push in the present pose. The residual is the compliance of each branch less the part that
   * the coordinates have (tree_sway/core/run/modal_coordinates.py). @param {number} segment @param {Pushed} push
   * @param {import("./sway.js").Table} table @param {Float64Array} coordinates */
  _renew(segment, push, { m, n, nKeys, arrays }, coordinates) {
    const { basis_matrix: basis, branch_coordinate: first, branch_keys: count } = this.kind.arrays;
    const { branch_compliance: compliance, shape_compliance: shapes } = arrays;
    const width = compliance.length / nKeys;
    const chain = Array.from(chainTo(this.kind, segment), (branch) =>
      Array.from({ length: count[branch] }, (_, i) => first[branch] + i));
    const moves = chain.map((keys) => keys.map((key) => this._moveBy(key, segment, coordinates)));
    push.renewedIn = RENEWED;
    push.keys = chain.flat();
    push.axes = [0, 1, 2].map((axis) => {
      const keyLever = moves.flat().map((move) => move[axis]);
      // Per streamed coordinate, then what the coordinates do with it.
      const own = Array.from({ length: n }, (_, k) => dot(keyLever, push.keys.map((key) => basis[key * n + k])));
      const represented = own.map((_, k) => dot(shapes, own, k * n));
      const residual = chain.flatMap((keys, branch) => {
        const branchLever = moves[branch].map((move) => move[axis]);
        return keys.map((key) => dot(compliance, branchLever, key * width) - dot(basis, represented, key * n));
      });
      return { lever: Array.from({ length: m }, (_, i) => dot(arrays.state, own, i * n)), keyLever, residual };
    });
  }

  /** Displacement of a segment per turn of a key rotation [m/rad], by central differences. @param {number} key
   * @param {number} segment @param {Float64Array} coordinates */
  _moveBy(key, segment, coordinates) {
    const turns = this._turns;
    const now = turns.get(key) ?? 0;
    const [there, back] = [TURN, -TURN].map((by) => this.place(segment, coordinates, turns.set(key, now + by)));
    turns.set(key, now);
    return there.map((each, c) => (each - back[c]) / (2 * TURN));
  }
}

/** Force of a spring, implicit: by where its point is at the end of the step, which the force itself moves. With k the
 * stiffness, G the displacement of the point per force and x - p the stretch, (1 + k G) f = k (x - p).
 * @param {number[]} at p @param {number[]} to x @param {number} stiffness [N/m] @param {number} share share of the
 * step in which it acts @param {Axis[]} axes
 * @param {Float64Array} displacements of the modal coordinates per force over the step
 * @param {number} settledTurn share of the residual rotation in the step */
function springForce(at, to, stiffness, share, axes, displacements, settledTurn) {
  const give = axes.map((u) => axes.map((v) => dot(u.lever, v.lever.map((l, i) => displacements[i] * l))));
  // A stiffer spring than this would not be stable.
  const k = share * Math.min(stiffness, 0.5 / (give[0][0] + give[1][1] + give[2][2]));
  const matrix = axes.map((u, i) => axes.map((v, j) =>
    k * (give[i][j] + settledTurn * dot(u.keyLever, v.residual)) + (i === j ? 1 : 0)));
  return solve3(matrix, to.map((each, c) => k * (each - at[c])));
}

/** Solve a symmetric system of three equations by Cramer's rule. @param {number[][]} matrix @param {number[]} right */
function solve3([a, b, c], right) {
  const cross = (/** @type {number[]} */ u, /** @type {number[]} */ v) =>
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const determinant = dot(a, cross(b, c));
  return [dot(right, cross(b, c)), dot(a, cross(right, c)), dot(a, cross(b, right))].map((each) => each / determinant);
}
