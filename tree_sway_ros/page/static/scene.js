// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Draws a described tree from its poses: bark, leaves, pot, ground, shadow and the wind. */

import { Camera } from "./camera.js";
import { Detail, levelsOf } from "./detail.js";
import {
  barkMesh,
  boxOf,
  branchOrder,
  highestOf,
  isPotted,
  leafMesh,
  turnedMesh,
} from "./mesh.js";
import { KindPlacer, STRIDE } from "./placing.js";
import * as shaders from "./shaders.js";

/** A shadow is drawn anew every so many frames without a graphics unit, of a crowd less often. */
const SHADOW_EVERY = 5;
const CROWD = 50;
/** Frames per second below which, without a graphics unit, fewer points are drawn. */
const WANTED_FPS = 55;
/** Points per point of the page, and share of the leaves, that are drawn at least. */
const COARSEST = 0.7;
const THINNEST = 0.3;
/** Segments of all trees that are drawn at most, and leaves of one; without a graphics unit less. */
const MOST = { segments: 40000, leaves: 24000 };
const MOST_SLOW = { segments: 12000, leaves: 4500 };
/** Frames per second below which fewer segments are drawn, down to so many. */
const LEAST_FPS = 20;
const FEWEST_SEGMENTS = 3000;
/** What of each tree is drawn is chosen anew every so many frames while the camera moves. */
const CHOOSE_EVERY = 6;
const POT_HEIGHT = 0.17;
/** Vertices of the trees that are drawn in one go, at most. */
const BATCH = 6000;

/**
 * @typedef {object} Look
 * @property {number[]} back
 * @property {number[]} ground
 *
 * @typedef {object} Drawable
 * @property {WebGLVertexArrayObject} vao
 * @property {number} count of its indices
 * @property {number} copies of a tree in it
 * @property {WebGLBuffer[]} buffers
 *
 * @typedef {object} DrawnLevel trees of a kind that are drawn on one level
 * @property {Uint32Array} starts rows of their first segments, then of nothing
 * @property {number} count of them
 * @property {Drawable} bark
 * @property {Drawable} leaf
 *
 * @typedef {object} DrawnKind
 * @property {KindPlacer} placer
 * @property {Float32Array} rest poses of its segments, as they are described
 * @property {(DrawnLevel | null)[]} drawn per level; null before it is first used
 */

/** @type {Record<string, Look>} */
export const LOOKS = {
  light: { back: [0.925, 0.937, 0.945], ground: [0.8, 0.805, 0.79] },
  dark: { back: [0.075, 0.09, 0.105], ground: [0.17, 0.185, 0.19] },
};

/** @typedef {{bark: number[], twig: number[], leaf: number[], fresh: number[]}} Wood */

/** @type {Record<string, Wood>} */
const WOODS = {
  usual: { bark: [0.42, 0.33, 0.26], twig: [0.36, 0.3, 0.2], leaf: [0.2, 0.4, 0.13], fresh: [0.45, 0.62, 0.2] },
  benjamina: { bark: [0.56, 0.49, 0.4], twig: [0.42, 0.4, 0.26], leaf: [0.12, 0.35, 0.12], fresh: [0.36, 0.58, 0.2] },
  goldcrest: { bark: [0.46, 0.31, 0.21], twig: [0.46, 0.42, 0.17], leaf: [0.4, 0.52, 0.1], fresh: [0.72, 0.74, 0.18] },
  spruce: { bark: [0.4, 0.29, 0.22], twig: [0.38, 0.28, 0.18], leaf: [0.11, 0.27, 0.16], fresh: [0.25, 0.43, 0.22] },
  birch: { bark: [0.82, 0.81, 0.78], twig: [0.4, 0.3, 0.25], leaf: [0.3, 0.48, 0.16], fresh: [0.55, 0.68, 0.25] },
};
WOODS.sitka = { ...WOODS.spruce, bark: [0.42, 0.37, 0.36] };
WOODS.oak = { ...WOODS.usual, bark: [0.36, 0.31, 0.26] };
WOODS.beech = { ...WOODS.usual, bark: [0.55, 0.56, 0.54] };
WOODS.ash = { ...WOODS.usual, bark: [0.52, 0.5, 0.44] };
WOODS.sycamore = { ...WOODS.usual, bark: [0.5, 0.45, 0.41] };
WOODS.walnut = { ...WOODS.usual, bark: [0.46, 0.43, 0.4] };
WOODS.douglas_fir = WOODS.spruce;
WOODS.pine = { ...WOODS.spruce, bark: [0.66, 0.4, 0.24] };

