// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Wrappers of WebGL: programs of shaders.glsl, vertex arrays, textures. */

import { textOf } from "../files.js";
import { PLACES } from "./gusts.js";
import { seeded } from "./looks.js";

/** Size of a picture below which it has no empty rim, which would be much of it [px]. */
const SMALLEST_RIM = 32;
/** Texels per row of the texture of poses. */
const TEXTURE_WIDTH = 1024;
/** Directions from which an impostor is painted: number around the tree, and elevations [rad]. */
export const ROUND = 8;
export const ELEVATIONS = [0.08, 0.5];

const HEAD = `#version 300 es
#define ROUND ${ROUND}
#define LOW ${ELEVATIONS[0]}
#define HIGH ${ELEVATIONS[1]}
#define PLACES ${PLACES}
`;

const parts = (await textOf("drawing/shaders.glsl")).split("\n#part ").slice(1).map((part) => {
  const [names, ...lines] = part.split("\n");
  const [name, base] = names.split(" ");
  return { name, base, text: lines.join("\n") };
});

/** Source of a part, after the parts that it builds on. @param {string | undefined} wanted @returns {string} */
function source(wanted) {
  const part = parts.find(({ name }) => name === wanted);
  return part ? source(part.base) + part.text : "";
}

/** WebGL context of a canvas, and whether the processor draws and may leave out. @param {HTMLCanvasElement} canvas
 * @param {boolean} isFine */
export function contextOf(canvas, isFine) {
  const probe = document.createElement("canvas").getContext("webgl2");
  const info = probe?.getExtension("WEBGL_debug_renderer_info");
  const name = info && probe?.getParameter(info.UNMASKED_RENDERER_WEBGL);
  const isSlow = !isFine && /swiftshader|llvmpipe|software|basic render/i.test(String(name));
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  const gl = canvas.getContext("webgl2", { antialias: !isSlow, alpha: false, powerPreference: "high-performance" });
  if (!gl) throw new Error("this browser has no WebGL 2");
  return { gl, isSlow };
}

/** Compile a program and find its inputs. @param {GL} gl @param {string} name of its part
 * @param {boolean} isPlain whether it leaves out what costs much without a graphics unit @returns {Program} */
export function program(gl, name, isPlain) {
  const made = gl.createProgram();
  for (const [kind, stage] of /** @type {const} */ ([[gl.VERTEX_SHADER, "vertex"], [gl.FRAGMENT_SHADER, "fragment"]])) {
    const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
    gl.shaderSource(shader, HEAD + (isPlain ? "#define PLAIN\n" : "") + source(`${name}.${stage}`));
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) {
    const logs = gl.getAttachedShaders(made)?.map((shader) => gl.getShaderInfoLog(shader));
    throw new Error([gl.getProgramInfoLog(made), ...logs ?? []].join(" "));
  }
  const inputs = source(`${name}.vertex`).matchAll(/^(?:layout.*)?in (?:float|vec(\d)) (\w+);/gm);
  const fields = Array.from(inputs, ([, size = 1, field]) => ({ size: Number(size), at: gl.getAttribLocation(made, field) }));
  const uniforms = /** @type {Program["uniforms"]} */ ({});
  for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); i++) {
    const { name, type, size } = /** @type {WebGLActiveInfo} */ (gl.getActiveUniform(made, i));
    const at = gl.getUniformLocation(made, name);
    /** @type {Program["uniforms"]} */
    const setters = {
      [gl.FLOAT]: (value) => (size > 1 ? gl.uniform1fv(at, value) : gl.uniform1f(at, value)),
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
    setters[gl.SAMPLER_2D_SHADOW] = setters[gl.SAMPLER_2D];
    uniforms[name] = setters[type];
  }
  return { program: made, fields, uniforms };
}

/** Use a program and set those of the uniforms that it has; a texture is a pair of its unit and itself.
 * @param {GL} gl @param {Program} used @param {Record<string, any>} values */
export function use(gl, used, values) {
  gl.useProgram(used.program);
  for (const [name, value] of Object.entries(values)) used.uniforms[name]?.(value);
}

/** Make a vertex array; each vertex has the inputs of the program in the order of their declaration. @param {GL} gl
 * @param {Program} used @param {Record<"values" | "indices", ArrayLike<number>>} mesh @returns {Drawable} */
export function drawable(gl, { fields }, { values, indices }) {
  const vao = gl.createVertexArray();
  gl.bindVertexArray(vao);
  const buffers = [Float32Array.from(values), Uint32Array.from(indices)].map((data, i) => {
    const buffer = gl.createBuffer();
    const kind = i ? gl.ELEMENT_ARRAY_BUFFER : gl.ARRAY_BUFFER;
    gl.bindBuffer(kind, buffer);
    gl.bufferData(kind, data, gl.STATIC_DRAW);
    return buffer;
  });
  const width = fields.reduce((sum, { size }) => sum + size, 0);
  let offset = 0;
  for (const { size, at } of fields) {
    if (at >= 0) {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 4 * width, 4 * offset);
    }
    offset += size;
  }
  return { vao, count: indices.length, buffers };
}

/** @param {GL} gl @param {Drawable | undefined} part */
export function discard(gl, part) {
  for (const buffer of part?.buffers ?? []) gl.deleteBuffer(buffer);
  gl.deleteVertexArray(part?.vao ?? null);
}

