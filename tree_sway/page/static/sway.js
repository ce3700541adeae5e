// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The solver in JavaScript: trees in wind by the tables that this program exports.
 *
 * A tree is m coordinates; a table has what every even wind does to them; each goes on by its exact
 * propagator. Outside of the table the load of its edge is used, which `Stand.outside` counts. The law is
 * that of table_model.py in tree_sway/core/run, gust_travel.py in core/wind and drag_law.py in
 * core/model, and vectors of these hold it;
 * doc/tree_as_a_file.md is for its users. */

import { checkTable, checkTablesHeader, FORMS, need, ProtocolError } from "./checks.js";
import { ClampWatch, fewer } from "./clamp_watch.js";
import { reader } from "./protocol.js";
import { Touch } from "./touch.js";

/** Time step of a stand unless it is given another [s]. */
export const STEP = 1 / 60;

const [AZIMUTHS, LEVELS] = [24, 7];
/** Sine of the elevation from which on a wind goes over to one straight up or down. */
const STEEP = Math.sin(Math.PI / 4);
/** Passes in which the force of a step is found, as of tree_sway/core/run/table_model.py. */
const [MOST_PASSES, STRIDE, MOMENTUM] = [8, 1.5, 0.1];
const HALF_AIR_DENSITY = 0.5 * 1.225; // [kg/m^3]
/** Speeds between which leaves streamline [m/s]. */
const [STREAMLINING_FROM, STREAMLINING_TO] = [4, 20];
/** Share by which scales may differ that have one time step. */
const FINEST_SCALE = 0.01;
/** Of gusts: least mean wind that carries them [m/s], change of a delay per second, the time [s] over
 * which the mean is taken, and the longest delay [s]. */
const [SLOWEST_GUST, LARGEST_STRETCH, AVERAGING, MEMORY] = [0.5, 0.5, 60, 60];
/** Of the wind that is on its way [s], and the share of the way of the slowest coordinate that a rate is
 * taken to go within a step, at least. */
const [SPACING, SLOWEST] = [0.05, 0.3];

/** Highest degree of the harmonics. */
const DEGREE = 5;

/** Read tables; a `ProtocolError` with a sentence if they are damaged. */
export const decodeTables = reader("tables", (header, kinds, own) => {
  const { description, anemometer, convection_ratio: ratio } = header;
  checkTablesHeader(header, kinds.map((arrays) => arrays.stiffness?.values.length ?? 0), own);
  const speeds = own.tree_speed.values;
  const tables = kinds.map((arrays, number) => new Table(header.kinds[number], arrays));
  return { description, anemometer, ratio: ratio ?? Infinity, kinds: tables, speeds: Float64Array.from(speeds) };
});

/** What an even wind does to the coordinates of a kind of tree. */
export class Table {
  /** @param {Record<string, any>} numbers @param {Arrays} arrays */
  constructor(numbers, arrays) {
    const size = checkTable(numbers, arrays);
    const { m, n } = size;
    const { most_pressure: mostPressure, most_energy: mostEnergy, drag_law: law } = numbers;
    /** Coordinates, and those of the description. */
    this.m = m;
    this.n = n;
    /** Dynamic pressure [kg/m/s^2] and twice the energy [J] up to which the table holds. */
    this.mostPressure = /** @type {number} */ (mostPressure);
    this.mostEnergy = /** @type {number} */ (mostEnergy);
    /** C, N and C0 of the drag, C U^-N + C0. @type {number[]} */
    this.law = law;
    /** All but the factors of slopes, in double precision. @type {Record<string, Float64Array>} */
    this.arrays = Object.fromEntries(Object.entries(arrays).filter(([name]) => !/_(rows|shapes)$/.test(name))
      .map(([name, { values }]) => [name, Float64Array.from(values)]));
    this.nKeys = size.keys;
    // Turning and damping side by side: they are read together.
    this.slopes = this._slopes(arrays, ["turning", "damping"]);
    this.steep = this._slopes(arrays, ["steep_turning", "steep_damping"]);
    this.lean = this._slopes(arrays, ["lean"]);
    /** What is worked in. */
    this.scratch = Array.from({ length: 10 }, () => new Float64Array(m));
    /** Change of the forces in the last pass of a step. */
    this.change = new Float64Array(m);
    this.values = new Float64Array(arrays.harmonics.values.length / m);
  }

