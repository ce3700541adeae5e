// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A chart of the last seconds of a value, with the labels of its axes. */

import { textOf } from "./files.js";

/** Time shown at once, and time kept to look back at [s]. */
const SECONDS = 20;
const LOOK_BACK = 60;
/** Points further apart than this are not joined by a line [s]. */
const GAP = 1;
/** Quantities: least span of the axis, so that rest does not look like a storm, and units by size.
 * @type {Record<string, {least: number, units: Unit[]}>} */
const QUANTITIES = JSON.parse(await textOf("units.json"));

/** Unit of a value. @param {string} quantity @param {number} value */
function unitOf(quantity, value) {
  const { units } = QUANTITIES[quantity];
  return units.find(({ below = Infinity }) => value < below) ?? units[0];
}

/** Measured points, in runs without a gap. @template {{time: number, value: number}} T @param {T[]} points */
function runsOf(points) {
  /** @type {T[][]} */
  const runs = [];
  let last = -Infinity;
  for (const point of points) {
    const isMeasured = Number.isFinite(point.value);
    if (isMeasured && point.time - last > GAP) runs.push([]);
    if (isMeasured) runs[runs.length - 1].push(point);
    last = isMeasured ? point.time : -Infinity;
  }
  return runs;
}

export class Trace {
  /** @type {{time: number, value: number, band?: number[]}[]} */
  _points = [];
  /** Age of the right end [s]. */
  back = 0;

  /** @param {HTMLElement} element that it is shown in @param {string} quantity */
  constructor(element, quantity) {
    this.quantity = quantity;
    this._unit = unitOf(quantity, 0);
    this._line = element.querySelector(".line");
    this._shade = element.querySelector(".band");
    this._labels = element.querySelectorAll("li");
  }

  /** Begin anew. @param {string} quantity */
  show(quantity) {
    this.quantity = quantity;
    this._unit = unitOf(quantity, 0);
    this._points.length = 0;
  }

  /** A value in the unit of the axis. @param {number} value */
  textOf(value) {
    const { factor, unit, digits } = this._unit;
    return `${(factor * value).toFixed(digits)} ${unit}`;
  }

  /** @param {number} time [s] @param {number} value not finite where nothing is measured
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

  /** Mean and greatest of the values that are shown; null without any. */
  get statistics() {
    const values = this._shown.points.map(({ value }) => value).filter(Number.isFinite);
    if (!values.length) return null;
    return { mean: values.reduce((a, b) => a + b) / values.length, greatest: Math.max(...values) };
  }

  draw() {
    const { points, end } = this._shown;
    const runs = runsOf(points);
    const highest = runs.flat().map(({ value, band = [0, 0] }) => value + band[1]);
    const greatest = Math.max(...highest, QUANTITIES[this.quantity].least);
    this._unit = unitOf(this.quantity, greatest);
    const { factor, unit } = this._unit;
    const power = 10 ** Math.floor(Math.log10(greatest * factor));
    const top = power * ([1, 2, 5].find((step) => step * power >= 0.999 * greatest * factor) ?? 10);
    /** @param {number} time @param {number} value */
    const corner = (time, value) => [SECONDS - end + time, 1 - Math.min(Math.max((value * factor) / top, 0), 1)];
    const lines = runs.map((run) => `M${run.map(({ time, value }) => corner(time, value)).join("L")}`);
    this._line?.setAttribute("d", lines.join(""));
    const bands = runs.filter((run) => run.some(({ band }) => band)).map((run) => {
      const sure = run.map(({ time, value, band = [0, 0] }) => band.map((off) => corner(time, value + off)));
      return `M${[...sure.map(([low]) => low), ...sure.map(([, high]) => high).reverse()].join("L")}Z`;
    });
    this._shade?.setAttribute("d", bands.join(""));
    const numbers = [top, top / 2, 0].map((each) => String(Number(each.toPrecision(2))));
    const times = [20, 15, 10, 5, 0].map((ago, i) => `${Math.round(-ago - this.back)}${i < 4 ? "" : " s"}`.replace("-", "−"));
    [unit, ...numbers, ...times].forEach((text, i) => (this._labels[i].textContent = text));
  }
}
