// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A line of the last seconds of a number, with axes: their numbers, their unit, their zero. */

/** Shown at once, and kept to look back at [s]. */
const SECONDS = 20;
export const LOOK_BACK = 60;
/** Room for the numbers beside and below the line [px]. */
const LEFT = 38;
const BELOW = 15;

/** The next round number. @param {number} value */
function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((step) => step * power).find((each) => each >= 0.999 * value) ?? value;
}

export class Trace {
  /** @param {HTMLCanvasElement} canvas
   * @param {number} least span of the scale, so that rest is no storm
   * @param {string} color name of a CSS variable @param {(greatest: number) => Unit} unit */
  constructor(canvas, least, color, unit) {
    this.canvas = canvas;
    this.least = least;
    this.color = color;
    this.unit = unit;
    /** How long ago what is shown ends [s]. */
    this.back = 0;
    /** @type {{time: number, value: number}[]} */
    this._points = [];
  }

  /** @param {number} time [s] @param {number} value */
  add(time, value) {
    const points = this._points;
    if (points.length && time <= points[points.length - 1].time) points.length = 0;
    points.push({ time, value });
    while (points[0].time < time - LOOK_BACK - SECONDS) points.shift();
  }

  clear() {
    this._points.length = 0;
  }

  /** The points that are shown, and when they end. */
  get _shown() {
    const end = (this._points[this._points.length - 1]?.time ?? 0) - this.back;
    return { end, points: this._points.filter(({ time }) => time <= end && time >= end - SECONDS) };
  }

  /** Mean and greatest value of what is shown. */
  get statistics() {
    const values = this._shown.points.map(({ value }) => value);
    if (!values.length) return { mean: 0, greatest: 0 };
    return { mean: values.reduce((a, b) => a + b) / values.length, greatest: Math.max(...values) };
  }

  draw() {
    const { canvas } = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    }
    const context = canvas.getContext("2d");
    if (!context || width <= LEFT) return;
    const style = getComputedStyle(document.documentElement);
    const [right, foot] = [width - 2, height - BELOW];
    const { points, end } = this._shown;
    const greatest = Math.max(this.statistics.greatest, this.least);
    const { factor, unit, digits } = this.unit(greatest);
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
      const text = (value * factor).toFixed(value * factor < 10 && digits === 0 ? 1 : digits).replace(/\.0$/, "");
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
