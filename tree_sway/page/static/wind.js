// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Wind of a page without a server: simulated turbulence, or a recorded one from a table. */

import { ProtocolError } from "./checks.js";

/** Standard deviation over that along the wind, and length scale at 10 m [m], along, across and up (IEC 61400-1,
 * Kaimal). */
const SPREAD = [1, 0.8, 0.5];
const LENGTH = [56.7, 18.9, 4.6];
/** Number of processes that make up a component, and the ratio of their time scales. */
const PROCESSES = 4;
const QUICKER = 4;
const POWERS = Array.from({ length: PROCESSES }, (_, n) => QUICKER ** ((-2 / 3) * n));
const WEIGHTS = POWERS.map((power) => Math.sqrt(power / POWERS.reduce((a, b) => a + b)));
/** Least mean wind for the time scales [m/s]. */
const SLOWEST = 0.5;
/** Fastest wind that is read [m/s]. */
const FASTEST = 150;

/** Draw from the standard normal distribution (Box and Muller 1958). */
const normal = () => Math.sqrt(-2 * Math.log(1 - Math.random())) * Math.cos(2 * Math.PI * Math.random());

/** Turbulence whose mean may change: each component is a sum of first-order processes; variances that go with
 * their time scales to 2/3 give the slope of -5/3 of the inertial range (Kolmogorov 1941). */
export class Turbulence {
  /** Mean [m/s], turbulence intensity, and the direction it blows to, clockwise from north [rad].
   * @type {Record<string, number>} */
  values = { mean_speed: 6, intensity: 0.2, bearing_to: Math.PI / 2 };
  _state = SPREAD.map(() => Array.from({ length: PROCESSES }, normal));

  /** Mean wind of the next step. @param {number} dt [s] */
  next(dt) {
    const { mean_speed: mean, intensity, bearing_to: bearing } = this.values;
    const [along, across, up] = this._state.map((state, c) => {
      let sum = 0;
      state.forEach((value, n) => {
        const scale = LENGTH[c] / Math.max(mean, SLOWEST) / QUICKER ** n;
        const stays = Math.exp(-dt / scale);
        state[n] = stays * value + Math.sqrt(1 - stays * stays) * normal();
        sum += WEIGHTS[n] * state[n];
      });
      return SPREAD[c] * intensity * mean * sum;
    });
    const s = Math.sin(bearing), c = Math.cos(bearing);
    return [s * (mean + along) - c * across, c * (mean + along) + s * across, up];
  }
}

/** A recorded wind, which starts again after its end. */
export class Recorded {
  /** Time since the start of the record [s]. */
  time = 0;
  _row = 0;

  /** @param {number[]} times [s] @param {number[][]} winds blowing to [m/s] */
  constructor(times, winds) {
    this.times = times;
    this.winds = winds;
    this.length = times[times.length - 1] - times[0];
  }

  /** Mean wind of the next step. @param {number} dt [s] */
  next(dt) {
    const { times, winds } = this;
    this.time = this.time + dt > this.length ? 0 : this.time + dt;
    const now = times[0] + this.time;
    if (times[this._row] > now) this._row = 0;
    while (times[this._row + 1] < now) this._row++;
    const a = this._row, b = this._row + 1;
    const u = (now - times[a]) / (times[b] - times[a]);
    return winds[a].map((each, c) => each + u * (winds[b][c] - each));
  }
}

const NAMES = [["time", "t", "timestamp", "stamp", "seconds"], ["u", "x", "east"], ["v", "y", "north"],
  ["w", "z", "up"], ["speed", "wind_speed", "ws"], ["direction", "wind_direction", "dir", "wd"]];
const UNITS = { "km/h": 1 / 3.6, kt: 0.514444, kn: 0.514444, mph: 0.44704 };

/** Read a table with a header: `time` [s, or a date], and `u`, `v` and maybe `w` [m/s], where the wind
 * blows to, or `speed` and `direction` [degrees], where it comes from. A unit may follow a name.
 * @param {string} text @param {string} file its name @returns {Recorded} */
export function readWind(text, file) {
  const nameOf = (/** @type {string} */ cell) => cell.toLowerCase().replace(/["']|[[(].*/g, "").trim();
  const rows = text.split(/\r?\n/).map((line) => line.split(/[,;\t]/).map((cell) => cell.trim()));
  const head = rows.findIndex((row) => row.some((cell) => NAMES[0].includes(nameOf(cell))));
  const names = rows[head]?.map(nameOf) ?? [];
  const columns = NAMES.map((known) => names.findIndex((name) => known.includes(name)));
  const [time, u, v, w, speed, direction] = columns;
  if (time < 0 || ((u < 0 || v < 0) && (speed < 0 || direction < 0))) {
    throw new ProtocolError(`${file} is no table of wind: its first line must name a column "time", and "u" and "v"`
      + ` (m/s, blowing to) or "speed" and "direction" (m/s, degrees it comes from). Drop another file.`);
  }
  const isVector = u >= 0 && v >= 0;
  const unit = Object.entries(UNITS).find(([name]) => rows[head][isVector ? u : speed].includes(name))?.[1] ?? 1;
  /** @type {number[]} */
  const times = [];
  /** @type {number[][]} */
  const winds = [];
  for (const row of rows.slice(head + 1)) {
    const [seconds, x, y, z, s, from] = columns.map((at) => (row[at] ? Number(row[at]) : NaN));
    const when = Number.isFinite(seconds) ? seconds : Date.parse(row[time]) / 1000;
    const way = [-Math.sin((from * Math.PI) / 180), -Math.cos((from * Math.PI) / 180), 0];
    const wind = isVector ? [x, y, w < 0 ? 0 : z].map((each) => unit * each) : way.map((each) => unit * s * each);
    if (!(Math.hypot(...wind) <= FASTEST && when > (times.at(-1) ?? -Infinity))) continue;
    times.push(when);
    winds.push(wind);
  }
  if (times.length < 2) throw new ProtocolError(`${file} has fewer than two rows of a time and a wind. Drop another file.`);
  return new Recorded(times, winds);
}
