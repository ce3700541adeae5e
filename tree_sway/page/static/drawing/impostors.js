// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Far trees: each kind is painted once from all sides, then drawn as pictures that lean. */

import { canvasTexture, discard, drawable, use } from "./gl.js";
import { ELEVATIONS, ROUND } from "./shaders.js";

const TILE = 128;
/** Rows of a picture that bends. */
const ROWS = 4;
/** Numbers per corner. */
const PER_CORNER = 9;

/**
 * @typedef {object} Box of a kind
 * @property {number} wide half its width [m]
 * @property {number} middle its height over the root [m]
 * @property {number} tall [m]
 */

export class Impostor {
  /** @param {WebGL2RenderingContext} gl @param {import("./gl.js").Program} used @param {Box} box
   * @param {number[]} tip the highest node at rest @param {number} most how many trees
   * @param {boolean} isPlain the nearest point alone is looked up, which costs less */
  constructor(gl, used, box, tip, most, isPlain) {
    this.gl = gl;
    this.box = box;
    this.tip = tip;
    this.count = 0;
    this._atlas = canvasTexture(gl, ROUND * TILE, ELEVATIONS.length * TILE, gl.RGBA8, true);
    if (isPlain) gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    this._values = new Float32Array(PER_CORNER * 2 * ROWS * most);
    const indices = new Uint32Array(6 * (ROWS - 1) * most);
    for (let i = 0; i < (ROWS - 1) * most; i++) {
      const a = 2 * (i + Math.floor(i / (ROWS - 1)));
      indices.set([a, a + 1, a + 2, a + 1, a + 3, a + 2], 6 * i);
    }
    // Not as instances: without a graphics unit each of them costs as much as a whole picture.
    this._part = drawable(gl, used, this._values, [["corner", 2], ["stand", 4], ["tree", 3]], indices);
  }

  /** Paint the kind from every side.
   * @param {(camera: Float32Array, eye: number[]) => void} paint
   * @param {number[]} color of its leaves, which the cut edges have */
  bake(paint, color) {
    const { gl } = this;
    const { wide, middle, tall } = this.box;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this._atlas.target);
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(0.6 * color[0], 0.6 * color[1], 0.6 * color[2], 0);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    ELEVATIONS.forEach((elevation, row) => {
      const [ce, se] = [Math.cos(elevation), Math.sin(elevation)];
      const high = 0.5 * tall * ce + wide * se;
      const deep = wide + tall;
      for (let side = 0; side < ROUND; side++) {
        const turn = (2 * Math.PI * side) / ROUND;
        const [c, s] = [Math.cos(turn), Math.sin(turn)];
        const axes = [[-s / wide, c / wide, 0], [(-se * c) / high, (-se * s) / high, ce / high],
          [(-ce * c) / deep, (-ce * s) / deep, -se / deep]];
        const m = new Float32Array(16);
        axes.forEach((axis, r) => {
          for (let k = 0; k < 3; k++) m[4 * k + r] = axis[k];
          m[12 + r] = -axis[2] * middle;
        });
        m[15] = 1;
        gl.viewport(side * TILE, row * TILE, TILE, TILE);
        paint(m, [100 * deep * ce * c, 100 * deep * ce * s, middle + 100 * deep * se]);
      }
    });
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this._atlas.release();
  }

  /** Forget which trees are drawn. */
  clear() {
    this.count = 0;
  }

  /** Draw a tree, too.
   * @param {number[]} place x, y, z, turn, scale @param {number} row of its highest node
   * @param {number} number among all trees */
  add(place, row, number) {
    const tint = 0.86 + 0.28 * ((number * 0.618034) % 1);
    const [x, y, z, yaw, scale] = place;
    let at = PER_CORNER * 2 * ROWS * this.count++;
    for (let i = 0; i < 2 * ROWS; i++, at += PER_CORNER) {
      const high = (2 * Math.floor(i / 2)) / (ROWS - 1) - 1;
      this._values.set([i % 2 ? 1 : -1, high, x, y, z, yaw, scale, row, tint], at);
    }
  }

  /** Hand the trees to the graphics unit. */
  upload() {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this._part.buffers[0]);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, this._values, 0, PER_CORNER * 2 * ROWS * this.count);
  }

  /** @param {import("./gl.js").Program} used
   * @param {number} shade of the foot of a tree among others */
  draw(used, shade) {
    const { gl, box, tip } = this;
    const picture = [2, this._atlas.texture];
    use(gl, used, { picture, box: [box.wide, box.middle, box.tall, shade], restTip: tip });
    gl.bindVertexArray(this._part.vao);
    gl.drawElements(gl.TRIANGLES, 6 * (ROWS - 1) * this.count, gl.UNSIGNED_INT, 0);
  }

  /** Give its memory back. */
  free() {
    const { gl } = this;
    gl.deleteTexture(this._atlas.texture);
    discard(gl, this._part);
  }
}
