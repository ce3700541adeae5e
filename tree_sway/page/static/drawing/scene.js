// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Draws a described tree from its poses: bark, leaves, what is beside it, ground and sky. */

import { AT_ORIGIN, STRIDE } from "../placing.js";
import { between } from "../quaternions.js";
import { Backdrop, DAYLIGHT, GROUNDS } from "./backdrop.js";
import { Camera } from "./camera.js";
import { Detail, levelsOf } from "./detail.js";
import { canvasTexture, contextOf, discard, drawable, drawPart, pictureTexture, poseTexture, use } from "./gl.js";
import { Impostor } from "./impostors.js";
import { barkMesh, leafMesh, shapeOf } from "./mesh.js";
import { arrowLength, arrowMesh, propMesh } from "./props.js";
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
/** The arrow follows the mean of the wind over this time [s]. */
const CALM = 4;
/** Height that the picture of a far tree is painted for [px]. */
const PAINTED = 260;

/** @type {Record<"bark" | "leaf" | "solid", [string, number][]>} what a vertex has */
const FIELDS = {
  bark: [["segment", 1], ["ring", 4], ["skin", 3]],
  leaf: [["segment", 1], ["place", 3], ["swing", 3], ["facing", 3], ["towards", 3], ["flutter", 4], ["corner", 2]],
  solid: [["at", 3], ["facing", 3], ["tint", 3]],
};

export class Scene {
  /** @param {HTMLCanvasElement} canvas
   * @param {boolean} [isFine] whether nothing is left out, however slow that is */
  constructor(canvas, isFine = false) {
    const { gl, isSoftware } = contextOf(canvas);
    /** Without a graphics unit: fewer points, fewer shadows. */
    this.isSlow = isSoftware && !isFine;
    this.gl = gl;
    this.canvas = canvas;
    this.camera = new Camera();
    this.day = DAYLIGHT.light;
    this.isAutumn = false;
    /** @type {Detail | null} */
    this.detail = null;
    /** @type {DrawnKind[]} */
    this._kinds = [];
    /** Tree whose tip is followed. */
    this._watched = 0;
    this._budget = 0;
    this._chosenFor = "";
    /** @type {Description | null} */
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
    this._texture = gl.createTexture();
    /** Where the shaders look poses up. */
    this._poses = this._texture;
    /** Poses of the segments that are drawn, tree after tree. */
    this._texels = new Float32Array(0);
    /** @type {Float32Array} */
    this._coordinates = new Float32Array(0);
    const [arrow, pot, person] = [arrowMesh(), propMesh("pot"), propMesh("person")].map((mesh) =>
      drawable(gl, this._programs.solid, mesh.values, FIELDS.solid, mesh.indices));
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
    this._extent = 1;
    this._treeHeight = 1;
    this._potSize = 0;
  }

  /** @returns {number[]} unit vector towards the sun */
  get light() {
    return this.day.light.map((each) => each / Math.hypot(...this.day.light));
  }

  /** Height of the ground [m], and of the highest tree. */
  get ground() {
    return this._groundHeight;
  }

  get height() {
    return this._treeHeight;
  }

  /** Whether any tree of the scene bears leaves. */
  get hasLeaves() {
    return Boolean(this.description?.kinds.some((kind) => kind.arrays.leaf_segment?.length));
  }

  /** Another time of day. @param {Daylight} day */
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

