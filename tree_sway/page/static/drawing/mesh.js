// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Meshes of a kind at rest: bark as tubes, leaves as cards. Each vertex hangs on a segment, whose row is
 * its first number, and moves with it. A branch is one tube: a ring between two segments is of both. */

import { AT_ORIGIN, KindPlacer, STRIDE } from "../placing.js";
import { between, multiply, turned } from "../quaternions.js";
import { crownShade } from "./shade.js";
import { lookOf, seeded } from "./looks.js";
import { leavesAlong } from "./textures.js";

/** Least spacing of rings of bark on the screen [px], height of the picture of bark on a stem [m]. */
const [RING_SPACING, BARK_TILE] = [6, 0.6];
/** How much larger cards of leaves are, at most, where few are drawn, which show more leaves then; and how
 * many a cluster has at most, which are smaller where they are more than the spray's own. */
const [LARGEST_CARDS, MOST_OF_CLUSTER] = [4, 12];
/** Radius of wood that shows the bark of the stem, over the height of the tree. */
const BARKED = 0.005;

/** The lowest and the highest corner of a box of points. @param {ArrayLike<number>[]} points */
export const boxOf = (points) => [Math.min, Math.max].map((of) =>
  [0, 1, 2].map((c) => points.reduce((most, each) => of(most, each[c]), points[0][c])));

/** A kind at rest: its poses, its box, its highest segment, how open its crown is. @param {Kind} kind */
export function shapeOf(kind) {
  const rest = new Float32Array(STRIDE * kind.nSegments);
  const still = new Float32Array(kind.nCoordinates);
  new KindPlacer(kind).place(still, 0, AT_ORIGIN, kind.nBranches, rest, 0);
  const nodes = Array.from({ length: kind.nSegments }, (_, s) => rest.subarray(STRIDE * s));
  const [low, high] = boxOf(nodes);
  const highest = nodes.findIndex((node) => node[2] === high[2]);
  const { leaf_segment: carrier, leaf_size: sizes } = kind.arrays;
  const places = Array.from(carrier ?? [], (_, i) => leafPlace(kind, rest, i));
  const shade = crownShade(places, Array.from(sizes ?? [], (size) => 0.25 * Math.PI * size * size), low, high);
  const placer = new KindPlacer(kind, branchOrder(kind, highest));
  return { kind, placer, rest, low, high, highest, shade };
}

/** Branches by what they cover of a picture, parents before their children; what carries the highest
 * segment comes first. @param {Kind} kind @param {number} highest */
function branchOrder({ arrays, nBranches }, highest) {
  const { branch_first: first, branch_parent: parents } = arrays;
  const isTop = new Uint8Array(nBranches);
  for (let top = first.findIndex((from) => from > highest) - 1; top >= 0; top = parents[top]) isTop[top] = 1;
  const weight = new Float64Array(nBranches);
  for (let b = 0; b < nBranches; b++) {
    const length = Array.from(arrays.segment_length.subarray(first[b], first[b + 1])).reduce((a, c) => a + c);
    const own = isTop[b] ? Infinity : length * arrays.segment_radius[2 * first[b]];
    weight[b] = parents[b] < 0 ? Infinity : Math.min(own, weight[parents[b]]);
  }
  return Int32Array.from(parents, (_, b) => b).sort((a, b) => weight[b] - weight[a] || a - b);
}

/** Where a cluster of leaves is at rest. @param {Kind} kind @param {Float32Array} rest @param {number} i */
function leafPlace({ arrays }, rest, i) {
  const o = STRIDE * arrays.leaf_segment[i];
  const offset = Array.from(arrays.leaf_offset.subarray(3 * i, 3 * i + 3));
  return turned(rest, offset, o + 4).map((each, c) => each + rest[o + c]);
}

/** The bark: rings of [along, across cosine, across sine, thickness], joined to tubes; of twigs two edges
 * of a ribbon, [along, across, 0, thickness - 2]; then [place on the bark (2), openness].
 * @param {Shape} shape @param {Int32Array} branches @param {number} pixels height of the tree on the
 * screen @param {number} [fineness] of the picture, points per pixel @returns {Mesh} */