/** @param {WebGLRenderingContext | WebGL2RenderingContext} gl */
function isSoftware(gl) {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

export class Scene {
  /**
   * @param {HTMLCanvasElement} canvas
   */
  constructor(canvas) {
    const probe = document.createElement("canvas").getContext("webgl2");
    if (!probe) throw new Error("this browser has no WebGL 2");
    /** Without a graphics unit: fewer points, fewer shadows. */
    this.isSlow = isSoftware(probe);
    probe.getExtension("WEBGL_lose_context")?.loseContext();
    const gl = canvas.getContext("webgl2", {
      antialias: !this.isSlow,
      alpha: false,
      powerPreference: "high-performance",
    });
    if (!gl) throw new Error("this browser has no WebGL 2");
    this.gl = gl;
    this.canvas = canvas;
    this.camera = new Camera();
    /** @type {Look} */
    this.look = LOOKS.light;
    /** @type {Detail | null} */
    this.detail = null;
    /** @type {DrawnKind[]} */
    this._kinds = [];
    /** Tree whose tip is told, and its highest segment. */
    this._watched = 0;
    this._highest = 0;
    this._budget = 0;
    this._chosenFor = new Float64Array(18);
    /** @type {import("./protocol.js").Description | null} */
    this.description = null;
    this.leavesShown = true;
    /** @type {[number, number, number]} */
    this.wind = [0, 0, 0];
    this.light = normalized([0.45, -0.5, 0.95]);
    this._frame = 0;
    this._programs = {
      bark: program(gl, shaders.BARK_VERTEX, shaders.BARK_FRAGMENT),
      leaf: program(gl, shaders.LEAF_VERTEX, shaders.LEAF_FRAGMENT),
      solid: program(gl, shaders.SOLID_VERTEX, shaders.SOLID_FRAGMENT),
      ground: program(gl, shaders.GROUND_VERTEX, shaders.GROUND_FRAGMENT),
      shadow: program(gl, shaders.SHADOW_VERTEX, shaders.SHADOW_FRAGMENT),
    };
    this._texture = gl.createTexture();
    this._rows = 0;
    /** Poses of the segments that are drawn, tree after tree. */
    this._texels = new Float32Array(0);
    /** @type {Float32Array} */
    this._coordinates = new Float32Array(0);
    /** @type {Record<string, Drawable>} */
    this._parts = {};
    this._parts.arrow = this._solid(arrowMesh());
    this._parts.pot = this._solid(potMesh());
    this._parts.ground = this._flat("ground", discMesh());
    this._parts.shadow = this._flat("shadow", {
      values: [-1, -1, 1, -1, 1, 1, -1, 1],
      indices: [0, 1, 2, 0, 2, 3],
    });
    this._shadowSize = this.isSlow ? 256 : 1024;
    this._shadow = this._shadowTarget();
    this._shadowMiddle = [0, 0];
    this._shadowHalf = 1;
    /** Points of the picture per point of the page. */
    this._fineness = 1;
    /** Share of the leaves that is drawn. */
    this._density = 1;
    this._paceFrom = 0;
    this._paced = 0;
    this._pacedAt = 0;
    this._groundHeight = 0;
    this._middle = [0, 0];
    this._extent = 1;
    this._treeHeight = 1;
    this._potSize = 1;
  }

  /**
   * Take another tree.
   *
   * @param {import("./protocol.js").Description} description
   */
  describe(description) {
    this._free();
    this.resize();
    const { kinds, trees } = description;
    const most = this.isSlow ? MOST_SLOW : MOST;
    this.description = description;
    this._coordinates = new Float32Array(description.nCoordinates);
    this._kinds = kinds.map((kind) => {
      const rest = new KindPlacer(kind).rest();
      return { placer: new KindPlacer(kind, branchOrder(kind, rest)), rest, drawn: [] };
    });
    const levels = this._kinds.map(({ placer, rest }) =>
      levelsOf(placer, highestOf(rest), most.segments, most.leaves));
    const boxes = this._kinds.map(({ rest }) => boxOf(rest));
    const radii = boxes.map(({ low, high }) => 0.6 * Math.hypot(...low.map((l, c) => high[c] - l)));
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    this._watched = 0;
    trees.forEach((tree, number) => {
      const box = boxes[tree.kind];
      const [x, y, z, yaw, scale] = tree.place;
      const [c, s] = [scale * Math.cos(yaw), scale * Math.sin(yaw)];
      for (const u of [box.low[0], box.high[0]]) {
        for (const v of [box.low[1], box.high[1]]) {
          const corner = [x + c * u - s * v, y + s * u + c * v];
          for (const i of [0, 1]) {
            low[i] = Math.min(low[i], corner[i]);
            high[i] = Math.max(high[i], corner[i]);
          }
        }
      }
      low[2] = Math.min(low[2], z + scale * box.low[2]);
      const top = z + scale * box.high[2];
      if (top > high[2]) this._watched = number;
      high[2] = Math.max(high[2], top);
    });
    this.detail = new Detail(trees, levels, radii, this._watched);
    this._highest = highestOf(this._kinds[trees[this._watched].kind].rest);
    this._budget = most.segments;
    this._chosenFor.fill(NaN);
    const isSame = this._name === description.name;
    this._name = description.name;
    const high2 = Math.max(high[2] - low[2], 0.05);
    const wide = Math.max(high[0] - low[0], high[1] - low[1], 0.4 * high2);
    const root = trees[0].place;
    this._treeHeight = Math.max(high2, 0.2 * wide);
    this._potSize = isPotted(description) ? POT_HEIGHT * high2 : 0;
    this._root = root.slice(0, 3);
    this._groundHeight = (isPotted(description) ? root[2] : Math.min(low[2], root[2])) - this._potSize;
    this._middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    this._extent = Math.max(wide, high2);
    this._frameShadow(low, high);
    if (!isSame) {
      this.camera.frame([low[0], low[1], this._groundHeight], [high[0], high[1], high[2]]);
    }
    this._frame = 0;
    this._chooseDetail(this.camera.update());
    this._place();
  }

  /** Where the top of the tallest tree is now. */
  tip() {
    return this.position(this._highest);
  }

  /**
   * Where a segment's root-side node is now; of the tallest tree, if it is drawn.
   *
   * @param {number} segment
   */
  position(segment) {
    const { detail, description } = this;
    if (!detail || !description) return [0, 0, 0];
    const { slots } = this._kinds[description.trees[this._watched].kind].placer;
    const from = STRIDE * (detail.start[this._watched] + slots[segment]);
    return Array.from(this._texels.subarray(from, from + 3));
  }

  /**
   * Choose what of each tree is drawn, where the camera or the budget is another than before.
   *
   * @param {Float32Array} matrix
   */
  _chooseDetail(matrix) {
    const { gl, detail, _chosenFor: before } = this;
    const tall = this.canvas.clientHeight;
    if (!detail) return;
    if (before[16] === tall && before[17] === this._budget && matrix.every((m, i) => m === before[i])) {
      return;
    }
    before.set(matrix);
    [before[16], before[17]] = [tall, this._budget];
    detail.choose(matrix, tall, this._budget);
    for (const { drawn } of this._kinds) for (const level of drawn) if (level) level.count = 0;
    for (let t = 0; t < detail.trees.length; t++) {
      if (detail.level[t] < 0) continue;
      const level = this._drawnLevel(detail.trees[t].kind, detail.level[t]);
      level.starts[level.count++] = detail.start[t];
    }
    for (const { drawn } of this._kinds) {
      for (const level of drawn) level?.starts.fill(shaders.NOTHING, level.count);
    }
    const rows = Math.ceil((2 * detail.segments) / shaders.TEXTURE_WIDTH);
    if (rows <= this._rows) return;
    this._rows = Math.ceil(1.25 * rows);
    this._texels = new Float32Array(4 * shaders.TEXTURE_WIDTH * this._rows);
    gl.bindTexture(gl.TEXTURE_2D, this._texture);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
      gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    }
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, shaders.TEXTURE_WIDTH, this._rows, 0, gl.RGBA,
      gl.FLOAT, null);
  }

  /**
   * A level of a kind, made when it is first used.
   *
   * @param {number} kind
   * @param {number} level
   * @returns {DrawnLevel}
   */
  _drawnLevel(kind, level) {
    const { gl } = this;
    const { placer, rest, drawn } = this._kinds[kind];
    const made = drawn[level];
    if (made) return made;
    const { levels, trees } = /** @type {Detail} */ (this.detail);
    const told = levels[kind][level];
    const branches = placer.order.slice(0, told.branches);
    const n = trees.filter((tree) => tree.kind === kind).length;
    const starts = new Uint32Array(n + shaders.MOST_COPIES);
    const bark = barkMesh(placer.kind, branches, rest, told.pixels);
    const most = levels[kind][levels[kind].length - 1].blades;
    const leaves = leafMesh(placer.kind, branches, rest, told, most, !this.isSlow);
    const fields = /** @type {[string, number][]} */ ([
      ["centre", 3],
      ["orientation", 4],
      ["place", 3],
      ["facing", 3],
      ["flutter", 3],
    ]);
    return (drawn[level] = {
      starts,
      count: 0,
      bark: this._hung("bark", bark, [["ring", 4]], placer.slots, n),
      leaf: this._hung("leaf", leaves, fields, placer.slots, n),
    });
  }

  /** Place what is drawn of each tree. */
  _place() {
    const { detail } = this;
    if (!detail) return;
    for (let t = 0; t < detail.trees.length; t++) {
      const level = detail.level[t];
      if (level < 0) continue;
      const { kind, firstCoordinate, place } = detail.trees[t];
      this._kinds[kind].placer.place(this._coordinates, firstCoordinate, place,
        detail.levels[kind][level].branches, this._texels, detail.start[t]);
    }
  }

  /** Fit the picture to the element. */
  resize() {
    const ratio = this.isSlow ? this._fineness : Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    if (this.canvas.width === width && this.canvas.height === height) return;
    const narrow = this.camera.aspect < 1;
    this.canvas.width = width;
    this.canvas.height = height;
    this.camera.aspect = width / height;
    if (narrow !== this.camera.aspect < 1) this.camera.home();
  }

  /**
   * Draw.
   *
   * @param {Float32Array | null} coordinates the state; the poses stay as they are if null
   * @param {number} time [s]
   * @param {boolean} isPaused nothing of the picture changes then
   */
  draw(coordinates, time, isPaused) {
    const { gl, look } = this;
    this.resize();
    const matrix = this.camera.update();
    if (this._frame % CHOOSE_EVERY === 0) this._chooseDetail(matrix);
    if (coordinates && coordinates.length === this._coordinates.length) this._coordinates = coordinates;
    this._place();
    this._upload();
    // The eye takes a shadow that is some frames old for one that is not.
    const isCrowd = (this.detail?.trees.length ?? 0) > CROWD;
    const every = this.isSlow ? (isCrowd ? 3 : 1) * SHADOW_EVERY : 1;
    if (this.detail && this._frame % every === 0) this._castShadow(matrix, time);
    if (this.isSlow && !isPaused) this._keepPace();
    this._frame++;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(look.back[0], look.back[1], look.back[2], 1);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!this.detail) return;
    this._drawTree(matrix, time, false);
    this._drawSolids(matrix, false);
    this._drawGround(matrix);
  }

  _upload() {
    const { gl } = this;
    const segments = this.detail?.segments ?? 0;
    if (!segments) return;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this._texture);
    const rows = Math.ceil((2 * segments) / shaders.TEXTURE_WIDTH);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, shaders.TEXTURE_WIDTH, rows, gl.RGBA, gl.FLOAT,
      this._texels);
  }

  /**
   * @param {Float32Array} matrix
   * @param {number} time
   */
  _castShadow(matrix, time) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this._shadow.target);
    gl.viewport(0, 0, this._shadowSize, this._shadowSize);
    gl.clearColor(0, 0, 0, 1);
    gl.disable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT);
    this._drawTree(matrix, time, true);
    this._drawSolids(matrix, true);
  }

  /**
   * @param {Program} used
   * @param {Float32Array} matrix
   * @param {boolean} isShadow
   */
  _begin(used, matrix, isShadow) {
    const { gl, light } = this;
    const at = used.uniforms;
    gl.useProgram(used.program);
    gl.uniformMatrix4fv(at.camera, false, matrix);
    gl.uniform3f(at.light, light[0], light[1], light[2]);
    gl.uniform3f(at.eye, this.camera.eye[0], this.camera.eye[1], this.camera.eye[2]);
    gl.uniform1f(at.ground, this._groundHeight);
    gl.uniform1f(at.isShadow, isShadow ? 1 : 0);
    const [x, y] = this._shadowMiddle;
    gl.uniform4f(at.shadowArea, x, y, 1 / this._shadowHalf, isShadow ? 1 : 0);
    gl.uniform1i(at.poses, 0);
  }

  /**
   * Where the shadow falls, with room to sway.
   *
   * @param {number[]} low
   * @param {number[]} high
   */
  _frameShadow(low, high) {
    const lean = [0, 1].map((c) => -this.light[c] / this.light[2]);
    const tall = high[2] - this._groundHeight;
    const room = 0.06 * this._extent;
    const from = [0, 1].map((c) => low[c] + Math.min(0, lean[c] * tall) - room);
    const to = [0, 1].map((c) => high[c] + Math.max(0, lean[c] * tall) + room);
    this._shadowMiddle = [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2];
    this._shadowHalf = Math.max(to[0] - from[0], to[1] - from[1]) / 2;
  }

  /** What of the picture is left out so that frames come in time, for people; empty if nothing. */
  get leftOut() {
    const parts = [];
    if (this._fineness < 0.99) parts.push(`${Math.round(100 * this._fineness)} % of the points`);
    if (this._density < 0.99) parts.push(`${Math.round(100 * this._density)} % of the leaves`);
    if (parts.length) parts.push("without a graphics unit");
    if (this.detail && this.detail.share < 1) {
      parts.push(`${this.detail.segments} of ${this.description?.nSegments} segments`);
    }
    return parts.length ? `Drawn: ${parts.join(", ")}` : "";
  }

  /** Draw fewer points and leaves while frames come too slowly, more again when there is time. */
  _keepPace() {
    const now = performance.now();
    // A page that was hidden was not slow.
    if (now - this._pacedAt > 1500) [this._paceFrom, this._paced] = [now, -1];
    this._pacedAt = now;
    this._paced++;
    if (now - this._paceFrom < 700 || this._paced < 3) return;
    const fps = (1000 * this._paced) / (now - this._paceFrom);
    const factor = fps < WANTED_FPS ? Math.max(0.75, Math.sqrt(fps / 60)) : 1.02;
    this._fineness = Math.min(1, Math.max(COARSEST, this._fineness * factor));
    // Points cost less than leaves, and are missed less.
    const thinner = factor < 1 && this._fineness > COARSEST ? 1 : factor;
    this._density = Math.min(1, Math.max(THINNEST, this._density * thinner));
    const fewer = fps < LEAST_FPS && this._density <= THINNEST ? 0.8 : fps > 2 * LEAST_FPS ? 1.05 : 1;
    this._budget = Math.min(MOST_SLOW.segments, Math.max(FEWEST_SEGMENTS, this._budget * fewer));
    this._paceFrom = now;
    this._paced = 0;
  }

  /**
   * @param {Float32Array} matrix
   * @param {number} time
   * @param {boolean} isShadow
   */
  _drawTree(matrix, time, isShadow) {
    const { gl } = this;
    const description = /** @type {import("./protocol.js").Description} */ (this.description);
    const law = description.flutter ?? { gain: 0, largest_angle: 1 };
    const { bark, leaf } = this._programs;
    this._begin(bark, matrix, isShadow);
    this._eachLevel((level, wood) => {
      gl.uniform3fv(bark.uniforms.barkColor, wood.bark);
      gl.uniform3fv(bark.uniforms.twigColor, wood.twig);
      drawBatches(gl, level.bark, level, bark.uniforms.starts);
    });
    if (!this.leavesShown) return;
    this._begin(leaf, matrix, isShadow);
    gl.uniform1f(leaf.uniforms.time, time % 1000);
    gl.uniform1f(leaf.uniforms.speed, Math.hypot(...this.wind));
    gl.uniform2f(leaf.uniforms.law, law.gain, law.largest_angle);
    gl.uniform1f(leaf.uniforms.swell, 1 / Math.sqrt(this._density));
    this._eachLevel((level, wood) => {
      if (!level.leaf.count) return;
      gl.uniform3fv(leaf.uniforms.leafColor, wood.leaf);
      gl.uniform3fv(leaf.uniforms.freshColor, wood.fresh);
      drawBatches(gl, level.leaf, level, leaf.uniforms.starts, this._density);
    });
  }

  /** @param {(level: DrawnLevel, wood: Wood) => void} draw */
  _eachLevel(draw) {
    for (const { placer, drawn } of this._kinds) {
      const wood = WOODS[placer.kind.species] ?? WOODS.usual;
      for (const level of drawn) if (level?.count) draw(level, wood);
    }
  }

  /**
   * The pot and the arrow of the wind.
   *
   * @param {Float32Array} matrix
   * @param {boolean} isShadow
   */
  _drawSolids(matrix, isShadow) {
    const { gl } = this;
    const used = this._programs.solid;
    this._begin(used, matrix, isShadow);
    const root = this._root ?? [0, 0, 0];
    if (this._potSize > 0 && this._parts.pot) {
      gl.uniform4f(used.uniforms.placed, root[0], root[1], root[2], this._potSize);
      gl.uniform2f(used.uniforms.heading, 1, 0);
      drawPart(gl, this._parts.pot);
    }
    const speed = Math.hypot(this.wind[0], this.wind[1]);
    if (speed > 0.05 && this._parts.arrow) {
      const long = this._treeHeight * 0.6 * Math.tanh(speed / 9);
      const [c, s] = [this.wind[0] / speed, this.wind[1] / speed];
      const away = 0.5 * this._extent + long;
      const z = this._groundHeight + 0.02 * this._treeHeight;
      gl.uniform4f(used.uniforms.placed, this._middle[0] - c * away, this._middle[1] - s * away, z,
        long);
      gl.uniform2f(used.uniforms.heading, c, s);
      drawPart(gl, this._parts.arrow);
    }
  }

  /** @param {Float32Array} matrix */
  _drawGround(matrix) {
    const { gl, look } = this;
    const ground = this._programs.ground.uniforms;
    gl.useProgram(this._programs.ground.program);
    gl.uniformMatrix4fv(ground.camera, false, matrix);
    gl.uniform4f(ground.area, this._middle[0], this._middle[1], 5 * this._extent,
      this._groundHeight);
    gl.uniform3fv(ground.groundColor, look.ground);
    gl.uniform3fv(ground.backColor, look.back);
    if (this._parts.ground) drawPart(gl, this._parts.ground);

    const shadow = this._programs.shadow.uniforms;
    gl.useProgram(this._programs.shadow.program);
    gl.uniformMatrix4fv(shadow.camera, false, matrix);
    const lift = 0.0015 * this._extent;
    gl.uniform4f(shadow.area, this._shadowMiddle[0], this._shadowMiddle[1], this._shadowHalf,
      this._groundHeight + lift);
    gl.uniform1f(shadow.softness, this.isSlow ? 0 : 1.5 / this._shadowSize);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this._shadow.texture);
    gl.uniform1i(shadow.shadow, 1);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    if (this._parts.shadow) drawPart(gl, this._parts.shadow);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    gl.activeTexture(gl.TEXTURE0);
  }

  _shadowTarget() {
    const { gl } = this;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, this._shadowSize, this._shadowSize, 0, gl.RED,
      gl.UNSIGNED_BYTE, null);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    const target = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    return { target, texture };
  }

  /** Forget the trees. */
  _free() {
    const { gl } = this;
    for (const { drawn } of this._kinds) {
      for (const level of drawn) {
        if (!level) continue;
        for (const { vao, buffers } of [level.bark, level.leaf]) {
          for (const buffer of buffers) gl.deleteBuffer(buffer);
          gl.deleteVertexArray(vao);
        }
      }
    }
    this._kinds = [];
  }

  /**
   * @param {"bark" | "leaf"} name
   * @param {{values: number[], segments: number[], indices: number[], width: number}} mesh
   * @param {[string, number][]} fields
   * @param {Int32Array} slots of the segments in a tree
   * @param {number} n how many trees may be drawn so
   * @returns {Drawable}
   */
  _hung(name, mesh, fields, slots, n) {
    const { gl } = this;
    const used = this._programs[name];
    const vao = /** @type {WebGLVertexArrayObject} */ (gl.createVertexArray());
    gl.bindVertexArray(vao);
    const { segments, values, indices } = mesh;
    const room = Math.floor(BATCH / Math.max(segments.length, 1));
    const copies = Math.max(1, Math.min(shaders.MOST_COPIES, n, room));
    const rows = new Uint32Array(copies * segments.length);
    const all = new Float32Array(copies * values.length);
    const corners = new Uint32Array(copies * indices.length);
    for (let copy = 0; copy < copies; copy++) {
      all.set(values, copy * values.length);
      const from = copy * segments.length;
      for (let v = 0; v < segments.length; v++) rows[from + v] = slots[segments[v]] | (copy << 24);
      // Leaf after leaf, so that any first part is as much of every tree; wood tree after tree.
      const [each, apart] = name === "leaf" ? [copies, copy] : [1, copy * (indices.length / 3)];
      for (let i = 0; i < indices.length; i++) {
        corners[3 * (each * Math.floor(i / 3) + apart) + (i % 3)] = from + indices[i];
      }
    }
    const at = gl.getAttribLocation(used.program, "segment");
    const buffer = filled(gl, gl.ARRAY_BUFFER, rows);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribIPointer(at, 1, gl.UNSIGNED_INT, 0, 0);
    const buffers = [buffer, ...this._fields(used, all, fields, corners)];
    return { vao, count: corners.length, copies, buffers };
  }

  /**
   * @param {{values: number[], indices: number[]}} mesh
   * @returns {Drawable}
   */
  _solid(mesh) {
    const { gl } = this;
    const vao = /** @type {WebGLVertexArrayObject} */ (gl.createVertexArray());
    gl.bindVertexArray(vao);
    const fields = /** @type {[string, number][]} */ ([["at", 3], ["facing", 3], ["tint", 3]]);
    const buffers = this._fields(this._programs.solid, mesh.values, fields, mesh.indices);
    return { vao, count: mesh.indices.length, copies: 1, buffers };
  }

  /**
   * @param {"ground" | "shadow"} name
   * @param {{values: number[], indices: number[]}} mesh
   * @returns {Drawable}
   */
  _flat(name, mesh) {
    const { gl } = this;
    const vao = /** @type {WebGLVertexArrayObject} */ (gl.createVertexArray());
    gl.bindVertexArray(vao);
    const buffers = this._fields(this._programs[name], mesh.values, [["corner", 2]], mesh.indices);
    return { vao, count: mesh.indices.length, copies: 1, buffers };
  }

  /**
   * @param {Program} used
   * @param {ArrayLike<number>} values
   * @param {[string, number][]} fields
   * @param {ArrayLike<number>} indices
   */
  _fields(used, values, fields, indices) {
    const { gl } = this;
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
    return [buffer, filled(gl, gl.ELEMENT_ARRAY_BUFFER, Uint32Array.from(indices))];
  }
}

