// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Pictures painted by code: sprays of leaves, cut out by their alpha, and the relief of bark. */

import { hasNeedles, lookOf, seeded } from "./species.js";

/** Leaves across a picture: a leaf alone, sprays of more and more. */
const ACROSS = [1, 3, 6, 12, 24];
const LEAF_PIXELS = 256;
const BARK_PIXELS = 128;
/** Length of a compound leaf in leaflets. */
const RACHIS = 3.4;

/**
 * @typedef {import("./species.js").Look} Look
 * @typedef {{size: number, data: Uint8Array}[]} Mips from the finest, RGBA
 */

/** Leaves across the picture for cards of a size, so that none is drawn larger than 1.5 times its
 * own.
 * @param {string} species @param {number} size of a card [m] */
export function leavesAcross(species, size) {
  const look = lookOf(species);
  const least = look.form === "compound" || hasNeedles(species) ? 3 : 1;
  const wanted = size / (1.5 * look.size);
  return ACROSS.find((across) => across >= wanted && across >= least) ?? ACROSS[ACROSS.length - 1];
}

/** Paint leaves: the twig comes in at the left.
 * @param {string} species @param {number} across how many leaves the picture is wide
 * @param {boolean} isAutumn @returns {Mips} */
export function leafPicture(species, across, isAutumn) {
  const look = lookOf(species);
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = across === 1 ? LEAF_PIXELS / 2 : LEAF_PIXELS;
  const context = /** @type {CanvasRenderingContext2D} */ (
    canvas.getContext("2d", { willReadFrequently: true }));
  context.scale(canvas.width, canvas.width);
  const random = seeded(97 + across);
  const base = isAutumn && look.autumn ? look.autumn : look.leaf;
  const fresh = isAutumn && look.autumn ? look.autumn.map((c) => 1.15 * c) : look.fresh;
  const color = () => {
    const [light, mixed] = [0.78 + 0.44 * random(), 0.35 * random()];
    return css(base.map((c, i) => light * (c + mixed * (fresh[i] - c))));
  };
  const long = 1 / across;
  if (across === 1) {
    paintLeaf(context, look, 0.01, 0.5, 0, 0.98, color(), random);
  } else if (across <= 6 && !hasNeedles(species)) {
    paintSpray(context, look, long, color, random);
  } else if (hasNeedles(species)) {
    paintShoots(context, look, long, color, random);
  } else {
    paintCloud(context, look, long, color, random);
  }
  return mipsOf(context, base.map((c) => 255 * c));
}

/** @param {number[]} color */
function css(color) {
  return `rgb(${color.map((c) => Math.round(255 * Math.min(1, Math.max(0, c)))).join(" ")})`;
}

/**
 * A twig with side twigs, leaves in turn on both sides.
 * @param {CanvasRenderingContext2D} context @param {Look} look
 * @param {number} long length of a leaf @param {() => string} color @param {() => number} random
 */
function paintSpray(context, look, long, color, random) {
  const unit = look.form === "compound" ? RACHIS * long : long;
  const twig = (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ turn,
    /** @type {number} */ length, /** @type {boolean} */ isMain) => {
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    context.strokeStyle = css(look.twig);
    context.lineWidth = (isMain ? 0.1 : 0.06) * long;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + length * c, y + length * s);
    context.stroke();
    const step = look.form === "compound" ? 0.3 * unit : 0.4 * unit;
    let side = 1;
    for (let at = isMain ? 0.15 * length : step; at < length; at += step, side = -side) {
      const lean = side * (0.65 + 0.5 * random());
      const [px, py] = [x + at * c, y + at * s];
      if (isMain && long < 0.3 && at < 0.8 * length) {
        twig(px, py, turn + 0.9 * lean, 0.42 * (1 - 0.4 * at / length), false);
      }
      paintLeaf(context, look, px, py, turn + lean, unit * (0.75 + 0.35 * random()), color(), random);
    }
    paintLeaf(context, look, x + length * c, y + length * s, turn, unit, color(), random);
  };
  twig(0, 0.5, 0, Math.max(0.25, 1 - 1.05 * unit), true);
}

