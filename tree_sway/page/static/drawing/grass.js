// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Grass around the trees, which bends in the gusts that pass over it; a blade is a triangle. */

import { drawable, drawPart, use } from "./gl.js";
import { Gusts } from "./gusts.js";
import { seeded } from "./looks.js";

/** Number of blades with and without a graphics unit. */
const [BLADES, FEW_BLADES] = [140000, 2500];
/** Pixels of a picture that shows all blades. */
const FULL = 1e6;
/** Radius over the size of the scene, and height over that of the trees. */
const [REACH, TALL] = [3, 0.02];
/** Lowest and highest grass [m]. */
const [LOWEST, HIGHEST] = [0.12, 0.35];

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
      const [far, turn] = [random(), 2 * Math.PI * random()];
      const own = [far * Math.cos(turn), far * Math.sin(turn), (0.5 + random()) * (1 - far ** 4), random()];
      for (const corner of [-1, 1, 0]) mesh.indices.push(mesh.values.push(...own, corner) / 5 - 1);
    }
    this._part = drawable(gl, used, mesh);
  }

  /** Draw it; the uniforms of the scene are set. @param {Meadow} meadow */
  draw({ middle: [x, y], extent, height, first, way, mean, time }) {
    const reach = REACH * extent;
    const tall = Math.min(HIGHEST, Math.max(LOWEST, TALL * height));
    this.gusts.spread(time, mean, 2 * reach);
    const field = [x, y, reach, tall];
    use(this.gl, this._program, { field, downwind: [...way, first, 2 * reach], time: time % 1000, "gusts[0]": this.gusts.speeds });
    // Around a small tree blades are large in the picture, and fewer of them cover it; so do fewer of a small picture.
    const share = Math.min(1, ((TALL * height) / tall) ** 2, (this.gl.drawingBufferWidth * this.gl.drawingBufferHeight) / FULL);
    drawPart(this.gl, this._part, share);
  }
}
