// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The line to the server: opens it, asks for frames by credit, opens it again when it is lost. */

import { checkMessage } from "./checks.js";
import {
  decodeDescription, decodeFrame, FRAME_SIZE, isFrame, isTables, LARGEST_DESCRIPTION, ProtocolError,
} from "./protocol.js";
import { decodeTables } from "./sway.js";

/** Frames that may be on their way at most, and at least where they are large. */
const [MOST_CREDIT, LEAST_CREDIT] = [24, 8];
/** What may be on its way [bytes], so that a slow line holds little that is old. */
const ON_THE_WAY = 200000;
const GRANT_EVERY = 4;
/** Until a lost line is opened again, and between pings [ms]. */
const [SHORTEST_WAIT, LONGEST_WAIT, PING_EVERY] = [500, 10000, 2000];
/** A line that has been silent for longer is taken for lost [ms]. */
const SILENCE = 6000;
const LARGEST_TEXT = 2 ** 20;

/** One line to a server, kept from `open` to `close`. */
export class Connection {
  /** @param {string} url of the stream @param {Listeners} listeners @param {number} [rate] of frames [1/s] */
  constructor(url, listeners, rate = 30) {
    this.url = url;
    this.listeners = listeners;
    this.rate = rate;
    this.roundTrip = NaN;
    this.description = /** @type {Description | null} */ (null);
    this._socket = /** @type {WebSocket | null} */ (null);
    /** Messages that could not be read; after each the line is made again. */
    this.unreadable = 0;
    this._wait = SHORTEST_WAIT;
    /** Frames that were asked for and have not come. */
    this._awaited = 0;
    this._credit = MOST_CREDIT;
    this._heard = 0;
    this._retry = this._watching = /** @type {ReturnType<typeof setTimeout> | undefined} */ (undefined);
  }

  /** Open the line now, whatever the wait. */
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

  /** Close the line for good. */
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

  /** Lose the line, and make it again. */
  _lose() {
    this.close();
    // Many pages that lose one server do not come back in one instant.
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
    let deliver;
    try {
      deliver = this._read(data, arrival);
    } catch (error) {
      this.unreadable += 1;
      const why = error instanceof ProtocolError ? error.message : String(error);
      this._lose();
      deliver = () => this.listeners.onMessage({ unreadable: why.slice(0, 400) });
    }
    deliver();
  }

  /** Read a text, a description, its tables or a frame. @param {string | ArrayBuffer} data
   * @param {number} arrival [ms] @returns {() => void} what is left to do: give it to the listener */
  _read(data, arrival) {
    const isText = typeof data === "string";
    const size = isText ? data.length : data.byteLength;
    const isTooLarge = size > (isText ? LARGEST_TEXT : LARGEST_DESCRIPTION);
    if (isTooLarge) throw new ProtocolError(`a message of ${size} bytes`);
    if (isText) {
      const message = checkMessage(JSON.parse(data));
      if ("pong" in message) this.roundTrip = performance.now() - message.pong;
      return () => this.listeners.onMessage(message);
    }
    if (isTables(data)) {
      const tables = decodeTables(data);
      return () => this.listeners.onTables?.(tables);
    }
    if (!isFrame(data)) {
      const description = (this.description = decodeDescription(data));
      const fitting = Math.floor(ON_THE_WAY / (FRAME_SIZE + 2 * description.nCoordinates));
      this._credit = Math.max(LEAST_CREDIT, Math.min(MOST_CREDIT, fitting));
      this._ask();
      return () => this.listeners.onDescription(description);
    }
    this._awaited -= 1;
    this._ask();
    const frame = decodeFrame(data, this.description);
    if (frame) this._wait = SHORTEST_WAIT;
    return () => frame && this.listeners.onFrame(frame, arrival, size);
  }
}
