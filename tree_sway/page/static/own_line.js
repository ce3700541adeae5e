// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** In place of a connection on a page without a server: solves the scene and gives the frames a server would send. */

import { Connection } from "./connection.js";
import { decodeDescription, PAUSED, RESTARTED } from "./protocol.js";
import { decodeTables, Stand } from "./sway.js";
import { readWind, Recorded, Turbulence } from "./wind.js";

/** Most time that a slow or hidden page catches up [ms]. */
const LATEST = 250;
/** Interval of status messages [ms]. */
const STATUS_EVERY = 500;

/** Scene inside the page; null on a page that a server sent. Throws if it is damaged. @returns {Promise<Kept | null>} */
export async function keptScene() {
  const data = await /** @type {any} */ (window).treeSwayScene?.();
  if (!data) return null;
  const from = 4 + new DataView(data).getUint32(0, true);
  const description = decodeDescription(data.slice(4, from), true);
  return { description, stand: new Stand(decodeTables(data.slice(from), true), description) };
}

/** Has the interface of `Connection`: the same listeners, messages and frames. */
export class OwnLine {
  roundTrip = NaN;
  /** Name of the recorded wind. */
  _record = "";
  _turbulence = new Turbulence();
  _isPaused = false;
  _hasRestarted = false;
  _sequence = 0;
  _time = 0;
  _reported = 0;
  _work = 0;
  /** @type {ReturnType<typeof setInterval> | undefined} */
  _timer = undefined;

  /** @param {Kept} kept @param {Listeners} listeners @param {string | null} [address] of a live wind */
  constructor({ description, stand }, listeners, address = null) {
    this.description = description;
    this.stand = stand;
    this.listeners = listeners;
    this._address = address;
    /** @type {{next: (dt: number) => number[]}} */
    this._wind = this._turbulence;
    /** Newest frame of a live wind. @type {Frame | null} */
    this._live = null;
    const unreadable = `no live wind from ${address}: the simulated one blows until it comes. `
      + "See whether tree-sway show runs there, with --origin null if this page is a file.";
    /** @type {Listeners} */
    const following = {
      onState: (state) => {
        if (state !== "lost") return;
        if (this._live || this._line?.description === null) listeners.onMessage({ unreadable });
        this._live = null;
      },
      onFrame: (frame) => (this._live = frame), onDescription: () => undefined, onMessage: () => undefined,
    };
    this._line = address === null ? null : new Connection(address, following, 60);
  }

  open() {
    this.close();
    this.listeners.onState("open", 0);
    this.listeners.onDescription(this.description);
    this._hello();
    this._time = Date.now();
    this._timer = setInterval(() => this._go(), 1000 * this.stand.dt / 2);
    this._line?.open();
  }

  close() {
    clearInterval(this._timer);
  }

  _hello() {
    const { mean_speed: speed, intensity, bearing_to: bearing } = this._turbulence.values;
    const controls = [control("mean_speed", speed, "m/s", 0, 40), control("intensity", intensity),
      control("bearing_to", bearing, "rad", -6.3, 6.3), control("pause", false), control("reset", null)];
    if (this._wind instanceof Recorded) controls.push(control("record_time", 0, "s", 0, this._wind.length));
    this.listeners.onMessage({ hello: { controls, can_pull: true } });
  }

  /** Apply a change of a control, or a pull. @param {Record<string, any>} message */
  send({ set, pull }) {
    if (pull) this.stand.push(pull);
    if (!set) return;
    const { name, value } = set;
    if (name === "reset") {
      this.stand.reset();
      this._hasRestarted = true;
    } else if (name === "pause") this._isPaused = value;
    else if (this._wind instanceof Recorded && name === "record_time") this._wind.time = value;
    else [this._turbulence.values[name], this._wind] = [value, this._turbulence];
    this.listeners.onMessage({ values: { ...this._turbulence.values, pause: this._isPaused } });
  }

  /** Play a recorded wind; throws a `ProtocolError` if the file has none. @param {File} file */
  async take(file) {
    this._wind = readWind(await file.text(), file.name);
    this._record = file.name.replace(/\.[^.]*$/, "");
    this._hello();
  }

  /** Source of the wind, as in the status of a server. */
  _source() {
    if (this._live) return { kind: "live", name: this._address ?? "" };
    return this._wind instanceof Recorded ? { kind: "recorded", name: this._record } : { kind: "simulated" };
  }

  _go() {
    const [now, step] = [Date.now(), 1000 * this.stand.dt];
    if (now - this._time > LATEST) this._time = now - step;
    for (; this._time + step <= now; this._time += step) {
      const begin = performance.now();
      const [x, y, z] = this._live?.wind ?? this._wind.next(this.stand.dt);
      if (!this._isPaused) this.stand.step(x, y, z);
      this._work += 0.05 * (performance.now() - begin - this._work);
      const flags = (this._isPaused ? PAUSED : 0) + (this._hasRestarted ? RESTARTED : 0);
      this._hasRestarted = false;
      this.listeners.onFrame({
        identity: this.description.shortIdentity, sequence: this._sequence++, stamp: this._time, flags,
        wind: [x, y, z], coordinates: this.stand.state(), first: 0,
      }, this._time, 0);
    }
    if (now - this._reported < STATUS_EVERY) return;
    this._reported = now;
    const { trees, outside, dt } = this.stand;
    this.listeners.onMessage({ status: {
      model: trees[0].table.m.toString(), trees: trees.length, rate: 1 / dt, work_us: 1000 * this._work, outside,
      wind: this._source(),
      ...(this._wind instanceof Recorded && { record_time: this._wind.time }),
    } });
  }
}

/** @param {string} name @param {any} value */
const control = (name, value, unit = "", minimum = 0, maximum = 1) =>
  ({ name, label: name, description: "", value, unit, minimum, maximum, choices: [], is_action: value === null });
