// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Sky, hills, haze and ground. They are painted when the camera moves and copied otherwise, which costs less. */

import { textOf } from "../files.js";
import { canvasTexture, drawable, drawPart, program, use } from "./gl.js";

/** Times of day. @type {Record<"light" | "evening" | "dark", Daylight>} */
export const DAYLIGHT = JSON.parse(await textOf("drawing/daylight.json"));

export class Backdrop {
  /** @param {GL} gl @param {boolean} isPlain whether to keep the shadow too, as every pixel costs much */
  constructor(gl, isPlain) {
    this.gl = gl;
    this._program = program(gl, "backdrop", isPlain);
    this._copying = program(gl, "copy", isPlain);
    this._whole = drawable(gl, this._program, { values: [-1, -1, 3, -1, -1, 3], indices: [0, 1, 2] });
    this._isPlain = isPlain;
    /** Pictures without and with the shadow. */
    this._pictures = /** @type {ReturnType<typeof canvasTexture>[]} */ ([]);
    this._paintedFor = "";
  }

  /** Paint into the bound target. @param {Camera} camera @param {Daylight} day @param {Ground} under */
  paint(camera, day, under) {
    this.gl.disable(this.gl.DEPTH_TEST);
    use(this.gl, this._program, { ...day, ...camera.axes(), ...under, eye: camera.eye });
    drawPart(this.gl, this._whole);
  }

  /** Show it on the canvas. @param {Camera} camera @param {Daylight} day @param {Ground} under
   * @param {() => void} drawShadow on the ground @param {boolean} isNew whether the shadow has changed */
  show(camera, day, under, drawShadow, isNew) {
    const { gl } = this;
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    gl.disable(gl.DEPTH_TEST);
    const wanted = [...camera.matrix, day.zenith, under.kind, under.ground, width, height].join();
    const isOther = this._paintedFor !== wanted;
    if (isOther) {
      this._paintedFor = wanted;
      if (this._pictures[0]?.width !== width || this._pictures[0].height !== height) {
        for (const each of this._pictures) each.release();
        this._pictures = [0, 1].map(() => canvasTexture(gl, width, height, gl.RGBA8));
      }
      gl.bindFramebuffer(gl.FRAMEBUFFER, this._pictures[0].target);
      this.paint(camera, day, under);
    }
    const [bare, shaded] = this._pictures;
    if (this._isPlain && (isOther || isNew)) {
      this._copy(bare, shaded.target);
      drawShadow();
    }
    this._copy(this._isPlain ? shaded : bare, null);
    if (!this._isPlain) drawShadow();
  }

  /** @param {ReturnType<typeof canvasTexture>} picture @param {WebGLFramebuffer | null} to bound then */
  _copy({ texture }, to) {
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, to);
    use(this.gl, this._copying, { picture: [2, texture] });
    drawPart(this.gl, this._whole);
  }
}
