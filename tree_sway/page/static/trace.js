// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A line of the last seconds of a number, with axes: their numbers, their unit, their zero. */

import { textOf } from "./files.js";

/** Shown at once, and kept to look back at [s]. */
const SECONDS = 20;
export const LOOK_BACK = 60;
/** Room for the numbers beside and below the line [px]. */
const LEFT = 38;
const BELOW = 15;

/** What can be shown: the least span of its scale, so that rest is no storm, and units from below a value.
 * @type {Record<string, {least: number, units: Unit[]}>} */
export const QUANTITIES = JSON.parse(await textOf("units.json"));

/** What a value is shown in. @param {string} quantity @param {number} value */
export function unitOf(quantity, value) {
  const { units } = QUANTITIES[quantity];
  return units.find(({ below = Infinity }) => value < below) ?? units[0];
}

/** The next round number. @param {number} value */
function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((step) => step * power).find((each) => each >= 0.999 * value) ?? value;
}

export class Trace {
  /** @param {HTMLCanvasElement} canvas @param {string} quantity @param {string} color name of a CSS variable */
  constructor(canvas, quantity, color) {
    this.canvas = canvas;
    this.quantity = quantity;
    this.color = color;
    /** How long ago what is shown ends [s]. */
    this.back = 0;
    this._points = /** @type {{time: number, value: number}[]} */ ([]);
  }

  /** Begin anew. @param {string} quantity */
  show(quantity) {
    this.quantity = quantity;
    this._points.length = 0;
  }

  /** @param {number} time [s] @param {number} value */
  add(time, value) {
    const points = this._points;
    if (time <= (points.at(-1)?.time ?? time - 1)) points.length = 0;
    points.push({ time, value });
    while (points[0].time < time - LOOK_BACK - SECONDS) points.shift();
  }

  /** The points that are shown, and when they end. */
  get _shown() {
    const end = (this._points.at(-1)?.time ?? 0) - this.back;
    return { end, points: this._points.filter(({ time }) => time <= end && time >= end - SECONDS) };
  }

  /** Mean and greatest value of what is shown. */
  get statistics() {
    const values = this._shown.points.map(({ value }) => value);
    const mean = values.reduce((a, b) => a + b, 0) / Math.max(1, values.length);
    return { mean, greatest: Math.max(0, ...values) };
  }

  draw() {
    const { canvas } = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    const [wide, high] = [width, height].map((each) => Math.round(each * ratio));
    if (canvas.width !== wide || canvas.height !== high) Object.assign(canvas, { width: wide, height: high });
    const context = canvas.getContext("2d");
    if (!context || width <= LEFT) return;
    const style = getComputedStyle(document.documentElement);
    const [right, foot] = [width - 2, height - BELOW];
    const { points, end } = this._shown;
    const greatest = Math.max(this.statistics.greatest, QUANTITIES[this.quantity].least);
    const { factor, unit, digits } = unitOf(this.quantity, greatest);
    const top = roundUp(greatest * factor) / factor;
    const xOf = (/** @type {number} */ ago) => right - ((right - LEFT) * ago) / SECONDS;
    const yOf = (/** @type {number} */ value) => foot - (foot - 7) * Math.min(value / top, 1);
    const line = (/** @type {number[][]} */ corners, /** @type {string} */ color, thick = 1) => {
      [context.strokeStyle, context.lineWidth] = [style.getPropertyValue(color), thick];
      context.beginPath();
      for (const [x, y] of corners) context.lineTo(x, y);
      context.stroke();
    };
    const write = (/** @type {string} */ text, /** @type {number} */ x, /** @type {number} */ y,
      /** @type {CanvasTextAlign} */ align, /** @type {CanvasTextBaseline} */ baseline) => {
      [context.textAlign, context.textBaseline] = [align, baseline];
      context.fillText(text, x, y);
    };
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = "11px system-ui, sans-serif";
    context.fillStyle = style.getPropertyValue("--soft");
    context.lineJoin = "round";
    for (const value of [0, top / 2, top]) {
      const number = value * factor;
      const text = number.toFixed(number < 10 && digits === 0 ? 1 : digits).replace(/\.0$/, "");
      write(text, LEFT - 5, yOf(value), "right", "middle");
      line([[LEFT, yOf(value)], [right, yOf(value)]], "--line");
    }
    for (let ago = 0; ago <= SECONDS; ago += 5) {
      const then = Math.round(ago + this.back);
      line([[xOf(ago), foot], [xOf(ago), foot + 3]], "--line");
      write(ago ? `−${then}` : then ? `−${then} s` : "0 s", xOf(ago), height, ago ? "center" : "right", "bottom");
    }
    write(unit, LEFT + 4, 0, "left", "top");
    line(points.map(({ time, value }) => [xOf(end - time), yOf(value)]), this.color, 1.6);
  }
}