/**
 * @typedef {object} Program
 * @property {WebGLProgram} program
 * @property {Record<string, WebGLUniformLocation>} uniforms
 */

/**
 * @param {WebGL2RenderingContext} gl
 * @param {string} vertex
 * @param {string} fragment
 * @returns {Program}
 */
function program(gl, vertex, fragment) {
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
  /** @type {Record<string, WebGLUniformLocation>} */
  const uniforms = {};
  for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); i++) {
    const { name } = /** @type {WebGLActiveInfo} */ (gl.getActiveUniform(made, i));
    // Arrays are told as that of their first element.
    const key = name.replace("[0]", "");
    uniforms[key] = /** @type {WebGLUniformLocation} */ (gl.getUniformLocation(made, name));
  }
  return { program: made, uniforms };
}

/**
 * @param {WebGL2RenderingContext} gl
 * @param {number} kind
 * @param {ArrayBufferView} data
 */
function filled(gl, kind, data) {
  const buffer = /** @type {WebGLBuffer} */ (gl.createBuffer());
  gl.bindBuffer(kind, buffer);
  gl.bufferData(kind, data, gl.STATIC_DRAW);
  return buffer;
}

/**
 * @param {WebGL2RenderingContext} gl
 * @param {Drawable} part
 * @param {number} [share] of its triangles
 */
