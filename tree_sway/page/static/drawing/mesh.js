// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/**
 * Shapes of a scene as vertex arrays, made once: every vertex hangs on a segment, whose pose the
 * graphics unit looks up. A branch is one tube: the ring between two segments belongs to both.
 */

import { STRIDE } from "../placing.js";
import { crownShade } from "./shade.js";
import { hasNeedles, lookOf, seeded } from "./species.js";
import { leavesAcross } from "./textures.js";

/** Rings of bark are no nearer to each other on the screen [px]. */
const RING_SPACING = 6;
/** Cards of leaves per cluster, at most: of leaves alone, and of sprays. */
const ALONE = 2;
const CARDS = 3;
/** Cards are at most so much larger where few of them are drawn; they show more leaves then. */
const LARGEST_CARDS = 4;
/** Height of the picture of bark on a stem [m]. */
const BARK_TILE = 0.6;

/**
 * @typedef {import("../protocol.js").Kind} Kind
 *
 * @typedef {object} Level how much of a kind is drawn
 * @property {number} branches the first of its order
 * @property {number} segments of these
 * @property {number} cards of its leaves
 * @property {number} pixels height of a tree that it is shaped for
 * @property {number} from height [px] from which on it is drawn
 * @property {boolean} isImpostor whether it is drawn as a picture of its kind
 */

/** Vertex arrays that grow. */
class Growing {
  /** @param {number} width numbers per vertex, the segment apart */
  constructor(width) {
    this.width = width;
    /** @type {number[]} */
    this.values = [];
    /** @type {number[]} */
    this.segments = [];
    /** @type {number[]} */
    this.indices = [];
  }

  get count() {
    return this.segments.length;
  }

  /** @param {number} segment @param {number[]} values */
  add(segment, ...values) {
    this.segments.push(segment);
    for (const value of values) this.values.push(value);
  }
}

/** @param {Float32Array} rest */
export function highestOf(rest) {
  let highest = 0;
  for (let s = 1; STRIDE * s < rest.length; s++) {
    if (rest[STRIDE * s + 2] > rest[STRIDE * highest + 2]) highest = s;
  }
  return highest;
}

/** Branches by what they cover of a picture, parents before their children; what carries the
 * highest segment comes first.
 * @param {Kind} kind @param {Float32Array} rest */
export function branchOrder(kind, rest) {
  const { arrays, nBranches } = kind;
  const first = arrays.branch_first;
  const highest = highestOf(rest);
  let top = nBranches - 1;
  while (first[top] > highest) top--;
  const isTop = new Uint8Array(nBranches);
  for (; top >= 0; top = arrays.branch_parent[top]) isTop[top] = 1;
  const weight = new Float64Array(nBranches);
  for (let b = 0; b < nBranches; b++) {
    let length = 0;
    for (let s = first[b]; s < first[b + 1]; s++) length += arrays.segment_length[s];
    const own = isTop[b] ? Infinity : length * arrays.segment_radius[2 * first[b]];
    const parent = arrays.branch_parent[b];
    weight[b] = parent < 0 ? Infinity : Math.min(own, weight[parent]);
  }
  const order = Int32Array.from({ length: nBranches }, (_, i) => i);
  return order.sort((a, b) => (weight[a] === weight[b] ? a - b : weight[b] > weight[a] ? 1 : -1));
}

/** Box of the tree at rest.
 * @param {Float32Array} poses
 * @returns {{low: [number, number, number], high: [number, number, number]}} */
export function boxOf(poses) {
  /** @type {[number, number, number]} */
  const low = [Infinity, Infinity, Infinity];
  /** @type {[number, number, number]} */
  const high = [-Infinity, -Infinity, -Infinity];
  for (let s = 0; s < poses.length; s += STRIDE) {
    for (let c = 0; c < 3; c++) {
      low[c] = Math.min(low[c], poses[s + c]);
      high[c] = Math.max(high[c], poses[s + c]);
    }
  }
  return { low, high };
}

/** How open the crown of a kind is at each place, at rest.
 * @param {Kind} kind @param {Float32Array} rest */
