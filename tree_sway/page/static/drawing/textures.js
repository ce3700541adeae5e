// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Pictures painted by code: sprays of leaves, cut out by their alpha, and the relief of bark. */

import { barkPattern, hasNeedles, lookOf, outlineOf, seeded } from "./species.js";

/** Leaves across a picture: a leaf alone, sprays of more and more. */
const ACROSS = [1, 3, 6, 12, 24];
const LEAF_PIXELS = 256;
const BARK_PIXELS = 128;
/** Length of a compound leaf in leaflets. */
const RACHIS = 3.4;

/** Leaves across the picture for cards of a size, so that none is drawn larger than 1.5 times its own.
 * @param {string} species @param {number} size of a card [m] */
export function leavesAcross(species, size) {
  const look = lookOf(species);
  const least = look.form === "compound" || hasNeedles(species) ? 3 : 1;
  const wanted = size / (1.5 * look.size);
  return ACROSS.find((across) => across >= wanted && across >= least) ?? ACROSS[ACROSS.length - 1];
}

/** Paint leaves: the twig comes in at the left. @param {string} species @param {number} across how many
 * leaves the picture is wide @param {boolean} isAutumn */
export function leafPicture(species, across, isAutumn) {
  const look = lookOf(species);
  const base = isAutumn && look.autumn ? look.autumn : look.leaf;
  const brush = new Brush(look, base, isAutumn && look.autumn ? base.map((c) => 1.15 * c) : look.fresh,
    across === 1 ? LEAF_PIXELS / 2 : LEAF_PIXELS, seeded(97 + across));
  const long = 1 / across;
  if (across === 1) brush.leaf(0.01, 0.5, 0, 0.98);
  else if (hasNeedles(species)) brush.shoot(0, 0.5, 0, 0.98 - 0.3 * long, long, 0);
  else if (across <= 6) brush.spray(0, 0.5, 0, long);
  else brush.cloud(long);
  return mipsOf(brush.context, base.map((c) => 255 * c));
}

/** @param {number[]} color */
const css = (color) => `rgb(${color.map((c) => Math.round(255 * Math.min(1, Math.max(0, c)))).join(" ")})`;

/** A square canvas. @param {number} size [px] */
function canvasOf(size) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  return /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", { willReadFrequently: true }));
}

/** Paints leaves and twigs of a species on the unit square. */
class Brush {
  /** @param {Look} look @param {number[]} base colour of its leaves @param {number[]} fresh of some
   * @param {number} size [px] @param {() => number} random */
  constructor(look, base, fresh, size, random) {
    this.look = look;
    this.random = random;
    this.context = canvasOf(size);
    this.context.scale(size, size);
    this.context.lineCap = "round";
    this._color = () => {
      const [light, mixed] = [0.78 + 0.44 * random(), 0.35 * random()];
      return css(base.map((c, i) => light * (c + mixed * (fresh[i] - c))));
    };
  }

  /** A straight line; where it ends. @param {number} x @param {number} y @param {number} turn
   * @param {number} long @param {number} width @param {string} color */
  line(x, y, turn, long, width, color) {
    const { context } = this;
    const end = [x + long * Math.cos(turn), y + long * Math.sin(turn)];
    [context.strokeStyle, context.lineWidth] = [color, width];
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(end[0], end[1]);
    context.stroke();
    return end;
  }