  /** Slopes from their factors, a row of each direction of the wind: by the coordinate that is loaded, the
   * one that moves, and the names in turn. @param {Arrays} arrays @param {string[]} names */
  _slopes(arrays, names) {
    const { m } = this;
    const root = this.arrays.stiffness.map(Math.sqrt);
    const [directions] = FORMS.tables[`${names[0]}_rows`].slice(1);
    const all = Array.from({ length: Number(directions) }, () => new Float64Array(names.length * m * m));
    names.forEach((name, number) => {
      const [{ values: rows }, { values: shapes }] = [arrays[`${name}_rows`], arrays[`${name}_shapes`]];
      const rank = rows.length / all.length;
      all.forEach((slopes, row) => {
        for (let at = 0; at < m * m; at++) {
          const [moved, loaded] = [Math.floor(at / m), at % m];
          let sum = 0;
          for (let r = 0; r < rank; r++) sum += rows[row * rank + r] * shapes[r * m * m + at];
          slopes[(loaded * m + moved) * names.length + number] = Math.fround(sum * (root[moved] * root[loaded]));
        }
      });
    });
    return all;
  }

  /** Drag per area and speed squared [kg/m^3]. @param {number} speed [m/s] */
  dragDensity(speed) {
    const [coefficient, exponent, steady] = this.law;
    if (exponent === 0) return HALF_AIR_DENSITY * (coefficient + steady);
    const streamlined = Math.min(Math.max(speed, STREAMLINING_FROM), STREAMLINING_TO);
    return HALF_AIR_DENSITY * (coefficient * streamlined ** -exponent + steady);
  }
}

/** How oscillators of unit inertia go on exactly in a time under a constant force, per coordinate:
 * position from position, rate and force, then the rate from them. @param {Float64Array} stiffness
 * @param {Float64Array} damping @param {number} time [s] */
export function propagator(stiffness, damping, time) {
  const out = new Float64Array(6 * stiffness.length);
  stiffness.forEach((k, i) => {
    const [alpha, kappa] = [(damping[i] * time) / 2, k * time * time];
    const square = alpha * alpha - kappa;
    const root = Math.sqrt(Math.abs(square));
    const [slow, fast] = [-kappa / (alpha + root), -alpha - root];
    const even = square > 0 ? Math.exp(slow) : Math.exp(-alpha) * Math.cos(root);
    let s = Math.exp(-alpha) * (1 + square / 6);
    if (root > 1e-3) {
      s = square > 0 ? (Math.exp(slow) - Math.exp(fast)) / (2 * root) : (Math.exp(-alpha) * Math.sin(root)) / root;
    }
    const stays = square > 0 ? even - slow * s : even + alpha * s;
    const keeps = square > 0 ? Math.exp(fast) + slow * s : even - alpha * s;
    let [pushed, before, term] = [0, 0, 0.5];
    // The power series where 1 - stays would cancel.
    for (let power = 2; power < 24; power++) {
      pushed += term;
      [before, term] = [term, (-2 * alpha * power * term - kappa * before) / (power * (power + 1))];
    }
    if (kappa + alpha > 0.5) pushed = (1 - stays) / kappa;
    out.set([stays, time * s, time * time * pushed, (-kappa * s) / time, keeps, time * s], 6 * i);
  });
  return out;
}

/** How oscillators get to the middle of a step, where the load is taken: exactly, but by an implicit Euler
 * step where one swings so fast that its rate there would not follow its force.
 * @param {Float64Array} stiffness @param {Float64Array} damping @param {number} time half of the step [s] */
export function toMiddle(stiffness, damping, time) {
  const out = propagator(stiffness, damping, time);
  stiffness.forEach((k, i) => {
    const share = 1 / (1 + time * damping[i] + time * time * k);
    if (out[6 * i + 5] >= time * share) return;
    const rate = [-time * k * share, share, time * share];
    out.set([1 + time * rate[0], time * rate[1], time * rate[2], ...rate], 6 * i);
  });
  return out;
}

/** A tree on a table: its modal coordinates, their rates and the forces on them. */
export class TreeState {
  /** @param {Table} table */
  constructor(table) {
    this.table = table;
    this.eta = new Float64Array(table.m);
    this.rate = new Float64Array(table.m);
    this.force = new Float64Array(table.m);
    /** Number of the first coordinates that are solved. */
    this.count = table.m;
    /** Whether the last step was clamped in a wind that cannot bend the tree so far. */
    this.isBentTooFar = false;
  }

