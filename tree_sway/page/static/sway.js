// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Steps the trees of exported tables in a wind, by the native core. Beyond a table its edge is used, and
 * `Stand.outside` counts it. doc/sway_model.md has the law, doc/tree_as_a_file.md the use;
 * tree_sway/core/scene/received_scene.py does the same. */

import { checkTable, checkTablesHeader, FORMS, need, ProtocolError, valuesOf } from "./checks.js";
import { ClampWatch, fewer } from "./clamp_watch.js";
import { Block, core, made, Model } from "./core.js";
import { reader } from "./protocol.js";
import { Touch } from "./touch.js";

/** Default time step of a stand [s]. */
export const STEP = 1 / 60;

/** Trees whose sizes differ by less than this share have one time step. */
const FINEST_SCALE = 0.01;
/** Least mean wind that carries gusts [m/s]. */
const SLOWEST_GUST = 0.5;
/** Time over which the mean wind is taken, and the longest delay of a gust [s]. */
const AVERAGING = 60, MEMORY = 60;
/** Steps of the wind that are kept; shorter ones are joined. */
const KEPT = 8192;
/** Spacing of the winds that a server sends of its last minute [s]. */
const SPACING = 0.05;
/** A correction changes the rate of a fast coordinate no more than by this share of the slowest one's. */
const SLOWEST = 0.3;
/** Bytes of a tree of a stand: number of its model, then six numbers. */
const TREE = 56;
/** Rows of a state: coordinates, rates, force, what is hidden, damping by the own rate, force of the wind. */
const ROWS = 6;

/** Read the tables of a scene; throws a `ProtocolError` if they are damaged. */
export const decodeTables = reader("tables", (header, kinds, own) => {
  const { description, anemometer, convection_ratio: ratio } = header;
  checkTablesHeader(header, kinds.map((arrays) => arrays.stiffness?.values.length ?? 0), own);
  return {
    description, anemometer, ratio: ratio ?? Infinity, speeds: own.tree_speed.values,
    kinds: kinds.map((arrays, number) => new Table(header.kinds[number], arrays)),
  };
});

/** Wind forces on the coordinates of a kind of tree, in uniform wind. */
export class Table {
  /** @type {Map<number, {whole: Float64Array, half: Float64Array, width: number}>} */
  _steps = new Map();

  /** @param {Record<string, any>} numbers @param {Arrays} parts */
  constructor(numbers, parts) {
    const size = checkTable(numbers, parts);
    /** Number of coordinates that are solved, of those that are streamed, and of key rotations. */
    this.m = size.m;
    this.n = size.n;
    this.nKeys = size.keys;
    this.mostPressure = /** @type {number} */ (numbers.most_pressure);
    this.arrays = valuesOf(parts);
    /** @type {Record<string, {values: any, shape: number[]}>} */
    const arrays = {};
    for (const name of ["drag_law", "most_pressure", "most_energy"]) {
      const values = Float64Array.from([numbers[name]].flat());
      arrays[name] = { values, shape: [values.length] };
    }
    for (const [name, [, ...axes]] of Object.entries(FORMS.tables)) {
      const { values, shape } = parts[name];
      const isOfModel = !/^(state|correction|branch_compliance|shape_compliance)$|_shapes$/.test(name);
      const slopes = name.match(/(.*)_rows$/)?.[1];
      if (slopes) arrays[slopes] = this._slopes(values, parts[`${slopes}_shapes`].values, Number(axes[0]));
      else if (isOfModel) arrays[name] = { values: Float64Array.from(values), shape };
    }
    this.model = new Model(arrays);
    const { state } = this.arrays;
    /** What each streamed coordinate has of those that are solved. */
    this.streamed = Float64Array.from(state, (_, at) => state[(at % this.m) * this.n + Math.floor(at / this.m)]);
  }

