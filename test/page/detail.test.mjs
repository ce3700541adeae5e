// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
// What is placed of small trees: `node --test test/page/detail.test.mjs`.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Camera } from "../../tree_sway_ros/page/static/camera.js";
import { Detail, levelsOf } from "../../tree_sway_ros/page/static/detail.js";
import {
  barkMesh,
  branchOrder,
  highestOf,
  leafMesh,
} from "../../tree_sway_ros/page/static/mesh.js";
import { KindPlacer, Placer } from "../../tree_sway_ros/page/static/placing.js";
import { decodeDescription } from "../../tree_sway_ros/page/static/protocol.js";

const bytes = readFileSync(new URL("vectors/description.bin", import.meta.url));
const description = decodeDescription(
  bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength),
);
const [kind] = description.kinds;
const rest = new KindPlacer(kind).rest();
const placer = new KindPlacer(kind, branchOrder(kind, rest));

test("branches come after their parents, thick ones first, what carries the top before all", () => {
  const place = new Map(Array.from(placer.order, (branch, i) => [branch, i]));
  const { branch_parent: parent, branch_first: first } = kind.arrays;
  assert.equal(place.size, kind.nBranches);
  for (const branch of placer.order) {
    if (parent[branch] >= 0) assert.ok(place.get(parent[branch]) < place.get(branch));
  }
  const top = parent.findIndex((_, b) => first[b + 1] > highestOf(rest));
  const others = Array.from(placer.order).filter((b) => b !== top && parent[b] >= 0);
  assert.ok(others.every((b) => place.get(b) > place.get(top)));
});

test("what is placed of a tree stands where the whole tree has it", () => {
  const values = Float32Array.from(description.scale, (s, i) => 0.5 * s * Math.sin(i));
  const whole = new Placer(description).place(values);
  const poses = new Float32Array(8 * kind.nSegments);
  for (const tree of description.trees.filter((each) => each.kind === 0)) {
    for (let count = 1; count <= kind.nBranches; count++) {
      poses.fill(0);
      placer.place(values, tree.firstCoordinate, tree.place, count, poses, 0);
      for (let s = 0; s < kind.nSegments; s++) {
        const at = 8 * placer.slots[s];
        const from = 8 * (tree.firstSegment + s);
        if (placer.slots[s] >= placer.reached[count]) assert.equal(poses[at + 3], 0);
        else assert.deepEqual(poses.slice(at, at + 8), whole.slice(from, from + 8));
      }
    }
  }
});

/** A thousand trees of 2,000 segments in rows, 3 m apart. */
function crowd() {
  const reached = Int32Array.from({ length: 1001 }, (_, i) => 2 * i);
  const slots = Int32Array.from({ length: 2000 }, (_, i) => i);
  const levels = levelsOf({ reached, slots, order: slots.slice(0, 1000) }, 30, 8000, 4500);
  const trees = Array.from({ length: 1000 }, (_, i) => ({
    kind: 0,
    height: 1,
    place: [3 * (i % 50), 3 * Math.floor(i / 50), 0, 0, 1],
  }));
  const camera = new Camera();
  camera.frame([0, 0, 0], [150, 60, 1]);
  return { levels, camera, detail: new Detail(trees, [levels], [0.7], 0) };
}

test("levels grow to the whole tree, and the highest segment is of all of them", () => {
  const { levels } = crowd();
  assert.ok(levels[0].segments > 30);
  levels.slice(1).forEach((level, i) => assert.ok(level.segments > levels[i].segments));
  assert.equal(levels[levels.length - 1].segments, 2000);
  assert.equal(levels[levels.length - 1].blades, 4500);
});

test("far trees are coarse, near ones fine, those out of sight nothing, all within the budget", () => {
  const { levels, camera, detail } = crowd();
  detail.choose(camera.update(), 800, 8000);
  assert.ok(detail.level.every((level) => level >= 0));
  assert.ok(detail.segments <= 1000 * levels[0].segments + 8000);
  camera.distance = 4;
  detail.choose(camera.update(), 800, 8000);
  const counts = detail.level.reduce((all, level) => all.set(level, (all.get(level) ?? 0) + 1),
    new Map());
  assert.ok(counts.get(-1) > 100);
  assert.ok(Math.max(...counts.keys()) > 2);
  let row = 0;
  detail.level.forEach((level, t) => {
    assert.equal(detail.start[t], row);
    row += level < 0 ? 0 : levels[level].segments;
  });
  assert.equal(row, detail.segments);
  const whole = detail.segments;
  detail.choose(camera.matrix, 800, 500);
  assert.ok(detail.segments < whole && detail.share < 1);
});

test("few leaves are larger: the crown has the same area", () => {
  const level = { branches: kind.nBranches, segments: kind.nSegments, pixels: 800 };
  const area = ({ values, indices }) => {
    let sum = 0;
    for (let i = 0; i < indices.length; i += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => values.slice(16 * indices[i + k] + 7).slice(0, 3));
      const u = b.map((each, k) => each - a[k]);
      const v = c.map((each, k) => each - a[k]);
      sum += 0.5 * Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0]);
    }
    return sum;
  };
  const [full, few] = [48, 6].map((blades) =>
    leafMesh(kind, placer.order, rest, { ...level, blades }, 48, false));
  assert.equal(full.indices.length, 8 * few.indices.length);
  assert.ok(Math.abs(area(few) / area(full) - 1) < 0.5);
});

test("a small tree has fewer rings of bark, none thinner than half a pixel", () => {
  const near = barkMesh(kind, placer.order, rest, 800);
  const far = barkMesh(kind, placer.order, rest, 12);
  assert.ok(far.count < near.count / 3);
  for (let v = 0; v < far.count; v++) {
    assert.ok(Math.hypot(far.values[4 * v + 1], far.values[4 * v + 2]) > 0.5 / 12 / 2);
  }
});
