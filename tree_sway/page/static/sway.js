// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The solver in JavaScript: steps the trees of exported tables in a wind.
 *
 * A tree is m oscillators. The wind's force on them is looked up in a table, by the direction of the wind and the
 * lean of the tree; under it each oscillator moves by its exact propagator. Beyond the table its edge is used,
 * and `Stand.outside` counts it. doc/sway_model.md has the equations, doc/tree_as_a_file.md the use. The same law
 * is in tree_sway/core/run/table_model.py, core/wind/gust_travel.py and core/model/drag_law.py, which
 * test/page/test_sway.py compares with this file. */

import { checkTable, checkTablesHeader, FORMS, need, ProtocolError } from "./checks.js";
import { ClampWatch, fewer } from "./clamp_watch.js";
import { reader } from "./protocol.js";
import { Touch } from "./touch.js";

/** Default time step of a stand [s]. */
export const STEP = 1 / 60;

/** Azimuths of the wind in a table, and equilibria of each at rising dynamic pressure. */
const [AZIMUTHS, LEVELS] = [24, 7];
/** Sine of the elevation above which a table of level winds is blended into that of a vertical one. */
const STEEP = Math.sin(Math.PI / 4);
/** Iteration for the force of a step: most passes, share of the correction that is taken, share of the last change. */
const [MOST_PASSES, STRIDE, MOMENTUM] = [8, 1.5, 0.1];
const HALF_AIR_DENSITY = 0.5 * 1.225; // [kg/m^3]
/** Wind speeds between which the drag coefficient of leaves falls [m/s]. */
const [STREAMLINING_FROM, STREAMLINING_TO] = [4, 20];
/** Trees whose sizes differ by less than this share have one time step. */
const FINEST_SCALE = 0.01;
/** Least mean wind that carries gusts [m/s]. */
const SLOWEST_GUST = 0.5;
/** Largest change of the delay of a gust per second [-]. */
const LARGEST_STRETCH = 0.5;
/** Time over which the mean wind is taken, and the longest delay of a gust [s]. */
const [AVERAGING, MEMORY] = [60, 60];
/** Spacing of the winds that a server sends of its last minute [s]. */
const SPACING = 0.05;
/** A correction changes the rate of a fast coordinate no more than by this share of the slowest one's. */
const SLOWEST = 0.3;

/** Highest degree of the spherical harmonics. */
const DEGREE = 5;

/** Read the tables of a scene; throws a `ProtocolError` if they are damaged. */
export const decodeTables = reader("tables", (header, kinds, own) => {
  const { description, anemometer, convection_ratio: ratio } = header;
  checkTablesHeader(header, kinds.map((arrays) => arrays.stiffness?.values.length ?? 0), own);
  const speeds = own.tree_speed.values;
  const tables = kinds.map((arrays, number) => new Table(header.kinds[number], arrays));
  return { description, anemometer, ratio: ratio ?? Infinity, kinds: tables, speeds: Float64Array.from(speeds) };
});

/** Wind forces on the coordinates of a kind of tree, in uniform wind. */
export class Table {
  /** @param {Record<string, any>} numbers @param {Arrays} arrays */
  constructor(numbers, arrays) {
    const size = checkTable(numbers, arrays);
    const { m, n } = size;
    const { most_pressure: mostPressure, most_energy: mostEnergy, drag_law: law } = numbers;
    /** Number of coordinates that are solved, and of those that are streamed. */
    this.m = m;
    this.n = n;
    /** Range of the table: dynamic pressure [kg/m/s^2], and twice the energy of the motion [J]. */
    this.mostPressure = /** @type {number} */ (mostPressure);
    this.mostEnergy = /** @type {number} */ (mostEnergy);
    /** C, N and C0 of the drag coefficient C U^-N + C0. @type {number[]} */
    this.law = law;
    /** Arrays in double precision, without the factors of the slopes. @type {Record<string, Float64Array>} */
    this.arrays = Object.fromEntries(Object.entries(arrays).filter(([name]) => !/_(rows|shapes)$/.test(name))
      .map(([name, { values }]) => [name, Float64Array.from(values)]));
    this.nKeys = size.keys;
    // Interleaved, as a step reads both at once.
    this.slopes = this._slopes(arrays, ["turning", "damping"]);
    this.steep = this._slopes(arrays, ["steep_turning", "steep_damping"]);
    this.lean = this._slopes(arrays, ["lean"]);
    /** Work arrays of a step, named where they are used. */
    this.scratch = Array.from({ length: 10 }, () => new Float64Array(m));
    /** Change of the forces in the last pass of a step. */
    this.change = new Float64Array(m);
    /** Spherical harmonics of the direction of the wind. */
    this.values = new Float64Array(arrays.harmonics.values.length / m);
  }

