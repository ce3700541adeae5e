// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Grass about trees, that bends with the gusts that come over it: a triangle a blade. */

import { discard, drawable, drawPart, use } from "./gl.js";
import { Gusts } from "./gusts.js";
import { seeded } from "./looks.js";

/** Blades with and without a graphics unit. */
const [BLADES, FEW_BLADES] = [26000, 2500];
/** How far it grows over the size of the scene, and its height over that of the trees. */
const [REACH, TALL] = [2, 0.03];
/** Lowest and highest grass [m]. */
const [LOWEST, HIGHEST] = [0.12, 0.6];

export class Grass {
  /** @param {GL} gl @param {Program} used @param {boolean} isFew */
  constructor(gl, used, isFew) {
    this.gl = gl;
    this._program = used;
    this.gusts = new Gusts();
    const random = seeded(7);
    /** @type {Mesh} */
    const mesh = { values: [], indices: [] };
    for (let i = 0; i < (isFew ? FEW_BLADES : BLADES); i++) {
      const [far, turn] = [Math.sqrt(random()), 2 * Math.PI * random()];
      const own = [far * Math.cos(turn), far * Math.sin(turn), (0.5 + random()) * (1 - far ** 4), random()];
      for (const corner of [-1, 1, 0]) mesh.indices.push(mesh.values.push(...own, corner) / 5 - 1);
    }
    this._part = drawable(gl, used, mesh);
  }

  /** Draw it, by a program that has the values of the scene. @param {Meadow} meadow */
  draw({ middle: [x, y], extent, height, first, way, mean, time }) {
    const reach = REACH * extent;
    const tall = Math.min(HIGHEST, Math.max(LOWEST, TALL * height));
    this.gusts.spread(time, mean, 2 * reach);
    const field = [x, y, reach, tall];
    use(this.gl, this._program, { field, downwind: [...way, first, 2 * reach], time: time % 1000, "gusts[0]": this.gusts.speeds });
    // About a small tree blades are large in the picture: fewer of them cover as much of it.
    const share = Math.min(1, ((TALL * height) / tall) ** 2);
    drawPart(this.gl, this._part, share);
  }

  free() {
    discard(this.gl, this._part);
  }
}