  /** Take another tree. @param {Description} description */
  describe(description) {
    const { kinds, trees } = description;
    const isSame = this.description?.name === description.name;
    const most = !this.isSlow ? MOST : trees.length > CROWD ? MOST_CROWD : MOST_SLOW;
    this._free();
    this.resize();
    this.description = description;
    this._coordinates = new Float32Array(description.nCoordinates);
    this._kinds = kinds.map((kind) => ({ ...shapeOf(kind), drawn: [] }));
    const levels = this._kinds.map(({ placer, highest }) => levelsOf(placer, highest, most));
    const radii = this._kinds.map(({ low, high }) => 0.6 * Math.hypot(...low.map((l, c) => high[c] - l)));
    const tops = trees.map(({ kind, place }) => place[2] + place[4] * this._kinds[kind].high[2]);
    this._watched = tops.reduce((best, top, t) => (top > tops[best] ? t : best), 0);
    this._low = [Infinity, Infinity, Infinity];
    this._high = [-Infinity, -Infinity, -Infinity];
    for (const { kind, place } of trees) {
      const { low, high } = this._kinds[kind];
      for (let corner = 0; corner < 8; corner++) {
        const at = placed(place, [0, 1, 2].map((c) => (corner & (1 << c) ? high[c] : low[c])));
        this._low = this._low.map((each, c) => Math.min(each, at[c]));
        this._high = this._high.map((each, c) => Math.max(each, at[c]));
      }
    }
    this.detail = new Detail(trees, levels, radii, this._watched);
    this._budget = most.segments + most.cards;
    if (!isSame) this.picked = -1;
    const [wide, deep, tall] = this._high.map((each, c) => each - this._low[c]);
    this._extent = Math.max(wide, deep, tall, 0.05);
    this._treeHeight = Math.max(tall, 0.2 * wide, 0.2 * deep, 0.05);
    const { place: root } = trees[0];
    this._potSize = trees.length === 1 && isPotted(kinds[0].species) ? POT_HEIGHT * this._treeHeight : 0;
    this._groundHeight = this._potSize ? root[2] - this._potSize : Math.min(this._low[2], root[2]);
    this._frameShadow();
    if (!isSame) this.camera.frame([this._low[0], this._low[1], this._groundHeight], this._high);
    this._frame = 0;
    this._chosenFor = "";
    this._chooseDetail(this.camera.update());
    this._place();
  }

  /** Where the tip of the branch that is picked is now, or the top of the tallest tree. */
  tip() {
    return this.position(this._followed);
  }

  /** The same at rest. */
  restTip() {
    return this.restPosition(this._followed);
  }

  /** Where a segment's root-side node is at rest. @param {number} segment */
  restPosition(segment) {
    if (!this.description) return [0, 0, 0];
    const { rest, place } = this.watched;
    return placed(place, rest.subarray(STRIDE * segment));
  }

  /** The tree that is followed: what it is, where it is, and its kind's poses at rest. */
  get watched() {
    const { kind: number, ...tree } = /** @type {Detail} */ (this.detail).trees[this._watched];
    const { kind, rest } = this._kinds[number];
    return { ...tree, number: this._watched, kind, rest };
  }

  /** Where a segment's root-side node is now; of the tallest tree, if it is drawn.
   * @param {number} segment */
  position(segment) {
    const from = STRIDE * this._row(segment);
    return Array.from(this._texels.subarray(from, from + 3));
  }

  /** Row of a segment of the watched tree. @param {number} segment */
  _row(segment) {
    if (!this.detail || !this.description) return 0;
    const { slots } = this._kinds[this.description.trees[this._watched].kind].placer;
    return this.detail.start[this._watched] + slots[segment];
  }

  /** The kind of the watched tree. @returns {Kind | null} */
  get watchedKind() {
    return this.description?.kinds[this.description.trees[this._watched].kind] ?? null;
  }

  /** The branch of the watched tree nearest to a place of the picture; -1 if none is near.
   * @param {number} x 0 to 1 from the left @param {number} y from the top
   * @param {number} [reach] share of the height */
  branchAt(x, y, reach = 0.03) {
    return this.nearest(x, y, reach).branch;
  }

  /** The same, and which of its segments it is. @param {number} x @param {number} y
   * @param {number} [reach] */
  nearest(x, y, reach = 0.03) {
    let [best, found] = [reach, { branch: -1, segment: -1 }];
    if (!this.detail || !this.description) return found;
    const { kind } = this.description.trees[this._watched];
    const { branches } = this.detail.levels[kind][this.detail.level[this._watched]];
    const { placer: { order }, kind: { arrays: { branch_first: first } } } = this._kinds[kind];
    for (const branch of order.subarray(0, branches)) {
      for (let s = first[branch]; s < first[branch + 1]; s++) {
        const [px, py] = this.camera.project(this.position(s));
        const away = Math.hypot((px - x) * this.camera.aspect, py - y);
        if (away < best) [best, found] = [away, { branch, segment: s }];
      }
    }
    return found;
  }