  /** Multiply out the factors in which slopes are sent. @param {NumberArray} rows @param {NumberArray} shapes
   * @param {number} count of slopes */
  _slopes(rows, shapes, count) {
    const { m, arrays: { stiffness } } = this;
    const rank = rows.length / count;
    const root = Float64Array.from(stiffness, Math.sqrt);
    const values = new Float32Array(count * m * m);
    for (let row = 0, to = 0; row < count; row++) {
      for (let at = 0; at < m * m; at++) {
        let sum = 0;
        for (let r = 0; r < rank; r++) sum += rows[row * rank + r] * shapes[r * m * m + at];
        values[to++] = sum * (root[Math.floor(at / m)] * root[at % m]);
      }
    }
    const azimuths = 24;
    const shape = count > azimuths ? [azimuths, count / azimuths] : [count];
    return { values, shape: [...shape, m, m] };
  }

  /** Coefficients of a step and of half of it, rows of `width` numbers: position from position, rate and force, then
   * rate from position, rate and force. @param {number} dt [s] */
  steps(dt) {
    const known = this._steps.get(dt);
    if (known) return known;
    const width = core.page_steps(this.model.at, dt, 0, 0);
    const [whole, half] = [0, 0].map(() => new Block(Float64Array, 6 * width));
    core.page_steps(this.model.at, dt, whole.at, half.at);
    const found = { whole: whole.values.slice(), half: half.values.slice(), width };
    this._steps.set(dt, found);
    return found;
  }
}

/** The wind at each place: gusts travel with the mean wind (Taylor 1938), so each place has the measured wind of
 * some time ago. */
class Gusts {
  _history = new Block(Float64Array, 2 + 4 * KEPT);
  _wind = new Block(Float64Array, 3);
  /** Mean wind [m/s], and the time over which it is taken [s]. */
  _mean = [0, 0, 0];

  /** @param {number[][]} places @param {Tables} tables @param {number} dt [s] */
  constructor(places, { anemometer, ratio }, dt) {
    const [ox, oy] = anemometer ?? [0, 0];
    /** Places from the anemometer [m]. */
    this._offsets = places.map(([x, y]) => [x - ox, y - oy]);
    /** Without an anemometer the wind is that of the place farthest upwind. */
    this._isFromFirst = !anemometer;
    this._ratio = ratio;
    this._dt = dt;
    const count = places.length;
    /** Mean wind of the last step at each place [m/s]. */
    this.felt = new Block(Float64Array, 3 * count);
    this._wanted = new Block(Float64Array, count);
    this._delay = new Block(Float64Array, count);
  }

  /** Take the wind of a step. @param {number} x mean over the step [m/s] @param {number} y @param {number} z */
  push(x, y, z) {
    const { _mean: mean, _dt: dt, _ratio: ratio } = this;
    mean[2] = Math.min(mean[2] + dt, AVERAGING);
    mean[0] += (dt / mean[2]) * (x - mean[0]);
    mean[1] += (dt / mean[2]) * (y - mean[1]);
    const speed = Math.max(Math.hypot(mean[0], mean[1]), SLOWEST_GUST);
    const wanted = this._offsets.map(([u, v]) => (u * mean[0] + v * mean[1]) / (ratio * speed * speed));
    const first = this._isFromFirst ? wanted.reduce((a, b) => Math.min(a, b), Infinity) : 0;
    this._wanted.values.set(wanted.map((each) => each - first));
    this._add([x, y, z], dt, wanted.length);
  }

  /** @param {number[]} wind @param {number} dt [s] @param {number} count of places that feel it */
  _add(wind, dt, count) {
    this._wind.values.set(wind);
    core.sway_past_winds(this._history.at, KEPT, (2 * MEMORY) / KEPT, this._wanted.at, this._delay.at, count, MEMORY,
      this._wind.at, dt, this.felt.at);
  }

  /** Continue from the last minute of a server, `GustHistory.recent` of tree_sway/core/wind/gusts/gust_travel.py.
   * @param {Recent} recent */
  goOn({ mean, delay, wind }) {
    this._history.values.fill(0);
    for (let i = 0; i + 2 < wind.length; i += 3) this._add(wind.slice(i, i + 3), SPACING, 0);
    if (delay.length !== this._offsets.length) return;
    this._mean = [...mean];
    this._delay.values.set(delay);
  }
}

