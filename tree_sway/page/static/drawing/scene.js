// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Draws a described tree from its poses: bark, leaves, what is beside it, ground and sky. */

import { KindPlacer, STRIDE } from "../placing.js";
import { Backdrop, DAYLIGHT, GROUNDS } from "./backdrop.js";
import { Camera } from "./camera.js";
import { Detail, levelsOf } from "./detail.js";
import { canvasTexture, discard, drawable, drawPart, filled, isSoftware, pictureTexture, use } from "./gl.js";
import { Impostor } from "./impostors.js";
import {
  barkMesh, boxOf, branchOrder, conjugate, highestOf, leafMesh, multiply, quaternion, shadeOf,
} from "./mesh.js";
import { arrowLength, arrowMesh, personMesh, potMesh } from "./props.js";
import { Quality } from "./quality.js";
import * as shaders from "./shaders.js";
import { isPotted, lookOf } from "./species.js";
import { barkPicture, leafPicture } from "./textures.js";

/** A shadow is drawn again after this number of frames without a graphics unit, of a crowd less often. */
const SHADOW_EVERY = 8;
/** Share of the leaves that cast it then. */
const SHADOW_LEAVES = 0.4;
const CROWD = 50;
/** Segments of all trees and cards of leaves of one, at most, and height of far trees [px]. */
const MOST = { segments: 40000, cards: 3000, far: 90 };
const MOST_SLOW = { segments: 12000, cards: 3000, far: 150 };
/** The same of a crowd without a graphics unit. */
const MOST_CROWD = { segments: 5000, cards: 3000, far: 220 };
/** What of each tree is drawn is chosen again after this number of frames while the camera moves. */
const CHOOSE_EVERY = 6;
const POT_HEIGHT = 0.17;
/** Height of a tree from which a person is beside it [m]. */
const WITH_PERSON = 2.5;
/** Vertices of the trees that are drawn in one go, at most. */
const BATCH = 6000;
/** The arrow follows the mean of the wind over this time [s]. */
const CALM = 4;
/** Height that the picture of a far tree is painted for [px]. */
const PAINTED = 260;
const AT_ORIGIN = [0, 0, 0, 0, 1];

/**
 * @typedef {import("./gl.js").Drawable} Drawable
 * @typedef {import("./gl.js").Program} Program
 *
 * @typedef {object} DrawnLevel trees of a kind that are drawn on one level
 * @property {Uint32Array} starts rows of their first segments, then of nothing
 * @property {number} count of them
 * @property {Drawable | null} bark
 * @property {Drawable | null} leaf
 * @property {number} across leaves in the picture of a card
 * @property {Impostor | null} impostor
 *
 * @typedef {object} DrawnKind
 * @property {KindPlacer} placer
 * @property {Float32Array} rest poses of its segments, as they are described
 * @property {ReturnType<typeof shadeOf>} shade
 * @property {(DrawnLevel | null)[]} drawn per level; null before it is first used
 */