  /** Multiply out the factors in which slopes are sent. One array per row of the table; in it the coordinate that is
   * loaded, then the one that moves, then the names in turn. @param {Arrays} arrays @param {string[]} names */
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

/** Exact propagator of oscillators of unit inertia over a time, under a constant force. Six numbers each: position
 * from position, rate and force, then rate from position, rate and force. The functions of the two eigenvalues
 * are those of tree_sway/core/oscillators/exponential.py, without cancellation.
 * @param {Float64Array} stiffness @param {Float64Array} damping @param {number} time [s] */
export function propagator(stiffness, damping, time) {
  const out = new Float64Array(6 * stiffness.length);
  stiffness.forEach((k, i) => {
    const alpha = (damping[i] * time) / 2;
    const kappa = k * time * time;
    const discriminant = alpha * alpha - kappa;
    const root = Math.sqrt(Math.abs(discriminant));
    const isOverdamped = discriminant > 0;
    const slow = -kappa / (alpha + root); // the eigenvalues, if real
    const fast = -alpha - root;
    const even = isOverdamped ? Math.exp(slow) : Math.exp(-alpha) * Math.cos(root);
    let s = Math.exp(-alpha) * (1 + discriminant / 6); // rate to position, over the time
    if (root > 1e-3) {
      s = isOverdamped ? (Math.exp(slow) - Math.exp(fast)) / (2 * root) : (Math.exp(-alpha) * Math.sin(root)) / root;
    }
    const positionKept = isOverdamped ? even - slow * s : even + alpha * s;
    const rateKept = isOverdamped ? Math.exp(fast) + slow * s : even - alpha * s;
    let pushed = 0; // force to position, over the squared time
    // A power series where 1 - positionKept would cancel.
    for (let power = 2, before = 0, term = 0.5; power < 24; power++) {
      pushed += term;
      [before, term] = [term, (-2 * alpha * power * term - kappa * before) / (power * (power + 1))];
    }
    if (kappa + alpha > 0.5) pushed = (1 - positionKept) / kappa;
    out.set([positionKept, time * s, time * time * pushed, (-kappa * s) / time, rateKept, time * s], 6 * i);
  });
  return out;
}

/** Propagator to the middle of a step, where the load is evaluated: exact, but an implicit Euler step for an
 * oscillator so fast that its exact rate there would not follow the force.
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

/** State of a tree: its modal coordinates, their rates and the forces on them. */
export class TreeState {
  /** @param {Table} table */
  constructor(table) {
    this.table = table;
    this.eta = new Float64Array(table.m);
    this.rate = new Float64Array(table.m);
    this.force = new Float64Array(table.m);
    /** How many of the coordinates are solved, the first ones. */
    this.count = table.m;
    /** Whether the last step was clamped in a wind too light to bend the tree so far. */
    this.isBentTooFar = false;
  }

  /** Return to rest. @param {number} [count] coordinates to solve from now on; all by default */
  reset(count = this.table.m) {
    for (const each of [this.eta, this.rate, this.force]) each.fill(0);
    this.count = count;
    this.isBentTooFar = false;
  }