  /** A twig with side twigs, leaves in turn on both sides. @param {number} x @param {number} y
   * @param {number} turn @param {number} leaf length of one @param {number} [length] of the twig; of the
   * main one if left out */
  spray(x, y, turn, leaf, length) {
    const { look, random } = this;
    const unit = look.form === "compound" ? RACHIS * leaf : leaf;
    const long = length ?? Math.max(0.25, 1 - 1.05 * unit);
    const end = this.line(x, y, turn, long, (length ? 0.06 : 0.1) * leaf, css(look.twig));
    const step = look.form === "compound" ? 0.3 * unit : 0.4 * unit;
    let side = 1;
    for (let at = length ? step : 0.15 * long; at < long; at += step, side = -side) {
      const lean = side * (0.65 + 0.5 * random());
      const [px, py] = [x + at * Math.cos(turn), y + at * Math.sin(turn)];
      if (!length && leaf < 0.3 && at < 0.8 * long) {
        this.spray(px, py, turn + 0.9 * lean, leaf, 0.42 * (1 - (0.4 * at) / long));
      }
      this.leaf(px, py, turn + lean, unit * (0.75 + 0.35 * random()));
    }
    this.leaf(end[0], end[1], turn, unit);
  }

  /** Leaves without order in a disc. @param {number} leaf length of one */
  cloud(leaf) {
    const { look, random } = this;
    const isCompound = look.form === "compound";
    const unit = isCompound ? RACHIS * leaf : leaf;
    const count = (isCompound ? 5 : 2.1) / (unit * unit) / Math.max(0.6, 2 * look.slender);
    for (let i = 0; i < count; i++) {
      const far = (0.5 - 0.55 * unit) * Math.sqrt(random());
      const at = 2 * Math.PI * random();
      const turn = at + 2.4 * (random() - 0.5);
      this.leaf(0.5 + far * Math.cos(at) - 0.4 * unit * Math.cos(turn),
        0.5 + far * Math.sin(at) - 0.4 * unit * Math.sin(turn), turn, unit * (0.75 + 0.4 * random()));
    }
  }

  /** A twig of a conifer: side shoots that grow shorter to its tip, needles on all of them.
   * @param {number} x @param {number} y @param {number} turn @param {number} length @param {number} unit
   * length of a shoot @param {number} depth */
  shoot(x, y, turn, length, unit, depth) {
    const { look, random } = this;
    const isTuft = look.form === "tufts";
    this.line(x, y, turn, length, 0.06 * unit, css(look.twig));
    const from = isTuft ? Math.max(0, 1 - (0.6 * unit) / length) : 0;
    const count = Math.ceil(((isTuft ? 60 : 36) * (1 - from) * length) / unit);
    const width = Math.max(0.005, (look.form === "fronds" ? 0.1 : 0.055) * unit);
    for (let i = 0; i < count; i++) {
      const at = length * (from + (1 - from) * (i / count));
      const lean = (i % 2 ? 1 : -1) * (isTuft ? 0.2 + 0.9 * random() : 0.5 + 0.4 * random());
      const long = (isTuft ? 0.55 : 0.29) * unit * (0.7 + 0.5 * random());
      this.line(x + at * Math.cos(turn), y + at * Math.sin(turn), turn + lean, long, width, this._color());
    }
    if (length < 0.9 * unit || depth > 2) return;
    const step = Math.max(0.42 * unit, 0.04);
    let side = 1;
    for (let at = 0.1 * length; at < 0.94 * length; at += step, side = -side) {
      const reach = Math.max(0.6 * unit, 0.46 * (length - at)) * (0.75 + 0.4 * random());
      this.shoot(x + at * Math.cos(turn), y + at * Math.sin(turn), turn + side * (0.8 + 0.2 * random()), reach, unit, depth + 1);
    }
  }

  /** One leaf from its stalk on. @param {number} x @param {number} y @param {number} turn
   * @param {number} long */
  leaf(x, y, turn, long) {
    const { context, look, random } = this;
    const color = this._color();
    context.save();
    context.translate(x, y);
    context.rotate(turn);
    context.scale(long, long);
    context.fillStyle = color;
    if (look.form === "compound") {
      this.line(0, 0, 0, 0.75, 0.02, color);
      const pairs = look.slender < 0.35 ? 5 : 4;
      for (let i = 0; i <= 2 * pairs; i++) {
        const pair = Math.floor(i / 2);
        const lean = pair === pairs ? 0 : (i % 2 ? 1 : -1) * (0.95 - 0.06 * pair) + 0.15 * (random() - 0.5);
        context.save();
        context.translate(0.14 + 0.58 * (pair / (pairs - 1 + (pair === pairs ? 1 : 0))), 0);
        context.rotate(lean);
        context.scale(1 / RACHIS, 1 / RACHIS);
        this._blade();
        context.restore();
      }
    } else {
      this._blade();
      this.line(-0.06, 0, 0, 0.96, 0.03, "rgb(255 255 220 / 22%)");
    }
    context.restore();
  }