export class Scene {
  /** @param {HTMLCanvasElement} canvas
   * @param {boolean} [isFine] whether nothing is left out, however slow that is */
  constructor(canvas, isFine = false) {
    const probe = document.createElement("canvas").getContext("webgl2");
    if (!probe) throw new Error("this browser has no WebGL 2");
    /** Without a graphics unit: fewer points, fewer shadows. */
    const hasUnit = !isSoftware(probe);
    this.isSlow = !hasUnit && !isFine;
    probe.getExtension("WEBGL_lose_context")?.loseContext();
    const gl = canvas.getContext("webgl2", {
      antialias: hasUnit,
      alpha: false,
      powerPreference: "high-performance",
    });
    if (!gl) throw new Error("this browser has no WebGL 2");
    this.gl = gl;
    this.canvas = canvas;
    this.camera = new Camera();
    this.day = DAYLIGHT.light;
    this.isAutumn = false;
    /** @type {Detail | null} */
    this.detail = null;
    /** @type {DrawnKind[]} */
    this._kinds = [];
    /** Tree whose tip is followed, and its highest segment. */
    this._watched = 0;
    this._highest = 0;
    this._budget = 0;
    this._chosenFor = new Float64Array(18);
    /** @type {import("../protocol.js").Description | null} */
    this.description = null;
    this.leavesShown = true;
    this.hasPerson = true;
    /** Whether leaves flutter; not where people ask for less motion. */
    this.flutters = true;
    /** Branch of the watched tree that is shown in another colour; none if -1. */
    this.picked = -1;
    /** @type {[number, number, number]} */
    this.wind = [0, 0, 0];
    this._calmWind = [0, 0];
    this._time = 0;
    this._frame = 0;
    this._programs = {
      bark: shaders.shaded(gl, "bark"),
      leaf: shaders.shaded(gl, "leaf"),
      impostor: shaders.shaded(gl, "impostor"),
      solid: shaders.shaded(gl, "solid"),
      shadow: shaders.shaded(gl, "shadow"),
    };
    this._backdrop = new Backdrop(gl);
    /** @type {Map<string, WebGLTexture>} */
    this._pictures = new Map();
    this._texture = /** @type {WebGLTexture} */ (gl.createTexture());
    /** Where the shaders look poses up. */
    this._poses = this._texture;
    this._rows = 0;
    /** Poses of the segments that are drawn, tree after tree. */
    this._texels = new Float32Array(0);
    /** @type {Float32Array} */
    this._coordinates = new Float32Array(0);
    /** @type {[string, number][]} */
    const solid = [["at", 3], ["facing", 3], ["tint", 3]];
    const [arrow, pot, person] = [arrowMesh(), potMesh(), personMesh()].map((mesh) =>
      drawable(gl, this._programs.solid, mesh.values, solid, mesh.indices));
    const shadow = drawable(gl, this._programs.shadow, [-1, -1, 1, -1, 1, 1, -1, 1], [["corner", 2]],
      [0, 1, 2, 0, 2, 3]);
    this._parts = { arrow, pot, person, shadow };
    this._shadowSize = this.isSlow ? 256 : 1024;
    this._shadow = canvasTexture(gl, this._shadowSize, this._shadowSize, gl.R8);
    this._shadowMiddle = [0, 0];
    this._shadowHalf = 1;
    this.quality = new Quality();
    this._groundHeight = 0;
    this._low = [0, 0, 0];
    this._high = [1, 1, 1];
    this._middle = [0, 0];
    this._extent = 1;
    this._treeHeight = 1;
    this._potSize = 0;
    this._root = [0, 0, 0];
  }

  /** @returns {number[]} unit vector towards the sun */
  get light() {
    const size = Math.hypot(...this.day.light);
    return this.day.light.map((each) => each / size);
  }

  /** Whether any tree of the scene bears leaves. */
  get hasLeaves() {
    return Boolean(this.description?.kinds.some((kind) => kind.arrays.leaf_segment?.length));
  }

  /** Another time of day. @param {import("./backdrop.js").Daylight} day */
  setDay(day) {
    this.day = day;
    if (this.description) this._frameShadow();
    this._frame = 0;
  }

  /** Paint again what is painted once: far trees, pictures of leaves. */
  repaint() {
    if (this.description) this.describe(this.description);
  }

  /** @param {boolean} isAutumn whether leaves that fall have the colours of autumn */
  setAutumn(isAutumn) {
    this.isAutumn = isAutumn;
    this.repaint();
  }

