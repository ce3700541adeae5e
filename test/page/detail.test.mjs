// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
// What is placed of small trees: `node --test test/page/detail.test.mjs`.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Camera } from "../../tree_sway/page/static/drawing/camera.js";
import { Detail, levelsOf } from "../../tree_sway/page/static/drawing/detail.js";
import { deadWood, leafMesh } from "../../tree_sway/page/static/drawing/foliage.js";
import { distance, turned } from "../../tree_sway/page/static/quaternions.js";
import { barkMesh, shapeOf } from "../../tree_sway/page/static/drawing/mesh.js";
import { arrowLength } from "../../tree_sway/page/static/drawing/props.js";
import { cornersAbout } from "../../tree_sway/page/static/drawing/impostors.js";
import { Quality } from "../../tree_sway/page/static/drawing/quality.js";
import { crownShade } from "../../tree_sway/page/static/drawing/shade.js";
import { average, lookOf } from "../../tree_sway/page/static/drawing/looks.js";
import { leavesAlong, pictureWidth, wholeLeaf } from "../../tree_sway/page/static/drawing/textures.js";
import { Placer } from "../../tree_sway/page/static/placing.js";
import { decodeDescription } from "../../tree_sway/page/static/protocol.js";

const bytes = readFileSync(new URL("vectors/description.bin", import.meta.url));
const description = decodeDescription(
  bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength),
);
const [kind] = description.kinds;
const shape = shapeOf(kind);
const { placer } = shape;

test("branches come after their parents, thick ones first, what carries the top before all", () => {
  const place = new Map(Array.from(placer.order, (branch, i) => [branch, i]));
  const { branch_parent: parent, branch_first: first } = kind.arrays;
  assert.equal(place.size, kind.nBranches);
  for (const branch of placer.order) {
    if (parent[branch] >= 0) assert.ok(place.get(parent[branch]) < place.get(branch));
  }
  const top = parent.findIndex((_, b) => first[b + 1] > shape.highest);
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
        else for (let i = 0; i < 8; i++) assert.ok(Math.abs(poses[at + i] - whole[from + i]) < 1e-6);
      }
    }
  }
});

/** A thousand trees of 2,000 segments in rows, 3 m apart. */
function crowd() {
  const reached = Int32Array.from({ length: 1001 }, (_, i) => 2 * i);
  const slots = Int32Array.from({ length: 2000 }, (_, i) => i);
  const levels = levelsOf({ reached, slots, order: slots.slice(0, 1000) }, 30, { segments: 8000, cards: 3000, near: 400, far: 40 });
  const trees = Array.from({ length: 1000 }, (_, i) => ({
    kind: 0,
    height: 1,
    place: [3 * (i % 50), 3 * Math.floor(i / 50), 0, 0, 1],
  }));
  const camera = new Camera();
  camera.home([[0, 0, 0], [150, 60, 1]]);
  return { levels, camera, detail: new Detail(trees, [levels], [0.7], 0) };
}

test("the camera stays above the ground, whatever room the cards leave it", () => {
  for (const room of [[0, 0, 1, 1], [0, 0.16, 1, 0.39], [0.3, 0, 1, 0.5], [0, 0.5, 1, 1]]) {
    for (const aspect of [0.46, 0.75, 2.2]) {
      const camera = Object.assign(new Camera(), { aspect, room: () => room });
      for (const tall of [0.5, 4, 22]) {
        camera.home([[-0.2 * tall, -0.2 * tall, 2], [0.2 * tall, 0.2 * tall, 2 + tall]]);
        for (let i = 0; i < 6; i++) {
          camera.update();
          assert.ok(camera.eye[2] > 2, `${room} ${aspect} ${tall}: ${camera.eye[2]}`);
          camera.zoom(1.5);
          camera.orbit(0, -60);
        }
      }
    }
  }
});

test("a tree fills most of the picture, and a stand is seen from its edge", () => {
  const camera = new Camera();
  for (const aspect of [0.75, 1, 1.6]) {
    camera.aspect = aspect;
    for (const [wide, tall] of [[16, 18], [5, 20], [10, 12]]) {
      camera.home([[-wide / 2, -wide / 2, 0], [wide / 2, wide / 2, tall]]);
      camera.update();
      const [foot, top] = [0, tall].map((z) => camera.project([0, 0, z])[1]);
      const [left, right] = [-1, 1].map((side) => camera.project([-0.28 * side * wide, 0.41 * side * wide, tall / 2])[0]);
      assert.ok(Math.max(foot - top, Math.abs(right - left)) > 0.6);
      assert.ok(top > 0 && foot < 1 && Math.min(left, right) > 0);
    }
  }
  camera.home([[0, 0, 0], [300, 200, 20]]);
  camera.update();
  const [x, y, z] = camera.eye;
  const outside = Math.hypot(Math.max(0, -x, x - 300), Math.max(0, -y, y - 200));
  assert.ok(outside < 2 * 20 && z > 1 && z < 20, `${camera.eye}`);
});