  /** Return to rest, and solve the first coordinates only. @param {number} [count] all unless given */
  reset(count = this.table.m) {
    for (const each of [this.eta, this.rate, this.force]) each.fill(0);
    this.count = count;
    this.isBentTooFar = false;
  }

  /** Go on a step. @param {Float64Array} half `toMiddle` of half a step @param {Float64Array} whole
   * @param {number} wx mean wind in the frame of the kind [m/s] @param {number} wy @param {number} wz
   * @returns {boolean} whether the load was that of the table's edge */
  step(half, whole, wx, wy, wz) {
    const { table, eta, rate, force } = this;
    const { m, mostPressure, mostEnergy, arrays: { stiffness } } = table;
    const change = table.change;
    const speed = Math.sqrt(wx * wx + wy * wy + wz * wz);
    const drag = table.dragDensity(speed);
    let isOutside = drag * speed * speed > mostPressure;
    let before = 0;
    for (let i = 0; i < m; i++) before += stiffness[i] * eta[i] * eta[i] + rate[i] * rate[i];
    const push = Math.min(drag * speed * speed, mostPressure);
    const way = speed > 0 ? [wx / speed, wy / speed, wz / speed] : [1, 0, 0];
    let [passes, stiffest] = [1, 0];
    for (let pass = 0; pass < passes; pass++) {
      const [wanted, diagonal] = this.loadOfMiddle(half, way, push, drag);
      for (let i = 0; i < m; i++) {
        // Implicit in all damping, as if the others moved with it: stable for any wind and step.
        const own = diagonal[i] * half[6 * i + 5];
        if (pass) {
          change[i] = STRIDE * ((wanted[i] - force[i]) / (1 - own)) + MOMENTUM * change[i];
          force[i] += change[i];
        } else {
          const f = (wanted[i] - own * force[i]) / (1 - own);
          change[i] = f - force[i];
          force[i] = f;
          stiffest = Math.max(stiffest, -own);
        }
      }
      // So bounded, the force lags where drag stops a coordinate within half a step.
      for (; !pass && stiffest > 1 && passes < MOST_PASSES; passes++) stiffest *= 0.5;
    }
    let energy = 0;
    for (let i = 0, at = 0; i < m; i++, at += 6) {
      const [q, v, f] = [eta[i], rate[i], force[i]];
      eta[i] = whole[at] * q + whole[at + 1] * v + whole[at + 2] * f;
      rate[i] = whole[at + 3] * q + whole[at + 4] * v + whole[at + 5] * f;
      energy += stiffness[i] * eta[i] * eta[i] + rate[i] * rate[i];
    }
    const most = Math.max(before, mostEnergy);
    if (!(energy <= most)) {
      // No wind takes it further; from rest again where it is not a number.
      const share = energy < Infinity ? Math.sqrt(most / energy) : 0;
      for (const all of share ? [eta, rate] : [eta, rate, force]) {
        all.forEach((each, i) => (all[i] = share ? share * each : 0));
      }
      isOutside = true;
    }
    this.isBentTooFar = isOutside && push < 0.5 * mostPressure;
    return isOutside;
  }

  /** Go to the middle of a step under the force; returns the forces of the wind there and the diagonal of
   * their slope by the rates. @param {Float64Array} half `toMiddle` of half a step @param {number[]} way of
   * the wind @param {number} push dynamic pressure @param {number} drag the same over speed squared */
  loadOfMiddle(half, way, push, drag) {
    const { table, eta, rate, force } = this;
    const [midEta, midRate, wanted, diagonal] = table.scratch;
    for (let i = 0, at = 0; i < table.m; i++, at += 6) {
      midEta[i] = half[at] * eta[i] + half[at + 1] * rate[i] + half[at + 2] * force[i];
      midRate[i] = half[at + 3] * eta[i] + half[at + 4] * rate[i] + half[at + 5] * force[i];
    }
    windForce(table, way, push, drag, this.count);
    return [wanted, diagonal];
  }