  /** Step. @param {Float64Array} half `toMiddle` of half a step @param {Float64Array} whole `propagator` of a step
   * @param {number} wx mean wind in the frame of the kind [m/s] @param {number} wy @param {number} wz
   * @returns {boolean} whether the wind or the motion was beyond the table */
  step(half, whole, wx, wy, wz) {
    const { table, eta, rate, force } = this;
    const { mostPressure, mostEnergy } = table;
    const speed = Math.sqrt(wx * wx + wy * wy + wz * wz);
    const density = table.dragDensity(speed);
    const pressure = Math.min(density * speed * speed, mostPressure);
    const way = speed > 0 ? [wx / speed, wy / speed, wz / speed] : [1, 0, 0];
    const most = Math.max(this._energy(), mostEnergy);
    this._findForce(half, way, pressure, density);
    for (let i = 0, at = 0; i < table.m; i++, at += 6) {
      const [q, v, f] = [eta[i], rate[i], force[i]];
      eta[i] = whole[at] * q + whole[at + 1] * v + whole[at + 2] * f;
      rate[i] = whole[at + 3] * q + whole[at + 4] * v + whole[at + 5] * f;
    }
    const isLimited = this._limitEnergy(most);
    const isOutside = isLimited || density * speed * speed > mostPressure;
    this.isBentTooFar = isOutside && pressure < 0.5 * mostPressure;
    return isOutside;
  }

  /** Twice the energy of the motion [J]. */
  _energy() {
    const { eta, rate, table: { m, arrays: { stiffness } } } = this;
    let energy = 0;
    for (let i = 0; i < m; i++) energy += stiffness[i] * eta[i] * eta[i] + rate[i] * rate[i];
    return energy;
  }

  /** Scale the motion down to an energy. @param {number} most twice of it [J] @returns {boolean} whether it had more */
  _limitEnergy(most) {
    const energy = this._energy();
    if (energy <= most) return false;
    const { eta, rate } = this;
    if (energy < Infinity) {
      const share = Math.sqrt(most / energy);
      for (const all of [eta, rate]) all.forEach((each, i) => (all[i] = share * each));
    } else for (const all of [eta, rate, this.force]) all.fill(0); // not a number: from rest again
    return true;
  }