/** Leaves without order in a disc.
 * @param {CanvasRenderingContext2D} context @param {Look} look @param {number} long
 * @param {() => string} color @param {() => number} random */
function paintCloud(context, look, long, color, random) {
  const isCompound = look.form === "compound";
  const unit = isCompound ? RACHIS * long : long;
  const count = (isCompound ? 5 : 2.1) / (unit * unit) / Math.max(0.6, 2 * look.slender);
  for (let i = 0; i < count; i++) {
    const far = (0.5 - 0.55 * unit) * Math.sqrt(random());
    const at = 2 * Math.PI * random();
    const turn = at + 2.4 * (random() - 0.5);
    const [x, y] = [0.5 + far * Math.cos(at), 0.5 + far * Math.sin(at)];
    paintLeaf(context, look, x - 0.4 * unit * Math.cos(turn), y - 0.4 * unit * Math.sin(turn), turn,
      unit * (0.75 + 0.4 * random()), color(), random);
  }
}

/**
 * A twig of a conifer: side shoots that grow shorter to its tip, needles on all of them.
 * @param {CanvasRenderingContext2D} context @param {Look} look
 * @param {number} long length of a shoot @param {() => string} color @param {() => number} random
 */
function paintShoots(context, look, long, color, random) {
  const isTuft = look.form === "tufts";
  const needle = (isTuft ? 0.55 : look.form === "fronds" ? 0.3 : 0.28) * long;
  context.lineCap = "round";
  const shoot = (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ turn,
    /** @type {number} */ length) => {
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    context.strokeStyle = css(look.twig);
    context.lineWidth = 0.06 * long;
    line(context, x, y, x + length * c, y + length * s);
    const from = isTuft ? Math.max(0, 1 - (0.6 * long) / length) : 0;
    const count = Math.ceil(((isTuft ? 60 : 36) * (1 - from) * length) / long);
    for (let i = 0; i < count; i++) {
      const at = length * (from + (1 - from) * (i / count));
      const lean = turn + (i % 2 ? 1 : -1) * (isTuft ? 0.2 + 0.9 * random() : 0.5 + 0.4 * random());
      const own = needle * (0.7 + 0.5 * random());
      context.strokeStyle = color();
      context.lineWidth = Math.max(0.005, (look.form === "fronds" ? 0.1 : 0.055) * long);
      line(context, x + at * c, y + at * s, x + at * c + own * Math.cos(lean),
        y + at * s + own * Math.sin(lean));
    }
  };
  const branch = (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ turn,
    /** @type {number} */ length, /** @type {number} */ depth) => {
    shoot(x, y, turn, length);
    if (length < 0.9 * long || depth > 2) return;
    const step = Math.max(0.42 * long, 0.04);
    let side = 1;
    for (let at = 0.1 * length; at < 0.94 * length; at += step, side = -side) {
      const reach = Math.max(0.6 * long, 0.46 * (length - at)) * (0.75 + 0.4 * random());
      branch(x + at * Math.cos(turn), y + at * Math.sin(turn), turn + side * (0.8 + 0.2 * random()), reach,
        depth + 1);
    }
  };
  branch(0, 0.5, 0, 0.98 - needle, 0);
}

/** One leaf from its stalk at x, y.
 * @param {CanvasRenderingContext2D} context @param {Look} look @param {number} x @param {number} y
 * @param {number} turn @param {number} long @param {string} color @param {() => number} random */
