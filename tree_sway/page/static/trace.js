// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A chart of the last seconds of a value, with the labels of its axes. */

import { textOf } from "./files.js";

/** Time shown at once, and time kept to look back at [s]. */
const SECONDS = 20;
export const LOOK_BACK = 60;
/** Quantities: least span of the axis, so that rest does not look like a storm, and units by size.
 * @type {Record<string, {least: number, units: Unit[]}>} */
export const QUANTITIES = JSON.parse(await textOf("units.json"));

/** Unit of a value. @param {string} quantity @param {number} value */
export function unitOf(quantity, value) {
  const { units } = QUANTITIES[quantity];
  return units.find(({ below = Infinity }) => value < below) ?? units[0];
}

export class Trace {
  /** @param {HTMLElement} element that it is shown in @param {string} quantity */
  constructor(element, quantity) {
    this.quantity = quantity;
    this._line = element.querySelector("polyline");
    this._shade = element.querySelector("polygon");
    this._labels = element.querySelectorAll("li");
    /** Age of the right end [s]. */
    this.back = 0;
    this._points = /** @type {{time: number, value: number, band?: number[]}[]} */ ([]);
  }

  /** Begin anew. @param {string} quantity */
  show(quantity) {
    this.quantity = quantity;
    this._points.length = 0;
  }

  /** @param {number} time [s] @param {number} value
   * @param {number[]} [band] interval of the real one, less the value */
  add(time, value, band) {
    const points = this._points;
    if (time <= (points.at(-1)?.time ?? time - 1)) points.length = 0;
    points.push({ time, value, band });
    while (points[0].time < time - LOOK_BACK - SECONDS) points.shift();
  }

  get _shown() {
    const end = (this._points.at(-1)?.time ?? 0) - this.back;
    return { end, points: this._points.filter(({ time }) => time <= end && time >= end - SECONDS) };
  }

  get statistics() {
    const values = this._shown.points.map(({ value }) => value);
    const mean = values.reduce((a, b) => a + b, 0) / Math.max(1, values.length);
    return { mean, greatest: Math.max(0, ...values) };
  }

  draw() {
    const { points, end } = this._shown;
    const highest = points.map(({ value, band = [0, 0] }) => value + band[1]);
    const greatest = Math.max(...highest, QUANTITIES[this.quantity].least);
    const { factor, unit, digits } = unitOf(this.quantity, greatest);
    const power = 10 ** Math.floor(Math.log10(greatest * factor));
    const top = power * ([1, 2, 5].find((step) => step * power >= 0.999 * greatest * factor) ?? 10);
    /** @param {number} time @param {number} value */
    const corner = (time, value) => [SECONDS - end + time, 1 - Math.min(Math.max((value * factor) / top, 0), 1)];
    this._line?.setAttribute("points", points.map(({ time, value }) => corner(time, value)).join(" "));
    const sure = points.map(({ time, value, band = [0, 0] }) => band.map((off) => corner(time, value + off)));
    const around = [...sure.map(([low]) => low), ...sure.map(([, high]) => high).reverse()];
    this._shade?.setAttribute("points", points.some(({ band }) => band) ? around.join(" ") : "");
    const numbers = [top, top / 2, 0].map((each) => each.toFixed(each < 10 && digits === 0 ? 1 : digits).replace(/\.0$/, ""));
    const times = [20, 15, 10, 5, 0].map((ago) => Math.round(ago + this.back)).map((ago, i) => `${ago ? "−" : ""}${ago}${i < 4 ? "" : " s"}`);
    [unit, ...numbers, ...times].forEach((text, i) => (this._labels[i].textContent = text));
  }
}
