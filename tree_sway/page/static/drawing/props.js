// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** What is beside a tree: its pot, a person of 1.75 m for scale, the arrow of the wind. */

/**
 * @typedef {[number, number, number]} Vector
 * @typedef {{values: number[], indices: number[]}} Mesh of [place, normal, colour] per vertex
 */

/** A shape turned about the vertical from a profile of [radius, height, colour].
 * @param {[number, number, Vector][]} profile @param {number} sides @param {Vector} [middle]
 * @param {number} [flat] depth over width @returns {Mesh} */
function turned(profile, sides, middle = [0, 0, 0], flat = 1) {
  /** @type {Mesh} */
  const { values, indices } = { values: [], indices: [] };
  profile.forEach(([r, z, color], i) => {
    const [r0, z0] = profile[Math.max(i - 1, 0)];
    const [r1, z1] = profile[Math.min(i + 1, profile.length - 1)];
    const size = Math.hypot(r1 - r0, z1 - z0) || 1;
    for (let k = 0; k < sides; k++) {
      const angle = (2 * Math.PI * k) / sides;
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      values.push(middle[0] + r * c, middle[1] + flat * r * s, middle[2] + z,
        (c * (z1 - z0)) / size, (s * (z1 - z0)) / size, (r0 - r1) / size, ...color);
      if (i === 0) continue;
      const a = (i - 1) * sides + k;
      const b = (i - 1) * sides + ((k + 1) % sides);
      indices.push(a, b, a + sides, b, b + sides, a + sides);
    }
  });
  return { values, indices };
}

/** @param {Mesh[]} parts @returns {Mesh} */
function joined(parts) {
  /** @type {Mesh} */
  const whole = { values: [], indices: [] };
  for (const { values, indices } of parts) {
    const first = whole.values.length / 9;
    for (const value of values) whole.values.push(value);
    for (const index of indices) whole.indices.push(first + index);
  }
  return whole;
}

/** A pot of height 1 below the root. */
export function potMesh() {
  /** @type {Vector} */
  const clay = [0.71, 0.41, 0.29];
  /** @type {Vector} */
  const rim = [0.78, 0.48, 0.35];
  /** @type {Vector} */
  const soil = [0.24, 0.18, 0.14];
  return turned(
    [
      [0, -1, clay], [0.5, -1, clay], [0.52, -0.98, clay], [0.66, -0.2, clay],
      [0.74, -0.2, rim], [0.77, -0.17, rim], [0.77, 0.07, rim], [0.74, 0.09, rim],
      [0.7, 0.09, rim], [0.68, 0.06, rim], [0.67, 0.0, soil], [0.35, 0.025, soil], [0, 0.03, soil],
    ],
    36,
  );
}

/** Somebody 1.75 m tall, in metres. */
export function personMesh() {
  /** @type {Vector} */
  const coat = [0.3, 0.37, 0.46];
  /** @type {Vector} */
  const trousers = [0.24, 0.23, 0.25];
  /** @type {Vector} */
  const skin = [0.74, 0.56, 0.45];
  /** @type {Vector} */
  const hair = [0.25, 0.19, 0.15];
  /** @type {Mesh[]} */
  const parts = [];
  for (const side of [-1, 1]) {
    parts.push(turned([[0.05, 0, hair], [0.055, 0.05, hair], [0.05, 0.1, trousers],
      [0.06, 0.45, trousers], [0.085, 0.85, trousers], [0, 0.9, trousers]], 8, [0, 0.09 * side, 0]));
    parts.push(turned([[0, 0.7, skin], [0.035, 0.73, skin], [0.032, 0.8, coat], [0.045, 1.1, coat],
      [0.055, 1.38, coat], [0, 1.44, coat]], 8, [0, 0.235 * side, 0]));
  }
  parts.push(turned([[0, 0.82, coat], [0.13, 0.84, coat], [0.125, 1.0, coat], [0.15, 1.25, coat],
    [0.16, 1.38, coat], [0.1, 1.46, coat], [0.055, 1.48, skin], [0.055, 1.53, skin]], 12, [0, 0, 0], 1.25));
  parts.push(turned([[0, 1.5, skin], [0.07, 1.55, skin], [0.09, 1.63, skin], [0.085, 1.7, hair],
    [0.05, 1.74, hair], [0, 1.75, hair]], 12));
  return joined(parts);
}

/** Length of the wind's arrow: never more than a sixth of the tree. @param {number} height @param {number} speed */
export const arrowLength = (height, speed) => 0.16 * height * Math.tanh(speed / 7);

/** An arrow of length 1 along x, lying flat. */
export function arrowMesh() {
  const blue = [0.16, 0.34, 0.52];
  /** @type {number[]} */
  const values = [];
  for (const [x, y] of [[0, 0.045], [0, -0.045], [0.66, -0.045], [0.66, 0.045], [0.62, 0.17],
    [0.62, -0.17], [1, 0]]) {
    values.push(x, y, 0, 0, 0, 1, ...blue);
  }
  return { values, indices: [0, 1, 2, 0, 2, 3, 4, 5, 6] };
}