  /** Take another tree. @param {import("../protocol.js").Description} description */
  describe(description) {
    this._free();
    this.resize();
    const { kinds, trees } = description;
    const most = !this.isSlow ? MOST : trees.length > CROWD ? MOST_CROWD : MOST_SLOW;
    this.description = description;
    this._coordinates = new Float32Array(description.nCoordinates);
    this._kinds = kinds.map((kind) => {
      const rest = new KindPlacer(kind).rest();
      const placer = new KindPlacer(kind, branchOrder(kind, rest));
      return { placer, rest, shade: shadeOf(kind, rest), drawn: [] };
    });
    const levels = this._kinds.map(({ placer, rest }) =>
      levelsOf(placer, highestOf(rest), most.segments, most.cards, most.far));
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
    this._budget = most.segments + most.cards;
    this._chosenFor.fill(NaN);
    const isSame = this._name === description.name;
    if (!isSame) this.picked = -1;
    this._name = description.name;
    const high2 = Math.max(high[2] - low[2], 0.05);
    const wide = Math.max(high[0] - low[0], high[1] - low[1], 0.4 * high2);
    const root = trees[0].place;
    this._treeHeight = Math.max(high2, 0.2 * wide);
    const inPot = trees.length === 1 && isPotted(kinds[0].species);
    this._potSize = inPot ? POT_HEIGHT * high2 : 0;
    this._root = root.slice(0, 3);
    this._groundHeight = (inPot ? root[2] : Math.min(low[2], root[2])) - this._potSize;
    this._middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    this._extent = Math.max(wide, high2);
    [this._low, this._high] = [low, high];
    this._frameShadow();
    if (!isSame) {
      this.camera.frame([low[0], low[1], this._groundHeight], [high[0], high[1], high[2]]);
    }
    this._frame = 0;
    this._chooseDetail(this.camera.update());
    this._place();
  }

  /** Where the tip of the branch that is picked is now, or the top of the tallest tree. */
  tip() {
    return this.position(this._followed);
  }

  /** The same at rest. */
  restTip() {
    if (!this.description) return [0, 0, 0];
    const { kind, place: [x, y, z, yaw, scale] } = this.description.trees[this._watched];
    const [u, v, w] = this._kinds[kind].rest.subarray(STRIDE * this._followed);
    const [c, s] = [scale * Math.cos(yaw), scale * Math.sin(yaw)];
    return [x + c * u - s * v, y + s * u + c * v, z + scale * w];
  }

  /** Where a segment's root-side node is now; of the tallest tree, if it is drawn.
   * @param {number} segment */
  position(segment) {
    const { detail, description } = this;
    if (!detail || !description) return [0, 0, 0];
    const { slots } = this._kinds[description.trees[this._watched].kind].placer;
    const from = STRIDE * (detail.start[this._watched] + slots[segment]);
    return Array.from(this._texels.subarray(from, from + 3));
  }

  /** The kind of the watched tree. @returns {import("../protocol.js").Kind | null} */
  get watchedKind() {
    return this.description?.kinds[this.description.trees[this._watched].kind] ?? null;
  }

  /** The branch of the watched tree nearest to a place of the picture; -1 if none is near.
   * @param {number} x 0 to 1 from the left @param {number} y from the top
   * @param {number} [reach] share of the height */
  branchAt(x, y, reach = 0.03) {
    const kind = this.watchedKind;
    if (!kind || !this.detail || !this.description) return -1;
    const { placer } = this._kinds[this.description.trees[this._watched].kind];
    const level = this.detail.levels[this.description.trees[this._watched].kind][this.detail.level[this._watched]];
    const { branch_first: first } = kind.arrays;
    let [best, found] = [reach, -1];
    for (const branch of placer.order.subarray(0, level?.branches ?? 0)) {
      for (let s = first[branch]; s < first[branch + 1]; s++) {
        const [px, py] = this.camera.project(this.position(s));
        const away = Math.hypot((px - x) * this.camera.aspect, py - y);
        if (away < best) [best, found] = [away, branch];
      }
    }
    return found;
  }

  /** The last segment of the branch that is picked, or the highest. */
  get _followed() {
    const first = this.watchedKind?.arrays.branch_first;
    return first && this.picked >= 0 ? first[this.picked + 1] - 1 : this._highest;
  }

