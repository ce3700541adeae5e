// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/**
 * Shapes of a scene as vertex arrays, made once: every vertex hangs on a segment, whose pose the
 * graphics unit looks up. A branch is one tube: the ring between two segments belongs to both.
 */

import { STRIDE } from "./placing.js";

const POTTED = new Set(["benjamina", "goldcrest"]);
const NEEDLES = new Set(["goldcrest", "spruce", "sitka", "douglas_fir", "pine"]);

/** Clusters of leaves are at most so much larger where few of them are drawn. */
const LARGEST_LEAVES = 7;
/** Rings of bark are no nearer to each other on the screen [px]. */
const RING_SPACING = 6;

/**
 * @typedef {import("./protocol.js").Kind} Kind
 *
 * @typedef {object} Level how much of a kind is drawn
 * @property {number} branches the first of its order
 * @property {number} segments of these
 * @property {number} blades of its leaves
 * @property {number} pixels height of a tree from which so much is worth drawing
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

  /**
   * @param {number} segment
   * @param {number[]} values
   */
  add(segment, ...values) {
    this.segments.push(segment);
    for (const value of values) this.values.push(value);
  }
}

/** @param {import("./protocol.js").Description} description */
export function isPotted(description) {
  return description.trees.length === 1 && POTTED.has(description.kinds[0].species);
}

/** @param {Kind} kind */
export function hasNeedles(kind) {
  return NEEDLES.has(kind.species);
}

/** @param {Float32Array} rest */
export function highestOf(rest) {
  let highest = 0;
  for (let s = 1; STRIDE * s < rest.length; s++) {
    if (rest[STRIDE * s + 2] > rest[STRIDE * highest + 2]) highest = s;
  }
  return highest;
}

/**
 * Branches by what they cover of a picture, parents before their children; what carries the highest
 * segment comes first.
 *
 * @param {Kind} kind
 * @param {Float32Array} rest
 */
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

/**
 * Box of the tree at rest.
 *
 * @param {Float32Array} poses
 * @returns {{low: [number, number, number], high: [number, number, number]}}
 */
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

/**
 * The bark: rings of [along, across cosine, across sine, shade], joined to tubes; of twigs two edges
 * of a ribbon, [along, across, 0, shade - 2].
 *
 * @param {Kind} kind
 * @param {Int32Array} branches
 * @param {Float32Array} rest
 * @param {number} pixels height of the tree on the screen
 */
export function barkMesh(kind, branches, rest, pixels) {
  const { arrays } = kind;
  const radius = arrays.segment_radius;
  const length = arrays.segment_length;
  const { low, high } = boxOf(rest);
  const size = Math.max(high[2] - low[2], 0.1);
  const pixel = size / pixels;
  const mesh = new Growing(4);
  for (const branch of branches) {
    const from = arrays.branch_first[branch];
    const end = arrays.branch_first[branch + 1];
    const thick = radius[2 * from];
    const sides = thick > 4.8 * pixel ? 12 : thick > 2 * pixel ? 6 : 2;
    const shade = Math.min(1, thick / (0.01 * size));
    const isStem = arrays.branch_parent[branch] < 0;
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
      for (let k = 0; k < sides; k++) {
        const angle = (2 * Math.PI * k) / sides - turn;
        if (sides === 2) mesh.add(segment, along, k ? -r : r, 0, shade - 2);
        else mesh.add(segment, along, r * Math.cos(angle), r * Math.sin(angle), shade);
      }
      if (s === from) continue;
      const ring = mesh.count - sides;
      for (let k = 0; k < (sides === 2 ? 1 : sides); k++) {
        const next = (k + 1) % sides;
        const a = ring - sides + k;
        const b = ring - sides + next;
        mesh.indices.push(a, b, ring + k, b, ring + next, ring + k);
      }
    }
  }
  return mesh;
}

/**
 * How far the frame of a segment is twisted about its axis from that of the one before [rad].
 *
 * @param {Float32Array} poses
 * @param {number} before
 * @param {number} after
 */
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

/**
 * An axis of a segment's frame.
 *
 * @param {Float32Array} poses
 * @param {number} segment
 * @param {0 | 1 | 2} which
 * @returns {[number, number, number]}
 */
function axis(poses, segment, which) {
  const o = STRIDE * segment + 4;
  const v = [0, 0, 0];
  v[which] = 1;
  return rotate(poses[o], poses[o + 1], poses[o + 2], poses[o + 3], v[0], v[1], v[2]);
}