  /** The last segment of the branch that is picked, or the highest. */
  get _followed() {
    const { description, picked, watchedKind } = this;
    if (watchedKind && picked >= 0) return watchedKind.arrays.branch_first[picked + 1] - 1;
    return description ? this._kinds[description.trees[this._watched].kind].highest : 0;
  }

  /** At the base of the branch that is picked, or of the stem: further strain of the outer wood, and
   * further bending moment [N m], by the bend between the first two segments. */
  load() {
    const { description, watchedKind: kind } = this;
    if (!description || !kind) return { strain: 0, moment: 0 };
    const { kind: number, place } = description.trees[this._watched];
    const { branch_first: first, segment_length: length, segment_radius: radius } = kind.arrays;
    const base = first[Math.max(0, this.picked)];
    if (first[Math.max(0, this.picked) + 1] - base < 2) return { strain: 0, moment: 0 };
    const bendOf = (/** @type {Float32Array} */ poses, /** @type {number[]} */ [from, to]) =>
      between(poses, STRIDE * from + 4, poses, STRIDE * to + 4);
    const now = bendOf(this._texels, [this._row(base), this._row(base + 1)]);
    const before = bendOf(this._kinds[number].rest, [base, base + 1]);
    const bend = 2 * Math.hypot(...[0, 1, 2].map((c) => Math.sign(now[3]) * now[c] - Math.sign(before[3]) * before[c]));
    const thick = radius[2 * (base + 1)];
    const strain = (bend * thick) / (0.5 * (length[base] + length[base + 1]));
    return { strain, moment: 0.25 * Math.PI * (kind.modulus ?? 0) * (place[4] * thick) ** 3 * strain };
  }

  /** Choose what of each tree is drawn, where the camera or the picture is another than before.
   * @param {Float32Array} matrix */
  _chooseDetail(matrix) {
    const { gl, detail } = this;
    const wanted = [...matrix, this.canvas.clientHeight].join();
    if (!detail || wanted === this._chosenFor) return;
    this._chosenFor = wanted;
    detail.choose(matrix, this.canvas.clientHeight, this._budget);
    this._eachLevel((level) => {
      level.starts.length = 0;
      if (level.impostor) level.impostor.count = 0;
    });
    // Near trees first: what they hide costs less then.
    for (const t of detail.order) {
      if (detail.level[t] < 0) continue;
      const { kind, place } = detail.trees[t];
      const level = (this._kinds[kind].drawn[detail.level[t]] ??= this._levelOf(kind, detail.level[t]));
      level.starts.push(detail.start[t]);
      level.impostor?.add(place, detail.start[t], t);
    }
    this._eachLevel((level) => level.impostor?.upload());
    const rows = Math.ceil((2 * detail.segments) / shaders.TEXTURE_WIDTH);
    if (4 * shaders.TEXTURE_WIDTH * rows <= this._texels.length) return;
    this._texels = new Float32Array(4 * shaders.TEXTURE_WIDTH * Math.ceil(1.25 * rows));
    poseTexture(gl, this._texture, shaders.TEXTURE_WIDTH, this._texels);
  }

  /** A level of a kind, when it is first used.
   * @param {number} number of the kind @param {number} level @returns {DrawnLevel} */
  _levelOf(number, level) {
    const { gl, _programs: programs } = this;
    const { levels, trees } = /** @type {Detail} */ (this.detail);
    const shape = this._kinds[number];
    const none = { starts: [], bark: null, leaf: null, across: 1, impostor: null };
    if (level === 0) return { ...none, impostor: this._bake(number, trees.filter(({ kind }) => kind === number).length) };
    const wanted = levels[number][level];
    const branches = shape.placer.order.slice(0, wanted.branches);
    const bark = barkMesh(shape, branches, wanted.pixels);
    const { mesh: leaf, across } = leafMesh(shape, branches, wanted.cards, levels[number][levels[number].length - 1].cards);
    return {
      ...none, across,
      bark: drawable(gl, programs.bark, bark.values, FIELDS.bark, bark.indices),
      leaf: leaf.indices.length ? drawable(gl, programs.leaf, leaf.values, FIELDS.leaf, leaf.indices) : null,
    };
  }