export function shadeOf(kind, rest) {
  const { arrays } = kind;
  const { low, high } = boxOf(rest);
  const places = Array.from(arrays.leaf_segment ?? [], (segment, i) => leafPlace(kind, rest, segment, i));
  const areas = Array.from(arrays.leaf_size ?? [], (size) => 0.25 * Math.PI * size * size);
  return crownShade(places, areas, low, high);
}

/** Where a cluster of leaves is at rest.
 * @param {Kind} kind @param {Float32Array} rest @param {number} segment @param {number} i */
function leafPlace(kind, rest, segment, i) {
  const o = STRIDE * segment;
  const [x, y, z] = kind.arrays.leaf_offset.subarray(3 * i, 3 * i + 3);
  return apply(quaternion(rest, segment), [x, y, z]).map((each, c) => each + rest[o + c]);
}

/**
 * The bark: rings of [along, across cosine, across sine, thickness], joined to tubes; of twigs two
 * edges of a ribbon, [along, across, 0, thickness - 2]; then [place on the bark (2), openness].
 * @param {Kind} kind @param {Int32Array} branches @param {Float32Array} rest
 * @param {number} pixels height of the tree on the screen
 * @param {ReturnType<typeof crownShade>} shade
 */
export function barkMesh(kind, branches, rest, pixels, shade) {
  const { arrays } = kind;
  const radius = arrays.segment_radius;
  const length = arrays.segment_length;
  const { low, high } = boxOf(rest);
  const size = Math.max(high[2] - low[2], 0.1);
  const pixel = size / pixels;
  const tile = Math.min(BARK_TILE, 0.06 * size);
  const mesh = new Growing(7);
  for (const branch of branches) {
    const from = arrays.branch_first[branch];
    const end = arrays.branch_first[branch + 1];
    const thick = radius[2 * from];
    const sides = thick > 4.8 * pixel ? 12 : thick > 2 * pixel ? 6 : 2;
    const corners = sides === 2 ? 2 : sides + 1;
    const thickness = Math.min(1, thick / (0.01 * size));
    const isStem = arrays.branch_parent[branch] < 0;
    const around = Math.max(1, Math.round((2 * Math.PI * thick) / tile));
    let turn = 0;
    let risen = 0;
    let drawn = 0;
    for (let s = from; s <= end; s++) {
      const segment = Math.min(s, end - 1);
      const isLast = s === end;
      if (s > from && !isLast) turn += twistBetween(rest, s - 1, s);
      if (s > from) risen += length[s - 1];
      if (s > from && !isLast && risen - drawn < RING_SPACING * pixel) continue;
      drawn = risen;
      // At a joint both segments agree on the thickness: no steps in the bark.
      let r = isLast
        ? radius[2 * segment + 1]
        : s > from ? 0.5 * (radius[2 * s] + radius[2 * s - 1]) : radius[2 * s];
      r = Math.max(r, 0.56 * pixel);
      if (isStem) r *= 1 + 0.9 * Math.exp(-risen / (2.5 * radius[2 * from]));
      const along = isLast ? length[segment] : 0;
      const { open } = shade(rest.subarray(STRIDE * segment, STRIDE * segment + 3));
      const up = (risen * around) / (2 * Math.PI * thick);
      for (let k = 0; k < corners; k++) {
        const angle = (2 * Math.PI * k) / sides - turn;
        if (sides === 2) mesh.add(segment, along, k ? -r : r, 0, thickness - 2, 0.5 * k, up, open);
        else {
          mesh.add(segment, along, r * Math.cos(angle), r * Math.sin(angle), thickness,
            (around * k) / sides, up, open);
        }
      }
      if (s === from) continue;
      const ring = mesh.count - corners;
      for (let k = 0; k < corners - 1; k++) {
        const a = ring - corners + k;
        mesh.indices.push(a, a + 1, ring + k, a + 1, ring + k + 1, ring + k);
      }
    }
  }
  return mesh;
}

/** How far the frame of a segment is twisted about its axis from that of the one before [rad].
 * @param {Float32Array} poses @param {number} before @param {number} after */
