// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Pictures painted by code: sprays of leaves, cut out by their alpha. */

import { hasNeedles, lookOf, outlines, seeded } from "./species.js";

/** Leaves across a picture: a leaf alone, sprays of more and more. */
const ACROSS = [1, 3, 6, 12, 24];
const LEAF_PIXELS = 256;
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

/** Paint leaves of a twig. @param {string} species @param {number} across @param {boolean} isAutumn */
export function leafPicture(species, across, isAutumn) {
  const size = across === 1 ? LEAF_PIXELS / 2 : LEAF_PIXELS;
  const brush = new Brush(lookOf(species), isAutumn, size, seeded(97 + across));
  const long = 1 / across;
  if (across === 1) brush.leaf(0.99);
  else if (hasNeedles(species)) brush.shoot(0.98 - 0.3 * long, long);
  else if (across <= 6) brush.spray(long);
  else brush.cloud(long);
  return brush.context.canvas;
}

/** @param {number[]} color */
const css = (color) => `rgb(${color.map((c) => 255 * c).join(" ")})`;

/** Paints leaves and twigs of a species on a unit square, from the middle of its left side on. */
class Brush {
  /** @param {Look} look @param {boolean} isAutumn @param {number} size [px] @param {() => number} random */
  constructor(look, isAutumn, size, random) {
    const turned = isAutumn && look.autumn;
    const [base, fresh] = turned ? [turned, turned.map((c) => 1.15 * c)] : [look.leaf, look.fresh];
    this.look = look;
    this.random = random;
    this.unit = look.form === "compound" ? RACHIS : 1;
    const half = (outlines[look.form] ?? outlines.ovate).map(([x, y]) => [x, 0.5 * look.slender * y]);
    const other = half.map(([x, y]) => [x, -y]).reverse();
    this.blade = new Path2D(`M${[...half, ...other].join("L")}Z`);
    const canvas = Object.assign(document.createElement("canvas"), { width: size, height: size });
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    this.context.setTransform(size, 0, 0, size, 0, size / 2);
    this.context.lineCap = "round";
    this._color = () => {
      const [light, mixed] = [0.78 + 0.44 * random(), 0.35 * random()];
      return css(base.map((c, i) => light * (c + mixed * (fresh[i] - c))));
    };
  }

  /** Paint elsewhere. @param {number} x @param {number} y @param {number} turn @param {number} scale
   * @param {() => void} paint */
  at(x, y, turn, scale, paint) {
    const [c, s] = [scale * Math.cos(turn), scale * Math.sin(turn)];
    this.context.save();
    this.context.transform(c, s, -s, c, x, y);
    paint();
    this.context.restore();
  }

  /** A straight line. @param {number} long @param {number} width @param {string} color */
  line(long, width, color) {
    Object.assign(this.context, { strokeStyle: color, lineWidth: width });
    this.context.stroke(new Path2D(`M0 0H${long}`));
  }

  /** A twig with side twigs, leaves in turn on both sides. @param {number} leaf length of one
   * @param {number} [length] of the twig; of the main one if left out */
  spray(leaf, length) {
    const { look, random } = this;
    const unit = this.unit * leaf;
    const long = length ?? Math.max(0.25, 1 - 1.05 * unit);
    this.line(long, (length ? 0.06 : 0.1) * leaf, css(look.twig));
    const step = (look.form === "compound" ? 0.3 : 0.4) * unit;
    let side = 1;
    for (let at = length ? step : 0.15 * long; at < long; at += step, side = -side) {
      const lean = side * (0.65 + 0.5 * random());
      if (!length && leaf < 0.3 && at < 0.8 * long) {
        this.at(at, 0, 0.9 * lean, 1, () => this.spray(leaf, 0.42 * (1 - (0.4 * at) / long)));
      }
      this.at(at, 0, lean, 1, () => this.leaf(unit * (0.75 + 0.35 * random())));
    }
    this.at(long, 0, 0, 1, () => this.leaf(unit));
  }

  /** Leaves without order in a disc. @param {number} leaf length of one */
  cloud(leaf) {
    const { look, random } = this;
    const unit = this.unit * leaf;
    const count = (look.form === "compound" ? 5 : 2.1) / (unit * unit) / Math.max(0.6, 2 * look.slender);
    for (let i = 0; i < count; i++) {
      const far = (0.5 - 0.55 * unit) * Math.sqrt(random());
      const at = 2 * Math.PI * random();
      const turn = at + 2.4 * (random() - 0.5);
      const [x, y] = [Math.cos, Math.sin].map((of) => far * of(at) - 0.4 * unit * of(turn));
      this.at(0.5 + x, y, turn, 1, () => this.leaf(unit * (0.75 + 0.4 * random())));
    }
  }

  /** A twig of a conifer: needles on both sides, one in the shade of the other, and side shoots that grow
   * shorter to its tip. @param {number} length @param {number} unit length of a shoot @param {boolean} [isSide] */
  shoot(length, unit, isSide = false) {
    const { look: { form, twig }, random } = this;
    const [isTuft, isFrond] = [form === "tufts", form === "fronds"];
    const colors = [this._color(), this._color()];
    this.line(length, 0.06 * unit, css(twig));
    const from = isTuft ? Math.max(0, length - 0.7 * unit) : 0;
    const long = Math.max(isTuft ? 0.75 * unit : 0.28 * unit, 0.03);
    const width = Math.max((isTuft ? 0.04 : isFrond ? 0.2 : 0.1) * long, 0.004);
    const count = isTuft ? 44 : (1.1 * length) / width;
    for (let i = 0; i < count; i++) {
      const lean = (i % 2 ? 1 : -1) * (isTuft ? 1.4 * random() : 0.6 + 0.3 * random());
      this.at(from + (length - from) * (i / count), 0, lean, 1, () => this.line(long * (0.7 + 0.5 * random()), width, colors[i % 2]));
    }
    let side = 1;
    for (let at = 0.08 * length; at < length - 0.5 * unit; at += Math.max(isSide ? unit : 0.42 * unit, 0.05), side = -side) {
      const reach = isSide ? 0.7 * unit : 0.2 * unit + 0.48 * (length - at);
      if (!isSide || length > 2 * unit) {
        this.at(at, 0, side * (0.8 + 0.25 * random()), 1, () => this.shoot(reach * (0.75 + 0.4 * random()), unit, true));
      }
    }
  }

  /** One leaf from its stalk on. @param {number} long */
  leaf(long) {
    const { context, look, random } = this;
    const color = this._color();
    const pairs = look.slender < 0.35 ? 5 : 4;
    context.fillStyle = color;
    this.at(0, 0, 0, long, () => {
      if (look.form !== "compound") {
        context.fill(this.blade);
        this.line(0.9, 0.03, "rgb(255 255 220 / 22%)");
        return;
      }
      this.line(0.75, 0.02, color);
      for (let i = 0; i <= 2 * pairs; i++) {
        const pair = Math.floor(i / 2);
        const lean = pair === pairs ? 0 : (i % 2 ? 1 : -1) * (0.95 - 0.06 * pair) + 0.15 * (random() - 0.5);
        const along = 0.14 + 0.58 * Math.min(1, pair / (pairs - 1));
        this.at(along, 0, lean, 1 / RACHIS, () => context.fill(this.blade));
      }
    });
  }
}