  /** Find the force over a step, implicit in the damping of each coordinate as if the others moved with it: stable in
   * any wind and for any step. Where drag stops a coordinate within half a step one pass of it lags; more follow.
   * @param {Float64Array} half @param {number[]} way of the wind @param {number} pressure @param {number} density */
  _findForce(half, way, pressure, density) {
    const { table: { m, change }, force } = this;
    let passes = 1;
    let stiffest = 0; // drag over half a step, largest of all coordinates
    for (let pass = 0; pass < passes; pass++) {
      const [wanted, diagonal] = this.loadOfMiddle(half, way, pressure, density);
      for (let i = 0; i < m; i++) {
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
      for (; !pass && stiffest > 1 && passes < MOST_PASSES; passes++) stiffest *= 0.5;
    }
  }

  /** Force of the wind in the middle of a step, and the diagonal of its derivative by the rates; the force so far
   * carries the state there. @param {Float64Array} half `toMiddle` of half a step @param {number[]} way of the wind
   * @param {number} pressure dynamic pressure [kg/m/s^2] @param {number} density `Table.dragDensity` [kg/m^3] */
  loadOfMiddle(half, way, pressure, density) {
    const { table, eta, rate, force } = this;
    const [midEta, midRate, wanted, diagonal] = table.scratch;
    for (let i = 0, at = 0; i < table.m; i++, at += 6) {
      midEta[i] = half[at] * eta[i] + half[at + 1] * rate[i] + half[at + 2] * force[i];
      midRate[i] = half[at + 3] * eta[i] + half[at + 4] * rate[i] + half[at + 5] * force[i];
    }
    windForce(table, way, pressure, density, this.count);
    return [wanted, diagonal];
  }

  /** Write this state as streamed coordinates.
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

/** Where a wind and a lean lie in a table. Four corners surround them: the azimuths here and there, the levels
 * below and above. Corner 00 is (here, below), 01 (here, above), 10 (there, below), 11 (there, above).
 * @typedef {{here: number, there: number, row00: number, row10: number, toThere: number, toAbove: number,
 * steep: number, rise: number, pole: number, weights: number[]}} Corners */

/** Forces of a uniform wind on the coordinates in the middle of a step, and the diagonal of their derivative by the
 * rates; both into the scratch of the table. @param {Table} table @param {number[]} way unit vector of the wind
 * @param {number} pressure dynamic pressure [kg/m/s^2] @param {number} density the same over speed squared [kg/m^3]
 * @param {number} count of the first coordinates, whose motion loads all */
function windForce(table, way, pressure, density, count) {
  fillHarmonics(way[0], way[1], way[2], table.values);
  const corners = cornersOf(table, way[0], way[1], way[2]);
  const stillAir = density > 0 ? pressure / density : 0;
  const speed = fillLevelLoads(table, corners, stillAir);
  addSlopes(table, corners, pressure, density * speed, count);
}

/** Write the loads of the corners, without slopes, and how far the tree is from each corner.
 * @param {Table} table @param {Corners} corners @param {number} windSquared [m^2/s^2]
 * @returns {number} root mean square speed of the air over the moving tree [m/s] */
function fillLevelLoads({ m, values, arrays, scratch }, corners, windSquared) {
  const { row00, row10, toThere, toAbove: up, steep, rise, weights: [w00, w01, w10, w11] } = corners;
  const { motion, load, equilibrium, harmonics } = arrays;
  const [eta, rate, force, , leanHere, leanThere, away00, away01, away10, away11] = scratch;
  const [at00, at01, at10, at11] = [row00 * m, (row00 + 1) * m, row10 * m, (row10 + 1) * m];
  const [fromHere, fromThere] = [1 - toThere, toThere];
  const level = 1 - steep;
  // Slopes are in single precision, and so are their weights.
  const [weightHere, weightThere] = [level * fromHere * rise, level * fromThere * rise].map(Math.fround);
  let speedSquared = windSquared;
  for (let i = 0; i < m; i++) {
    const stepHere = equilibrium[at01 + i] - equilibrium[at00 + i];
    const stepThere = equilibrium[at11 + i] - equilibrium[at10 + i];
    const away = eta[i] - fromHere * (equilibrium[at00 + i] + up * stepHere)
      - fromThere * (equilibrium[at10 + i] + up * stepThere);
    // Half of the way to each corner, so that the load between two levels is a cubic.
    away00[i] = w00 * (away + 0.5 * up * stepHere);
    away01[i] = w01 * (away - 0.5 * (1 - up) * stepHere);
    away10[i] = w10 * (away + 0.5 * up * stepThere);
    away11[i] = w11 * (away - 0.5 * (1 - up) * stepThere);
    speedSquared += motion[i] * rate[i] * rate[i];
    let sum = w00 * load[at00 + i] + w01 * load[at01 + i] + w10 * load[at10 + i] + w11 * load[at11 + i];
    for (let k = 0, at = i; k < values.length; k++, at += m) sum += values[k] * harmonics[at];
    force[i] = sum;
    leanHere[i] = Math.fround(weightHere * Math.fround(eta[i]));
    leanThere[i] = Math.fround(weightThere * Math.fround(eta[i]));
  }
  return Math.sqrt(speedSquared);
}

/** Add what the motion changes: the load turns with the tree, and drag damps the rates. A slope holds near its
 * corner only, so the load is limited to the largest that a steady wind has.
 * @param {Table} table @param {Corners} corners @param {number} pressure @param {number} densitySpeed [kg/m^2/s]
 * @param {number} count */
function addSlopes({ m, slopes, steep: poles, lean, arrays, scratch }, corners, pressure, densitySpeed, count) {
  const { here, there, row00, row10, steep, pole, weights: [w00, w01, w10, w11] } = corners;
  const { limit, cross_damping: cross } = arrays;
  const [eta, rate, force, diagonal, leanHere, leanThere, away00, away01, away10, away11] = scratch;
  const [at00, at01, at10, at11] = [row00 * m, (row00 + 1) * m, row10 * m, (row10 + 1) * m];
  const [slopes00, slopes01, slopes10, slopes11] = [slopes[row00], slopes[row00 + 1], slopes[row10], slopes[row10 + 1]];
  const [s00, s01, s10, s11, sSteep] = [w00, w01, w10, w11, steep].map(Math.fround);
  const [slopeHere, slopeThere, slopePole] = [lean[here], lean[there], poles[pole]];
  for (let i = 0; i < m; i++) {
    let turned = 0;
    let damped = 0;
    // Of each pair of coordinates the turning stands at `at`, the damping behind it.
    for (let k = 0, at = 2 * i * m, flat = i * m; k < count; k++, at += 2, flat++) {
      turned += away00[k] * slopes00[at] + away01[k] * slopes01[at] + away10[k] * slopes10[at] + away11[k] * slopes11[at]
        + leanHere[k] * slopeHere[flat] + leanThere[k] * slopeThere[flat];
      damped += rate[k] * (s00 * slopes00[at + 1] + s01 * slopes01[at + 1] + s10 * slopes10[at + 1] + s11 * slopes11[at + 1]);
    }
    for (let k = 0, at = 2 * i * m; steep > 0 && k < count; k++, at += 2) {
      turned += Math.fround(sSteep * Math.fround(eta[k])) * slopePole[at];
      damped += sSteep * rate[k] * slopePole[at + 1];
    }
    const load = Math.min(Math.max(force[i] + turned, -limit[i]), limit[i]);
    force[i] = pressure * load + densitySpeed * damped;
    const own = 2 * (i * m + i) + 1;
    diagonal[i] = densitySpeed * (w00 * (slopes00[own] - cross[at00 + i]) + w01 * (slopes01[own] - cross[at01 + i])
      + w10 * (slopes10[own] - cross[at10 + i]) + w11 * (slopes11[own] - cross[at11 + i]) + steep * slopePole[own]);
  }
}

/** Find the corners about a wind and the lean of the tree. @param {Table} table
 * @param {number} x direction of the wind @param {number} y @param {number} z @returns {Corners} */
function cornersOf({ m, scratch: [eta], arrays: { amount, levels } }, x, y, z) {
  const turn = Math.atan2(y, x) * (0.5 / Math.PI) * AZIMUTHS;
  const toThere = turn - Math.floor(turn);
  const here = (Math.floor(turn) + AZIMUTHS) % AZIMUTHS;
  const there = (here + 1) % AZIMUTHS;
  let lean = 0;
  for (let i = 0; i < m; i++) {
    lean += ((1 - toThere) * amount[here * m + i] + toThere * amount[there * m + i]) * eta[i];
  }
  const leanAt = (/** @type {number} */ j) => (1 - toThere) * levels[here * LEVELS + j] + toThere * levels[there * LEVELS + j];
  let level = 0;
  while (level < LEVELS - 2 && lean > leanAt(level + 1)) level++;
  const [below, above] = [leanAt(level), leanAt(level + 1)];
  const toAbove = Math.min(Math.max((lean - below) / (above - below), 0), 1);
  const steep = Math.max(0, (Math.abs(z) - STEEP) / (1 - STEEP));
  const [fromHere, fromThere] = [1 - toThere, toThere];
  const weights = [fromHere * (1 - toAbove), fromHere * toAbove, fromThere * (1 - toAbove), fromThere * toAbove]
    .map((each) => (1 - steep) * each);
  return {
    here, there, row00: here * LEVELS + level, row10: there * LEVELS + level, toThere, toAbove,
    steep, rise: Math.min(Math.max(z, -STEEP), STEEP), pole: z > 0 ? 1 : 0, weights,
  };
}

/** Factor of the Legendre function in each harmonic, by degree and order, for a mean square of 1. */
const NORMS = [0, 1, 2, 3, 4, 5].map((degree) => {
  let norm = 2 * degree + 1;
  return Array.from({ length: degree + 1 }, (_, order) => {
    if (order) norm /= (degree + order) * (degree - order + 1);
    return Math.sqrt(order ? 2 * norm : norm);
  });
});

/** Evaluate the real spherical harmonics of odd degree, as tree_sway/core/model/spherical_harmonics.py does.
 * @param {number} x @param {number} y @param {number} z a unit vector
 * @param {Float64Array} out */
function fillHarmonics(x, y, z, out) {
  // The sine of the polar angle to the power of the order is in c and s, not in the Legendre functions.
  let [c, s, first] = [1, 0, 1];
  for (let order = 0; order <= DEGREE; order++) {
    let [before, now] = [0, first]; // of the recurrence in the degree
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

/** The wind at each place: gusts travel with the mean wind (Taylor 1938), so each place has the measured wind of
 * some time ago. Delays change slowly, and the mean over a step is taken of the run of the wind between its ends. */
class Gusts {
  /** @param {number[][]} places @param {Tables} tables @param {number} dt [s] */
  constructor(places, { anemometer, ratio }, dt) {
    const [ox, oy] = anemometer ?? [0, 0];
    /** Places from the anemometer [m]. */
    this._offsets = places.map(([x, y]) => [x - ox, y - oy]);
    /** Without an anemometer the wind is that of the place farthest upwind. */
    this._isFromFirst = !anemometer;
    this._ratio = ratio;
    this._dt = dt;
    /** Mean wind of the last step at each place [m/s]. */
    this.felt = places.map(() => [0, 0, 0]);
    /** Time [s] and run of the wind (its integral) [m], at the end of each step. */
    this._run = [[0, 0, 0, 0]];
    /** Mean wind [m/s], and the time over which it is taken [s]. */
    this._mean = [0, 0, 0];
    /** Delay of each place [s]. */
    this._delay = places.map(() => 0);
  }

  /** Take the wind of a step. @param {number} x mean over the step [m/s] @param {number} y @param {number} z */
  push(x, y, z) {
    const { _run: run, _mean: mean, _dt: dt, _delay: delay } = this;
    const last = run[run.length - 1];
    run.push([last[0] + dt, last[1] + x * dt, last[2] + y * dt, last[3] + z * dt]);
    if (run.length > (2 * MEMORY) / dt) run.splice(0, MEMORY / dt - 4);
    mean[2] = Math.min(mean[2] + dt, AVERAGING);
    mean[0] += (dt / mean[2]) * (x - mean[0]);
    mean[1] += (dt / mean[2]) * (y - mean[1]);
    const speed = Math.max(Math.hypot(mean[0], mean[1]), SLOWEST_GUST);
    const wanted = this._offsets.map(([u, v]) => (u * mean[0] + v * mean[1]) / (this._ratio * speed * speed));
    const first = this._isFromFirst ? wanted.reduce((a, b) => Math.min(a, b), Infinity) : 0;
    const now = last[0] + dt;
    wanted.forEach((each, i) => {
      const goal = Math.min(Math.max(each - first, 0), MEMORY);
      const before = run.length === 2 ? goal : delay[i];
      const most = LARGEST_STRETCH * dt;
      delay[i] = Math.min(Math.max(goal, before - most), before + most);
      if (before === 0 && delay[i] === 0) return (this.felt[i] = [x, y, z]);
      const begin = now - dt - before;
      const end = now - delay[i];
      const [from, to] = [this._runUntil(begin), this._runUntil(end)];
      this.felt[i] = from.map((each, c) => (to[c] - each) / (end - begin));
    });
  }

  /** Continue from the last minute of a server, `GustHistory.recent` of tree_sway/core/wind/gust_travel.py.
   * @param {Recent} recent */
  goOn({ mean, delay, wind }) {
    const { _run: run, _dt: dt } = this;
    for (let i = 1; i <= (wind.length * SPACING) / 3 / dt; i++) {
      const at = 3 * Math.floor(((i - 0.5) * dt) / SPACING);
      run.push(run[i - 1].map((each, c) => each + dt * (c ? wind[at + c - 1] : 1)));
    }
    if (delay.length === this._delay.length) [this._mean, this._delay] = [mean, delay];
  }

  /** Run of the wind up to a time [m]; before the first step it blew as in that. @param {number} time [s] */
  _runUntil(time) {
    const run = this._run;
    const cell = Math.floor((time - run[0][0]) / this._dt);
    const [a, b] = run.slice(Math.min(Math.max(cell, 0), run.length - 2));
    const u = (time - a[0]) / (b[0] - a[0]);
    return [1, 2, 3].map((c) => a[c] + u * (b[c] - a[c]));
  }
}

/** All trees of a description, stepped in one wind. */
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
    /** Number of trees beyond their table in the last step. */
    this.outside = 0;
    /** How often a tree whose steps stayed clamped was reset with fewer coordinates. */
    this.reduced = 0;
    this._steps = 0;
    this._watches = /** @type {Map<number, ClampWatch>} */ (new Map());
    const propagators = /** @type {Map<string, Float64Array[]>} */ (new Map());
    /** Pushes on each tree, by its number. */
    this._touches = /** @type {Map<number, Touch>} */ (new Map());
    this.trees = trees.map(({ kind, place, firstCoordinate }, number) => {
      const table = tables.kinds[kind];
      const { stiffness, own_damping: damping } = table.arrays;
      const sizeStep = Math.round(Math.log(place[4]) / FINEST_SCALE);
      // A tree of k times the size swings k times slower: its table is stepped by 1 / k of the time.
      const ownDt = dt / Math.exp(sizeStep * FINEST_SCALE);
      const key = `${kind} ${ownDt}`;
      const [half, whole] = propagators.get(key)
        ?? [toMiddle(stiffness, damping, ownDt / 2), propagator(stiffness, damping, ownDt)];
      propagators.set(key, [half, whole]);
      const speed = tables.speeds[number];
      const turn = [speed * Math.cos(place[3]), speed * Math.sin(place[3])];
      return { state: new TreeState(table), half, whole, speed, turn, firstCoordinate, full: [half, whole] };
    });
  }

  /** Step all trees. @param {number} x mean wind, blowing to [m/s] @param {number} y @param {number} z */
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

  /** Reset a tree whose steps stay clamped, with fewer coordinates. @param {number} number */
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

  /** Push the root-side end of a segment by a force, or pull it by a spring, for some time.
   * @param {Push} push a spring without stiffness ends the pull @param {number} [seconds] until it ends by itself */
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

  /** Write the state as streamed coordinates.
   * @template {Float32Array | Float64Array} T @param {T} out @returns {T} */
  write(out) {
    for (const { state, firstCoordinate } of this.trees) state.coordinates(out, firstCoordinate);
    return out;
  }

  /** The streamed coordinates, and behind them the rotations of pulled branches beyond them (`beyond` in placing.js). */
  state() {
    const { nCoordinates } = this.description;
    const turns = [...this._touches.values()].flatMap((touch) => touch.beyond);
    const out = new Float32Array(nCoordinates + turns.length);
    out.set(turns, nCoordinates);
    return this.write(out);
  }

  /** Set streamed coordinates to the values of a server, and change the rates by what would have led there.
   * @param {Float32Array} values @param {number} [from] coordinate of the first value
   * @param {number} [steps] over which they came apart @returns {number} the largest change over full scale */
  correct(values, from = 0, steps = Infinity) {
    const { nCoordinates, scale } = this.description;
    const now = this.write(new Float64Array(nCoordinates));
    let largest = 0;
    for (const { state: { eta, rate, count, table }, whole, firstCoordinate: first } of this.trees) {
      const { m, n, arrays: { correction } } = table;
      const perRate = eta.map((_, i) => whole[6 * i + 1]);
      const least = SLOWEST * Math.max(...perRate);
      for (let k = 0; k < n; k++) {
        if (first + k < from || first + k - from >= values.length) continue;
        const difference = values[first + k - from] - now[first + k];
        for (let i = 0; i < count; i++) {
          const own = difference * correction[k * m + i];
          eta[i] += own;
          rate[i] += (own * whole[6 * i + 4]) / (Math.max(perRate[i], least) * steps);
        }
        largest = Math.max(largest, Math.abs(difference) / scale[first + k]);
      }
    }
    return largest;
  }

  /** Return all trees to rest, without wind. */
  reset() {
    for (const tree of this.trees) {
      tree.state.reset();
      [tree.half, tree.whole] = tree.full;
    }
    this._watches.clear();
    this.gusts = this._newGusts();
  }
}