export function barkMesh({ kind, placer, rest, low, high, shade }, branches, pixels, fineness = 1) {
  const { branch_first: first, branch_parent: parents, segment_radius: radius, segment_length: length } = kind.arrays;
  const size = Math.max(high[2] - low[2], 0.1);
  const pixel = size / pixels;
  const point = pixel / fineness;
  const tile = Math.min(BARK_TILE, 0.06 * size);
  /** @type {Mesh} */
  const { values, indices } = { values: [], indices: [] };
  for (const branch of branches) {
    const [from, end] = [first[branch], first[branch + 1]];
    const thick = radius[2 * from];
    const sides = thick > 4.8 * point ? 12 : thick > 2 * point ? 6 : 2;
    const corners = sides === 2 ? 2 : sides + 1;
    const thickness = Math.min(1, thick / (BARKED * size));
    const around = Math.max(1, Math.round((2 * Math.PI * thick) / tile));
    let [turn, risen, drawn] = [0, 0, 0];
    for (let s = from; s <= end; s++) {
      const segment = Math.min(s, end - 1);
      const isLast = s === end;
      if (s > from) risen += length[s - 1];
      if (s > from && !isLast) {
        const twist = between(rest, STRIDE * (s - 1) + 4, rest, STRIDE * s + 4);
        turn += 2 * Math.atan2(twist[0], twist[3]);
        if (risen - drawn < RING_SPACING * point) continue;
      }
      drawn = risen;
      // At a joint both segments agree on the thickness: no steps in the bark.
      const joined = s > from ? 0.5 * (radius[2 * s] + radius[2 * s - 1]) : thick;
      let r = Math.max(isLast ? radius[2 * segment + 1] : joined, 0.56 * pixel);
      if (parents[branch] < 0) r *= 1 + 0.9 * Math.exp(-risen / (2.5 * thick));
      const { open } = shade(rest.subarray(STRIDE * segment, STRIDE * segment + 3));
      const up = (risen * around) / (2 * Math.PI * thick);
      for (let k = 0; k < corners; k++) {
        const angle = (2 * Math.PI * k) / sides - turn;
        const ring = sides === 2 ? [k ? -r : r, 0, thickness - 2] : [r * Math.cos(angle), r * Math.sin(angle), thickness];
        values.push(placer.slots[segment], isLast ? length[segment] : 0, ...ring, (around * k) / sides, up, open);
      }
      if (s === from) continue;
      const ring = values.length / 8 - corners;
      for (let k = 0; k < corners - 1; k++) {
        const a = ring - corners + k;
        indices.push(a, a + 1, ring + k, a + 1, ring + k + 1, ring + k);
      }
    }
  }
  return { values, indices };
}

/** Leaves: each cluster is up to three cards that cross each other about its shoot, and show leaves in a
 * picture; or smaller ones of the same area that are spread over it. They come in a mixed order, so that any first part of them is a thinner crown. Per vertex: place
 * (3), how it moves with the flutter (3), normal (3), where light comes from (3), flutter frequency and
 * phase (2), openness, tint, place in the picture (2). @param {Shape} shape @param {Int32Array} branches
 * that are drawn @param {number} cards @param {number} most cards of the whole crown, whose area fewer have
 * as well @returns {{mesh: Mesh, along: number}} and how many leaves the picture is long */