/**
 * @param {number} x
 * @param {number} y
 * @param {number} z
 * @param {number} w
 * @param {number} vx
 * @param {number} vy
 * @param {number} vz
 * @returns {[number, number, number]}
 */
function rotate(x, y, z, w, vx, vy, vz) {
  const tx = 2 * (y * vz - z * vy);
  const ty = 2 * (z * vx - x * vz);
  const tz = 2 * (x * vy - y * vx);
  return [vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx];
}

/** Numbers that are the same on every page. */
function seeded() {
  let state = 12345;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) | 0;
    return (state >>> 8) / 16777216;
  };
}

/**
 * Leaves: each cluster is a spray of blades, each blade two triangles folded at the midrib, or one.
 * They come in a mixed order, so that any first part of them is a thinner crown. Per vertex: centre of the cluster (3), its orientation w x y z (4), place in it (3), normal in it
 * (3), flutter frequency and phase (2), shade (1).
 *
 * @param {Kind} kind
 * @param {Int32Array} branches that are drawn
 * @param {Float32Array} rest
 * @param {Level} level
 * @param {number} most blades of the whole crown, whose area fewer have as well
 * @param {boolean} areFolded
 */
export function leafMesh(kind, branches, rest, level, most, areFolded) {
  const { arrays } = kind;
  const mesh = new Growing(16);
  const carrier = arrays.leaf_segment;
  if (!carrier) return mesh;
  const random = seeded();
  const fullest = hasNeedles(kind) ? 12 : 8;
  const perCluster = (/** @type {number} */ blades) =>
    Math.max(1, Math.min(fullest, Math.floor(blades / carrier.length)));
  const each = perCluster(level.blades);
  const order = Array.from(carrier, (_, i) => i);
  const clusters = mixed(order, 1, random).slice(0, level.blades);
  const larger = Math.min(LARGEST_LEAVES,
    Math.sqrt((carrier.length * perCluster(most)) / (clusters.length * each)));
  const needles = hasNeedles(kind) && larger < 2;
  const hung = hungOn(kind, branches);
  const { low, high } = boxOf(rest);
  const middle = [0, 1, 2].map((c) => 0.5 * (low[c] + high[c]));
  const half = [0, 1, 2].map((c) => 0.5 * Math.max(high[c] - low[c], 0.1));
  for (const i of clusters) {
    let segment = carrier[i];
    let centre = [0, 1, 2].map((c) => arrays.leaf_offset[3 * i + c]);
    let turn = [0, 1, 2, 3].map((c) => arrays.leaf_orientation[4 * i + c]);
    const o = STRIDE * segment;
    const q = [rest[o + 4], rest[o + 5], rest[o + 6], rest[o + 7]];
    const at = rotate(q[0], q[1], q[2], q[3], centre[0], centre[1], centre[2]);
    for (let c = 0; c < 3; c++) at[c] += rest[o + c];
    if (hung[segment] !== segment) {
      segment = hung[segment];
      const p = STRIDE * segment;
      const [bx, by, bz, bw] = [-rest[p + 4], -rest[p + 5], -rest[p + 6], rest[p + 7]];
      centre = rotate(bx, by, bz, bw, at[0] - rest[p], at[1] - rest[p + 1], at[2] - rest[p + 2]);
      turn = multiply([bw, bx, by, bz], multiply([q[3], q[0], q[1], q[2]], turn));
    }
    // The inside of a crown is darker than its outside, its top lighter than its foot.
    const out = Math.hypot(...[0, 1, 2].map((c) => (at[c] - middle[c]) / half[c])) / 1.3;
    const open = Math.min(1, 0.25 + 0.75 * out) * (0.8 + 0.2 * ((at[2] - low[2]) / (2 * half[2])));
    const size = larger * arrays.leaf_size[i];
    for (let blade = 0; blade < each; blade++) {
      const shade = open * (0.82 + 0.36 * random());
      addBlade(mesh, segment, centre, turn, size, needles, areFolded, random,
        arrays.leaf_frequency[i], arrays.leaf_phase[i] + 6.28 * random(), shade);
    }
  }
  mesh.indices = mixed(mesh.indices, areFolded ? 6 : 3, random);
  return mesh;
}

/**
 * Groups of indices in a random order (Fisher and Yates).
 *
 * @param {number[]} indices
 * @param {number} size of a group
 * @param {() => number} random
 */
