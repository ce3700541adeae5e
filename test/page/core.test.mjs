// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
// The memory of the native core in WebAssembly, and what it refuses: `node --test test/page/core.test.mjs`.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ProtocolError } from "../../tree_sway/page/static/checks.js";
import { Block, core, Model } from "../../tree_sway/page/static/core.js";

/** Blocks of many sizes, each filled with a number of its own. @param {number} count */
function filled(count) {
  return Array.from({ length: count }, (_, i) => {
    const block = new Block(Float64Array, (i * 7919) % 5000);
    assert.ok(block.values.every((each) => each === 0), `block ${i} is not empty`);
    assert.equal(block.at % 16, 0);
    block.values.fill(i);
    return block;
  });
}

test("memory that was freed in any order is taken again, and blocks never overlap", () => {
  let size = 0;
  for (let round = 0; round < 20; round++) {
    const blocks = filled(500);
    blocks.forEach((block, i) => assert.ok(block.values.every((each) => each === i), `block ${i} was written to`));
    const order = blocks.map((block, i) => ({ block, key: (i * 104729 + round * 31) % 499 })).sort((a, b) => a.key - b.key);
    for (const { block } of order) block.free();
    if (round === 0) size = core.memory.buffer.byteLength;
  }
  assert.equal(core.memory.buffer.byteLength, size);
});

test("numbers keep their values when memory grows", () => {
  const block = new Block(Float64Array, 3);
  block.values.set([1, 2, 3]);
  const before = block.values;
  new Block(Uint8Array, 2 * core.memory.buffer.byteLength).free();
  assert.equal(before.length, 0);
  assert.deepEqual([...block.values], [1, 2, 3]);
});

test("more memory than there is, and arrays of no tree, are refused in a sentence", () => {
  for (const size of [2 ** 32 - 64, 2 ** 32 - 2 ** 16, 0xfffffff0]) {
    assert.throws(() => new Block(Uint8Array, size), /memory is short/);
  }
  const one = { values: new Float64Array(1), shape: [1] };
  for (const [arrays, named] of [[{ oak: one }, "oak"], [{ levels: one }, "levels"], [{ branch_first: one }, "branch_first"], [{}, "turning"]]) {
    assert.throws(() => new Model(arrays), (error) => error instanceof ProtocolError && error.message.includes(named));
  }
  assert.ok(filled(3).length === 3, "it goes on");
});
