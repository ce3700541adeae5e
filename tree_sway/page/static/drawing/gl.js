// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The graphics unit: programs, vertex arrays, textures. */

/** A context of a canvas, and whether it draws on the processor. @param {HTMLCanvasElement} canvas */
export function contextOf(canvas) {
  const probe = document.createElement("canvas").getContext("webgl2");
  const info = probe?.getExtension("WEBGL_debug_renderer_info");
  const name = info && probe?.getParameter(info.UNMASKED_RENDERER_WEBGL);
  const isSoftware = /swiftshader|llvmpipe|software|basic render/i.test(String(name));
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  const gl = canvas.getContext("webgl2", { antialias: !isSoftware, alpha: false, powerPreference: "high-performance" });
  if (!gl) throw new Error("this browser has no WebGL 2");
  return { gl, isSoftware };
}

/** @param {WebGL2RenderingContext} gl @param {string} vertex @param {string} fragment @returns {Program} */
export function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const source of [vertex, fragment]) {
    const kind = source === vertex ? gl.VERTEX_SHADER : gl.FRAGMENT_SHADER;
    const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(String(gl.getShaderInfoLog(shader)));
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(String(gl.getProgramInfoLog(made)));
  const uniforms = /** @type {Program["uniforms"]} */ ({});
  for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); i++) {
    const { name, type } = /** @type {WebGLActiveInfo} */ (gl.getActiveUniform(made, i));
    const at = gl.getUniformLocation(made, name);
    /** @type {Program["uniforms"]} */
    const setters = {
      [gl.FLOAT]: (value) => gl.uniform1f(at, value),
      [gl.FLOAT_VEC2]: (value) => gl.uniform2fv(at, value),
      [gl.FLOAT_VEC3]: (value) => gl.uniform3fv(at, value),
      [gl.FLOAT_VEC4]: (value) => gl.uniform4fv(at, value),
      [gl.FLOAT_MAT4]: (value) => gl.uniformMatrix4fv(at, false, value),
      [gl.SAMPLER_2D]: ([unit, texture]) => {
        gl.activeTexture(gl.TEXTURE0 + unit);
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.uniform1i(at, unit);
      },
    };
    uniforms[name] = setters[type];
  }
  return { program: made, uniforms };
}

/** Set what a program is given: numbers, vectors and matrices; of a texture, its unit and itself.
 * @param {WebGL2RenderingContext} gl @param {Program} used @param {Record<string, any>} values those that
 * it has not are left out */
export function use(gl, used, values) {
  gl.useProgram(used.program);
  for (const [name, value] of Object.entries(values)) used.uniforms[name]?.(value);
}

/** A vertex array of its own. @param {WebGL2RenderingContext} gl @param {Program} used
 * @param {ArrayLike<number>} values vertex after vertex @param {[string, number][]} fields names and sizes
 * of what a vertex has @param {ArrayLike<number>} indices @returns {Drawable} */
export function drawable(gl, used, values, fields, indices) {
  const vao = gl.createVertexArray();
  gl.bindVertexArray(vao);
  const buffers = [Float32Array.from(values), Uint32Array.from(indices)].map((data, i) => {
    const buffer = gl.createBuffer();
    const kind = i ? gl.ELEMENT_ARRAY_BUFFER : gl.ARRAY_BUFFER;
    gl.bindBuffer(kind, buffer);
    gl.bufferData(kind, data, gl.STATIC_DRAW);
    return buffer;
  });
  const width = fields.reduce((sum, [, size]) => sum + size, 0);
  let offset = 0;
  for (const [name, size] of fields) {
    const at = gl.getAttribLocation(used.program, name);
    if (at >= 0) {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 4 * width, 4 * offset);
    }
    offset += size;
  }
  return { vao, count: indices.length, buffers };
}

/** @param {WebGL2RenderingContext} gl @param {Drawable} part */
export function discard(gl, part) {
  for (const buffer of part.buffers) gl.deleteBuffer(buffer);
  gl.deleteVertexArray(part.vao);
}

/** @param {WebGL2RenderingContext} gl @param {Drawable} part @param {number} [share] of its triangles */
export function drawPart(gl, part, share = 1) {
  gl.bindVertexArray(part.vao);
  gl.drawElements(gl.TRIANGLES, 3 * Math.round((share * part.count) / 3), gl.UNSIGNED_INT, 0);
}

/** @param {WebGL2RenderingContext} gl @param {number} wrap @param {number} less filter where it is smaller
 * @param {number} more where it is larger */
function sample(gl, wrap, less, more) {
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrap);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrap);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, less);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, more);
}

/** A texture of a picture; where it has no smaller ones these are made. @param {WebGL2RenderingContext} gl
 * @param {ImageData[]} mips from the finest @param {number} wrap @param {boolean} isPlain the nearest
 * point alone is looked up, which costs less */
export function pictureTexture(gl, mips, wrap, isPlain) {
  const texture = gl.createTexture();
  gl.activeTexture(gl.TEXTURE2);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  mips.forEach((mip, level) => gl.texImage2D(gl.TEXTURE_2D, level, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, mip));
  if (mips.length === 1) gl.generateMipmap(gl.TEXTURE_2D);
  if (isPlain) sample(gl, wrap, gl.NEAREST_MIPMAP_NEAREST, gl.NEAREST);
  else sample(gl, wrap, gl.LINEAR_MIPMAP_LINEAR, gl.LINEAR);
  return texture;
}

/** A texture that poses lie in. @param {WebGL2RenderingContext} gl @param {WebGLTexture} texture
 * @param {number} width @param {Float32Array} texels */
export function poseTexture(gl, texture, width, texels) {
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  sample(gl, gl.CLAMP_TO_EDGE, gl.NEAREST, gl.NEAREST);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, texels.length / 4 / width, 0, gl.RGBA, gl.FLOAT, texels);
}

/** What is drawn into a texture. @param {WebGL2RenderingContext} gl @param {number} width
 * @param {number} height @param {number} format such as R8 @param {boolean} hasDepth */
export function canvasTexture(gl, width, height, format, hasDepth = false) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
  sample(gl, gl.CLAMP_TO_EDGE, gl.LINEAR, gl.LINEAR);
  const target = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, target);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  const depth = hasDepth ? gl.createRenderbuffer() : null;
  if (depth) {
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT16, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
  }
  const release = (isWhole = false) => {
    gl.deleteFramebuffer(target);
    gl.deleteRenderbuffer(depth);
    if (isWhole) gl.deleteTexture(texture);
  };
  return { texture, target, width, height, release };
}