function twistBetween(poses, before, after) {
  const y = axis(poses, before, 1);
  const x = axis(poses, after, 0);
  const along = y[0] * x[0] + y[1] * x[1] + y[2] * x[2];
  for (let c = 0; c < 3; c++) y[c] -= along * x[c];
  const ny = axis(poses, after, 1);
  const nz = axis(poses, after, 2);
  const cosine = y[0] * ny[0] + y[1] * ny[1] + y[2] * ny[2];
  const sine = y[0] * nz[0] + y[1] * nz[1] + y[2] * nz[2];
  return -Math.atan2(sine, cosine);
}

/** An axis of a segment's frame.
 * @param {Float32Array} poses @param {number} segment @param {0 | 1 | 2} which */
function axis(poses, segment, which) {
  return apply(quaternion(poses, segment), [0, 1, 2].map((c) => (c === which ? 1 : 0)));
}

/** Leaves: each cluster is up to three cards that fan out from the twig and show leaves in a
 * picture. They come in a mixed order, so that any first part of them is a thinner crown. Per
 * vertex: place (3), how it moves with the flutter (3), normal (3), where light comes from (3),
 * flutter frequency and phase (2), openness, tint, place in the picture (2).
 * @param {Kind} kind @param {Int32Array} branches that are drawn @param {Float32Array} rest
 * @param {Level} level
 * @param {number} most cards of the whole crown, whose area fewer have as well
 * @param {ReturnType<typeof crownShade>} shade */
export function leafMesh(kind, branches, rest, level, most, shade) {
  const { arrays } = kind;
  const mesh = new Growing(18);
  const carrier = arrays.leaf_segment;
  if (!carrier) return { mesh, across: 1 };
  const random = seeded();
  const sizes = Array.from(arrays.leaf_size);
  const mean = sizes.reduce((sum, size) => sum + size, 0) / sizes.length;
  const fullest = leavesAcross(kind.species, mean) === 1 ? ALONE : CARDS;
  const perCluster = (/** @type {number} */ cards) =>
    Math.max(1, Math.min(fullest, Math.floor(cards / carrier.length)));
  const each = perCluster(level.cards);
  const order = Array.from(carrier, (_, i) => i);
  const clusters = mixed(order, 1, random).slice(0, level.cards);
  const whole = carrier.length * perCluster(most);
  const larger = Math.min(LARGEST_CARDS, Math.sqrt(whole / (clusters.length * each)));
  const across = leavesAcross(kind.species, larger * mean);
  // A leaf alone has its own size, whatever the cluster has.
  const unit = across === 1 ? Math.min(1, (1.4 * lookOf(kind.species).size) / mean) : larger;
  const hung = hungOn(kind, branches);
  for (const i of clusters) {
    const at = leafPlace(kind, rest, carrier[i], i);
    const own = quaternion(rest, carrier[i]);
    const turn = multiply(own, Array.from(arrays.leaf_orientation.subarray(4 * i, 4 * i + 4)));
    const segment = hung[carrier[i]];
    const back = conjugate(quaternion(rest, segment));
    const p = STRIDE * segment;
    const here = {
      segment,
      centre: apply(back, at.map((a, c) => a - rest[p + c])),
      turn: multiply(back, turn),
      frequency: arrays.leaf_frequency[i],
      phase: arrays.leaf_phase[i],
      ...shade(at),
    };
    here.towards = apply(back, here.towards);
    for (let card = 0; card < each; card++) {
      addCard(mesh, here, unit * sizes[i], card, kind.species, across, random);
    }
  }
  mesh.indices = mixed(mesh.indices, 6, random);
  return { mesh, across };
}

/** Groups of indices in a random order (Fisher and Yates).
 * @param {number[]} indices @param {number} size of a group @param {() => number} random */
function mixed(indices, size, random) {
  const order = Int32Array.from({ length: indices.length / size }, (_, i) => i);
  for (let i = order.length - 1; i > 0; i--) {
    const j = Math.floor((i + 1) * random());
    [order[i], order[j]] = [order[j], order[i]];
  }
  return Array.from(order, (i) => indices.slice(i * size, (i + 1) * size)).flat();
}