function drawPart(gl, part, share = 1) {
  gl.bindVertexArray(part.vao);
  gl.drawElements(gl.TRIANGLES, 3 * Math.round((share * part.count) / 3), gl.UNSIGNED_INT, 0);
}

/**
 * Draw the trees of a level, a batch at a time.
 *
 * @param {WebGL2RenderingContext} gl
 * @param {Drawable} part
 * @param {DrawnLevel} level
 * @param {WebGLUniformLocation} at of the rows of the trees
 * @param {number} [share] of its triangles
 */
function drawBatches(gl, part, { starts, count }, at, share = 1) {
  for (let from = 0; from < count; from += part.copies) {
    gl.uniform4uiv(at, starts, from, 4 * Math.ceil(part.copies / 4));
    drawPart(gl, part, share);
  }
}

/** @param {number[]} v */
function normalized(v) {
  const size = Math.hypot(...v);
  return v.map((each) => each / size);
}

function potMesh() {
  /** @type {[number, number, number]} */
  const clay = [0.71, 0.41, 0.29];
  /** @type {[number, number, number]} */
  const rim = [0.78, 0.48, 0.35];
  /** @type {[number, number, number]} */
  const soil = [0.24, 0.18, 0.14];
  return turnedMesh(
    [
      [0, -1, clay], [0.5, -1, clay], [0.52, -0.98, clay], [0.66, -0.2, clay],
      [0.74, -0.2, rim], [0.77, -0.17, rim], [0.77, 0.07, rim], [0.74, 0.09, rim],
      [0.7, 0.09, rim], [0.68, 0.06, rim], [0.67, 0.0, soil], [0.35, 0.025, soil], [0, 0.03, soil],
    ],
    36,
  );
}