  /** The blade of a leaf of unit length along x. */
  _blade() {
    const half = outlineOf(this.look);
    this.context.beginPath();
    for (const [x, y] of half) this.context.lineTo(x, -y);
    for (const [x, y] of [...half].reverse()) this.context.lineTo(x, y);
    this.context.fill();
  }
}

/** A picture halved again and again; each has the cover of the first, so that no crown thins out where it
 * is far, and what is cut away has the leaves' colour, so that no leaf has a rim.
 * @param {CanvasRenderingContext2D} context @param {number[]} mean colour */
function mipsOf(context, mean) {
  const mips = [];
  let cover = 0;
  for (let size = context.canvas.width; size >= 1; size /= 2) {
    const mip = context.getImageData(0, 0, size, size);
    const alphas = mip.data.filter((_, i) => i % 4 === 3).sort();
    cover ||= alphas.filter((alpha) => alpha > 127).length / alphas.length;
    const gain = 128 / Math.max(alphas[Math.min(alphas.length - 1, Math.floor((1 - cover) * alphas.length))], 16);
    for (let i = 0; i < mip.data.length; i += 4) {
      if (mip.data[i + 3] < 8) mip.data.set(mean, i);
      mip.data[i + 3] *= gain;
    }
    mips.push(mip);
    const half = canvasOf(Math.max(size / 2, 1));
    half.drawImage(context.canvas, 0, 0, size / 2, size / 2);
    context = half;
  }
  return mips;
}

/** Relief of bark, dark in its furrows; it repeats both ways, and runs up the stem.
 * @param {Look["pattern"]} name */
export function barkPicture(name) {
  const { cells: [wide, high], ridge, spot, depth, grain } = barkPattern(name);
  const picture = new ImageData(BARK_PIXELS, BARK_PIXELS);
  for (let i = 0; i < BARK_PIXELS ** 2; i++) {
    const [u, v] = [(i % BARK_PIXELS) / BARK_PIXELS, Math.floor(i / BARK_PIXELS) / BARK_PIXELS];
    const shape = noise(u + 0.08 * noise(u, v, 4, 4), v, wide, high);
    const raised = ridge ? Math.min(1, ridge * Math.abs(2 * shape - 1)) : spot ? Number(shape < spot) : shape;
    const tone = 1.1 - depth * (1 - raised) + grain * (noise(u, v, 32, 16) - 0.5);
    picture.data.fill(200 * tone, 4 * i, 4 * i + 3);
    picture.data[4 * i + 3] = 255;
  }
  return [picture];
}

/** Smooth noise from 0 to 1 that repeats on the unit square. @param {number} u @param {number} v
 * @param {number} nx cells across @param {number} ny and up */
function noise(u, v, nx, ny) {
  const hash = (/** @type {number} */ x, /** @type {number} */ y) =>
    seeded(Math.imul((x % nx) + 17 * nx, 374761393) ^ Math.imul((y % ny) + 29 * ny, 668265263))();
  const [x, y] = [(u - Math.floor(u)) * nx, (v - Math.floor(v)) * ny];
  const [i, j] = [Math.floor(x), Math.floor(y)];
  const [a, b] = [x - i, y - j].map((t) => t * t * (3 - 2 * t));
  const mix = (/** @type {number} */ p, /** @type {number} */ q, /** @type {number} */ t) => p + t * (q - p);
  return mix(mix(hash(i, j), hash(i + 1, j), a), mix(hash(i, j + 1), hash(i + 1, j + 1), a), b);
}
