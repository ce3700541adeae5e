// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A line of the last seconds of a number, with axes: their numbers, their unit, their zero. */

const SECONDS = 20;
/** Room for the numbers beside and below the line [px]. */
const LEFT = 38;
const BELOW = 15;

/** @typedef {{factor: number, unit: string, digits: number}} Unit what a number is shown in */

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
    /** @type {{time: number, value: number}[]} */
    this._points = [];
  }

  /** @param {number} time [s] @param {number} value */
  add(time, value) {
    const points = this._points;
    if (points.length && time <= points[points.length - 1].time) points.length = 0;
    points.push({ time, value });
    while (points[0].time < time - SECONDS) points.shift();
  }

  clear() {
    this._points.length = 0;
  }

  /** Mean and greatest value of what is shown. */
  get statistics() {
    const values = this._points.map(({ value }) => value);
    if (!values.length) return { mean: 0, greatest: 0 };
    return { mean: values.reduce((a, b) => a + b) / values.length, greatest: Math.max(...values) };
  }

  draw() {
    const { canvas, _points: points } = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    }
    const context = canvas.getContext("2d");
    if (!context || width <= LEFT) return;
    const style = getComputedStyle(document.documentElement);
    const [right, foot] = [width - 2, height - BELOW];
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const { greatest } = this.statistics;
    const { factor, unit, digits } = this.unit(Math.max(greatest, this.least));
    const top = roundUp(Math.max(greatest, this.least) * factor) / factor;
    const yOf = (/** @type {number} */ value) => foot - (foot - 7) * Math.min(value / top, 1);
    context.font = "11px system-ui, sans-serif";
    context.fillStyle = style.getPropertyValue("--soft");
    context.strokeStyle = style.getPropertyValue("--line");
    context.lineWidth = 1;
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const value of [0, top / 2, top]) {
      const text = value ? (value * factor).toFixed(value * factor < 10 && digits === 0 ? 1 : digits) : "0";
      context.fillText(text.replace(/\.0$/, ""), LEFT - 5, yOf(value));
      this._line(context, LEFT, yOf(value), right, yOf(value));
    }
    context.textBaseline = "bottom";
    for (let second = 0; second <= SECONDS; second += 5) {
      const x = right - ((right - LEFT) * second) / SECONDS;
      this._line(context, x, foot, x, foot + 3);
      context.textAlign = second ? "center" : "right";
      context.fillText(second ? `−${second}` : "0 s", x, height);
    }
    context.textAlign = "left";
    context.textBaseline = "top";
    context.fillText(unit, LEFT + 4, 0);
    if (points.length < 2) return;
    const end = points[points.length - 1].time;
    context.strokeStyle = style.getPropertyValue(this.color);
    context.lineWidth = 1.6;
    context.lineJoin = "round";
    context.beginPath();
    for (const { time, value } of points) {
      context.lineTo(right - ((right - LEFT) * (end - time)) / SECONDS, yOf(value));
    }
    context.stroke();
  }

  /** @param {CanvasRenderingContext2D} context
   * @param {number} x @param {number} y @param {number} toX @param {number} toY */
  _line(context, x, y, toX, toY) {
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(toX, toY);
    context.stroke();
  }
}