test("levels grow to the whole tree, and the highest segment is of all of them", () => {
  const { levels } = crowd();
  assert.deepEqual([levels[0].branches, levels[0].segments], [0, 1]);
  assert.ok(levels.slice(1).every((level) => level.segments > 30));
  levels.slice(1).forEach((level, i) => assert.ok(level.segments >= levels[i].segments));
  assert.equal(levels[levels.length - 1].segments, 2000);
  assert.equal(levels[levels.length - 1].cards, 3000);
});

test("far trees are coarse, near ones fine, those out of sight nothing, all within the budget", () => {
  const { levels, camera, detail } = crowd();
  camera.set([-0.6, 0.2, 300, 75, 30, 0.5]);
  detail.choose(camera.update(), 800, 8000);
  assert.ok(detail.level.every((level) => level >= 0));
  assert.ok(detail.segments <= 1000 + 8000);
  camera.distance = 4;
  detail.choose(camera.update(), 800, 8000);
  const counts = detail.level.reduce((all, level) => all.set(level, (all.get(level) ?? 0) + 1),
    new Map());
  assert.ok(counts.get(-1) > 100);
  assert.ok(Math.max(...counts.keys()) > 2);
  let row = 0;
  for (const t of detail.order) {
    assert.equal(detail.start[t], row);
    row += levels[detail.level[t]]?.segments ?? 0;
  }
  assert.equal(row, detail.segments);
  const whole = detail.segments;
  detail.choose(camera.matrix, 800, 500);
  assert.ok(detail.segments < whole);
  assert.equal(detail.level[0], 1, "the tree that is watched is placed whatever the budget");
});

/** Length and width of a card [m]. */
function edges({ values, indices }, i) {
  const [a, b, c] = [0, 1, 2].map((k) => values.slice(19 * indices[6 * i + k] + 1).slice(0, 3));
  return [Math.hypot(...b.map((x, k) => x - a[k])), Math.hypot(...c.map((x, k) => x - b[k]))];
}

/** Cards of a mesh: the segment, corners and middles of both ends of each, and whether it is the wood of a twig. */
function cardsOf({ values, indices }) {
  return Array.from({ length: indices.length / 6 }, (_, i) => {
    const at = [0, 1, 2, 3].map((k) => 19 * (indices[6 * i] + k));
    const corners = at.map((v) => values.slice(v + 1, v + 4));
    const [a, b, c, d] = corners;
    const ends = [[a, d], [b, c]].map(([one, other]) => one.map((each, k) => 0.5 * (each + other[k])));
    return { slot: values[at[0]], corners, ends, isWood: values[at[0] + 17] < 0 };
  });
}

test("leaves that reach beyond the wood are lighter than those within it", () => {
  const places = Array.from({ length: 2000 }, (_, i) => [(i % 10) - 4.5, (Math.floor(i / 10) % 10) - 4.5, i / 200]);
  const shade = crownShade(places, places.map(() => 1), [-5, -5, 0], [5, 5, 10]);
  assert.ok(shade([0, 0, 10.5]).open > 1.2 * shade([0, 0, 9.9]).open);
});

test("stubs below the crown of a conifer bear no needles, short limbs at its top do", () => {
  // A stem of two parts, a stub with a twig on it, a long limb, and a short one above.
  const arrays = {
    branch_first: Int32Array.of(0, 2, 3, 4, 5, 6, 7), branch_parent: Int32Array.of(-1, 0, 0, 2, 0, 1),
    segment_length: Float32Array.of(5, 5, 5, 0.2, 0.1, 4, 0.2),
  };
  const rest = new Float32Array(8 * 7);
  [0, 5, 15, 5, 5, 7, 12].forEach((high, segment) => (rest[8 * segment + 2] = high));
  assert.deepEqual([...deadWood({ arrays, nBranches: 6 }, rest, 2)], [3, 4]);
});

