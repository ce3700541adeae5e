// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Draws a described scene: places its trees, then draws bark, leaves, pot and person, ground and sky. A kind of tree
 * has several levels of detail (`Detail`); far trees are pictures (`Impostor`). */

import { AT_ORIGIN, beyond, placed, STRIDE } from "../placing.js";
import { between, distance } from "../quaternions.js";
import { Backdrop, DAYLIGHT } from "./backdrop.js";
import { Camera } from "./camera.js";
import { BUDGETS, Detail, levelsOf } from "./detail.js";
import {
  canvasTexture, chosenTexture, contextOf, depthTexture, discard, drawable, drawPart, pictureTexture, program, texelsOf, textureOf,
  uploadPoses, use,
} from "./gl.js";
import { Grass } from "./grass.js";
import { Impostor } from "./impostors.js";
import { leafMesh } from "./foliage.js";
import { barkMesh, boxOf, shapeOf } from "./mesh.js";
import { arrow, arrowLength, propMesh } from "./props.js";
import { COARSEST, Quality } from "./quality.js";
import { feet, hangs, lookOf } from "./looks.js";
import { barkPicture, leafPicture } from "./textures.js";

/** Frames from one shadow to the next without a graphics unit; and the share of the leaves that cast it, with one and without. */
const [SHADOW_EVERY, SHADOW_LEAVES] = [8, [0.22, 0.25]];
/** Number of trees above which a scene counts as a crowd. */
const CROWD = 50;
/** Cost of a card over that of a segment, which the processor places for each frame. */
const CARD = 0.12;
/** Frames from one choice of levels to the next while the camera moves. */
const CHOOSE_EVERY = 6;
/** Largest angle between a branch and the pointer that picks it [rad]. */
const REACH = 0.017;
/** Height of a pot over that of its tree; height of a tree from which on a person stands beside it [m]. */
const [POT_HEIGHT, WITH_PERSON] = [0.17, 2.5];
/** Time over which the arrow averages the wind [s]. */
const CALM = 4;
/** Height for which the picture of a far tree is painted [px]. */
const PAINTED = 260;
/** Width of a picture from one side where there are few kinds, and where there are more, as pictures take memory [px]. */
const [TILES, FEW_KINDS] = [[192, 128], 16];
/** Specular reflection of a leathery evergreen leaf, and of a card of many leaves, which face all ways. */
const [GLOSS, GLOSS_OF_MANY] = [0.2, 0.03];
/** Colour of a crown of leaves or of needles in the open, over its green; where a leaf is more vivid it is
 * half-way between, and less bright or dark. */
const OPEN_GREENS = [[0.82, 1, 0.6], [0.84, 1, 0.62]];
/** First and last row of no branch. */
const NONE = [-2, -2];
/** Months in which a horse chestnut flowers, from 1. */
const FLOWERING = [5.2, 6.2];
/** Shrubs about a tree of a stand, by their distance. */
const SHRUBS = [0.7, 1, 1.3];
/** Paint of a tree in its own colours. */
const UNPAINTED = [0, 0, 0, 0];

