// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/**
 * Sky, hills, haze and ground. They are painted when the camera moves and copied when it does not:
 * their pixels are many, and may cost something.
 */

import { canvasTexture, drawable, drawPart, use } from "./gl.js";
import { shaded } from "./shaders.js";

/** @type {Record<"light" | "evening" | "dark", Daylight>} */
export const DAYLIGHT = {
  light: {
    light: [0.45, -0.5, 0.95], sun: [0.86, 0.81, 0.7], sky: [0.62, 0.68, 0.74],
    zenith: [0.42, 0.6, 0.8], horizon: [0.85, 0.89, 0.91], dimmed: 1,
  },
  evening: {
    light: [0.85, -0.5, 0.42], sun: [1.0, 0.68, 0.38], sky: [0.5, 0.52, 0.62],
    zenith: [0.34, 0.42, 0.6], horizon: [0.95, 0.78, 0.62], dimmed: 0.95,
  },
  dark: {
    light: [0.45, -0.5, 0.95], sun: [0.4, 0.46, 0.56], sky: [0.3, 0.35, 0.43],
    zenith: [0.045, 0.06, 0.09], horizon: [0.13, 0.165, 0.2], dimmed: 0.36,
  },
};

/** What lies under a scene. */
export const GROUNDS = { terrace: 0, meadow: 1 };

export class Backdrop {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this._program = shaded(gl, "backdrop");
    this._copy = shaded(gl, "copy");
    this._whole = drawable(gl, this._program, [-1, -1, 3, -1, -1, 3], [["corner", 2]], [0, 1, 2]);
    /** @type {ReturnType<typeof canvasTexture> | null} */
    this._kept = null;
    this._paintedFor = "";
  }

  /** @param {import("./camera.js").Camera} camera @param {Daylight} day
   * @param {{kind: number, height: number, haze: number}} ground @param {number} width [px]; 0 paints
   * at once, for a camera that is never still @param {number} height */
  draw(camera, day, ground, width, height) {
    const { gl } = this;
    gl.disable(gl.DEPTH_TEST);
    if (!width) return this._paint(camera, day, ground);
    const wanted = [...camera.matrix, day.zenith, ground.kind, ground.height, width, height].join();
    if (this._paintedFor !== wanted) {
      this._paintedFor = wanted;
      this._keep(width, height);
      this._paint(camera, day, ground);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }
    if (this._kept) {
      use(gl, this._copy, { picture: [2, this._kept.texture] });
      drawPart(gl, this._whole);
    }
  }

  /** Paint into a texture of the size of the picture.
   * @param {number} width @param {number} height */
  _keep(width, height) {
    const { gl } = this;
    if (this._kept?.width !== width || this._kept.height !== height) {
      this._kept?.release();
      if (this._kept) gl.deleteTexture(this._kept.texture);
      this._kept = canvasTexture(gl, width, height, gl.RGBA8);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, this._kept.target);
  }

  /** @param {import("./camera.js").Camera} camera @param {Daylight} day
   * @param {{kind: number, height: number, haze: number}} ground */
  _paint(camera, day, ground) {
    const { gl } = this;
    const size = Math.hypot(...day.light);
    const { height, haze, kind } = ground;
    use(gl, this._program, {
      ...day, ...camera.axes(), eye: camera.eye, ground: height, haze, kind,
      light: day.light.map((l) => l / size),
    });
    drawPart(gl, this._whole);
  }
}
