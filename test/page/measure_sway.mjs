// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
// Time of a step in Node.js, of one tree and of a frame of many, on made-up tables:
// `node test/page/measure_sway.mjs`. Prints the least of many batches, as other programs run beside.
import { Stand, Table } from "../../tree_sway/page/static/sway.js";

const [A, N] = [24, 7];
let seed = 1;
const random = () => ((seed = (seed * 16807) % 2147483647) / 2147483647 - 0.5);
const singles = (count, scale = 1, shift = 0) => Float32Array.from({ length: count }, () => shift + scale * random());

/** A table of m coordinates whose numbers are of no tree. @param {number} m */
export function madeUp(m) {
  const arrays = {};
  const add = (name, shape, values) => (arrays[name] = { shape, values });
  const plain = (name, ...shape) => add(name, shape, singles(shape.reduce((a, b) => a * b), 1e-3));
  add("stiffness", [m], Float32Array.from({ length: m }, (_, i) => (6.28 * (0.4 + 0.2 * i)) ** 2));
  add("limit", [m], new Float32Array(m).fill(1));
  add("own_damping", [m], Float32Array.from({ length: m }, (_, i) => 0.5 + 0.1 * i));
  add("motion", [m], singles(m, 0, 1e-3));
  add("levels", [A, N], Float32Array.from({ length: A * N }, (_, i) => (i % N) * 0.1));
  plain("harmonics", 21, m);
  plain("equilibrium", A, N, m);
  plain("amount", A, m);
  plain("load", A, N, m);
  plain("cross_damping", A, N, m);
  plain("state", m, 20);
  plain("correction", 20, m);
  plain("branch_compliance", 20, 4);
  plain("shape_compliance", 20, 20);
  for (const [name, rows] of [["turning", A * N], ["damping", A * N], ["lean", A], ["steep_turning", 2], ["steep_damping", 2]]) {
    add(`${name}_rows`, [rows, 2], singles(2 * rows, 1e-9));
    add(`${name}_shapes`, [2, m * m], Int16Array.from({ length: 2 * m * m }, () => 1000 * random()));
  }
  return new Table({ most_pressure: 1e3, most_energy: 1e9, drag_law: [0.5, 0.3, 0.2] }, arrays);
}

/** Least time of a frame [us]. @param {number} m @param {number} count of trees */
function timed(m, count) {
  const table = madeUp(m);
  const trees = Array.from({ length: count }, (_, i) => ({
    kind: 0, place: [4 * (i % 32), 4 * Math.floor(i / 32), 0, i, 1], firstCoordinate: 20 * i,
  }));
  const description = { kinds: [{ nCoordinates: 20, nKeys: 20 }], trees, identity: "made up", nCoordinates: 20 * count };
  const tables = { description: "made up", anemometer: null, ratio: 1, kinds: [table], speeds: new Float32Array(count).fill(1) };
  const stand = new Stand(tables, description);
  const steps = Math.max(1, Math.round(100 / count));
  let [least, time] = [Infinity, 0];
  for (let batch = 0; batch < (count > 1 ? 60 : 600); batch++) {
    const begin = performance.now();
    for (let i = 0; i < steps; i++, time += 1 / 60) stand.step(6 + 2 * Math.sin(time), Math.cos(0.7 * time), 0.2 * Math.sin(2 * time));
    least = Math.min(least, (1000 * (performance.now() - begin)) / steps);
  }
  return least;
}

for (const [m, count] of [[20, 1], [60, 1], [20, 1000]]) {
  console.log(`${count} of ${m} coordinates: ${timed(m, count).toFixed(1)} us per step of all`);
}
