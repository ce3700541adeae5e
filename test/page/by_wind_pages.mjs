// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
// Two pages that solve by the wind, each of which loses frames of its own; how far they are apart
// before and after each state that both were sent: `node test/page/by_wind_pages.mjs FOLDER`.
import { readFileSync } from "node:fs";
import { ByWind } from "../../tree_sway/page/static/by_wind.js";
import { Placer, STRIDE } from "../../tree_sway/page/static/placing.js";
import { decodeDescription, decodeFrame } from "../../tree_sway/page/static/protocol.js";
import { decodeTables, Stand } from "../../tree_sway/page/static/sway.js";

const read = (name) => {
  const bytes = readFileSync(`${process.argv[2]}/${name}`);
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
};
const description = decodeDescription(read("description.bin"));
const pages = [1, 2].map((seed) => ({
  solver: new ByWind(new Stand(decodeTables(read("tables.bin")), description)),
  placer: new Placer(description),
  random: () => ((seed = (seed * 48271) % 2147483647) / 2147483647),
  frame: null,
  lost: 0,
}));
const frames = read("frames.bin");
const apart = () => {
  const [a, b] = pages.map(({ placer, frame }) => placer.place(frame.coordinates));
  let most = 0;
  for (let s = 0; s < a.length; s += STRIDE) {
    most = Math.max(most, Math.hypot(a[s] - b[s], a[s + 1] - b[s + 1], a[s + 2] - b[s + 2]));
  }
  return most;
};
let [before, after, states, at, number] = [0, 0, 0, 0, 0];
while (at < frames.byteLength) {
  const size = new DataView(frames).getUint32(at, true);
  const frame = decodeFrame(frames.slice(at + 4, at + 4 + size), description);
  at += 4 + size;
  if (frame.coordinates.length && number > 2) before = Math.max(before, apart());
  for (const page of pages) {
    if (number > 2 && !frame.coordinates.length && page.random() < 0.01) page.lost++;
    else page.frame = page.solver.take(frame) ?? page.frame;
  }
  if (frame.coordinates.length && number > 2) {
    states++;
    after = Math.max(after, apart());
  }
  number++;
}
const { corrections, largest } = pages[0].solver;
console.log(JSON.stringify({ frames: number, states, lost: pages.map(({ lost }) => lost), before, after, corrections, largest }));