  /** Write the coordinates of the description that hold this state.
   * @template {Float32Array | Float64Array} T @param {T} out @param {number} [from] @returns {T} */
  coordinates(out, from = 0) {
    const { m, n, arrays: { state: matrix } } = this.table;
    for (let k = 0; k < n; k++) {
      let sum = 0;
      for (let i = 0; i < m; i++) sum += this.eta[i] * matrix[i * n + k];
      out[from + k] = sum;
    }
    return out;
  }
}

/** Modal forces of an even wind on a tree half a step on, and the diagonal of their slope by the rates,
 * into the scratch of its table. @param {Table} table @param {number[]} way where the wind goes, a unit
 * vector @param {number} push dynamic pressure [kg/m/s^2] @param {number} drag the same over speed squared
 * @param {number} count of the first coordinates, whose motion loads all */
function windForce(table, [x, y, z], push, drag, count) {
  const { m, slopes, lean, values, arrays } = table;
  const { motion, load, limit, equilibrium, harmonics, cross_damping: cross } = arrays;
  const [eta, rate, force, diagonal, leaning, leaned, offA, offB, offC, offD] = table.scratch;
  fillHarmonics(x, y, z, values);
  const { here, there, first, second, share, up } = corners(table, x, y);
  const steep = Math.max(0, (Math.abs(z) - STEEP) / (1 - STEEP));
  const slant = Math.min(Math.max(z, -STEEP), STEEP);
  const [from, to, slight] = [1 - share, share, 1 - steep];
  const [a, b, c, d] = [from * (1 - up), from * up, to * (1 - up), to * up].map((each) => slight * each);
  const [ia, ib, ic, id] = [first * m, (first + 1) * m, second * m, (second + 1) * m];
  let moving = drag > 0 ? push / drag : 0;
  // Slopes are in single precision, and so are their weights.
  const [e, f] = [slight * from * slant, slight * to * slant];
  const [a4, b4, c4, d4, e4, f4, s4] = [a, b, c, d, e, f, steep].map(Math.fround);
  for (let i = 0; i < m; i++) {
    const [on, by] = [equilibrium[ib + i] - equilibrium[ia + i], equilibrium[id + i] - equilibrium[ic + i]];
    const away = eta[i] - from * (equilibrium[ia + i] + up * on) - to * (equilibrium[ic + i] + up * by);
    // Half of the way to each pose, so that loads between levels are cubic.
    offA[i] = a * (away + 0.5 * up * on), offB[i] = b * (away - 0.5 * (1 - up) * on);
    offC[i] = c * (away + 0.5 * up * by), offD[i] = d * (away - 0.5 * (1 - up) * by);
    moving += motion[i] * rate[i] * rate[i];
    let sum = a * load[ia + i] + b * load[ib + i] + c * load[ic + i] + d * load[id + i];
    for (let k = 0, at = i; k < values.length; k++, at += m) sum += values[k] * harmonics[at];
    force[i] = sum;
    leaning[i] = Math.fround(e4 * Math.fround(eta[i]));
    leaned[i] = Math.fround(f4 * Math.fround(eta[i]));
  }
  const dragged = drag * Math.sqrt(moving);
  const [ta, tb, tc, td] = [slopes[first], slopes[first + 1], slopes[second], slopes[second + 1]];
  const [near, next, pole] = [lean[here], lean[there], table.steep[z > 0 ? 1 : 0]];
  for (let i = 0; i < m; i++) {
    const own = 2 * (i * m + i) + 1;
    let [turned, damped, at, flat] = [0, 0, 2 * i * m, i * m];
    for (let k = 0; k < count; k++, at += 2, flat++) {
      turned += offA[k] * ta[at] + offB[k] * tb[at] + offC[k] * tc[at] + offD[k] * td[at]
        + leaning[k] * near[flat] + leaned[k] * next[flat];
      damped += rate[k] * (a4 * ta[at + 1] + b4 * tb[at + 1] + c4 * tc[at + 1] + d4 * td[at + 1]);
    }
    for (let k = 0, p = 2 * i * m; steep > 0 && k < count; k++) {
      turned += Math.fround(s4 * Math.fround(eta[k])) * pole[p++];
      damped += s4 * rate[k] * pole[p++];
    }
    // Slopes hold near a pose. However far it is from there, a wind loads a tree no more.
    force[i] = push * Math.min(Math.max(force[i] + turned, -limit[i]), limit[i]) + dragged * damped;
    diagonal[i] = dragged * (a * (ta[own] - cross[ia + i]) + b * (tb[own] - cross[ib + i])
      + c * (tc[own] - cross[ic + i]) + d * (td[own] - cross[id + i]) + steep * pole[own]);
  }
}