function paintLeaf(context, look, x, y, turn, long, color, random) {
  context.save();
  context.translate(x, y);
  context.rotate(turn);
  context.scale(long, long);
  context.fillStyle = color;
  context.strokeStyle = "rgb(255 255 220 / 22%)";
  context.lineWidth = 0.03;
  if (look.form === "compound") {
    const leaflet = 1 / RACHIS;
    context.strokeStyle = color;
    context.lineWidth = 0.02;
    line(context, 0, 0, 0.75, 0);
    const pairs = look.slender < 0.35 ? 5 : 4;
    for (let pair = 0; pair < pairs; pair++) {
      for (const side of [-1, 1]) {
        context.save();
        context.translate(0.14 + 0.58 * (pair / (pairs - 1)), 0);
        context.rotate(side * (0.95 - 0.06 * pair) + 0.15 * (random() - 0.5));
        context.scale(leaflet * (0.8 + 0.07 * pair), leaflet);
        outline(context, look);
        context.restore();
      }
    }
    context.translate(0.72, 0);
    context.scale(leaflet, leaflet);
    outline(context, look);
  } else {
    outline(context, look);
    line(context, -0.06, 0, 0.9, 0);
  }
  context.restore();
}

/** @param {CanvasRenderingContext2D} context @param {number} x @param {number} y
 * @param {number} toX @param {number} toY */
function line(context, x, y, toX, toY) {
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(toX, toY);
  context.stroke();
}

/** The outline of a blade of unit length along x, filled.
 * @param {CanvasRenderingContext2D} context @param {Look} look */
function outline(context, look) {
  const half = 0.5 * look.slender;
  context.beginPath();
  context.moveTo(0, 0);
  if (look.form === "palmate") {
    // Five lobes, as of a hand.
    const points = [];
    for (let lobe = -2; lobe <= 2; lobe++) {
      const far = 0.62 - 0.09 * Math.abs(lobe);
      points.push([0.38 + far * Math.cos(0.85 * lobe), far * Math.sin(0.85 * lobe)]);
      if (lobe < 2) points.push([0.38 + 0.3 * Math.cos(0.85 * (lobe + 0.5)), 0.3 * Math.sin(0.85 * (lobe + 0.5))]);
    }
    for (const [x, y] of points) context.lineTo(x, y);
  } else {
    const steps = 24;
    const at = (/** @type {number} */ t) => {
      const widest = look.form === "lobed" ? 0.62 : look.form === "pointed" ? 0.36 : 0.45;
      const u = t < widest ? t / widest : (1 - t) / (1 - widest);
      const tip = look.form === "pointed" && t > widest ? 1.35 : 0.75;
      const wave = look.form === "lobed" ? 0.74 + 0.26 * Math.cos(9 * Math.PI * t + 0.8) : 1;
      return half * Math.sin(0.5 * Math.PI * u) ** tip * wave;
    };
    for (let i = 1; i <= steps; i++) context.lineTo(i / steps, -at(i / steps));
    for (let i = steps; i >= 0; i--) context.lineTo(i / steps, at(i / steps));
  }
  context.closePath();
  context.fill();
}

/** A picture halved again and again; each has the cover of the first, so that no crown thins out
 * where it is far, and what is cut away has the leaves' colour, so that no leaf has a rim.
 * @param {CanvasRenderingContext2D} context @param {number[]} mean colour @returns {Mips} */
function mipsOf(context, mean) {
  let size = context.canvas.width;
  let data = new Uint8Array(context.getImageData(0, 0, size, size).data);
  for (let i = 0; i < data.length; i += 4) {
    if (data[i + 3] < 8) for (let c = 0; c < 3; c++) data[i + c] = mean[c];
  }
  const cover = covered(data, 1);
  const mips = [{ size, data }];
  while (size > 1) {
    const half = size / 2;
    const less = new Uint8Array(4 * half * half);
    for (let i = 0; i < half * half; i++) {
      const from = 4 * (2 * Math.floor(i / half) * size + 2 * (i % half));
      let weight = 0;
      const sums = [0, 0, 0];
      for (const at of [from, from + 4, from + 4 * size, from + 4 * size + 4]) {
        const alpha = data[at + 3] + 1;
        weight += alpha;
        for (let c = 0; c < 3; c++) sums[c] += alpha * data[at + c];
      }
      for (let c = 0; c < 3; c++) less[4 * i + c] = sums[c] / weight;
      less[4 * i + 3] = (weight - 4) / 4;
    }
    [size, data] = [half, less];
    let [low, high] = [0.5, 8];
    for (let i = 0; i < 10; i++) {
      const middle = 0.5 * (low + high);
      if (covered(data, middle) > cover) high = middle;
      else low = middle;
    }
    // The next is made from what was before it was corrected.
    const shown = data.slice();
    for (let i = 3; i < shown.length; i += 4) shown[i] = Math.min(255, low * shown[i]);
    mips.push({ size, data: shown });
  }
  return mips;
}