  /**
   * Strain of the outer wood at the base of the branch that is picked, or of the stem: its further
   * bend between its first two segments.
   */
  strain() {
    const { detail, description, watchedKind: kind } = this;
    if (!detail || !description || !kind) return 0;
    const { placer, rest } = this._kinds[description.trees[this._watched].kind];
    const { branch_first: first, segment_length: length, segment_radius: radius } = kind.arrays;
    const base = first[Math.max(0, this.picked)];
    if (first[Math.max(0, this.picked) + 1] - base < 2) return 0;
    const at = (/** @type {number} */ s) => detail.start[this._watched] + placer.slots[s];
    const now = apart(this._texels, at(base), at(base + 1));
    const before = apart(rest, base, base + 1);
    const bend = 2 * Math.hypot(now[0] - before[0], now[1] - before[1], now[2] - before[2]);
    return (bend * radius[2 * (base + 1)]) / (0.5 * (length[base] + length[base + 1]));
  }

  /** Choose what of each tree is drawn, where the camera or the budget is another than before.
   * @param {Float32Array} matrix */
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
    for (const { drawn } of this._kinds) {
      for (const level of drawn) {
        if (level) level.count = 0;
        level?.impostor?.clear();
      }
    }
    // Near trees first: what they hide costs less then.
    const { eye } = this.camera;
    const away = detail.trees.map(({ place }) => Math.hypot(place[0] - eye[0], place[1] - eye[1]));
    for (const t of Uint32Array.from(away, (_, i) => i).sort((a, b) => away[a] - away[b])) {
      if (detail.level[t] < 0) continue;
      const { kind, place } = detail.trees[t];
      const level = this._drawnLevel(kind, detail.level[t]);
      level.starts[level.count++] = detail.start[t];
      const { placer, rest } = this._kinds[kind];
      level.impostor?.add(place, detail.start[t] + placer.slots[highestOf(rest)], t);
    }
    for (const { drawn } of this._kinds) {
      for (const level of drawn) {
        level?.starts.fill(shaders.NOTHING, level.count);
        level?.impostor?.upload();
      }
    }
    const rows = Math.ceil((2 * detail.segments) / shaders.TEXTURE_WIDTH);
    if (rows <= this._rows) return;
    this._rows = Math.ceil(1.25 * rows);
    this._texels = new Float32Array(4 * shaders.TEXTURE_WIDTH * this._rows);
    poseTexture(gl, this._texture, this._rows, null);
  }

  /** A level of a kind, made when it is first used.
   * @param {number} kind @param {number} level @returns {DrawnLevel} */
  _drawnLevel(kind, level) {
    const { gl } = this;
    const { placer, rest, drawn, shade } = this._kinds[kind];
    const made = drawn[level];
    if (made) return made;
    const { levels, trees } = /** @type {Detail} */ (this.detail);
    const wanted = levels[kind][level];
    const branches = placer.order.slice(0, wanted.branches);
    const n = trees.filter((tree) => tree.kind === kind).length;
    const starts = new Uint32Array(n + shaders.MOST_COPIES);
    if (wanted.isImpostor) {
      const impostor = this._bake(kind, n);
      return (drawn[level] = { starts, count: 0, bark: null, leaf: null, across: 1, impostor });
    }
    const bark = barkMesh(placer.kind, branches, rest, wanted.pixels, shade);
    const most = levels[kind][levels[kind].length - 1].cards;
    const { mesh, across } = leafMesh(placer.kind, branches, rest, wanted, most, shade);
    const fields = /** @type {[string, number][]} */ ([
      ["place", 3],
      ["swing", 3],
      ["facing", 3],
      ["towards", 3],
      ["flutter", 4],
      ["corner", 2],
    ]);
    return (drawn[level] = {
      starts,
      count: 0,
      bark: this._hung("bark", bark, [["ring", 4], ["skin", 3]], placer.slots, n),
      leaf: mesh.count ? this._hung("leaf", mesh, fields, placer.slots, n) : null,
      across,
      impostor: null,
    });
  }

  /** Paint the picture of a kind that far trees are drawn by.
   * @param {number} kind @param {number} most how many trees */
  _bake(kind, most) {
    const { gl } = this;
    const { placer, rest } = this._kinds[kind];
    const levels = /** @type {Detail} */ (this.detail).levels[kind];
    const number = Math.max(1, levels.findIndex((level) => level.pixels >= PAINTED));
    const level = this._drawnLevel(kind, number);
    const { low, high } = boxOf(rest);
    const leaf = Math.max(0, ...(placer.kind.arrays.leaf_size ?? []));
    const wide = leaf + Math.max(...[0, 1].map((c) => Math.max(-low[c], high[c])));
    const tall = high[2] + 0.7 * leaf;
    const tip = highestOf(rest) * STRIDE;
    const impostor = new Impostor(gl, this._programs.impostor, { wide, middle: 0.5 * tall, tall },
      Array.from(rest.subarray(tip, tip + 3)), most, this.isSlow);
    const texels = new Float32Array(4 * shaders.TEXTURE_WIDTH
      * Math.ceil((2 * levels[number].segments) / shaders.TEXTURE_WIDTH));
    placer.place(new Float32Array(placer.kind.nCoordinates), 0, AT_ORIGIN, levels[number].branches,
      texels, 0);
    const poses = /** @type {WebGLTexture} */ (gl.createTexture());
    this._poses = poses;
    gl.activeTexture(gl.TEXTURE0);
    poseTexture(gl, poses, texels.length / 4 / shaders.TEXTURE_WIDTH, texels);
    const alone = { ...level, starts: new Uint32Array(shaders.MOST_COPIES).fill(shaders.NOTHING), count: 1 };
    alone.starts[0] = 0;
    const { leaf: color } = lookOf(placer.kind.species);
    const kindOf = this._kinds[kind];
    impostor.bake((camera, eye) => this._paintTree(kindOf, alone, camera, eye), color);
    this._poses = this._texture;
    gl.deleteTexture(poses);
    return impostor;
  }

  /** Paint a tree at rest in even light.
   * @param {DrawnKind} kind @param {DrawnLevel} level @param {Float32Array} camera
   * @param {number[]} eye */
  _paintTree(kind, level, camera, eye) {
    const { bark, leaf } = this._programs;
    const even = { eye, sun: [0, 0, 0], sky: [1.1, 1.1, 1.1], haze: 0 };
    this._begin(bark, camera, false, even);
    this._drawBark(kind, level);
    if (!this.leavesShown) return;
    this._begin(leaf, camera, false, { ...even, isBaked: 1, speed: 0, law: [0, 1] });
    this._drawLeaves(kind, level, 1);
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
    const ratio = this.isSlow ? this.quality.fineness : Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    if (this.canvas.width === width && this.canvas.height === height) return;
    const narrow = this.camera.aspect < 1;
    this.canvas.width = width;
    this.canvas.height = height;
    this.camera.aspect = width / height;
    if (narrow !== this.camera.aspect < 1) this.camera.home();
  }

  /** Draw.
   * @param {Float32Array | null} coordinates the state; the poses stay as they are if null
   * @param {number} time [s] @param {boolean} isPaused nothing of the picture changes then */
  draw(coordinates, time, isPaused) {
    const { gl } = this;
    this.resize();
    const matrix = this.camera.update();
    if (this._frame % CHOOSE_EVERY === 0) this._chooseDetail(matrix);
    if (coordinates && coordinates.length === this._coordinates.length) this._coordinates = coordinates;
    this._place();
    this._upload();
    const passed = Math.min(0.1, Math.abs(time - this._time));
    this._time = time;
    for (const c of [0, 1]) this._calmWind[c] += (passed / CALM) * (this.wind[c] - this._calmWind[c]);
    // The eye takes a shadow that is some frames old for one that is not.
    const every = this.isSlow ? (this.isCrowd ? 3 : 1) * SHADOW_EVERY : 1;
    if (this.detail && this._frame % every === 0) this._castShadow(matrix, time);
    if (this.isSlow && !isPaused) this.quality.count(performance.now(), this._hasCards);
    this._frame++;
    const [width, height] = [this.canvas.width, this.canvas.height];
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this._backdrop.draw(this.camera, this.day, this._ground, width, height);
    if (!this.detail) return;
    this._drawShadow(matrix);
    this._drawTrees(matrix, time, false);
    this._drawSolids(matrix, false);
  }

  /** Whether any leaves are drawn near enough to be left out. */
  get _hasCards() {
    return this._kinds.some(({ drawn }) => drawn.some((level) => level?.count && level.leaf));
  }

  /** The ground of the scene. */
  get _ground() {
    const n = this.detail?.trees.length ?? 0;
    const kind = this._potSize > 0 || !n ? GROUNDS.terrace : GROUNDS.meadow;
    return { kind, height: this._groundHeight, haze: this._haze };
  }

  /** One over how far one sees [1/m]. */
  get _haze() {
    return 1 / (this._potSize > 0 ? 30 * this._treeHeight : Math.max(1500, 30 * this._extent));
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

  /** @param {Float32Array} matrix @param {number} time */
  _castShadow(matrix, time) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this._shadow.target);
    gl.viewport(0, 0, this._shadowSize, this._shadowSize);
    gl.clearColor(0, 0, 0, 1);
    gl.disable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT);
    this._drawTrees(matrix, time, true);
    this._drawSolids(matrix, true);
  }

  /** @param {Program} used @param {Float32Array} camera @param {boolean} shadow
   * @param {Record<string, any>} [own] what it is given beside the usual */
  _begin(used, camera, shadow, own = {}) {
    const isShadow = shadow ? 1 : 0;
    const shadowArea = [...this._shadowMiddle, 1 / this._shadowHalf, isShadow];
    use(this.gl, used, {
      ...this.day, camera, light: this.light, eye: this.camera.eye, haze: this._haze,
      ground: this._groundHeight, isShadow, shadowArea, poses: [0, this._poses], ...own,
    });
  }

  /** Where the shadow falls, with room to sway. */
  _frameShadow() {
    const { light, _low: low, _high: high } = this;
    const lean = [0, 1].map((c) => -light[c] / light[2]);
    const tall = high[2] - this._groundHeight;
    const room = 0.06 * this._extent;
    const from = [0, 1].map((c) => low[c] + Math.min(0, lean[c] * tall) - room);
    const to = [0, 1].map((c) => high[c] + Math.max(0, lean[c] * tall) + room);
    this._shadowMiddle = [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2];
    this._shadowHalf = Math.max(to[0] - from[0], to[1] - from[1]) / 2;
  }

  /** What of the picture is left out so that frames come in time; null if nothing is. */
  get leftOut() {
    return this.isSlow ? this.quality.leftOut : null;
  }

  /** @param {Float32Array} matrix @param {number} time @param {boolean} isShadow */
  _drawTrees(matrix, time, isShadow) {
    const description = /** @type {import("../protocol.js").Description} */ (this.description);
    const law = description.flutter ?? { gain: 0, largest_angle: 1 };
    const { bark, leaf, impostor } = this._programs;
    this._begin(bark, matrix, isShadow, { picked: this._pickedRows() });
    this._eachLevel((level, kind) => this._drawBark(kind, level));
    if (this.leavesShown) {
      this._begin(leaf, matrix, isShadow, {
        isBaked: 0, time: time % 1000, speed: Math.hypot(...this.wind),
        law: [this.flutters ? law.gain : 0, law.largest_angle],
      });
      const density = this.isSlow ? this.quality.density * (isShadow ? SHADOW_LEAVES : 1) : 1;
      this._eachLevel((level, kind) => this._drawLeaves(kind, level, density));
    }
    this._begin(impostor, matrix, isShadow);
    const shade = this.isCrowd ? 0.35 : 0.9;
    this._eachLevel((level) => level.impostor?.draw(impostor, shade));
  }

  /** @param {(level: DrawnLevel, kind: DrawnKind) => void} draw */
  _eachLevel(draw) {
    for (const kind of this._kinds) {
      for (const level of kind.drawn) if (level?.count) draw(level, kind);
    }
  }

  /** @param {DrawnKind} kind @param {DrawnLevel} level */
  _drawBark(kind, level) {
    const { gl } = this;
    const used = this._programs.bark;
    if (!level.bark) return;
    const { bark: barkColor, twig: twigColor, pattern } = lookOf(kind.placer.kind.species);
    const picture = this._picture(`bark ${pattern}`, gl.REPEAT, () => barkPicture(pattern));
    use(gl, used, { barkColor, twigColor, relief: [2, picture] });
    drawBatches(gl, level.bark, level, used);
  }

  /** @param {DrawnKind} kind @param {DrawnLevel} level @param {number} density share of them */
  _drawLeaves(kind, level, density) {
    const { gl } = this;
    const used = this._programs.leaf;
    if (!level.leaf) return;
    const { species } = kind.placer.kind;
    const picture = this._picture(`leaves ${species} ${level.across} ${this.isAutumn}`, gl.CLAMP_TO_EDGE,
      () => leafPicture(species, level.across, this.isAutumn));
    use(gl, used, { leaves: [2, picture] });
    drawBatches(gl, level.leaf, level, used, density);
  }

  /** A picture that is painted when it is first used.
   * @param {string} name @param {number} wrap @param {() => import("./textures.js").Mips} paint */
  _picture(name, wrap, paint) {
    const { gl } = this;
    let texture = this._pictures.get(name);
    if (!texture) {
      texture = pictureTexture(gl, paint(), wrap, this.isSlow);
      this._pictures.set(name, texture);
    }
    return texture;
  }

  /** Rows of the first and the last segment of the branch that is picked. */
  _pickedRows() {
    const { detail, description, picked } = this;
    if (!detail || !description || picked < 0) return [-2, -2];
    const { kind } = description.trees[this._watched];
    const { placer } = this._kinds[kind];
    const { branch_first: first } = placer.kind.arrays;
    const start = detail.start[this._watched];
    return [start + placer.slots[first[picked]], start + placer.slots[first[picked + 1] - 1]];
  }

  /** The pot, somebody beside the tree, and the arrow of the wind.
   * @param {Float32Array} matrix @param {boolean} isShadow */
  _drawSolids(matrix, isShadow) {
    const { gl, _root: root, _parts: parts } = this;
    const used = this._programs.solid;
    this._begin(used, matrix, isShadow);
    const draw = (/** @type {Drawable} */ part, /** @type {number[]} */ placed, c = 1, s = 0) => {
      use(gl, used, { placed, heading: [c, s] });
      drawPart(gl, part);
    };
    if (this._potSize > 0) draw(parts.pot, [...root, this._potSize]);
    if (this.hasPerson && this._treeHeight > WITH_PERSON && !this._potSize) {
      // Beside it, as the camera first sees it.
      const away = 0.5 * Math.max(this._high[0] - this._low[0], this._high[1] - this._low[1]) + 0.5;
      const at = this.isCrowd ? [this._high[0] + 3, this._low[1] - 3]
        : [root[0] + 0.8 * away, root[1] + 0.66 * away];
      draw(parts.person, [...at, this._groundHeight, 1], Math.cos(-0.9), Math.sin(-0.9));
    }
    const [u, v] = this._calmWind;
    const speed = Math.hypot(u, v);
    if (speed > 0.2 && !isShadow) {
      const long = arrowLength(this._treeHeight, speed);
      const away = 0.42 * this._extent + long;
      draw(parts.arrow, [this._middle[0] - (u / speed) * away, this._middle[1] - (v / speed) * away,
        this._groundHeight + 0.01 * this._treeHeight, long], u / speed, v / speed);
    }
  }

  /** Whether the trees are a wood. */
  get isCrowd() {
    return (this.detail?.trees.length ?? 0) > CROWD;
  }

  /** @param {Float32Array} matrix */
  _drawShadow(matrix) {
    const { gl } = this;
    use(gl, this._programs.shadow, {
      camera: matrix, area: [...this._shadowMiddle, this._shadowHalf, this._groundHeight],
      softness: this.isSlow ? 0 : 1.5 / this._shadowSize, depth: 0.5, shadow: [1, this._shadow.texture],
    });
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.disable(gl.DEPTH_TEST);
    drawPart(gl, this._parts.shadow);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.activeTexture(gl.TEXTURE0);
  }

  /** Forget the trees. */
  _free() {
    const { gl } = this;
    for (const { drawn } of this._kinds) {
      for (const level of drawn) {
        level?.impostor?.free();
        for (const part of [level?.bark, level?.leaf]) if (part) discard(gl, part);
      }
    }
    for (const texture of this._pictures.values()) gl.deleteTexture(texture);
    this._pictures.clear();
    this._kinds = [];
  }

  /** @param {"bark" | "leaf"} name
   * @param {{values: number[], segments: number[], indices: number[], width: number}} mesh
   * @param {[string, number][]} fields @param {Int32Array} slots of the segments in a tree
   * @param {number} n how many trees may be drawn so @returns {Drawable} */
  _hung(name, mesh, fields, slots, n) {
    const { gl } = this;
    const used = this._programs[name];
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
      // Card after card, so that any first part is as much of every tree; wood tree after tree.
      const [each, apart] = name === "leaf" ? [copies, copy] : [1, copy * (indices.length / 6)];
      for (let i = 0; i < indices.length; i++) {
        corners[6 * (each * Math.floor(i / 6) + apart) + (i % 6)] = from + indices[i];
      }
    }
    const part = drawable(gl, used, all, fields, corners);
    const at = gl.getAttribLocation(used.program, "segment");
    part.buffers.push(filled(gl, gl.ARRAY_BUFFER, rows));
    gl.enableVertexAttribArray(at);
    gl.vertexAttribIPointer(at, 1, gl.UNSIGNED_INT, 0, 0);
    return { ...part, copies };
  }
}

/** Draw the trees of a level, a batch at a time.
 * @param {WebGL2RenderingContext} gl @param {Drawable} part @param {DrawnLevel} level
 * @param {Program} used @param {number} [share] of its triangles */
function drawBatches(gl, part, { starts, count }, used, share = 1) {
  for (let from = 0; from < count; from += part.copies) {
    used.uniforms.starts(starts.subarray(from, from + 4 * Math.ceil(part.copies / 4)));
    drawPart(gl, part, share);
  }
}

/** A texture that poses lie in.
 * @param {WebGL2RenderingContext} gl @param {WebGLTexture} texture @param {number} rows
 * @param {Float32Array | null} texels */
function poseTexture(gl, texture, rows, texels) {
  gl.bindTexture(gl.TEXTURE_2D, texture);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
    gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
  }
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, shaders.TEXTURE_WIDTH, rows, 0, gl.RGBA, gl.FLOAT,
    texels);
}

/** Vector of the rotation from one segment to another. @param {Float32Array} poses
 * @param {number} from row of its pose @param {number} to */
function apart(poses, from, to) {
  const [w, ...vector] = multiply(conjugate(quaternion(poses, from)), quaternion(poses, to));
  return vector.map((each) => (w < 0 ? -each : each));
}
