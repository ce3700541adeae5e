// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The connection to the server: opens it, requests frames by credit, reconnects when it is lost. */

import { checkMessage } from "./checks.js";
import {
  decodeDescription, decodeFrame, FRAME_SIZE, isFrame, isTables, LARGEST_DESCRIPTION, ProtocolError,
} from "./protocol.js";
import { decodeTables } from "./sway.js";

/** Most frames that may be under way, and the least of it if they are large. */
const MOST_CREDIT = 24, LEAST_CREDIT = 8;
/** Most bytes that may be under way, so that a slow connection does not fill with old frames. */
const ON_THE_WAY = 200000;
/** Number of frames for which credit is given at once. */
const GRANT_EVERY = 4;
/** Wait before a reconnection, doubled with each failure [ms]. */
const SHORTEST_WAIT = 500, LONGEST_WAIT = 10000;
const PING_EVERY = 2000;
/** Silence after which a connection counts as lost [ms]. */
const SILENCE = 6000;
const LARGEST_TEXT = 2 ** 20;

/** A connection to a server, kept up from `open` to `close`. */
export class Connection {
  roundTrip = NaN;
  /** @type {Description | null} */
  description = null;
  /** @type {WebSocket | null} */
  _socket = null;
  /** Number of messages that could not be read; each is followed by a reconnection. */
  unreadable = 0;
  _wait = SHORTEST_WAIT;
  /** Frames that were requested and have not come. */
  _awaited = 0;
  _credit = MOST_CREDIT;
  _heard = 0;

  /** @param {string} url of the stream @param {Listeners} listeners @param {number} [rate] of frames [1/s] */
  constructor(url, listeners, rate = 30) {
    this.url = url;
    this.listeners = listeners;
    this.rate = rate;
    this._retry = this._watching = /** @type {ReturnType<typeof setTimeout> | undefined} */ (undefined);
  }

  /** Connect now, without waiting for the next attempt. */
  open() {
    this.close();
    const socket = this._socket = new WebSocket(this.url);
    socket.binaryType = "arraybuffer";
    this._watching = setInterval(() => {
      const isSilent = performance.now() - this._heard > SILENCE;
      if (isSilent && socket.readyState === WebSocket.OPEN) this._lose();
      else this.send({ ping: performance.now() });
    }, PING_EVERY);
    this._heard = performance.now();
    this.listeners.onState("connecting", 0);
    socket.onopen = () => {
      this._awaited = 0;
      this.send({ rate: this.rate, ping: performance.now(), wind: Boolean(this.listeners.onTables) });
      this.listeners.onState("open", 0);
    };
    socket.onmessage = (event) => {
      if (socket === this._socket) this._take(event.data);
    };
    socket.onclose = () => {
      if (socket === this._socket) this._lose();
    };
  }

  /** Disconnect for good. */
  close() {
    clearTimeout(this._retry);
    clearInterval(this._watching);
    const socket = this._socket;
    this._socket = null;
    socket?.close();
  }

  /** @param {Record<string, any>} message */
  send(message) {
    if (this._socket?.readyState === WebSocket.OPEN) this._socket.send(JSON.stringify(message));
  }

  /** Give the connection up, and reconnect after a wait. */
  _lose() {
    this.close();
    // At random, so that many pages of one server do not all return at once.
    const wait = this._wait * (0.75 + 0.5 * Math.random());
    this._wait = Math.min(2 * this._wait, LONGEST_WAIT);
    this._retry = setTimeout(() => this.open(), wait);
    this.listeners.onState("lost", wait);
  }

  _ask() {
    const more = this._credit - this._awaited;
    if (more < GRANT_EVERY) return;
    this._awaited += more;
    this.send({ credit: more });
  }

  /** @param {string | ArrayBuffer} data */
  _take(data) {
    const arrival = Date.now();
    this._heard = performance.now();
    /** @type {ReturnType<Connection["_read"]>} */
    let read;
    try {
      read = this._read(data, arrival);
    } catch (error) {
      this.unreadable += 1;
      const why = error instanceof ProtocolError ? error.message : String(error);
      this._lose();
      read = ["onMessage", { unreadable: why.slice(0, 400) }];
    }
    const [name, ...values] = read;
    /** @type {any} */ (this.listeners)[name]?.(...values);
  }

  /** Read a text, a description, its tables or a frame. @param {string | ArrayBuffer} data
   * @param {number} arrival [ms] @returns {[name: keyof Listeners | "", ...any]} its listener, and what that is given */
  _read(data, arrival) {
    const isText = typeof data === "string";
    const size = isText ? data.length : data.byteLength;
    if (size > (isText ? LARGEST_TEXT : LARGEST_DESCRIPTION)) throw new ProtocolError(`a message of ${size} bytes`);
    if (isText) {
      const message = checkMessage(JSON.parse(data));
      if ("pong" in message) this.roundTrip = performance.now() - message.pong;
      return ["onMessage", message];
    }
    if (isTables(data)) return ["onTables", decodeTables(data)];
    if (!isFrame(data)) {
      const description = (this.description = decodeDescription(data));
      const fitting = Math.floor(ON_THE_WAY / (FRAME_SIZE + 2 * description.nCoordinates));
      this._credit = Math.max(LEAST_CREDIT, Math.min(MOST_CREDIT, fitting));
      this._ask();
      return ["onDescription", description];
    }
    this._awaited -= 1;
    this._ask();
    const frame = decodeFrame(data, this.description);
    if (frame) this._wait = SHORTEST_WAIT;
    return [frame ? "onFrame" : "", frame, arrival, size];
  }
}
