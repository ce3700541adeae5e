// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The graphics unit: programs, vertex arrays, textures. */

/**
 * @typedef {object} Program
 * @property {WebGLProgram} program
 * @property {Record<string, (value: any) => void>} uniforms what sets each of them
 *
 * @typedef {object} Drawable
 * @property {WebGLVertexArrayObject} vao
 * @property {number} count of its indices
 * @property {number} copies of a tree in it
 * @property {WebGLBuffer[]} buffers
 */

/** @param {WebGLRenderingContext | WebGL2RenderingContext} gl */
export function isSoftware(gl) {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

/** @param {WebGL2RenderingContext} gl @param {string} vertex @param {string} fragment
 * @returns {Program} */
export function program(gl, vertex, fragment) {
  const made = /** @type {WebGLProgram} */ (gl.createProgram());
  for (const [kind, source] of /** @type {[number, string][]} */ ([
    [gl.VERTEX_SHADER, vertex],
    [gl.FRAGMENT_SHADER, fragment],
  ])) {
    const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) {
      throw new Error(String(gl.getShaderInfoLog(shader)));
    }
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) {
    throw new Error(String(gl.getProgramInfoLog(made)));
  }
  /** @type {Program["uniforms"]} */
  const uniforms = {};
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
      [gl.UNSIGNED_INT_VEC4]: (value) => gl.uniform4uiv(at, value),
      [gl.SAMPLER_2D]: ([unit, texture]) => {
        gl.activeTexture(gl.TEXTURE0 + unit);
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.uniform1i(at, unit);
      },
    };
    // An array has the name of its first element.
    uniforms[name.replace("[0]", "")] = setters[type];
  }
  return { program: made, uniforms };
}

/** Set what a program is given: numbers, vectors and matrices; of a texture, its unit and itself.
 * @param {WebGL2RenderingContext} gl @param {Program} used
 * @param {Record<string, any>} values those that it has not are left out */
export function use(gl, used, values) {
  gl.useProgram(used.program);
  for (const [name, value] of Object.entries(values)) used.uniforms[name]?.(value);
}

/** @param {WebGL2RenderingContext} gl @param {number} kind @param {ArrayBufferView} data */
export function filled(gl, kind, data) {
  const buffer = /** @type {WebGLBuffer} */ (gl.createBuffer());
  gl.bindBuffer(kind, buffer);
  gl.bufferData(kind, data, gl.STATIC_DRAW);
  return buffer;
}

/** A vertex array of its own.
 * @param {WebGL2RenderingContext} gl @param {Program} used
 * @param {ArrayLike<number>} values vertex after vertex
 * @param {[string, number][]} fields names and sizes of what a vertex has
 * @param {ArrayLike<number>} indices @returns {Drawable} */
export function drawable(gl, used, values, fields, indices) {
  const vao = /** @type {WebGLVertexArrayObject} */ (gl.createVertexArray());
  gl.bindVertexArray(vao);
  const buffer = filled(gl, gl.ARRAY_BUFFER, Float32Array.from(values));
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
  const corners = filled(gl, gl.ELEMENT_ARRAY_BUFFER, Uint32Array.from(indices));
  return { vao, count: indices.length, copies: 1, buffers: [buffer, corners] };
}

/** @param {WebGL2RenderingContext} gl @param {Drawable} part */
export function discard(gl, part) {
  for (const buffer of part.buffers) gl.deleteBuffer(buffer);
  gl.deleteVertexArray(part.vao);
}

/** @param {WebGL2RenderingContext} gl @param {Drawable} part
 * @param {number} [share] of its triangles */
export function drawPart(gl, part, share = 1) {
  gl.bindVertexArray(part.vao);
  gl.drawElements(gl.TRIANGLES, 3 * Math.round((share * part.count) / 3), gl.UNSIGNED_INT, 0);
}

/** A texture of a picture; where it has no smaller ones these are made.
 * @param {WebGL2RenderingContext} gl @param {import("./textures.js").Mips} mips
 * @param {number} wrap
 * @param {boolean} isPlain the nearest point alone is looked up, which costs less */
export function pictureTexture(gl, mips, wrap, isPlain) {
  const texture = /** @type {WebGLTexture} */ (gl.createTexture());
  gl.activeTexture(gl.TEXTURE2);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  mips.forEach(({ size, data }, level) => {
    gl.texImage2D(gl.TEXTURE_2D, level, gl.RGBA, size, size, 0, gl.RGBA, gl.UNSIGNED_BYTE, data);
  });
  if (mips.length === 1) gl.generateMipmap(gl.TEXTURE_2D);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrap);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrap);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER,
    isPlain ? gl.NEAREST_MIPMAP_NEAREST : gl.LINEAR_MIPMAP_LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, isPlain ? gl.NEAREST : gl.LINEAR);
  return texture;
}

/** What is drawn into a texture.
 * @param {WebGL2RenderingContext} gl @param {number} width @param {number} height
 * @param {number} format such as R8 @param {boolean} hasDepth */
export function canvasTexture(gl, width, height, format, hasDepth = false) {
  const texture = /** @type {WebGLTexture} */ (gl.createTexture());
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
    gl.texParameteri(gl.TEXTURE_2D, name, gl.LINEAR);
  }
  for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) {
    gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
  }
  const target = /** @type {WebGLFramebuffer} */ (gl.createFramebuffer());
  gl.bindFramebuffer(gl.FRAMEBUFFER, target);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  const depth = hasDepth ? gl.createRenderbuffer() : null;
  if (depth) {
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT16, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
  }
  const release = () => {
    gl.deleteFramebuffer(target);
    gl.deleteRenderbuffer(depth);
  };
  return { texture, target, width, height, release };
}