  /** Paint the picture of a kind that far trees are drawn by: a tree at rest in even light.
   * @param {number} number of the kind @param {number} most how many trees */
  _bake(number, most) {
    const { gl, _programs: { bark, leaf } } = this;
    const shape = this._kinds[number];
    const levels = /** @type {Detail} */ (this.detail).levels[number];
    const finest = Math.max(1, levels.findIndex(({ pixels }) => pixels >= PAINTED));
    const level = { ...(shape.drawn[finest] ??= this._levelOf(number, finest)), starts: [0] };
    const impostor = new Impostor(gl, this._programs.impostor, shape, most, this.isSlow);
    const rows = Math.ceil((2 * levels[finest].segments) / shaders.TEXTURE_WIDTH);
    const texels = new Float32Array(4 * shaders.TEXTURE_WIDTH * rows);
    const still = new Float32Array(shape.kind.nCoordinates);
    shape.placer.place(still, 0, AT_ORIGIN, levels[finest].branches, texels, 0);
    this._poses = gl.createTexture();
    poseTexture(gl, this._poses, shaders.TEXTURE_WIDTH, texels);
    impostor.bake((camera, eye) => {
      const even = { eye, sun: [0, 0, 0], sky: [1.1, 1.1, 1.1], haze: 0 };
      this._begin(bark, camera, false, { ...even, picked: [-2, -2] });
      this._drawBark(shape, level);
      this._begin(leaf, camera, false, { ...even, isBaked: 1, speed: 0, law: [0, 1] });
      if (this.leavesShown) this._drawLeaves(shape, level, 1);
    }, lookOf(shape.kind.species).leaf);
    gl.deleteTexture(this._poses);
    this._poses = this._texture;
    return impostor;
  }

