// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
// The vectors in vectors/, read in JavaScript: `node --test test/page/vectors.test.mjs`.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Placer } from "../../tree_sway/page/static/placing.js";
import {
  ProtocolError,
  decodeDescription,
  decodeFrame,
} from "../../tree_sway/page/static/protocol.js";

const read = (name) => {
  const bytes = readFileSync(new URL(`vectors/${name}`, import.meta.url));
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
};
const expected = JSON.parse(new TextDecoder().decode(read("expected.json")));
const description = decodeDescription(read("description.bin"));

test("the description says what it holds", () => {
  assert.equal(description.identity, expected.identity);
  assert.deepEqual(description.trees.map((tree) => tree.name), ["left", "right", "turned"]);
  assert.equal(description.nSegments, expected.frames[0].poses.length);
  assert.equal(description.kinds[0].arrays.leaf_segment.length, 6);
});

for (const [number, frame] of expected.frames.entries()) {
  test(`frame ${number} and its poses`, () => {
    const decoded = decodeFrame(read(`frame${number}.bin`), description);
    assert.equal(decoded.sequence, frame.sequence);
    assert.equal(decoded.flags, frame.flags);
    assert.ok(Math.abs(decoded.stamp - Number(BigInt(frame.stamp_ns) / 1000000n)) <= 1);
    frame.wind.forEach((value, i) => assert.ok(Math.abs(decoded.wind[i] - value) <= 0.0026));
    frame.coordinates.forEach((value, i) => {
      assert.ok(Math.abs(decoded.coordinates[i] - value) <= 1e-6);
    });
    const poses = new Placer(description).place(decoded.coordinates);
    frame.poses.forEach((pose, row) => {
      for (let c = 0; c < 3; c++) {
        assert.ok(Math.abs(poses[8 * row + c] - pose[c]) < 2e-6, `segment ${row}`);
      }
      let dot = 0;
      for (let c = 3; c < 7; c++) dot += poses[8 * row + 1 + c] * pose[c];
      assert.ok(Math.abs(Math.abs(dot) - 1) < 1e-6, `segment ${row} is turned otherwise`);
    });
  });
}

test("what is broken is refused in words", () => {
  const whole = read("description.bin");
  for (const data of [new ArrayBuffer(0), whole.slice(1), whole.slice(0, whole.byteLength - 9)]) {
    assert.throws(() => decodeDescription(data), ProtocolError);
  }
  const newer = whole.slice(0);
  new DataView(newer).setUint32(4, 3, true);
  assert.throws(() => decodeDescription(newer), /version 3/);
  const frame = read("frame1.bin");
  assert.throws(() => decodeFrame(frame.slice(0, 40), description), ProtocolError);
  const other = frame.slice(0);
  new DataView(other).setUint32(4, 1, true);
  assert.equal(decodeFrame(other, description), null);
});