/** Where a wind and a lean are in a table: azimuths, of both the rows of the level below, shares of the way
 * to the next. @param {Table} table @param {number} x @param {number} y */
function corners({ m, scratch: [eta], arrays: { amount, levels } }, x, y) {
  const turn = Math.atan2(y, x) * (0.5 / Math.PI) * AZIMUTHS;
  const share = turn - Math.floor(turn);
  const here = (Math.floor(turn) + AZIMUTHS) % AZIMUTHS;
  const there = (here + 1) % AZIMUTHS;
  const [first, second] = [here * LEVELS, there * LEVELS];
  let lean = 0;
  for (let i = 0; i < m; i++) {
    lean += ((1 - share) * amount[here * m + i] + share * amount[there * m + i]) * eta[i];
  }
  const at = (/** @type {number} */ j) => (1 - share) * levels[first + j] + share * levels[second + j];
  let level = 0;
  while (level < LEVELS - 2 && lean > at(level + 1)) level++;
  const [below, above] = [at(level), at(level + 1)];
  const up = Math.min(Math.max((lean - below) / (above - below), 0), 1);
  return { here, there, first: first + level, second: second + level, share, up };
}

/** Square norms of the harmonics by degree and order, over those of their Legendre functions. */
const NORMS = [0, 1, 2, 3, 4, 5].map((degree) => {
  let norm = 2 * degree + 1;
  return Array.from({ length: degree + 1 }, (_, order) => {
    if (order) norm /= (degree + order) * (degree - order + 1);
    return Math.sqrt(order ? 2 * norm : norm);
  });
});

/** Real spherical harmonics of odd degree, as of tree_sway/core/model/spherical_harmonics.py.
 * @param {number} x @param {number} y @param {number} z a unit vector
 * @param {Float64Array} out */
function fillHarmonics(x, y, z, out) {
  let [c, s, first] = [1, 0, 1];
  for (let order = 0; order <= DEGREE; order++) {
    // Legendre functions over the sine to the power of their order, by their recurrence in the degree.
    let [before, now] = [0, first];
    for (let degree = order; degree <= DEGREE; degree++) {
      const middle = (degree * (degree + 1)) / 2;
      if (degree % 2) out[middle - order] = NORMS[degree][order] * now * s;
      if (degree % 2) out[middle + order] = NORMS[degree][order] * now * c;
      const next = ((2 * degree + 1) * z * now - (degree + order) * before) / (degree - order + 1);
      [before, now] = [now, next];
    }
    [c, s, first] = [x * c - y * s, x * s + y * c, (2 * order + 1) * first];
  }
}

/** The wind of the last minute, and what of it each place feels: gusts travel with the mean wind. */
class Gusts {
  /** @param {number[][]} places @param {Tables} tables @param {number} dt [s] */
  constructor(places, { anemometer, ratio }, dt) {
    const [ox, oy] = anemometer ?? [0, 0];
    this._along = places.map(([x, y]) => [x - ox, y - oy]);
    this._fromFirst = !anemometer;
    this._ratio = ratio;
    this._dt = dt;
    this.felt = places.map(() => [0, 0, 0]);
    /** Time, and run of the wind since the start, at the end of each step. */
    this._run = [[0, 0, 0, 0]];
    /** Mean wind, and the time that it is the mean of. */
    this._mean = [0, 0, 0];
    this._delay = places.map(() => 0);
  }

