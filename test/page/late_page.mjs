// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
// A page that comes late to a stand that is solved by its wind, beside one from the start:
// `node test/page/late_page.mjs FOLDER`. Prints how far they are apart of how far the trees move.
import { readFileSync } from "node:fs";
import { ByWind } from "../../tree_sway/page/static/by_wind.js";
import { decodeDescription, decodeFrame } from "../../tree_sway/page/static/protocol.js";
import { decodeTables, Stand } from "../../tree_sway/page/static/sway.js";

const read = (name) => {
  const bytes = readFileSync(`${process.argv[2]}/${name}`);
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
};
const description = decodeDescription(read("description.bin"));
const tables = () => decodeTables(read("tables.bin"));
const [older, late, bare] = [0, 0, 0].map(() => new ByWind(new Stand(tables(), description)));
const { frames, joining, joined, gusts } = JSON.parse(new TextDecoder().decode(read("frames.json")));
const frameOf = (text) => {
  const bytes = Uint8Array.from(atob(text), (each) => each.charCodeAt(0));
  return decodeFrame(bytes.buffer, description);
};
late.goOn(gusts);
let [apart, without, motion] = [0, 0, 0];
frames.forEach((text, number) => {
  const { coordinates } = older.take(frameOf(text));
  if (number < joined) return;
  const found = [late, bare].map((page) => page.take(frameOf(joining[number - joined])).coordinates);
  coordinates.forEach((each, i) => {
    motion = Math.max(motion, Math.abs(each));
    apart = Math.max(apart, Math.abs(each - found[0][i]));
    without = Math.max(without, Math.abs(each - found[1][i]));
  });
});
console.log(JSON.stringify({ apart: apart / motion, without: without / motion }));
