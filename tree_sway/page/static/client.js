// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A client of the stream for any program: connects, reconnects, and gives the present pose of every segment.
 * It has no dependencies; draw the poses with three.js, Babylon or WebXR. */

import { ByWind } from "./by_wind.js";
import { Connection } from "./connection.js";
import { OwnLine } from "./own_line.js";
import { Placer } from "./placing.js";
import { Playout } from "./playout.js";
import { Stand } from "./sway.js";

/** Playout delay of a scene without a server [ms]. */
const OWN_DELAY = 40;
/** Names of this machine; from there scenes of fewer coordinates than FEW are sent at 60 Hz. */
const HERE = /^(localhost|127[.]|\[::1\])/;
const FEW = 1000;

export class TreeStream {
  /** @type {Placer | null} */
  placer = null;
  /** Solver of a scene whose wind alone is sent; null where states are. @type {ByWind | null} */
  byWind = null;

  /** @param {string} page address of the page, with its token if it has one
   * @param {StreamListeners} [listeners] @param {StreamOptions} [options] */
  constructor(page, listeners = {}, options = {}) {
    const { kept = null, byWind = false, delay = kept ? OWN_DELAY : undefined } = options;
    this.playout = new Playout(delay);
    const { onDescription, onFrame, onMessage } = listeners;
    /** @type {Listeners} */
    const taking = {
      onState: () => undefined,
      ...listeners,
      onMessage: (message) => {
        if (message.gusts) this.byWind?.goOn(message.gusts);
        onMessage?.(message);
      },
      onDescription: (description) => {
        this.playout.clear();
        this.placer = null;
        this.byWind = null;
        const isQuick = HERE.test(new URL(page).hostname) && description.nCoordinates < FEW;
        if (isQuick && !options.rate) this.connection.send({ rate: 60 });
        onDescription?.(description);
      },
      onFrame: (frame, arrival, size) => {
        const whole = this.byWind ? this.byWind.take(frame) : frame;
        if (whole && whole.coordinates.length >= (this.description?.nCoordinates ?? Infinity)) this.playout.push(whole, arrival);
        onFrame?.(frame, arrival, size);
      },
      ...(byWind && { onTables: (tables) => {
        if (this.description) this.byWind = new ByWind(new Stand(tables, this.description));
      } }),
    };
    const url = new URL("stream", page);
    url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
    url.search = new URL(page).search;
    this.connection = kept
      ? new OwnLine(kept, taking, new URL(page).searchParams.get("wind"))
      : new Connection(url.href, taking, options.rate ?? (byWind ? 60 : undefined));
  }

  /** Connect now, without waiting for the next attempt. */
  open() {
    this.connection.open();
  }

  /** Disconnect for good. */
  close() {
    this.connection.close();
  }

  /** Description of the scene; null before it has come. */
  get description() {
    return this.connection.description;
  }

  /** Change a control of the server. @param {string} name @param {number | string | boolean | null} value */
  set(name, value) {
    this.connection.send({ set: { name, value } });
  }

  /** Pull a branch by a spring, if the server allows it; repeat within half a second to keep it.
   * @param {Push} pull without stiffness it ends */
  pull(pull) {
    this.connection.send({ pull });
    this.byWind?.stand.push(pull);
  }

  /** Coordinates to show; null before the first frame. @param {number} [now] [ms] */
  sample(now = Date.now()) {
    return this.playout.sample(now);
  }

  /** Poses to show, `STRIDE` numbers per segment; null before the first frame. @param {number} [now] [ms]
   * @returns {Float32Array | null} the same array each time */
  poses(now = Date.now()) {
    const coordinates = this.sample(now);
    if (!coordinates || !this.description) return null;
    this.placer ??= new Placer(this.description);
    return this.placer.place(coordinates);
  }
}