  /** @param {number} x mean wind of a step [m/s] @param {number} y @param {number} z */
  push(x, y, z) {
    const { _run: run, _mean: mean, _dt: dt, _delay: delay } = this;
    const last = run[run.length - 1];
    run.push([last[0] + dt, last[1] + x * dt, last[2] + y * dt, last[3] + z * dt]);
    if (run.length > (2 * MEMORY) / dt) run.splice(0, MEMORY / dt - 4);
    mean[2] = Math.min(mean[2] + dt, AVERAGING);
    mean[0] += (dt / mean[2]) * (x - mean[0]);
    mean[1] += (dt / mean[2]) * (y - mean[1]);
    const speed = Math.max(Math.hypot(mean[0], mean[1]), SLOWEST_GUST);
    const wanted = this._along.map(([u, v]) => (u * mean[0] + v * mean[1]) / (this._ratio * speed * speed));
    const first = this._fromFirst ? wanted.reduce((a, b) => Math.min(a, b), Infinity) : 0;
    const now = last[0] + dt;
    wanted.forEach((each, i) => {
      const goal = Math.min(Math.max(each - first, 0), MEMORY);
      const before = run.length === 2 ? goal : delay[i];
      const most = LARGEST_STRETCH * dt;
      delay[i] = Math.min(Math.max(goal, before - most), before + most);
      if (before === 0 && delay[i] === 0) return (this.felt[i] = [x, y, z]);
      const [begin, end] = [now - dt - before, now - delay[i]];
      const [from, to] = [this._until(begin), this._until(end)];
      this.felt[i] = from.map((each, c) => (to[c] - each) / (end - begin));
    });
  }

  /** Go on from what another has felt, `GustHistory.recent` of tree_sway/core/wind/gust_travel.py.
   * @param {Recent} recent */
  goOn({ mean, delay, wind }) {
    const { _run: run, _dt: dt } = this;
    for (let i = 1; i <= (wind.length * SPACING) / 3 / dt; i++) {
      const at = 3 * Math.floor(((i - 0.5) * dt) / SPACING);
      run.push(run[i - 1].map((each, c) => each + dt * (c ? wind[at + c - 1] : 1)));
    }
    if (delay.length === this._delay.length) [this._mean, this._delay] = [mean, delay];
  }

  /** Run of the wind at a time; before all it blew as in the first step. @param {number} time [s] */
  _until(time) {
    const run = this._run;
    const cell = Math.floor((time - run[0][0]) / this._dt);
    const [a, b] = run.slice(Math.min(Math.max(cell, 0), run.length - 2));
    const u = (time - a[0]) / (b[0] - a[0]);
    return [1, 2, 3].map((c) => a[c] + u * (b[c] - a[c]));
  }
}

/** Described trees that sway in one wind. */
export class Stand {
  /** @param {Tables} tables @param {Description} description @param {number} [dt] time step [s] */
  constructor(tables, description, dt = STEP) {
    const { kinds, trees, identity } = description;
    need(tables.description === identity && tables.speeds.length === trees.length, "description");
    need(tables.kinds.length === kinds.length, "kinds");
    tables.kinds.forEach(({ n, nKeys, arrays }, k) => {
      const { nCoordinates, nKeys: rows, arrays: { branch_keys: keys } } = kinds[k];
      let most = 0;
      for (const each of keys) most = Math.max(most, each);
      need(n === nCoordinates, "state");
      need(nKeys === rows && arrays.branch_compliance.length >= rows * most, "branch_compliance");
    });
    this.dt = dt;
    this.description = description;
    this._newGusts = () => new Gusts(trees.map(({ place }) => place), tables, dt);
    this.gusts = this._newGusts();
    /** Trees whose load was at the edge of their table in the last step. */
    this.outside = 0;
    /** Times that a tree whose steps stayed clamped went on from rest with fewer coordinates. */
    this.reduced = 0;
    this._steps = 0;
    this._watches = /** @type {Map<number, ClampWatch>} */ (new Map());
    const found = /** @type {Map<string, Float64Array[]>} */ (new Map());
    /** Pushes by the numbers of trees. */
    this._touches = /** @type {Map<number, Touch>} */ (new Map());
    this.trees = trees.map(({ kind, place, firstCoordinate }, number) => {
      const table = tables.kinds[kind];
      const { stiffness, own_damping: damping } = table.arrays;
      const step = Math.round(Math.log(place[4]) / FINEST_SCALE);
      // A tree of k times the size swings k times slower: it goes on by 1 / k of the time.
      const own = dt / Math.exp(step * FINEST_SCALE);
      const key = `${kind} ${own}`;
      const [half, whole] =
        found.get(key) ?? [toMiddle(stiffness, damping, own / 2), propagator(stiffness, damping, own)];
      found.set(key, [half, whole]);
      const speed = tables.speeds[number];
      const turn = [speed * Math.cos(place[3]), speed * Math.sin(place[3])];
      return { state: new TreeState(table), half, whole, speed, turn, firstCoordinate, full: [half, whole] };
    });
  }