/** @param {GL} gl @param {Drawable} part @param {number} [share] of its triangles */
export function drawPart(gl, part, share = 1) {
  gl.bindVertexArray(part.vao);
  gl.drawElements(gl.TRIANGLES, 3 * Math.round((share * part.count) / 3), gl.UNSIGNED_INT, 0);
}

/** Make and bind a texture. @param {GL} gl @param {number} less filter where it is smaller @param {number} more larger */
export function textureOf(gl, less, more) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  for (const way of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, way, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, less);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, more);
  return texture;
}

/** Texture of a picture with premultiplied alpha, so that leaves have no rim of the background.
 * @param {GL} gl @param {HTMLCanvasElement} picture @param {boolean} isPlain read one point only
 * @param {boolean} [isTile] whether it repeats beyond its edges */
export function pictureTexture(gl, picture, isPlain, isTile = false) {
  gl.activeTexture(gl.TEXTURE2);
  const texture = isPlain ? textureOf(gl, gl.NEAREST_MIPMAP_NEAREST, gl.NEAREST)
    : textureOf(gl, gl.LINEAR_MIPMAP_LINEAR, gl.LINEAR);
  for (const way of isTile ? [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T] : []) gl.texParameteri(gl.TEXTURE_2D, way, gl.REPEAT);
  gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, true);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, picture);
  gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false); // poses are no colours
  gl.generateMipmap(gl.TEXTURE_2D);
  return texture;
}

/** Texture of leaves for drawing without a graphics unit: a point is drawn if its alpha is a quarter or more. The random
 * threshold of `leaf.fragment` is applied here, once for each size, and colours are not premultiplied. The rim is empty,
 * since cards reach beyond the picture.
 * @param {GL} gl @param {HTMLCanvasElement} picture, a square */
export function chosenTexture(gl, picture) {
  const random = seeded(5);
  gl.activeTexture(gl.TEXTURE2);
  const texture = textureOf(gl, gl.NEAREST_MIPMAP_NEAREST, gl.NEAREST);
  const context = /** @type {CanvasRenderingContext2D} */ (picture.getContext("2d"));
  let size = picture.width;
  const { data } = context.getImageData(0, 0, size, size);
  let points = new Float32Array(data.length);
  for (let i = 0; i < data.length; i += 4) {
    points[i + 3] = data[i + 3] / 255;
    for (let c = 0; c < 3; c++) points[i + c] = (points[i + 3] * data[i + c]) / 255;
  }
  for (let level = 0; size >= 1; level++) {
    const own = new Uint8Array(points.length);
    const share = Math.min(1, Math.max(0, 0.3 * (Math.log2(180 * Math.SQRT2 / size))));
    for (let i = 0; i < points.length; i += 4) {
      const alpha = points[i + 3];
      const least = 0.5 + share * (0.04 + 0.55 * random() - 0.5);
      for (let c = 0; c < 3; c++) own[i + c] = Math.round(255 * Math.min(1, points[i + c] / Math.max(alpha, 0.01)));
      const x = (i / 4) % size;
      const isRim = size > SMALLEST_RIM && (x === 0 || x === size - 1 || i < 4 * size || i >= 4 * size * (size - 1));
      own[i + 3] = isRim ? 0 : Math.round(255 * Math.min(1, (0.25 * alpha) / least));
    }
    gl.texImage2D(gl.TEXTURE_2D, level, gl.RGBA, size, size, 0, gl.RGBA, gl.UNSIGNED_BYTE, own);
    points = halved(points, size);
    size >>= 1;
  }
  return texture;
}

/** A square RGBA picture at half its size. @param {Float32Array} points
 * @param {number} size of it */
function halved(points, size) {
  const half = size >> 1;
  const row = 4 * size;
  const smaller = new Float32Array(4 * half * half);
  for (let i = 0; i < smaller.length; i++) {
    const [x, y] = [(i >> 2) % half, Math.floor((i >> 2) / half)];
    const at = 2 * y * row + 8 * x + (i & 3);
    smaller[i] = 0.25 * (points[at] + points[at + 4] + points[at + row] + points[at + row + 4]);
  }
  return smaller;
}

/** Rows of the texture of poses, two texels per segment. @param {number} segments */
const rowsOf = (segments) => Math.ceil((2 * segments) / TEXTURE_WIDTH);

/** Make an array for poses. @param {number} segments */
export const texelsOf = (segments) => new Float32Array(4 * TEXTURE_WIDTH * rowsOf(segments));

/** Upload poses. @param {GL} gl @param {WebGLTexture} texture
 * @param {Float32Array} texels @param {number} segments the first of them */
export function uploadPoses(gl, texture, texels, segments) {
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, TEXTURE_WIDTH, rowsOf(segments), 0, gl.RGBA, gl.FLOAT, texels);
}

/** Make a depth texture for a shadow map.
 * @param {GL} gl @param {number} size */
export function depthTexture(gl, size) {
  const texture = textureOf(gl, gl.LINEAR, gl.LINEAR);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, size, size);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL);
  return texture;
}

/** Make a texture to draw into. @param {GL} gl @param {number} width
 * @param {number} height @param {number} format such as R8 @param {boolean} hasDepth */
export function canvasTexture(gl, width, height, format, hasDepth = false) {
  const texture = textureOf(gl, gl.LINEAR, gl.LINEAR);
  gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
  const target = gl.createFramebuffer();
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
    gl.deleteTexture(texture);
  };
  return { texture, target, width, height, release };
}