/** All trees of a description, stepped in one wind. */
export class Stand {
  /** Number of trees beyond their table in the last step. */
  outside = 0;
  /** How often a tree whose steps stayed clamped was reset with fewer coordinates. */
  reduced = 0;
  _steps = 0;
  /** @type {Map<number, ClampWatch>} */
  _watches = new Map();
  /** Pushes on each tree, by its number. @type {Map<number, Touch>} */
  _touches = new Map();
  _counts = new Block(BigInt64Array, 2);

  /** @param {Tables} tables @param {Description} description @param {number} [dt] time step [s] */
  constructor(tables, description, dt = STEP) {
    const { kinds, trees, identity } = description;
    need(tables.description === identity && tables.speeds.length === trees.length, "description");
    need(tables.kinds.length === kinds.length, "kinds");
    tables.kinds.forEach(({ n, nKeys, arrays }, k) => {
      const { nCoordinates, nKeys: keys, arrays: { branch_keys: each } } = kinds[k];
      const most = Array.from(each).reduce((a, b) => Math.max(a, b), 0);
      need(n === nCoordinates, "state");
      need(nKeys === keys && arrays.branch_compliance.length >= keys * most, "branch_compliance");
    });
    this.dt = dt;
    this.description = description;
    this._newGusts = () => new Gusts(trees.map(({ place }) => place), tables, dt);
    this.gusts = this._newGusts();
    this.trees = trees.map(({ kind, place, firstCoordinate }) => ({
      table: tables.kinds[kind], firstCoordinate,
      // A tree of k times the size swings k times slower: its table is stepped by 1 / k of the time.
      ownDt: dt / Math.exp(FINEST_SCALE * Math.round(Math.log(place[4]) / FINEST_SCALE)),
    }));
    this._core = this._opened(tables);
    const [stride, width] = [0, 0].map(() => new Block(Uint32Array, 1));
    const first = core.sway_state(this._core, stride.at, width.at);
    /** Numbers of a tree, and of each of its rows. */
    this._stride = stride.values[0];
    this._width = width.values[0];
    this._states = new Block(Float64Array, this._stride * trees.length, first);
  }

  /** Make the stand of the core, at rest. @param {Tables} tables */
  _opened({ kinds, speeds }) {
    const { trees } = this.description;
    const models = new Block(Uint8Array, 4 * kinds.length), given = new Block(Uint8Array, TREE * trees.length);
    const [handles, view] = [models, given].map(({ at, values }) => new DataView(values.buffer, at));
    kinds.forEach(({ model }, k) => handles.setUint32(4 * k, model.at, true));
    trees.forEach(({ kind, place }, i) => {
      view.setBigInt64(TREE * i, BigInt(kind), true);
      [...place, speeds[i]].forEach((each, k) => view.setFloat64(TREE * i + 8 + 8 * k, each, true));
    });
    const found = made(this, "sway_stand_close", (error, room) =>
      core.sway_stand_open(models.at, kinds.length, given.at, trees.length, 1, error, room));
    core.sway_set_step(found, this.dt);
    return found;
  }

  /** Rows of the state of a tree, and the numbers behind them, until more memory is taken. @param {number} tree */
  rows(tree) {
    const all = this._states.values, first = tree * this._stride, width = this._width;
    const [eta, rate, force, , diagonal] = Array.from({ length: ROWS }, (_, row) =>
      all.subarray(first + row * width, first + (row + 1) * width));
    return { eta, rate, force, diagonal, more: all.subarray(first + ROWS * width, first + this._stride) };
  }