  /** Go on a step. @param {number} x mean wind, blowing to [m/s] @param {number} y @param {number} z */
  step(x, y, z) {
    if (!Number.isFinite(x + y + z)) throw new ProtocolError("a wind that is not finite");
    this.gusts.push(x, y, z);
    this.outside = 0;
    this._steps++;
    this.trees.forEach(({ state, half, whole, speed, turn: [c, s] }, i) => {
      const [u, v, w] = this.gusts.felt[i];
      if (state.step(half, whole, c * u + s * v, c * v - s * u, speed * w)) this.outside++;
      const touch = this._touches.get(i);
      if (!touch) return state.isBentTooFar ? this._watchClamped(i) : undefined;
      const goesOn = touch.step(state, state.coordinates(new Float64Array(state.table.n)), half, whole, this.dt);
      if (!goesOn) this._touches.delete(i);
    });
  }

  /** Go on with fewer coordinates of a tree whose steps stay clamped. @param {number} number */
  _watchClamped(number) {
    const watch = this._watches.get(number) ?? new ClampWatch();
    this._watches.set(number, watch);
    if (!watch.isStuck(this._steps, this.dt)) return;
    const tree = this.trees[number];
    const count = fewer(tree.state.count);
    if (count === tree.state.count) return;
    tree.state.reset(count);
    [tree.half, tree.whole] = tree.full.map((each) => each.map((value, at) => (at < 6 * count ? value : 0)));
    this.reduced++;
  }

  /** Push at the root side of a segment, or pull it by a spring, while the trees go on swaying.
   * @param {Push} push a spring of no stiffness lets go @param {number} [seconds] unless it is renewed */
  push(push, seconds = push.to && !push.stiffness ? 1e-6 : 0.5) {
    const { segment, force = [], to = [], stiffness = 0 } = push;
    const { trees, kinds } = this.description;
    const tree = trees.findIndex(({ kind, firstSegment: from }) =>
      segment >= from && segment < from + kinds[kind].nSegments);
    need(Number.isInteger(segment) && tree >= 0, "segment");
    need([...force, ...to].length === 3 && [...force, ...to, stiffness, seconds].every(Number.isFinite), "push");
    need(stiffness >= 0 && seconds > 0, "push");
    if (!this._touches.has(tree)) this._touches.set(tree, new Touch(this.description, tree));
    this._touches.get(tree)?.add(push, seconds);
  }

  /** Write the coordinates of the description that hold the state.
   * @template {Float32Array | Float64Array} T @param {T} out @returns {T} */
  write(out) {
    for (const { state, firstCoordinate } of this.trees) state.coordinates(out, firstCoordinate);
    return out;
  }

  /** The same, and behind it what pulled branches turn by beyond it. */
  state() {
    const { nCoordinates } = this.description;
    const turns = [...this._touches.values()].flatMap((touch) => touch.beyond);
    const out = new Float32Array(nCoordinates + turns.length);
    out.set(turns, nCoordinates);
    return this.write(out);
  }

  /** Bring coordinates of the description to values that came from elsewhere, and rates to what would
   * have brought them there. @param {Float32Array} values @param {number} [from] the first of them
   * @param {number} [steps] that they had for it @returns {number} the largest change over full scale */
  correct(values, from = 0, steps = Infinity) {
    const { nCoordinates, scale } = this.description;
    const now = this.write(new Float64Array(nCoordinates));
    let largest = 0;
    for (const { state: { eta, rate, count, table }, whole, firstCoordinate: first } of this.trees) {
      const { m, n, arrays: { correction } } = table;
      const ways = eta.map((_, i) => whole[6 * i + 1]);
      const least = SLOWEST * Math.max(...ways);
      for (let k = 0; k < n; k++) {
        const by = values[first + k - from] - now[first + k];
        if (first + k < from || first + k - from >= values.length) continue;
        for (let i = 0; i < count; i++) {
          const own = by * correction[k * m + i];
          eta[i] += own;
          rate[i] += (own * whole[6 * i + 4]) / (Math.max(ways[i], least) * steps);
        }
        largest = Math.max(largest, Math.abs(by) / scale[first + k]);
      }
    }
    return largest;
  }

  /** Back to rest, without wind. */
  reset() {
    for (const tree of this.trees) {
      tree.state.reset();
      [tree.half, tree.whole] = tree.full;
    }
    this._watches.clear();
    this.gusts = this._newGusts();
  }
}