  /** Place what is drawn of each tree. */
  _place() {
    const { detail, _coordinates: values, _texels: texels } = this;
    detail?.trees.forEach(({ kind, firstCoordinate, place }, t) => {
      const level = detail.level[t];
      const { drawn, placer } = this._kinds[kind];
      if (level > 0) {
        placer.place(values, firstCoordinate, place, detail.levels[kind][level].branches, texels, detail.start[t]);
      } else if (level === 0) drawn[0].impostor?.place(values, firstCoordinate, place, texels, detail.start[t]);
    });
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
   * @param {number} time [s] @param {boolean} isPaused nothing of the picture changes then
   * @param {View[]} [views] of a headset, in place of the picture's own */
  draw(coordinates, time, isPaused, views) {
    if (!views) this.resize();
    const matrix = (views?.[0].camera ?? this.camera).update();
    if (this._frame % CHOOSE_EVERY === 0) this._chooseDetail(matrix);
    if (coordinates && coordinates.length === this._coordinates.length) this._coordinates = coordinates;
    this._place();
    this._upload();
    const passed = Math.min(0.1, Math.abs(time - this._time));
    this._time = time;
    for (const c of [0, 1]) this._calmWind[c] += (passed / CALM) * (this.wind[c] - this._calmWind[c]);
    // The eye takes a shadow that is some frames old for one that is not.
    const every = this.isSlow ? (this.isCrowd ? 3 : 1) * SHADOW_EVERY : 1;
    if (this.detail && this._frame % every === 0) this._castShadow(matrix);
    if (this.isSlow && !isPaused) this.quality.count(performance.now(), this._hasCards);
    this._frame++;
    const own = this.camera;
    const area = [0, 0, this.canvas.width, this.canvas.height];
    for (const view of views ?? [{ camera: own, target: null, area }]) this._paint(view, !views);
    this.camera = own;
  }

  /** Draw what one eye sees. @param {View} view @param {boolean} isOwn whether it may be still */
  _paint({ camera, target, area: [x, y, width, height] }, isOwn) {
    const { gl } = this;
    this.camera = /** @type {Camera} */ (camera);
    const matrix = camera.update();
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.viewport(x, y, width, height);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this._backdrop.draw(this.camera, this.day, this._ground, isOwn ? width : 0, height);
    gl.enable(gl.DEPTH_TEST);
    if (!this.detail) return;
    this._drawShadow(matrix);
    this._drawTrees(matrix, false);
    this._drawSolids(matrix, false);
  }

  /** Whether so many trees are drawn with leaves that some may be left out; far ones are pictures. */
  get _hasCards() {
    const drawn = this.detail?.level.filter((level) => level > 0).length ?? 0;
    return this.hasLeaves && this.leavesShown && (drawn > 1 || !this.isCrowd);
  }

  /** The ground of the scene, and one over how far one sees [1/m]. */
  get _ground() {
    const kind = this._potSize > 0 || !this.detail ? GROUNDS.terrace : GROUNDS.meadow;
    const haze = 1 / (this._potSize > 0 ? 30 * this._treeHeight : Math.max(1500, 30 * this._extent));
    return { kind, height: this._groundHeight, haze };
  }

  _upload() {
    const { gl } = this;
    const rows = Math.ceil((2 * (this.detail?.segments ?? 0)) / shaders.TEXTURE_WIDTH);
    if (!rows) return;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this._texture);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, shaders.TEXTURE_WIDTH, rows, gl.RGBA, gl.FLOAT, this._texels);
  }

  /** @param {Float32Array} matrix */
  _castShadow(matrix) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this._shadow.target);
    gl.viewport(0, 0, this._shadowSize, this._shadowSize);
    gl.clearColor(0, 0, 0, 1);
    gl.disable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT);
    this._drawTrees(matrix, true);
    this._drawSolids(matrix, true);
  }

  /** @param {Program} used @param {Float32Array} camera @param {boolean} isShadow
   * @param {Record<string, any>} [own] what it is given beside the usual */
  _begin(used, camera, isShadow, own = {}) {
    const shadowArea = [...this._shadowMiddle, 1 / this._shadowHalf, Number(isShadow)];
    const { height: ground, haze } = this._ground;
    use(this.gl, used, {
      ...this.day, camera, light: this.light, eye: this.camera.eye, haze, ground,
      isShadow: Number(isShadow), shadowArea, poses: [0, this._poses], ...own,
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

  /** @param {Float32Array} matrix @param {boolean} isShadow */
  _drawTrees(matrix, isShadow) {
    const law = this.description?.flutter ?? { gain: 0, largest_angle: 1 };
    const { bark, leaf, impostor } = this._programs;
    this._begin(bark, matrix, isShadow, { picked: this._pickedRows() });
    this._eachLevel((level, kind) => this._drawBark(kind, level));
    if (this.leavesShown) {
      this._begin(leaf, matrix, isShadow, {
        isBaked: 0, time: this._time % 1000, speed: Math.hypot(...this.wind),
        law: [this.flutters ? law.gain : 0, law.largest_angle],
      });
      const density = this.isSlow ? this.quality.density * (isShadow ? SHADOW_LEAVES : 1) : 1;
      this._eachLevel((level, kind) => this._drawLeaves(kind, level, density));
    }
    this._begin(impostor, matrix, isShadow);
    this._eachLevel((level) => level.impostor?.draw(impostor, this.isCrowd ? 0.35 : 0.9));
  }

  /** @param {(level: DrawnLevel, kind: DrawnKind) => void} draw */
  _eachLevel(draw) {
    for (const kind of this._kinds) kind.drawn.forEach((level) => draw(level, kind));
  }

  /** @param {DrawnKind} kind @param {DrawnLevel} level */
  _drawBark({ kind: { species } }, { bark, starts }) {
    const used = this._programs.bark;
    if (!bark) return;
    const { bark: barkColor, twig: twigColor, pattern } = lookOf(species);
    const picture = this._picture(`bark ${pattern}`, this.gl.REPEAT, () => barkPicture(pattern));
    use(this.gl, used, { barkColor, twigColor, relief: [2, picture] });
    this._drawEach(bark, used, starts, 1);
  }

  /** @param {DrawnKind} kind @param {DrawnLevel} level @param {number} density share of them */
  _drawLeaves({ kind: { species } }, { leaf, starts, across }, density) {
    const used = this._programs.leaf;
    if (!leaf) return;
    const picture = this._picture(`leaves ${species} ${across} ${this.isAutumn}`, this.gl.CLAMP_TO_EDGE,
      () => leafPicture(species, across, this.isAutumn));
    use(this.gl, used, { leaves: [2, picture] });
    this._drawEach(leaf, used, starts, density);
  }

  /** Draw a part of each tree of a level. @param {Drawable} part @param {Program} used
   * @param {number[]} starts rows of their first segments @param {number} share of its triangles */
  _drawEach(part, used, starts, share) {
    for (const start of starts) {
      used.uniforms.start(start);
      drawPart(this.gl, part, share);
    }
  }

  /** A picture that is painted when it is first used.
   * @param {string} name @param {number} wrap @param {() => ImageData[]} paint */
  _picture(name, wrap, paint) {
    const known = this._pictures.get(name) ?? pictureTexture(this.gl, paint(), wrap, this.isSlow);
    this._pictures.set(name, known);
    return known;
  }

  /** Rows of the first and the last segment of the branch that is picked. */
  _pickedRows() {
    const { watchedKind, picked } = this;
    if (!watchedKind || picked < 0) return [-2, -2];
    const { branch_first: first } = watchedKind.arrays;
    return [this._row(first[picked]), this._row(first[picked + 1] - 1)];
  }

  /** The pot, somebody beside the tree, and the arrow of the wind.
   * @param {Float32Array} matrix @param {boolean} isShadow */
  _drawSolids(matrix, isShadow) {
    const { gl, _low: low, _high: high, _parts: parts } = this;
    const [x, y, z] = this.detail?.trees[0].place ?? AT_ORIGIN;
    const used = this._programs.solid;
    this._begin(used, matrix, isShadow);
    const draw = (/** @type {Drawable} */ part, /** @type {number[]} */ where, c = 1, s = 0) => {
      use(gl, used, { placed: where, heading: [c, s] });
      drawPart(gl, part);
    };
    if (this._potSize > 0) draw(parts.pot, [x, y, z, this._potSize]);
    if (this.hasPerson && this._treeHeight > WITH_PERSON && !this._potSize) {
      // Beside it, as the camera first sees it.
      const away = 0.5 * Math.max(high[0] - low[0], high[1] - low[1]) + 0.5;
      const at = this.isCrowd ? [high[0] + 3, low[1] - 3] : [x + 0.8 * away, y + 0.66 * away];
      draw(parts.person, [...at, this._groundHeight, 1], Math.cos(-0.9), Math.sin(-0.9));
    }
    const [u, v] = this._calmWind;
    const speed = Math.hypot(u, v);
    if (speed > 0.2 && !isShadow) {
      const long = arrowLength(this._treeHeight, speed);
      const away = 0.42 * this._extent + long;
      draw(parts.arrow, [0.5 * (low[0] + high[0]) - (u / speed) * away, 0.5 * (low[1] + high[1]) - (v / speed) * away,
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
    this._eachLevel(({ impostor, bark, leaf }) => {
      impostor?.free();
      for (const part of [bark, leaf]) if (part) discard(this.gl, part);
    });
    for (const texture of this._pictures.values()) this.gl.deleteTexture(texture);
    this._pictures.clear();
    this._kinds = [];
  }
}

/** Where a point of a kind at rest is in a tree that has its place. @param {number[]} place
 * @param {ArrayLike<number>} point */
function placed([x, y, z, yaw, scale], point) {
  const [c, s] = [scale * Math.cos(yaw), scale * Math.sin(yaw)];
  return [x + c * point[0] - s * point[1], y + s * point[0] + c * point[1], z + scale * point[2]];
}
