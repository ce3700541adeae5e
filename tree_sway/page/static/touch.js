// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Pushes and springs on trees that are solved here, as of tree_sway/core/run/pushes.py: a force f at
 * a place p does (dp/dc)^T f to the coordinates c of the description, found by differences. What these leave of
 * the wood follows the force on the branches to the root, within SETTLES. */

import { KindPlacer, STRIDE } from "./placing.js";

/** Time after which the lever of a push is found again [s], and turn for differences [rad]. */
const [RENEWED, TURN] = [0.1, 0.01];
/** Time in which the rest of the wood follows [s], and turn that is left of it [rad]. */
const [SETTLES, GONE] = [0.05, 1e-3];
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

/** @param {ArrayLike<number>} u @param {number[]} v @param {number} [from] where v begins in u */
const dot = (u, v, from = 0) => v.reduce((sum, each, i) => sum + u[from + i] * each, 0);

/** How a force in a direction does work: how far a turn of each modal coordinate and of each key rotation moves the
 * segment [m], and what the key rotations turn by per force beyond the coordinates.
 * @typedef {{lever: number[], keyLever: number[], residual: number[]}} Way
 * @typedef {{push: Push, left: number, renewedIn: number, keys: number[], ways: Way[]}} Pushed */

/** Pushes on one tree. */
export class Touch {
  /** @param {Description} description @param {number} tree its number */
  constructor(description, tree) {
    this.tree = description.trees[tree];
    this.kind = description.kinds[this.tree.kind];
    this._pushes = /** @type {Map<number, Pushed>} */ (new Map());
    this._placers = /** @type {Map<number, KindPlacer>} */ (new Map());
    /** What key rotations have beyond the coordinates [rad]. */
    this._turns = /** @type {Map<number, number>} */ (new Map());
  }

  /** Begin a push, or change that on the same segment. @param {Push} push @param {number} seconds */
  add(push, seconds) {
    const segment = push.segment - this.tree.firstSegment;
    const before = this._pushes.get(segment) ?? { renewedIn: 0, keys: [], ways: [] };
    if (this._pushes.size >= MOST_PUSHES && !this._pushes.has(segment)) return;
    this._pushes.set(segment, { ...before, push, left: seconds });
  }

  /** What follows the coordinates in a state, as `beyond` of placing.js reads it. */
  get beyond() {
    return [...this._turns].flatMap(([key, turn]) => [this.tree.firstKey + key, turn]);
  }

  /** Where the root side of a segment is [m]. @param {number} segment @param {Float64Array} coordinates
   * @param {Map<number, number>} [turns] of key rotations beyond them */
  place(segment, coordinates, turns = this._turns) {
    const placer = this._placers.get(segment) ?? new KindPlacer(this.kind, chainTo(this.kind, segment));
    this._placers.set(segment, placer);
    const count = placer.order.length;
    const poses = new Float32Array(STRIDE * placer.reached[count]);
    placer.place(coordinates, 0, this.tree.place, count, poses, 0, turns);
    return Array.from(poses.subarray(STRIDE * placer.slots[segment], STRIDE * placer.slots[segment] + 3));
  }