export class Scene {
  /** @param {HTMLCanvasElement} canvas @param {boolean} [isFine] leave nothing out, even if it is slow */
  constructor(canvas, isFine = false) {
    const { gl, isSlow } = contextOf(canvas, isFine);
    /** Whether to save points and shadows, without a graphics unit. */
    this.isSlow = isSlow;
    this.gl = gl;
    this.canvas = canvas;
    this.camera = new Camera();
    this.quality = new Quality();
    this.day = DAYLIGHT.light;
    this.isAutumn = false;
    this.isFlowering = false;
    this.leavesShown = true;
    this.hasPerson = true;
    /** Whether an arrow shows the wind. */
    this.hasArrow = true;
    /** Whether leaves flutter; off if the browser asks for reduced motion. */
    this.flutters = true;
    /** Colour of each tree and its opacity, by the number of the tree. @type {number[][]} */
    this._paints = [];
    /** Branch of the watched tree that is highlighted; none if -1. */
    this.picked = -1;
    /** @type {Vector} */
    this.wind = [0, 0, 0];
    this._calmWind = [0, 0];
    this._time = 0;
    this._frame = 0;
    this.description = /** @type {Description | null} */ (null);
    this.detail = new Detail([], [], [], 0);
    this._kinds = /** @type {DrawnKind[]} */ ([]);
    this._budget = 0;
    this._chosenFor = "";
    const names = /** @type {const} */ (["bark", "leaf", "impostor", "solid", "shadow", "grass"]);
    this._programs = /** @type {Record<typeof names[number], Program>} */ (
      Object.fromEntries(names.map((name) => [name, program(gl, name, this.isSlow)])));
    this.grass = new Grass(gl, this._programs.grass, this.isSlow);
    this._backdrop = new Backdrop(gl, this.isSlow);
    /** Textures of leaves and bark, painted when they are first used. */
    this._pictures = /** @type {Map<string, WebGLTexture>} */ (new Map());
    this._texture = textureOf(gl, gl.NEAREST, gl.NEAREST);
    /** Texture from which the shaders read poses. */
    this._poses = this._texture;
    /** Poses of the drawn segments, tree after tree. */
    this._texels = new Float32Array(0);
    this._coordinates = /** @type {Float32Array} */ (new Float32Array(0));
    const square = { values: [-1, -1, 1, -1, 1, 1, -1, 1], indices: [0, 1, 2, 0, 2, 3] };
    const { solid, shadow } = this._programs;
    const [pot, person] = [propMesh("pot"), propMesh("person")].map((mesh) => drawable(gl, solid, mesh));
    this._parts = { arrow: drawable(gl, solid, arrow), pot, person, shadow: drawable(gl, shadow, square) };
    const size = this.isSlow ? 256 : 1024;
    this._shadow = canvasTexture(gl, size, size, gl.R8);
    /** Depths as seen from the sun, by which trees shade themselves. */
    this._sunMap = depthTexture(gl, size);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this._sunMap, 0);
    /** The same without any shadow, used while the real one is drawn. */
    this._noMap = depthTexture(gl, 1);
    const bare = canvasTexture(gl, 1, 1, gl.R8);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this._noMap, 0);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    bare.release();
    /** Ground that the shadow covers: middle x, y and half its size [m]. */
    this._shadowArea = [0, 0, 1];
    /** Height of the ground [m], and of the highest tree. */
    this.ground = 0;
    this.height = 1;
    this._low = [0, 0, 0];
    this._high = [1, 1, 1];
    this._extent = 1;
    this._potSize = 0;
    this._under = /** @type {Ground} */ ({ kind: 0, ground: 0, haze: 0, stem: [0, 0, 0, 0] });
  }

  get hasLeaves() {
    return Boolean(this.description?.kinds.some((kind) => kind.arrays.leaf_segment?.length));
  }

  /** Show or hide leaves, and change their season; all pictures are painted again.
   * @param {{leavesShown?: boolean, isAutumn?: boolean, isFlowering?: boolean}} leaves */
  dress(leaves) {
    Object.assign(this, leaves);
    if (this.description) this.describe(this.description);
  }

  /** Show the flowers of a month. @param {number} month from 1, with its fraction */
  flower(month) {
    const isFlowering = month >= FLOWERING[0] && month < FLOWERING[1];
    if (isFlowering !== this.isFlowering) this.dress({ isFlowering });
  }

  /** Take another description. @param {Description} description */
  describe(description) {
    const { kinds, trees } = description;
    const isSame = this.description?.name === description.name;
    const most = BUDGETS[+this.isSlow][+(trees.length > CROWD)];
    for (const { impostor, bark, leaf } of this._levels) {
      impostor?.free();
      for (const part of [bark, leaf]) discard(this.gl, part);
    }
    for (const texture of this._pictures.values()) this.gl.deleteTexture(texture);
    this._pictures.clear();
    this.resize();
    this.description = description;
    this._coordinates = new Float32Array(description.nCoordinates);
    this._kinds = kinds.map((kind) => ({ ...shapeOf(kind), drawn: [] }));
    const levels = this._kinds.map(({ placer, highest }) => levelsOf(placer, highest, most));
    const radii = this._kinds.map(({ low, high }) => 0.6 * Math.hypot(...low.map((l, c) => high[c] - l)));
    const tops = trees.map(({ kind, place }) => place[2] + place[4] * this._kinds[kind].high[2]);
    this.detail = new Detail(trees, levels, radii, tops.indexOf(tops.reduce((a, b) => Math.max(a, b))), this.isSlow ? 1 : CARD);
    this._budget = most.all;
    const corners = trees.flatMap(({ kind, place }) => Array.from({ length: 8 }, (_, corner) => {
      const { low, high } = this._kinds[kind];
      return placed(place, low.map((each, c) => (corner & (1 << c) ? high[c] : each)));
    }));
    [this._low, this._high] = boxOf(corners);
    const [wide, deep, tall] = this._high.map((each, c) => each - this._low[c]);
    this._extent = Math.max(wide, deep, tall, 0.05);
    this.height = Math.max(tall, 0.2 * wide, 0.2 * deep, 0.05);
    const { place: root } = trees[0];
    this._potSize = trees.length === 1 && lookOf(kinds[0]).is_potted ? POT_HEIGHT * this.height : 0;
    this.ground = this._potSize ? root[2] - this._potSize : Math.min(this._low[2], root[2]);
    const [kind, haze] = this._potSize ? [0, 1 / (350 * this.height)] : [1, 1 / Math.max(1500, 30 * this._extent)];
    this._under = { kind, ground: this.ground, haze, stem: [root[0], root[1], 2 / wide, 1 / (0.02 * tall + 0.4 * this._potSize)] };
    if (!isSame) {
      this.picked = -1;
      this.camera.home([[this._low[0], this._low[1], this.ground], this._high]);
    }
    this._frame = 0;
    this._chosenFor = "";
    this._chooseDetail();
    this._place();
  }

  /** Paint whole trees. @param {number[][]} paints colour and opacity of each tree; empty for their own colours */
  paint(paints) {
    this._paints = paints;
    this._chosenFor = "";
    this._frame = 0;
  }

  /** The tree that is followed: its number, place and kind; empty before the first description. */
  get watched() {
    const { trees, watched: number } = this.detail;
    return { ...trees[number], ...this._kinds[trees[number]?.kind], number };
  }

  /** Place of the root-side end of a segment of the watched tree at rest. @param {number} segment */
  restPosition(segment = this.followed) {
    const { rest, place } = this.watched;
    return placed(place, rest.subarray(STRIDE * segment));
  }

  /** The same now, if it is drawn. @param {number} segment */
  position(segment = this.followed) {
    const from = STRIDE * this._row(segment);
    return Array.from(this._texels.subarray(from, from + 3));
  }

  /** Row of a segment of the watched tree. @param {number} segment */
  _row(segment) {
    return this.detail.start[this.detail.watched] + this.watched.placer.slots[segment];
  }

  /** Place of a pointer in the picture, 0 to 1 from the left and from the top. @param {MouseEvent} event */
  placeOf({ clientX, clientY }) {
    return [clientX / this.canvas.clientWidth, clientY / this.canvas.clientHeight];
  }

  /** Branch of the watched tree nearest to a ray, its segment and their distance from the eye [m]; -1 if none is
   * near. @param {number[]} from @param {number[]} along @param {number} [most] angle [rad] */
  nearest(from, along, most = REACH) {
    let [best, found] = [Math.cos(most) * Math.hypot(...along), { branch: -1, segment: -1, far: 0 }];
    const { placer: { order }, number, kind: { arrays: { branch_first: first } } } = this.watched;
    for (const branch of order.subarray(0, this.detail.levelOf(number).branches)) {
      for (let segment = first[branch]; segment < first[branch + 1]; segment++) {
        const at = this.position(segment);
        const far = distance(at, from);
        const cosine = at.reduce((sum, each, c) => sum + (each - from[c]) * along[c], 0) / far;
        if (cosine > best) [best, found] = [cosine, { branch, segment, far }];
      }
    }
    return found;
  }

  /** The same under a pointer. @param {MouseEvent} event */
  under(event) {
    return this.nearest(this.camera.eye, this.camera.ray(this.placeOf(event)));
  }

  /** The last segment of the picked branch if it is drawn, else the highest segment. */
  get followed() {
    const { kind, highest, number, placer: { slots } } = this.watched;
    const last = kind.arrays.branch_first[this.picked + 1] - 1;
    return this.picked >= 0 && slots[last] < this.detail.levelOf(number).segments ? last : highest;
  }

  /** Strain of the outer wood and bending moment [N m] at the base of the picked branch or the stem, beyond those at
   * rest, from the bend between its first two segments. */
  load() {
    const { kind, rest, place } = this.watched;
    const { branch_first: first, segment_length: length, segment_radius: radius } = kind.arrays;
    const branch = Math.max(0, this.picked);
    const base = first[branch];
    if (first[branch + 1] - base < 2) return { strain: 0, moment: 0 };
    const [now, before] = [this._texels, rest].map((poses) => {
      const [a, b] = [base, base + 1].map((s) => STRIDE * (poses === rest ? s : this._row(s)) + 4);
      return between(poses, a, poses, b);
    });
    const bends = [0, 1, 2].map((c) => Math.sign(now[3]) * now[c] - Math.sign(before[3]) * before[c]);
    const thick = radius[2 * (base + 1)];
    const strain = (4 * Math.hypot(...bends) * thick) / (length[base] + length[base + 1]);
    return { strain, moment: 0.25 * Math.PI * (kind.modulus ?? 0) * (place[4] * thick) ** 3 * strain };
  }

  /** Choose the level of each tree if the camera or the size of the picture has changed. */
  _chooseDetail() {
    const { detail, camera, canvas: { clientHeight: high } } = this;
    const wanted = [...camera.update(), high].join();
    if (wanted === this._chosenFor) return;
    this._chosenFor = wanted;
    detail.choose(camera.matrix, high, this._budget);
    for (const { starts, numbers, impostor } of this._levels) {
      starts.length = numbers.length = 0;
      if (impostor) impostor.count = 0;
    }
    // Near trees first, since what they hide then costs less.
    for (const t of detail.order) {
      if (detail.level[t] < 0) continue;
      const { kind, place } = detail.trees[t];
      const level = (this._kinds[kind].drawn[detail.level[t]] ??= this._drawnLevel(kind, detail.level[t]));
      level.starts.push(detail.start[t]);
      level.numbers.push(t);
      level.impostor?.add(place, detail.start[t], t, this._paints[t] ?? UNPAINTED);
    }
    if (this.isCrowd && !this.isSlow) this._plantShrubs();
    for (const { impostor } of this._levels) impostor?.upload();
    if (STRIDE * detail.segments > this._texels.length) this._texels = texelsOf(1.25 * detail.segments);
  }

  /** Stand shrubs about the trees of a stand: pictures of its broadleaves. */
  _plantShrubs() {
    for (const [t, { kind, place: [x, y, z, , scale] }] of this.detail.trees.entries()) {
      const { kind: { look }, drawn: [far] } = this._kinds[kind];
      if (look?.has_needles || !far?.impostor) continue;
      for (const k of SHRUBS) {
        const [turn, size] = [7 * t + 9 * k, scale * (0.16 + 0.16 * ((t * k) % 1))];
        const at = [x + 3 * k * Math.cos(turn), y + 3 * k * Math.sin(turn), z - 0.55 * size * far.impostor.box.tall];
        far.impostor.add([...at, turn, size], -1, k * t, UNPAINTED);
      }
    }
  }

  /** Make a level of a kind. @param {number} number of the kind @param {number} level
   * @returns {DrawnLevel} */
  _drawnLevel(number, level) {
    const { gl, _programs: programs, _pictures: pictures, detail: { levels: { [number]: levels } } } = this;
    const shape = this._kinds[number];
    if (level === 0) return { starts: [], numbers: [], impostor: this._bake(number) };
    const look = lookOf(shape.kind);
    const { bark: barkColor } = look;
    const branches = shape.placer.order.slice(0, levels[level].branches);
    const isFlowering = this.isFlowering && !this.isAutumn;
    const { mesh, along, isSpread } = leafMesh(shape, branches, levels[level].cards, levels[levels.length - 1].cards, isFlowering, this.isSlow);
    // Shoots are as green as the needles on them; so are thin twigs where few cards are drawn for the leaves on them.
    const green = this.isAutumn || !mesh.values.length ? 0 : look.has_needles ? 0.7 : this.isSlow && this.isCrowd ? 0.5 : 0;
    const twigColor = look.twig.map((each, c) => (1 - green) * each + green * look.green[c]);
    const bark = barkMesh(shape, branches, levels[level].pixels, this.isSlow ? COARSEST : 1);
    const name = `${number} ${along} ${isSpread}`;
    if (!pictures.has(name)) {
      const picture = leafPicture(look, along, { isAutumn: this.isAutumn, isFlowering, isSpread });
      pictures.set(name, this.isSlow ? chosenTexture(gl, picture) : pictureTexture(gl, picture, false));
    }
    const relief = look.bark_pattern;
    const own = (this.isAutumn && look.autumn) || look.green;
    const unturned = look.green.map((each, c) => each / own[c]);
    const dulled = OPEN_GREENS[+look.has_needles].map((each, c) => Math.sqrt(0.084 / own[1]) * (1 + Math.max(1, (each * own[1]) / own[c])));
    const foot = feet[relief] ?? { color: barkColor, height: 0 };
    if (!pictures.has(relief)) pictures.set(relief, pictureTexture(gl, barkPicture(relief), this.isSlow, true));
    return {
      starts: [], numbers: [], bark: drawable(gl, programs.bark, bark), leaf: drawable(gl, programs.leaf, mesh),
      skin: { barkColor, twigColor, relief: [1, pictures.get(relief)], footColor: foot.color, footHeight: foot.height },
      foliage: {
        leaves: [2, pictures.get(name)], unturned, dulled, woody: look.twig.map((each, c) => (each + (hangs(look) ? look.fresh[c] : each)) / (2 * dulled[c])),
        gloss: look.autumn || look.has_needles ? 0 : this.isSlow ? GLOSS_OF_MANY : GLOSS,
      },
    };
  }

  /** Paint the picture that stands for far trees of a kind: a tree at rest in diffuse light.
   * @param {number} number of the kind */
  _bake(number) {
    const { gl, detail: { levels: { [number]: levels }, trees } } = this;
    const shape = this._kinds[number];
    const most = (1 + SHRUBS.length) * trees.filter(({ kind }) => kind === number).length;
    const finest = Math.max(1, levels.findIndex(({ pixels }) => pixels >= PAINTED));
    const level = { ...(shape.drawn[finest] ??= this._drawnLevel(number, finest)), starts: [0], numbers: [-1] };
    const impostor = new Impostor(gl, this._programs.impostor, shape, most, this.isSlow, TILES[Number(this._kinds.length > FEW_KINDS)]);
    const { segments, branches } = levels[finest];
    const texels = texelsOf(segments);
    shape.placer.place(new Float32Array(shape.kind.nCoordinates), 0, AT_ORIGIN, branches, texels, 0);
    this._poses = textureOf(gl, gl.NEAREST, gl.NEAREST);
    uploadPoses(gl, this._poses, texels, segments);
    const even = { sun: [0, 0, 0], sky: [1.1, 1.1, 1.1], haze: 0, picked: NONE, isBaked: 1, law: [0, 1] };
    impostor.bake((camera, eye) => this._drawMeshes([level], false, { camera, eye, ...even }, 1),
      lookOf(shape.kind).green);
    gl.deleteTexture(this._poses);
    this._poses = this._texture;
    return impostor;
  }

  _place() {
    const { detail, _coordinates: values, _texels: texels } = this;
    const turns = beyond(values, this.description?.nCoordinates ?? 0);
    detail.trees.forEach(({ kind, firstCoordinate, firstKey, place }, t) => {
      const { drawn, placer } = this._kinds[kind];
      const start = detail.start[t];
      const { branches } = detail.levelOf(t) ?? {};
      if (branches) placer.place(values, firstCoordinate, place, branches, texels, start, turns, firstKey);
      else if (branches === 0) drawn[0].impostor?.place(values, firstCoordinate, place, texels, start);
    });
  }

  resize() {
    const { canvas, camera } = this;
    const ratio = this.isSlow ? this.quality.fineness : Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((each) => Math.max(1, Math.round(each * ratio)));
    if (canvas.width === width && canvas.height === height) return;
    const isNarrow = camera.aspect < 1;
    Object.assign(canvas, { width, height });
    camera.aspect = width / height;
    if (isNarrow !== camera.aspect < 1) camera.home();
  }

  /** Draw a state. @param {Float32Array | null} coordinates the last ones again if null @param {number} time [s]
   * @param {boolean} isPaused whether the picture stands still @param {View[]} [views] of a headset */
  draw(coordinates, time, isPaused, views) {
    const { gl, camera: own, canvas, detail: { segments } } = this;
    if (views) this.camera = /** @type {Camera} */ (views[0].camera);
    else this.resize();
    if (this._frame % CHOOSE_EVERY === 0) this._chooseDetail();
    if (coordinates && coordinates.length >= (this.description?.nCoordinates ?? Infinity)) this._coordinates = coordinates;
    this._place();
    if (segments) uploadPoses(gl, this._texture, this._texels, segments);
    const passed = Math.min(0.1, Math.abs(time - this._time));
    this._time = time;
    for (const c of [0, 1]) this._calmWind[c] += (passed / CALM) * (this.wind[c] - this._calmWind[c]);
    // A shadow that is some frames old is not noticed.
    const every = this.isSlow ? (this.isCrowd ? 3 : 1) * SHADOW_EVERY : 1;
    const isShadowNew = this._frame % every === 0;
    if (isShadowNew) this._castShadow();
    // In a crowd most trees are pictures, whose leaves cannot be thinned.
    const hasCards = !this.isCrowd || this.detail.level.filter((level) => level > 0).length > 1;
    const mayThin = this.hasLeaves && this.leavesShown && hasCards;
    this.grass.gusts.add(time, Math.hypot(...this.wind));
    if (this.isSlow && !isPaused) this.quality.count(performance.now(), mayThin);
    this._frame++;
    const whole = { camera: own, target: null, area: [0, 0, canvas.width, canvas.height] };
    for (const view of views ?? [whole]) this._paint(view, !views, isShadowNew);
    this.camera = own;
  }

  /** Draw one view. @param {View} view @param {boolean} isOwn whether it is the canvas, whose backdrop is kept
   * @param {boolean} isShadowNew whether the shadow has changed */
  _paint({ camera, target, area: [x, y, width, height] }, isOwn, isShadowNew) {
    const { gl } = this;
    this.camera = /** @type {Camera} */ (camera);
    camera.update();
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.viewport(x, y, width, height);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    const under = /** @type {const} */ ([this.camera, this.day, this._under]);
    if (isOwn) this._backdrop.show(...under, () => this._drawShadow(), isShadowNew);
    else this._backdrop.paint(...under);
    if (!isOwn) this._drawShadow();
    gl.enable(gl.DEPTH_TEST);
    this._drawTrees(false);
    this._drawSolids(false);
    this._drawGrass();
  }

  /** Draw the shadow on the ground and the depths as seen from the sun, with room to sway. */
  _castShadow() {
    const { gl, _shadow: { target, width, height } } = this;
    const { day: { light }, _low: low, _high: high } = this;
    const room = 0.06 * this._extent;
    const ends = [0, 1].map((c) => {
      const lean = (-light[c] / light[2]) * (high[2] - this.ground);
      return [low[c] + Math.min(0, lean) - room, high[c] + Math.max(0, lean) + room];
    });
    const half = Math.max(...ends.map(([from, to]) => to - from)) / 2;
    this._shadowArea = [...ends.map(([from, to]) => (from + to) / 2), half];
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this._drawTrees(true);
    this._drawSolids(true);
  }

  /** Draw grass, unless the tree stands in a pot. */
  _drawGrass() {
    const { height, _low: low, _high: high, _time: time, _programs: { grass } } = this;
    if (this._potSize || !this.quality.hasGrass) return;
    const mean = Math.hypot(...this._calmWind);
    const way = this._calmWind.map((each) => each / Math.max(mean, 1e-3));
    const alongs = this.detail.trees.map(({ place: [x, y] }) => x * way[0] + y * way[1]);
    const middle = [0, 1].map((c) => 0.5 * (low[c] + high[c]));
    this._begin(grass, false);
    this.grass.draw({ middle, extent: this._extent, height, first: Math.min(...alongs), way, mean, time });
  }

  /** Set the uniforms that programs share. @param {Program} used @param {boolean} isShadow whether it casts the shadow
   * @param {Record<string, any>} [own] further uniforms */
  _begin(used, isShadow, own = {}) {
    const { camera: { matrix: camera, eye }, _poses: poses, _shadowArea: [x, y, half] } = this;
    const lit = { ...this.day, ...this._under, camera, eye, isShadow: Number(isShadow) };
    const shadow = {
      shadowArea: [x, y, 1 / half, lit.isShadow], shadowTop: 1 / (1.1 * (this._high[2] - this.ground) + 0.1),
      sunMap: [3, isShadow ? this._noMap : this._sunMap],
    };
    use(this.gl, used, { ...lit, ...shadow, poses: [0, poses], ...own });
  }

  /** @param {boolean} isShadow */
  _drawTrees(isShadow) {
    const { description, picked, watched, _programs: { impostor } } = this;
    const { gain, largest_angle: most } = description?.flutter ?? { gain: 0, largest_angle: 1 };
    const [first, next] = watched.kind?.arrays.branch_first.subarray(picked, picked + 2) ?? [];
    const rows = picked < 0 ? NONE : [this._row(first), this._row(next - 1)];
    this._drawMeshes(this._levels, isShadow, {
      picked: rows, isBaked: 0, time: this._time % 1000, speed: Math.hypot(...this.wind),
      law: [this.flutters ? gain : 0, most],
    }, this.quality.density * (isShadow ? SHADOW_LEAVES[+this.isSlow] : 1));
    this._begin(impostor, isShadow);
    for (const level of this._levels) level.impostor?.draw(impostor, this.isCrowd ? 0.5 : 0.9);
  }

  /** The levels of all kinds made so far. */
  get _levels() {
    return this._kinds.flatMap(({ drawn }) => drawn.flat());
  }

  /** Draw bark, then leaves. @param {DrawnLevel[]} levels @param {boolean} isShadow
   * @param {Record<string, any>} own values of their programs @param {number} density share of the leaves */
  _drawMeshes(levels, isShadow, own, density) {
    const { gl, _programs: { bark, leaf } } = this;
    this._begin(bark, isShadow, own);
    gl.enable(gl.CULL_FACE);
    for (const level of levels) this._drawEach(level.bark, bark, level, level.skin, 1);
    gl.disable(gl.CULL_FACE);
    if (!this.leavesShown) return;
    this._begin(leaf, isShadow, own);
    if (!this.isSlow) gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    for (const level of levels) this._drawEach(level.leaf, leaf, level, level.foliage, density);
    gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
  }

  /** Draw a mesh for each tree of a level. @param {Drawable | undefined} part @param {Program} used
   * @param {DrawnLevel} level @param {Record<string, any>} values @param {number} share of its triangles */
  _drawEach(part, used, { starts, numbers }, values = {}, share) {
    if (!part) return;
    use(this.gl, used, values);
    starts.forEach((start, i) => {
      used.uniforms.start(start);
      used.uniforms.paint(this._paints[numbers[i]] ?? UNPAINTED);
      drawPart(this.gl, part, share);
    });
  }

  /** Draw the pot, the person beside the tree, and the arrow of the wind. @param {boolean} isShadow */
  _drawSolids(isShadow) {
    const { gl, height, ground, _low: low, _high: high, _parts: parts, _programs: { solid } } = this;
    const [x, y, z] = this.detail.trees[0]?.place ?? AT_ORIGIN;
    this._begin(solid, isShadow);
    /** @param {Drawable} part @param {number[]} placed @param {number[]} heading */
    const draw = (part, placed, heading) => {
      use(gl, solid, { placed, heading });
      drawPart(gl, part);
    };
    if (this._potSize > 0) draw(parts.pot, [x, y, z, this._potSize], [1, 0]);
    if (this.hasPerson && height > WITH_PERSON && !this._potSize) {
      // To the side, as the camera first looks.
      const away = 0.5 * Math.max(high[0] - low[0], high[1] - low[1]) + 0.5;
      const at = this.isCrowd ? [high[0] + 3, low[1] - 3] : [x + 0.8 * away, y + 0.66 * away];
      draw(parts.person, [...at, ground, 1], [Math.cos(-0.9), Math.sin(-0.9)]);
    }
    const speed = Math.hypot(...this._calmWind);
    if (this.hasArrow && speed > 0.2 && !isShadow) {
      const long = arrowLength(height, speed);
      const to = this._calmWind.map((each) => each / speed);
      const at = to.map((way, c) => 0.5 * (low[c] + high[c]) - way * (0.42 * this._extent + long));
      draw(parts.arrow, [...at, ground + 0.18 * long + 0.01 * height, long], to);
    }
  }

  get isCrowd() {
    return this.detail.trees.length > CROWD;
  }

  _drawShadow() {
    const { gl, _shadow: { texture } } = this;
    use(gl, this._programs.shadow, {
      camera: this.camera.matrix, area: [...this._shadowArea, this.ground],
      softness: (0.005 * this.height) / this._shadowArea[2], depth: 0.65, shadow: [1, texture], ...this._under,
    });
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.disable(gl.DEPTH_TEST);
    drawPart(gl, this._parts.shadow);
    gl.disable(gl.BLEND);
  }
}