export function leafMesh({ kind, placer, rest, shade }, branches, cards, most) {
  const { arrays } = kind;
  const look = lookOf(kind);
  const { rolls, length } = look.spray;
  const { leaf_segment: carrier, leaf_size: sizes, leaf_orientation: orientation } = arrays;
  /** @type {Mesh} */
  const mesh = { values: [], indices: [] };
  if (!carrier) return { mesh, along: 1 };
  const random = seeded();
  const mean = Array.from(sizes).reduce((sum, size) => sum + size, 0) / sizes.length;
  const perCluster = (/** @type {number} */ all, mostOf = MOST_OF_CLUSTER) =>
    Math.max(1, Math.min(mostOf, Math.floor(all / carrier.length)));
  const each = perCluster(cards);
  const clusters = mixed(Array.from(carrier.keys()), random).slice(0, cards);
  // Their area is that of as many of full size.
  const full = Math.min(each, rolls.length);
  const whole = carrier.length * perCluster(most, rolls.length);
  const larger = Math.min(LARGEST_CARDS, Math.sqrt(whole / (clusters.length * full)));
  const along = leavesAlong(look, larger * length * mean * Math.sqrt(full / each));
  // A leaf alone has its own size, whatever the cluster has.
  const spray = along > 1 ? { ...look.spray, length: larger * length }
    : { rolls, width: Math.min(1, look.slenderness), length: Math.min(length, (1.4 * look.leaf_size) / mean) };
  const hung = hungOn(kind, branches);
  const quads = [];
  for (const i of clusters) {
    const at = leafPlace(kind, rest, i);
    const [p, own] = [STRIDE * hung[carrier[i]], STRIDE * carrier[i] + 4];
    const back = [-rest[p + 4], -rest[p + 5], -rest[p + 6], rest[p + 7]];
    const [w, x, y, z] = orientation.subarray(4 * i, 4 * i + 4);
    const turn = between(rest, p + 4, rest, own);
    multiply(turn, 0, [x, y, z, w], 0, turn);
    const { open, towards } = shade(at);
    const centre = turned(back, at.map((a, c) => a - rest[p + c]));
    const light = [...turned(back, towards), arrays.leaf_frequency[i]];
    const phase = arrays.leaf_phase[i];
    for (let card = 0; card < each; card++) {
      const tint = 1 + 0.16 * Math.sin(7 * phase + 2 * card);
      const first = mesh.values.length / 19;
      const spread = each > full && along > 1 ? { share: full / each, isFlat: look.has_needles && look.form !== "tufts", random } : null;
      for (const corner of cardCorners(spray, sizes[i], phase, card, spread)) {
        const [place, swing, facing] = corner.vectors.map((each) => turned(turn, each));
        mesh.values.push(placer.slots[hung[carrier[i]]], ...place.map((each, c) => each + centre[c]), ...swing, ...facing,
          ...light, phase + 2.4 * card, open, tint, ...corner.at);
      }
      quads.push([first, first + 1, first + 2, first, first + 2, first + 3]);
    }
  }
  mesh.indices = mixed(quads, random).flat();
  return { mesh, along };
}

/** Corners of a card: place, motion with the flutter, normal, in the frame of the cluster; in the picture.
 * `tree_mesh.py` has those of full size for files. @param {Spray} spray @param {number} size of the cluster
 * [m] @param {number} phase of its flutter, which makes each of its own @param {number} card its number
 * @param {Spread | null} [spread] of a smaller card, somewhere in the space of those of full size */
function cardCorners({ length, width, rolls }, size, phase, card, spread) {
  const whole = length * size;
  const long = whole * Math.sqrt(spread?.share ?? 1);
  const some = () => (spread ? spread.random() - 0.5 : 0);
  const [far, beside, above] = [some() + 0.5, some(), some()].map((each) => (spread ? each : 0));
  const roll = rolls[card % rolls.length] + 0.3 * Math.sin(phase) + (spread?.isFlat ? 0.6 : 1.2) * some();
  const yaw = 0.35 * Math.sin(phase + 2.1 * card) + (spread?.isFlat ? 1.2 * beside : 2 * width * some());
  const middle = [(whole - long) * far - 0.5 * size, width * whole * beside, (spread?.isFlat ? 0.2 : 0.8) * width * whole * above];
  const around = [0, 0, Math.sin(yaw / 2), Math.cos(yaw / 2)];
  multiply(around, 0, [Math.sin(roll / 2), 0, 0, Math.cos(roll / 2)], 0, around);
  return [[0, -0.5], [1, -0.5], [1, 0.5], [0, 0.5]].map(([u, v]) => {
    const place = turned(around, [u * long, v * width * long, 0]).map((each, c) => each + middle[c]);
    place[2] -= 0.1 * long * u;
    return { vectors: [place, [0, -place[2], place[1]], turned(around, [0.3 * u, 1.2 * v, 1])], at: [u, 0.5 + v] };
  });
}

/** In a random order. @template T @param {T[]} items @param {() => number} random */
function mixed(items, random) {
  return items.map((item) => ({ item, key: random() })).sort((a, b) => a.key - b.key).map(({ item }) => item);
}

/** The drawn segment that each segment moves with: itself, or what carries the branch left out.
 * @param {Kind} kind @param {Int32Array} branches */
function hungOn({ arrays, nSegments, nBranches }, branches) {
  const hung = Int32Array.from({ length: nSegments }, (_, i) => i);
  const drawn = new Set(branches);
  for (let branch = 0; branch < nBranches; branch++) {
    if (drawn.has(branch)) continue;
    const under = hung[arrays.branch_base_segment[branch]];
    hung.fill(under, arrays.branch_first[branch], arrays.branch_first[branch + 1]);
  }
  return hung;
}
