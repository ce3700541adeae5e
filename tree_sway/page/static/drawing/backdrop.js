// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/**
 * Sky, hills, haze and ground. They are painted when the camera moves and copied when it does not:
 * their pixels are many, and may cost something.
 */

import { textOf } from "../files.js";
import { canvasTexture, drawable, drawPart, use } from "./gl.js";
import { shaded } from "./shaders.js";

/** Times of day. @type {Record<"light" | "evening" | "dark", Daylight>} */
export const DAYLIGHT = JSON.parse(await textOf("drawing/daylight.json"));

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