test("few cards are larger and show more leaves, none of which is twice its own size", () => {
  const { leaf_size: size } = lookOf(kind);
  const most = 3 * kind.arrays.leaf_segment.length;
  const areas = [most, Math.round(most / 3), Math.round(most / 12), 6].map((cards) => {
    const { mesh, along } = leafMesh(shape, placer.order, cards, most);
    let area = 0;
    for (let i = 0; i < mesh.indices.length / 6; i++) {
      const [long, wide] = edges(mesh, i);
      area += long * wide;
      assert.ok(long / along < 2 * size, `${long / along} m of ${size} m`);
    }
    return area;
  });
  assert.ok(areas.slice(1, 3).every((area) => area > 0.3 * areas[0] && area < 1.5 * areas[0]));
});

test("many cards are small, and no branch ends without leaves", () => {
  const { leaf_segment: clusters, leaf_size: sizes, branch_first: first, segment_length: length } = kind.arrays;
  const mean = sizes.reduce((sum, size) => sum + size, 0) / sizes.length;
  const { mesh } = leafMesh(shape, placer.order, 24 * clusters.length, 24 * clusters.length);
  const { mesh: coarse } = leafMesh(shape, placer.order, 3 * clusters.length, 24 * clusters.length);
  assert.ok(mesh.indices.length > 1.5 * coarse.indices.length);
  assert.ok(edges(mesh, 0)[0] < 0.8 * edges(coarse, 0)[0]);
  const at = new Map();
  for (let v = 0; v < mesh.values.length; v += 19) {
    const [slot, ...place] = mesh.values.slice(v, v + 4);
    at.set(slot, [...(at.get(slot) ?? []), place]);
  }
  for (let branch = 0; branch < kind.nBranches; branch++) {
    const end = first[branch + 1] - 1;
    if (length[end] < mean) continue;
    const near = at.get(placer.slots[end])?.map(([x, y, z]) => Math.hypot(x - length[end], y, z)) ?? [];
    assert.ok(Math.min(...near) < 1.5 * mean, `branch ${branch}`);
  }
});

test("a long shoot that hangs is clothed from its foot on", () => {
  const arrays = { ...kind.arrays, leaf_size: kind.arrays.leaf_size.map((size) => size / 8) };
  const small = shapeOf({ ...kind, arrays, look: { ...average, leaf_size: 0.01, droop: 0.5 } });
  const { leaf_segment: clusters, leaf_size: sizes, segment_length: length } = arrays;
  const mean = sizes.reduce((sum, size) => sum + size, 0) / sizes.length;
  const { mesh } = leafMesh(small, placer.order, 6 * clusters.length, 6 * clusters.length);
  const nearest = new Map();
  for (let v = 0; v < mesh.values.length; v += 19) {
    const [slot, ...place] = mesh.values.slice(v, v + 4);
    nearest.set(slot, Math.min(nearest.get(slot) ?? Infinity, Math.hypot(...place)));
  }
  const long = [...new Set(clusters)].filter((segment) => length[segment] > 2 * mean);
  assert.ok(long.length > 3);
  assert.ok(long.every((segment) => nearest.get(placer.slots[segment]) < mean));
});

test("a large cluster has no larger leaves than the others", () => {
  const sizes = kind.arrays.leaf_size.map((size, i) => (i ? 1 : 6) * size);
  const uneven = shapeOf({ ...kind, arrays: { ...kind.arrays, leaf_size: sizes } });
  const cards = 24 * sizes.length;
  const { mesh, isSpread } = leafMesh(uneven, placer.order, cards, cards, false);
  assert.ok(isSpread);
  const longs = cardsOf(mesh).filter(({ isWood }) => !isWood).map(({ corners: [a, b] }) => distance(a, b));
  assert.ok(Math.max(...longs) < 4 * Math.min(...longs));
});

test("every small card grows from a twig that is drawn", () => {
  const cards = 24 * kind.arrays.leaf_segment.length;
  const { mesh } = leafMesh(shape, placer.order, cards, cards, false);
  const all = cardsOf(mesh);
  const twigs = all.filter(({ isWood }) => isWood).map(({ slot, ends }) => ({ slot, ends }));
  assert.ok(twigs.length > cards / 20);
  const far = (place, { ends: [from, to] }) => {
    const along = to.map((each, c) => each - from[c]);
    const share = along.reduce((sum, each, c) => sum + each * (place[c] - from[c]), 0) / along.reduce((sum, each) => sum + each * each, 1e-9);
    return distance(place, from.map((each, c) => each + Math.min(1, Math.max(0, share)) * along[c]));
  };
  for (const { slot, corners: [a, b], ends: [foot], isWood } of all.slice(0, 400)) {
    if (isWood) continue;
    const nearest = Math.min(...twigs.filter((twig) => twig.slot === slot).map((twig) => far(foot, twig)));
    assert.ok(nearest < 0.2 * distance(a, b), `${nearest} m from wood, ${distance(a, b)} m long`);
  }
});

