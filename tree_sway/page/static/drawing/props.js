// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Things beside a tree: its pot, a person of 1.75 m for scale, the arrow of the wind. */

import { textOf } from "../files.js";

/** @type {{colours: Record<string, number[]>, arrow: Mesh, pot: Turned[], person: Turned[]}} */
export const { arrow, colours, ...PROPS } = JSON.parse(await textOf("drawing/props.json"));

/** Mesh of a pot of height 1 below the root, or of a person 1.75 m tall. @param {"pot" | "person"} name */
export function propMesh(name) {
  /** @type {Mesh} */
  const { values, indices } = { values: [], indices: [] };
  for (const { sides, middles, wide = 1, profile } of PROPS[name]) {
    for (const middle of middles) {
      profile.forEach(([r, z, color], i) => {
        const [r0, z0] = profile[Math.max(i - 1, 0)];
        const [r1, z1] = profile[Math.min(i + 1, profile.length - 1)];
        const first = values.length / 9;
        for (let k = 0; k < sides; k++) {
          const [c, s] = [Math.cos, Math.sin].map((of) => of((2 * Math.PI * k) / sides));
          const facing = [c * (z1 - z0), s * (z1 - z0), r0 - r1];
          values.push(r * c, middle + wide * r * s, z, ...facing, ...colours[color]);
          const a = first + k - sides, b = first + ((k + 1) % sides) - sides;
          if (i > 0) indices.push(a, b, a + sides, b, b + sides, a + sides);
        }
      });
    }
  }
  return { values, indices };
}

/** Length of the wind's arrow, at most a quarter of the tree. @param {number} height @param {number} speed */
export const arrowLength = (height, speed) => 0.24 * height * Math.tanh(speed / 7);