  /** Push for a step that was just made. @param {import("./sway.js").TreeState} state
   * @param {Float64Array} coordinates of the description of this tree @param {Float64Array} half
   * @param {Float64Array} whole @param {number} dt [s] @returns {boolean} whether anything is left of pushes */
  step(state, coordinates, half, whole, dt) {
    const { _turns: turns, tree: { place: { 4: scale } } } = this;
    const settled = 1 - Math.exp(-dt / SETTLES);
    // The step was implicit in the damping of each coordinate.
    const soft = state.table.scratch[3].map((own, i) => 1 / (1 - own * half[6 * i + 5]) / scale ** 3);
    for (const [key, turn] of turns) turns.set(key, (1 - settled) * turn);
    const added = /** @type {number[][]} */ ([]);
    for (const [segment, each] of this._pushes) {
      const at = this.place(segment, coordinates);
      if (each.renewedIn <= 0) this._renew(segment, each, state.table, coordinates);
      const { keys, ways, push } = each;
      const give = ways.map((u) => ways.map((v) => dot(u.lever, v.lever.map((l, i) => whole[6 * i + 2] * soft[i] * l))));
      const share = Math.min(1, each.left / dt);
      const k = share * Math.min(push.stiffness ?? 0, 0.5 / (give[0][0] + give[1][1] + give[2][2]));
      const rest = settled / scale ** 3;
      const moved = give.map((row, a) => row.map((g, b) => g + rest * dot(ways[a].keyLever, ways[b].residual)));
      const force = push.to ? pull(at, push.to, k, moved) : (push.force ?? [0, 0, 0]).map((f) => share * f);
      soft.forEach((each, i) => {
        const f = each * dot(force, ways.map(({ lever }) => lever[i]));
        state.eta[i] += whole[6 * i + 2] * f;
        state.rate[i] += whole[6 * i + 5] * f;
        state.force[i] += f;
      });
      added.push(...keys.map((key, i) => [key, rest * dot(force, ways.map(({ residual }) => residual[i]))]));
      each.left -= dt;
      each.renewedIn -= dt;
      if (each.left <= 1e-9) this._pushes.delete(segment);
    }
    for (const [key, turn] of added) turns.set(key, (turns.get(key) ?? 0) + turn);
    return this._pushes.size > 0 || [...turns.values()].some((turn) => Math.abs(turn) > GONE);
  }

  /** Find how a segment moves with each coordinate, and what these leave of the wood: the compliance of each branch
   * less what the coordinates have of it (tree_sway/core/run/modal_coordinates.py). @param {number} segment
   * @param {Pushed} push @param {import("./sway.js").Table} table @param {Float64Array} coordinates */
  _renew(segment, push, { m, n, nKeys, arrays }, coordinates) {
    const { basis_matrix: basis, branch_coordinate: first, branch_keys: count } = this.kind.arrays;
    const { branch_compliance: compliance, shape_compliance: shapes } = arrays;
    const [turns, width] = [this._turns, compliance.length / nKeys];
    const chain = Array.from(chainTo(this.kind, segment), (branch) =>
      Array.from({ length: count[branch] }, (_, i) => first[branch] + i));
    const moves = chain.map((keys) => keys.map((key) => {
      const now = turns.get(key) ?? 0;
      const [there, back] = [TURN, -TURN].map((by) =>
        this.place(segment, coordinates, turns.set(key, now + by)));
      turns.set(key, now);
      return there.map((each, a) => (each - back[a]) / (2 * TURN));
    }));
    push.renewedIn = RENEWED;
    push.keys = chain.flat();
    push.ways = [0, 1, 2].map((a) => {
      const keyLever = moves.flat().map((each) => each[a]);
      const own = Array.from({ length: n }, (_, k) => dot(keyLever, push.keys.map((key) => basis[key * n + k])));
      const held = own.map((_, k) => dot(shapes, own, k * n));
      const residual = chain.flatMap((keys, branch) => keys.map((key) =>
        dot(compliance, moves[branch].map((each) => each[a]), key * width) - dot(basis, held, key * n)));
      const lever = Array.from({ length: m }, (_, i) => dot(arrays.state, own, i * n));
      return { lever, keyLever, residual };
    });
  }
}

/** Force of a spring of k [N/m] by where it is at the end of the step. @param {number[]} at @param {number[]} to
 * @param {number} k @param {number[][]} give [m/N] */
function pull(at, to, k, give) {
  const [a, b, c] = give.map((row, i) => row.map((g, j) => k * g + (i === j ? 1 : 0)));
  const f = to.map((each, i) => k * (each - at[i]));
  const cross = (/** @type {number[]} */ u, /** @type {number[]} */ v) =>
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  // Its matrix is symmetric: rows are columns.
  return [dot(f, cross(b, c)), dot(a, cross(f, c)), dot(a, cross(b, f))].map((each) => each / dot(a, cross(b, c)));
}
