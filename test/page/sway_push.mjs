// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
// A segment that is pushed, then let go: `node test/page/sway_push.mjs FOLDER`, which has description.bin,
// tables.bin and push.json. Prints where its root side is after each step.
import { readFileSync } from "node:fs";
import { Placer, STRIDE } from "../../tree_sway/page/static/placing.js";
import { decodeDescription } from "../../tree_sway/page/static/protocol.js";
import { decodeTables, Stand } from "../../tree_sway/page/static/sway.js";

const read = (name) => {
  const bytes = readFileSync(`${process.argv[2]}/${name}`);
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
};
const description = decodeDescription(read("description.bin"));
const stand = new Stand(decodeTables(read("tables.bin")), description);
const placer = new Placer(description);
const { push, wind, steps, steps_pushed } = JSON.parse(new TextDecoder().decode(read("push.json")));
const places = [];
for (let step = 0; step < steps; step++) {
  if (step < steps_pushed) stand.push(push);
  if (step === steps_pushed) stand.push({ segment: push.segment, to: [0, 0, 0], stiffness: 0 });
  stand.step(...wind);
  const from = STRIDE * push.segment;
  places.push(Array.from(placer.place(stand.state()).subarray(from, from + 3)));
}
const refused = [{ segment: -1, force: [1, 0, 0] }, { segment: 1e9, force: [1, 0, 0] }, { segment: 1, force: [NaN, 0, 0] },
  { segment: 1, to: [0, 0, 0], stiffness: Infinity }, { segment: 1, force: [1, 0] }, { segment: 0.5, force: [1, 0, 0] }];
let count = 0;
for (const each of refused) {
  try {
    stand.push(each);
  } catch (error) {
    if (error.name === "ProtocolError" || error.constructor.name === "ProtocolError") count++;
  }
}
console.log(JSON.stringify({ places, refused: count === refused.length }));
