// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
// Steps the tables of a folder in its wind, and prints how far the states are from the expected ones, and the least
// times of a step and of the poses of a tree [us]: `node test/page/sway_vectors.mjs FOLDER`.
import { readFileSync } from "node:fs";
import { Placer } from "../../tree_sway/page/static/placing.js";
import { decodeDescription } from "../../tree_sway/page/static/protocol.js";
import { decodeTables, Stand } from "../../tree_sway/page/static/sway.js";

const read = (name) => {
  const bytes = readFileSync(`${process.argv[2]}/${name}`);
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
};
const stand = new Stand(decodeTables(read("tables.bin")), decodeDescription(read("description.bin")));
const winds = new Float64Array(read("winds.bin"));
const expected = new Float64Array(read("expected.bin"));
const size = stand.trees.reduce((sum, { table }) => sum + table.m, 0);
const every = winds.length / 3 / (expected.length / size);
let [wrong, greatest, outside, at] = [0, 0, 0, 0];
let [begin, micros, placed] = [performance.now(), Infinity, Infinity];
for (let step = 0; step < winds.length / 3; step++) {
  stand.step(winds[3 * step], winds[3 * step + 1], winds[3 * step + 2]);
  outside += stand.outside;
  if ((step + 1) % every) continue;
  micros = Math.min(micros, (1000 * (performance.now() - begin)) / every / stand.trees.length);
  for (const [number, { table }] of stand.trees.entries()) {
    for (const value of stand.rows(number).eta.subarray(0, table.m)) {
      wrong = Math.max(wrong, Math.abs(value - expected[at]));
      greatest = Math.max(greatest, Math.abs(expected[at++]));
    }
  }
  begin = performance.now();
}
const placer = new Placer(stand.description);
for (let frame = 0; frame < 200; frame++) {
  begin = performance.now();
  placer.place(stand.state());
  placed = Math.min(placed, (1000 * (performance.now() - begin)) / stand.trees.length);
}
console.log(JSON.stringify({ wrong, greatest, outside, steps: winds.length / 3, compared: at, reduced: stand.reduced, micros, placed }));