test("twigs of a plant in a pot hang if its shoots droop", () => {
  const segmentAt = new Map(Array.from(placer.slots, (slot, segment) => [slot, segment]));
  const { leaf_segment: clusters, segment_radius: radius } = kind.arrays;
  const leafy = new Set(clusters);
  // Thick wood has no shoots but its clusters.
  const arrays = { ...kind.arrays, segment_radius: radius.map((each, i) => (leafy.has(i >> 1) ? each : 9)) };
  const cards = 24 * clusters.length;
  const [hanging, upright] = [0.5, -0.5].map((droop) => {
    const look = { ...average, leaf_size: 0.2, is_potted: true, droop };
    const { mesh } = leafMesh(shapeOf({ ...kind, arrays, look }), placer.order.slice(0, 1), cards, cards, false);
    const falls = cardsOf(mesh).filter(({ isWood }) => isWood).map(({ slot, ends: [from, to] }) => {
      const along = turned(shape.rest, to.map((each, c) => each - from[c]), 8 * segmentAt.get(slot) + 4);
      return -along[2] / distance(from, to);
    });
    return falls.reduce((sum, each) => sum + each, 0) / falls.length;
  });
  assert.ok(hanging > 0.4, `${hanging}`);
  assert.ok(upright < 0.1, `${upright}`);
});

test("a leaf with leaflets is a picture of its own, about as large as it is, and a needle is exactly", () => {
  const walnut = { ...average, form: "compound", leaf_size: 0.1 };
  const drawn = wholeLeaf(average) / average.leaf_size;
  assert.ok(drawn >= 1 && drawn < 1.5, `${drawn}`);
  assert.equal(wholeLeaf({ ...average, has_needles: true }), average.leaf_size);
  assert.ok(wholeLeaf(walnut) > 0.3);
  assert.ok(pictureWidth(walnut, 1) > walnut.slenderness);
  assert.equal(pictureWidth(walnut, 5), walnut.spray.width);
});

test("a picture of a large card shows small leaves, whatever the species", () => {
  for (const form of ["ovate", "compound", "digitate", "needles", "bunches", "tufts", "fronds", "of no species"]) {
    const look = { ...average, form, has_needles: ["needles", "bunches", "tufts", "fronds"].includes(form) };
    const { leaf_size: size } = look;
    for (const card of [size, 3 * size, 8 * size, 30 * size]) {
      assert.ok(card / leavesAlong(look, card) < 2 * size);
    }
  }
});

test("it is darker inside a crown than at its edge, and light comes from outside", () => {
  const places = [];
  for (let i = 0; i < 4000; i++) {
    const p = [0.7548, 0.5698, 0.8192].map((step) => 2 * ((i * step) % 1) - 1);
    if (Math.hypot(...p) < 1) places.push(p);
  }
  const at = crownShade(places, places.map(() => 0.01), [-1, -1, -1], [1, 1, 1]);
  assert.ok(at([0, 0, 0]).open < 0.5 * at([0, 0, 0.97]).open);
  assert.ok(at([0.9, 0, 0]).towards[0] > 0.2);
  assert.ok(at([-0.9, 0, 0]).towards[0] < -0.2);
  assert.equal(crownShade([], [], [0, 0, 0], [1, 1, 1])([0, 0, 0]).open, 1);
});

test("a slow page leaves out pixels first, then frames, then grass, and leaves last", () => {
  const quality = new Quality();
  let now = 0;
  const run = (fps, seconds) => {
    for (let i = 0; i < fps * seconds; i++) quality.count((now += 1000 / fps), true);
  };
  run(60, 5);
  assert.equal(quality.leftOut, null);
  run(30, 20);
  assert.ok(quality.fineness < 0.6);
  assert.equal(quality.density, 1);
  assert.ok(quality.hasGrass);
  run(20, 1);
  assert.ok(!quality.hasGrass && quality.density === 1);
  run(12, 20);
  assert.ok(quality.density < 1 && quality.density >= 0.4);
  run(60, 120);
  assert.equal(quality.density, 1);
  assert.ok(quality.hasGrass);
});