/** A disc of rings, close together where the ground fades. */
function discMesh() {
  const values = [0, 0];
  /** @type {number[]} */
  const indices = [];
  const sectors = 40;
  const rings = [0.15, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1];
  rings.forEach((r, ring) => {
    for (let k = 0; k < sectors; k++) {
      const angle = (2 * Math.PI * k) / sectors;
      values.push(r * Math.cos(angle), r * Math.sin(angle));
      const next = (k + 1) % sectors;
      const outer = 1 + ring * sectors;
      const inner = outer - sectors;
      if (ring === 0) indices.push(0, 1 + k, 1 + next);
      else indices.push(inner + k, outer + k, outer + next, inner + k, outer + next, inner + next);
    }
  });
  return { values, indices };
}

/** An arrow of length 1 along x, lying flat. */
function arrowMesh() {
  const blue = [0.16, 0.47, 0.78];
  /** @type {number[]} */
  const values = [];
  for (const [x, y] of [[0, 0.05], [0, -0.05], [0.66, -0.05], [0.66, 0.05], [0.62, 0.17], [0.62, -0.17], [1, 0]]) {
    values.push(x, y, 0, 0, 0, 1, ...blue);
  }
  return { values, indices: [0, 1, 2, 0, 2, 3, 4, 5, 6] };
}