  /** Step all trees. @param {number} x mean wind, blowing to [m/s] @param {number} y @param {number} z */
  step(x, y, z) {
    if (!Number.isFinite(x + y + z)) throw new ProtocolError("a wind that is not finite");
    this.gusts.push(x, y, z);
    core.sway_step(this._core, 0, 0, this.trees.length, this.gusts.felt.at, this._counts.at);
    this.outside = Number(this._counts.values[0]);
    this._steps++;
    for (const [number, touch] of this._touches) {
      const { table, ownDt } = this.trees[number];
      const coordinates = new Float64Array(table.n);
      this._write(number, coordinates, 0);
      if (!touch.step(() => this.rows(number), table, coordinates, table.steps(ownDt), this.dt)) this._touches.delete(number);
    }
    if (!this.outside) return;
    this.trees.forEach((_, number) => {
      const isClamped = this._states.values[number * this._stride + ROWS * this._width + 4];
      if (isClamped && !this._touches.has(number)) this._watchClamped(number);
    });
  }

  /** Reset a tree whose steps stay clamped, with fewer coordinates. @param {number} number */
  _watchClamped(number) {
    const { eta, rate, force, more } = this.rows(number);
    const { table } = this.trees[number];
    const [u, v, w, density, , leftOut] = more;
    // A wind that bends the tree so far is no fault.
    if (density * (u * u + v * v + w * w) >= 0.5 * table.mostPressure) return;
    const watch = this._watches.get(number) ?? new ClampWatch();
    this._watches.set(number, watch);
    if (!watch.isStuck(this._steps, this.dt)) return;
    const count = fewer(table.m - leftOut);
    if (count === table.m - leftOut) return;
    for (const each of [eta, rate, force]) each.fill(0);
    more.fill(table.m - count, 5, 7);
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

  /** Write the streamed coordinates of a tree. @param {number} tree @param {Float32Array | Float64Array} out
   * @param {number} from index of the first */
  _write(tree, out, from) {
    const { m, n, streamed } = this.trees[tree].table;
    const all = this._states.values, first = tree * this._stride;
    for (let k = 0; k < n; k++) {
      let sum = 0;
      for (let i = 0; i < m; i++) sum += all[first + i] * streamed[k * m + i];
      out[from + k] = sum;
    }
  }

  /** The streamed coordinates, and behind them the rotations of pulled branches beyond them (`beyond` in placing.js). */
  state() {
    const { nCoordinates } = this.description;
    const turns = [...this._touches.values()].flatMap((touch) => touch.beyond);
    const out = new Float32Array(nCoordinates + turns.length);
    out.set(turns, nCoordinates);
    this.trees.forEach(({ firstCoordinate }, number) => this._write(number, out, firstCoordinate));
    return out;
  }

  /** Set streamed coordinates to the values of a server, and change the rates by what would have led there.
   * @param {Float32Array} values @param {number} [from] coordinate of the first value
   * @param {number} [steps] over which they came apart @returns {number} the largest change over full scale */
  correct(values, from = 0, steps = Infinity) {
    const { scale } = this.description;
    let largest = 0;
    this.trees.forEach(({ table, ownDt, firstCoordinate: first }, number) => {
      const { m, n, arrays: { correction } } = table;
      const now = new Float64Array(n);
      this._write(number, now, 0);
      const { eta, rate, more } = this.rows(number);
      const { whole, width } = table.steps(ownDt);
      const perRate = whole.subarray(width, width + m);
      const least = SLOWEST * Math.max(...perRate);
      for (let k = 0; k < n; k++) {
        if (first + k < from || first + k - from >= values.length) continue;
        const difference = values[first + k - from] - now[k];
        for (let i = 0; i < m - more[5]; i++) {
          const own = difference * correction[k * m + i];
          eta[i] += own;
          rate[i] += (own * whole[4 * width + i]) / (Math.max(perRate[i], least) * steps);
        }
        largest = Math.max(largest, Math.abs(difference) / scale[first + k]);
      }
    });
    return largest;
  }

  /** Return all trees to rest, without wind. */
  reset() {
    this._states.values.fill(0);
    this._watches.clear();
    this.gusts = this._newGusts();
  }
}
