// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/**
 * Sky, hills, haze and ground. They are painted when the camera moves and copied when it does not:
 * their pixels are many, and may cost something.
 */

import { canvasTexture, drawable, drawPart, program, use } from "./gl.js";

/**
 * @typedef {object} Daylight
 * @property {number[]} light towards the sun
 * @property {number[]} sun colour of its light
 * @property {number[]} sky colour of the light of the sky
 * @property {number[]} zenith
 * @property {number[]} horizon
 * @property {number} dimmed brightness of the ground
 */

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

const VERTEX = `#version 300 es
precision highp float;
layout(location = 0) in vec2 corner;
uniform vec3 right;
uniform vec3 up;
uniform vec3 back;
out vec3 ray;
void main() {
  ray = corner.x * right + corner.y * up - back;
  gl_Position = vec4(corner, 0.99999, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec3 ray;
uniform vec3 eye;
uniform float ground;
uniform float haze;
uniform float kind;
uniform vec3 light;
uniform vec3 sun;
uniform vec3 zenith;
uniform vec3 horizon;
uniform float dimmed;
out vec4 color;
float hash(vec2 p) {
  uvec2 q = uvec2(ivec2(p)) * uvec2(1597334673u, 3812015801u);
  uint n = (q.x ^ q.y) * 1597334673u;
  return float(n >> 8) / 16777216.0;
}
float noise(vec2 p) {
  vec2 i = floor(p);
  vec2 f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(hash(i), hash(i + vec2(1, 0)), f.x),
    mix(hash(i + vec2(0, 1)), hash(i + vec2(1, 1)), f.x), f.y);
}
// Noise of a cell size [m], that vanishes where a pixel is larger.
float grain(vec2 p, float size, float pixel) {
  float shown = 1.0 - smoothstep(0.25, 0.8, pixel / size);
  return shown > 0.0 ? shown * (noise(p / size) - 0.5) : 0.0;
}
vec3 heaven(vec3 way) {
  float high = max(way.z, 0.0);
  vec3 c = mix(horizon, zenith, 1.0 - exp(-3.2 * high));
  vec2 at = way.xy / (high + 0.16);
  float cloud = noise(1.7 * at) + 0.5 * noise(3.6 * at + 7.0) + 0.25 * noise(7.5 * at);
  c = mix(c, horizon * 1.05, 0.42 * smoothstep(0.85, 1.45, cloud) * smoothstep(0.0, 0.25, high));
  float glow = max(dot(way, light), 0.0);
  c += sun * (0.1 * pow(glow, 6.0) + 0.16 * pow(glow, 60.0)) * dimmed;
  if (kind > 0.5) {
    // Hills, the nearer ones darker.
    float turn = 3.0 * atan(way.y, way.x);
    float far = 0.028 + 0.03 * noise(vec2(turn * 1.3 + 40.0, 3.0)) + 0.006 * noise(vec2(turn * 9.0, 1.0));
    float near = 0.008 + 0.024 * noise(vec2(turn * 2.1 + 9.0, 8.0)) + 0.008 * noise(vec2(turn * 22.0, 5.0));
    vec3 blue = mix(zenith, vec3(0.3, 0.4, 0.36) * dimmed, 0.5);
    if (way.z < far) c = mix(horizon, blue, 0.28);
    if (way.z < near) c = mix(horizon, blue, 0.5 * smoothstep(-0.004, near, way.z) + 0.06);
  }
  return c;
}
void main() {
  vec3 way = normalize(ray);
  vec3 c = heaven(way);
  if (way.z < -1e-4) {
    float far = (ground - eye.z) / way.z;
    vec2 p = eye.xy + far * way.xy;
    float pixel = far * length(fwidth(ray)) / max(-way.z, 0.05) * 0.5;
    vec3 soil;
    if (kind < 0.5) {
      vec2 slab = p / 0.6;
      slab.x += 0.5 * mod(floor(slab.y), 2.0);
      vec2 edge = abs(fract(slab) - 0.5);
      float joint = smoothstep(0.485, 0.495, max(edge.x, edge.y)) * (1.0 - smoothstep(0.1, 0.5, pixel / 0.12));
      soil = vec3(0.7, 0.68, 0.64) * (1.0 + 0.09 * (hash(floor(slab)) - 0.5));
      soil *= 1.0 + 0.1 * grain(p, 0.35, pixel) + 0.12 * grain(p, 0.03, pixel) + 0.16 * grain(p, 0.006, pixel);
      soil *= 1.0 - 0.26 * joint;
    } else {
      vec3 lush = vec3(0.4, 0.47, 0.24);
      vec3 dry = vec3(0.54, 0.53, 0.31);
      float patch_ = 0.5 + 0.5 * grain(p, 14.0, pixel) + 0.45 * grain(p, 3.1, pixel) + 0.3 * grain(p, 0.7, pixel);
      soil = mix(lush, dry, clamp(patch_, 0.0, 1.0));
      soil *= 1.0 + 0.42 * grain(p, 0.22, pixel) + 0.5 * grain(p * vec2(1.0, 0.6), 0.06, pixel)
        + 0.24 * grain(p, 60.0, pixel);
    }
    soil *= dimmed * (0.4 + 0.6 * max(light.z, 0.3) / 0.83) * mix(vec3(1.0), sun / 0.8, 0.35 * dimmed);
    c = mix(horizon, soil, exp(-haze * far));
  }
  color = vec4(c, 1.0);
}`;

const COPY_VERTEX = `#version 300 es
layout(location = 0) in vec2 corner;
void main() { gl_Position = vec4(corner, 0.99999, 1.0); }`;

const COPY_FRAGMENT = `#version 300 es
precision mediump float;
uniform sampler2D picture;
out vec4 color;
void main() { color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }`;

export class Backdrop {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this._program = program(gl, VERTEX, FRAGMENT);
    this._copy = program(gl, COPY_VERTEX, COPY_FRAGMENT);
    this._whole = drawable(gl, this._program, [-1, -1, 3, -1, -1, 3], [["corner", 2]], [0, 1, 2]);
    /** @type {ReturnType<typeof canvasTexture> | null} */
    this._kept = null;
    this._paintedFor = "";
  }

  /** @param {import("./camera.js").Camera} camera @param {Daylight} day
   * @param {{kind: number, height: number, haze: number}} ground @param {number} width [px]
   * @param {number} height */
  draw(camera, day, ground, width, height) {
    const { gl } = this;
    gl.disable(gl.DEPTH_TEST);
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
    gl.enable(gl.DEPTH_TEST);
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