/** @param {Growing} mesh
 * @param {{segment: number, centre: number[], turn: number[], frequency: number, phase: number,
 * open: number, towards: number[]}} here
 * @param {number} size of the card [m] @param {number} number of the card in its cluster
 * @param {string} species @param {number} across leaves in the picture
 * @param {() => number} random */
function addCard(mesh, here, size, number, species, across, random) {
  const { form } = lookOf(species);
  const isAlone = across === 1;
  const isConifer = hasNeedles(species);
  const long = (isConifer ? 1.35 : 1) * size * (0.85 + 0.3 * random());
  // Cards cross each other, so that the crown is full from every side.
  const roll = isAlone ? 1.6 * (random() - 0.5) : (Math.PI * number) / CARDS + 0.6 * (random() - 0.5);
  const fan = isAlone ? 2.2 * (random() - 0.5) : 1.1 * (random() - 0.5);
  const hang = (isAlone && form === "pointed" ? 0.7 : form === "fronds" || form === "tufts" ? -0.5 : 0.25) + 0.6 * (random() - 0.5);
  const around = multiply([Math.cos(fan / 2), 0, 0, Math.sin(fan / 2)],
    multiply([Math.cos(hang / 2), 0, Math.sin(hang / 2), 0], [Math.cos(roll / 2), Math.sin(roll / 2), 0, 0]));
  const tint = 0.85 + 0.3 * random();
  const phase = here.phase + 6.28 * random();
  const first = mesh.count;
  const normal = apply(around, [0, 0, 1]);
  const side = apply(around, [0, 1, 0]);
  // A leaf alone fills its card: what would be cut away costs time.
  const half = isAlone ? Math.min(0.5, 0.56 * lookOf(species).slender) : isConifer ? 0.36 : 0.5;
  for (const [u, way] of [[0, -1], [1, -1], [1, 1], [0, 1]]) {
    const v = 0.5 + way * half;
    const flat = apply(around, [u * long, (v - 0.5) * long, 0]);
    flat[0] -= 0.5 * long;
    flat[2] -= 0.1 * long * u;
    const lean = 0.7 * (v - 0.5);
    mesh.add(here.segment,
      ...apply(here.turn, flat).map((each, c) => each + here.centre[c]),
      ...apply(here.turn, [0, -flat[2], flat[1]]),
      ...apply(here.turn, normal.map((each, c) => each - lean * side[c])),
      ...here.towards, here.frequency, phase, here.open, tint, u, v);
  }
  mesh.indices.push(first, first + 1, first + 2, first, first + 2, first + 3);
}

/** @param {Float32Array} rest @param {number} segment @returns {number[]} w x y z */
export function quaternion(rest, segment) {
  const o = STRIDE * segment + 4;
  return [rest[o + 3], rest[o], rest[o + 1], rest[o + 2]];
}

/** @param {number[]} q */
export function conjugate([w, x, y, z]) {
  return [w, -x, -y, -z];
}

/** A vector turned by a quaternion. @param {number[]} q @param {number[]} v */
function apply([w, x, y, z], [vx, vy, vz]) {
  const tx = 2 * (y * vz - z * vy);
  const ty = 2 * (z * vx - x * vz);
  const tz = 2 * (x * vy - y * vx);
  return [vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx];
}

/** The drawn segment that each segment moves with: itself, or what carries the branch left out.
 * @param {Kind} kind @param {Int32Array} branches */
function hungOn(kind, branches) {
  const { arrays, nSegments, nBranches } = kind;
  const hung = Int32Array.from({ length: nSegments }, (_, i) => i);
  const isDrawn = new Uint8Array(nBranches);
  for (const branch of branches) isDrawn[branch] = 1;
  for (let branch = 0; branch < nBranches; branch++) {
    if (isDrawn[branch]) continue;
    const under = hung[arrays.branch_base_segment[branch]];
    hung.fill(under, arrays.branch_first[branch], arrays.branch_first[branch + 1]);
  }
  return hung;
}

/** Quaternion product, w x y z. @param {number[]} a @param {number[]} b */
export function multiply(a, b) {
  return [
    a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
    a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
    a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
    a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
  ];
}
