// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A line of the last seconds of a number. */

const SECONDS = 20;

export class Trace {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {number} least span of the scale, so that rest is no storm
   * @param {string} color name of a CSS variable
   */
  constructor(canvas, least, color) {
    this.canvas = canvas;
    this.least = least;
    this.color = color;
    /** @type {{time: number, value: number}[]} */
    this._points = [];
    this._scale = least;
  }

  /**
   * @param {number} time [s]
   * @param {number} value
   */
  add(time, value) {
    const points = this._points;
    if (points.length && time <= points[points.length - 1].time) points.length = 0;
    points.push({ time, value });
    while (points[0].time < time - SECONDS) points.shift();
  }

  clear() {
    this._points.length = 0;
  }

  draw() {
    const { canvas, _points: points } = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.round(canvas.clientWidth * ratio);
    const height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    const context = canvas.getContext("2d");
    if (!context) return;
    const style = getComputedStyle(document.documentElement);
    context.clearRect(0, 0, width, height);
    context.strokeStyle = style.getPropertyValue("--line");
    context.lineWidth = ratio;
    context.strokeRect(0.5, 0.5, width - 1, height - 1);
    if (points.length < 2) return;
    const greatest = points.reduce((most, point) => Math.max(most, point.value), 0);
    const wanted = Math.max(this.least, 1.15 * greatest);
    this._scale += 0.2 * (wanted - this._scale);
    const end = points[points.length - 1].time;
    context.strokeStyle = style.getPropertyValue(this.color);
    context.lineWidth = 1.6 * ratio;
    context.lineJoin = "round";
    context.beginPath();
    for (const { time, value } of points) {
      const x = width * (1 - (end - time) / SECONDS);
      const y = height - 2 - (height - 4) * Math.min(value / this._scale, 1);
      context.lineTo(x, y);
    }
    context.stroke();
  }
}