function mixed(indices, size, random) {
  const order = Int32Array.from({ length: indices.length / size }, (_, i) => i);
  for (let i = order.length - 1; i > 0; i--) {
    const j = Math.floor((i + 1) * random());
    [order[i], order[j]] = [order[j], order[i]];
  }
  return Array.from(order, (i) => indices.slice(i * size, (i + 1) * size)).flat();
}

/**
 * @param {Growing} mesh
 * @param {number} segment
 * @param {number[]} centre
 * @param {number[]} turn
 * @param {number} size of the cluster [m]
 * @param {boolean} needles
 * @param {boolean} isFolded
 * @param {() => number} random
 * @param {number} frequency
 * @param {number} phase
 * @param {number} shade
 */
function addBlade(mesh, segment, centre, turn, size, needles, isFolded, random, frequency, phase,
  shade) {
  const angle = 2 * Math.PI * random();
  const far = size * (needles ? 0.15 : 0.3) * Math.sqrt(random());
  const long = size * (needles ? 0.62 : 0.6) * (0.75 + 0.5 * random());
  const wide = long * (needles ? 0.09 : 0.27);
  const tilt = (needles ? 1.1 : 0.9) * (random() - 0.5) * 2;
  const droop = (needles ? 0.5 : 0.35) * (random() - 0.7);
  const along = [Math.cos(angle) * Math.cos(droop), Math.sin(angle) * Math.cos(droop), Math.sin(droop)];
  const flat = [-Math.sin(angle), Math.cos(angle), 0];
  const side = [flat[0] * Math.cos(tilt), flat[1] * Math.cos(tilt), Math.sin(tilt)];
  const normal = [
    along[1] * side[2] - along[2] * side[1],
    along[2] * side[0] - along[0] * side[2],
    along[0] * side[1] - along[1] * side[0],
  ];
  const base = [far * Math.cos(angle), far * Math.sin(angle), 0.3 * size * (random() - 0.5)];
  const first = mesh.count;
  const corners = !isFolded
    ? [[0.2, 1.1, 0.1], [1, 0, 0], [0.2, -1.1, 0.1]]
    : needles
    ? [[0, 0, 0], [0.5, 1, 0], [1, 0, 0], [0.5, -1, 0]]
    : [[0, 0, 0], [0.42, 1, 0.25], [1, 0, -0.12], [0.42, -1, 0.25]];
  for (const [u, v, lift] of corners) {
    const place = [0, 1, 2].map(
      (c) => base[c] + u * long * along[c] + v * wide * side[c] + lift * wide * normal[c],
    );
    const lean = needles ? 0 : 0.35 * v;
    mesh.add(segment, ...centre, ...turn, ...place,
      normal[0] - lean * side[0], normal[1] - lean * side[1], normal[2] - lean * side[2],
      frequency, phase, shade);
  }
  mesh.indices.push(first, first + 1, first + 2);
  if (isFolded) mesh.indices.push(first, first + 2, first + 3);
}

/**
 * The drawn segment that each segment moves with: itself, or what carries the branch left out.
 *
 * @param {Kind} kind
 * @param {Int32Array} branches
 */
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

/**
 * Quaternion product, w x y z.
 *
 * @param {number[]} a
 * @param {number[]} b
 */
function multiply(a, b) {
  return [
    a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
    a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
    a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
    a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
  ];
}

/**
 * A shape turned about the vertical from a profile of [radius, height], with colour per point.
 *
 * @param {[number, number, [number, number, number]][]} profile
 * @param {number} sides
 */
export function turnedMesh(profile, sides) {
  /** @type {number[]} */
  const values = [];
  /** @type {number[]} */
  const indices = [];
  profile.forEach(([r, z, color], i) => {
    const [r0, z0] = profile[Math.max(i - 1, 0)];
    const [r1, z1] = profile[Math.min(i + 1, profile.length - 1)];
    const size = Math.hypot(r1 - r0, z1 - z0) || 1;
    for (let k = 0; k < sides; k++) {
      const angle = (2 * Math.PI * k) / sides;
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      values.push(r * c, r * s, z, (c * (z1 - z0)) / size, (s * (z1 - z0)) / size, (r0 - r1) / size, ...color);
      if (i === 0) continue;
      const a = (i - 1) * sides + k;
      const b = (i - 1) * sides + ((k + 1) % sides);
      indices.push(a, b, a + sides, b, b + sides, a + sides);
    }
  });
  return { values, indices };
}