test("more pixels that cost frames are taken back, and tried again later each time", () => {
  const quality = new Quality();
  let [now, tries, wasCoarse] = [0, 0, false];
  const count = (fps) => quality.count((now += 1000 / fps), true);
  for (let i = 0; i < 30 * 20; i++) count(30);
  assert.equal(quality.fineness, 0.5);
  const begun = now;
  while (now < begun + 120e3) {
    const isCoarse = quality.fineness === 0.5;
    tries += Number(wasCoarse && !isCoarse);
    wasCoarse = isCoarse;
    count(isCoarse ? 60 : 54);
  }
  assert.ok(tries > 1 && tries < 6);
  assert.equal(quality.fineness, 0.5);
});

test("without a graphics unit a card is a triangle that stays in as much of the picture", () => {
  const few = 2 * kind.arrays.leaf_segment.length;
  const [square, plain] = [false, true].map((isPlain) => leafMesh(shape, placer.order, few, few, false, isPlain).mesh);
  assert.equal(plain.indices.length, square.indices.length / 2);
  assert.equal(plain.values.length, (3 / 4) * square.values.length);
  const areaOf = ({ values }, v) => {
    const [a, b, c] = [0, 1, 2].map((k) => Array.from(values.slice(19 * (v + k) + 17, 19 * (v + k) + 19)));
    return 0.5 * Math.abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
  };
  assert.ok(Math.abs(areaOf(plain, 0) - 2 * areaOf(square, 0)) < 0.05);
});

test("the picture of a far tree is cut to the tree, and never reaches into another", () => {
  const points = new Uint8Array(4 * 1024 * 256);
  // Narrow at its top, a cone in each of the pictures.
  for (let y = 10; y < 120; y++) {
    const wide = 50 * (1 - y / 125);
    for (let x = 0; x < 1024; x++) {
      if (Math.abs((x % 128) - 63.5) < wide) points[4 * (1024 * y + x) + 3] = 255;
    }
  }
  const [[left, low], [right], [, high], [end]] = cornersAbout(points, 128);
  assert.ok(left === -right && right <= 1 && end < 0.3 * right);
  assert.ok(low < 2 * (10 / 128) - 1 + 1e-6 && high > 2 * (119 / 128) - 1);
  assert.deepEqual(cornersAbout(points.fill(0), 128)[0], [-1, -1]);
});

test("a small tree has fewer rings of bark, none thinner than half a pixel", () => {
  const near = barkMesh(shape, placer.order, 800);
  const far = barkMesh(shape, placer.order, 12);
  assert.ok(far.values.length < near.values.length / 3);
  for (let v = 0; v < far.values.length / 8; v++) {
    assert.ok(Math.hypot(far.values[8 * v + 2], far.values[8 * v + 3]) > 0.5 / 12 / 2);
  }
});

test("wood bends between its joints where these turn, and nowhere else", () => {
  const { segment_length: length, segment_radius: radius, branch_first: first } = kind.arrays;
  const bends = (poses) => {
    const { values } = barkMesh({ ...shape, rest: poses }, placer.order.slice(0, 1), 8000);
    const middles = new Map();
    for (let v = 0; v < values.length; v += 8) {
      const [slot, along, y, z] = values.slice(v, v + 4);
      const key = `${slot} ${along}`;
      middles.set(key, [...(middles.get(key) ?? []), [y, z]]);
    }
    // The second first corner of a ring is left out.
    return [...middles.values()].map((ring) => Math.hypot(...[0, 1].map((c) => ring.slice(1).reduce((sum, each) => sum + each[c] / (ring.length - 1), 0))));
  };
  const straight = shape.rest.slice();
  const bent = shape.rest.slice();
  const [branch] = placer.order;
  for (let s = first[branch]; s < first[branch + 1]; s++) {
    straight.set([0, 0, 0, 1], 8 * s + 4);
    bent.set([0, Math.sin(0.3 * s), 0, Math.cos(0.3 * s)], 8 * s + 4);
  }
  const [thick, long] = [Math.max(...radius), Math.min(...length.slice(first[branch], first[branch + 1]))];
  assert.ok(Math.max(...bends(straight)) < thick);
  assert.ok(Math.max(...bends(bent)) > Math.max(...bends(straight)) + 0.03 * long);
});

test("the arrow of the wind is small beside the tree, whatever the wind", () => {
  for (const speed of [1, 10, 100]) assert.ok(arrowLength(12, speed) < 12 / 4);
  assert.ok(arrowLength(12, 10) > arrowLength(12, 5));
});