/** Share of a picture that is drawn where its alpha is multiplied.
 * @param {Uint8Array} data @param {number} factor */
function covered(data, factor) {
  let count = 0;
  for (let i = 3; i < data.length; i += 4) if (factor * data[i] > 127) count++;
  return (4 * count) / data.length;
}

/** Relief of bark, dark in its furrows; it repeats both ways, and runs up the stem.
 * @param {Look["pattern"]} pattern @returns {Mips} */
export function barkPicture(pattern) {
  const size = BARK_PIXELS;
  const data = new Uint8Array(4 * size * size);
  const noise = tiledNoise();
  for (let y = 0; y < size; y++) {
    for (let x = 0; x < size; x++) {
      const [u, v] = [x / size, y / size];
      const grain = noise(u, v, 32, 16) - 0.5;
      const bend = noise(u, v, 4, 4) - 0.5;
      let tone = 1;
      if (pattern === "furrows") {
        const ridge = Math.abs(2 * noise(u + 0.06 * bend, v, 10, 3) - 1);
        tone = 0.5 + 0.62 * Math.min(1, 1.7 * ridge) + 0.25 * grain;
      } else if (pattern === "plates") {
        const ridge = Math.min(Math.abs(2 * noise(u + 0.1 * bend, v, 6, 3) - 1),
          Math.abs(2 * noise(v + 0.1 * bend, u, 4, 5) - 1) + 0.25);
        tone = 0.5 + 0.65 * Math.min(1, 2.4 * ridge) + 0.3 * grain;
      } else if (pattern === "dashes") {
        const dash = noise(u, v, 3, 40) > 0.72 && noise(u, v, 5, 8) > 0.42 ? 0.35 : 1;
        const scar = noise(u + 0.2 * bend, v, 3, 3) > 0.8 ? 0.3 : 1;
        tone = Math.min(dash, scar) + 0.12 * grain;
      } else if (pattern === "flakes") {
        tone = 0.78 + 0.45 * (noise(u + 0.08 * bend, v + 0.1 * bend, 12, 9) - 0.4) + 0.3 * grain;
      } else {
        tone = 0.95 + 0.14 * bend + 0.1 * grain + 0.08 * (noise(u, v, 2, 24) - 0.5);
      }
      const at = 4 * (y * size + x);
      data.fill(Math.max(0, Math.min(255, 200 * tone)), at, at + 3);
      data[at + 3] = 255;
    }
  }
  return [{ size, data }];
}

/** Smooth noise from 0 to 1 that repeats on the unit square, of a number of cells each way. */
function tiledNoise() {
  const hash = (/** @type {number} */ x, /** @type {number} */ y) => {
    let h = Math.imul(x + 17, 374761393) + Math.imul(y + 29, 668265263);
    h = Math.imul(h ^ (h >>> 13), 1274126177);
    return ((h ^ (h >>> 16)) >>> 0) / 4294967296;
  };
  return (/** @type {number} */ u, /** @type {number} */ v, /** @type {number} */ nx,
    /** @type {number} */ ny) => {
    const [x, y] = [(u - Math.floor(u)) * nx, (v - Math.floor(v)) * ny];
    const [i, j] = [Math.floor(x), Math.floor(y)];
    const [a, b] = [x - i, y - j].map((t) => t * t * (3 - 2 * t));
    const at = (/** @type {number} */ di, /** @type {number} */ dj) =>
      hash((i + di) % nx + 57 * nx, (j + dj) % ny + 91 * ny);
    return (at(0, 0) * (1 - a) + at(1, 0) * a) * (1 - b) + (at(0, 1) * (1 - a) + at(1, 1) * a) * b;
  };
}
