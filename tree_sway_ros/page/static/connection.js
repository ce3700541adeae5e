// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/**
 * The line to the server: opens it, asks for frames by credit, opens it again when it is lost.
 */

import { decodeDescription, decodeFrame, frameSize, isFrame, ProtocolError } from "./protocol.js";

/** Frames that may be on their way at most, and at least where they are large. */
const MOST_CREDIT = 24;
const LEAST_CREDIT = 8;
/** What may be on its way [bytes], so that a slow line holds little that is old. */
const ON_THE_WAY = 200000;
const GRANT_EVERY = 4;
const SHORTEST_WAIT = 500;
const LONGEST_WAIT = 10000;
const PING_EVERY = 2000;
/** A line that has been silent for so long is taken for lost [ms]. */
const SILENCE = 6000;

/**
 * @typedef {"connecting" | "open" | "lost"} LineState
 *
 * @typedef {object} Listeners
 * @property {(state: LineState, retryIn: number) => void} onState
 * @property {(description: import("./protocol.js").Description) => void} onDescription
 * @property {(frame: import("./protocol.js").Frame, arrival: number, size: number) => void} onFrame
 * @property {(message: Record<string, any>) => void} onMessage
 */

/** One line to a server, kept from `open` to `close`. */
export class Connection {
  /**
   * @param {string} url of the stream
   * @param {Listeners} listeners
   * @param {number} [rate] frames per second that are asked for
   */
  constructor(url, listeners, rate = 30) {
    this.url = url;
    this.listeners = listeners;
    this.rate = rate;
    this.roundTrip = NaN;
    /** @type {import("./protocol.js").Description | null} */
    this.description = null;
    /** @type {WebSocket | null} */
    this._socket = null;
    this._wait = SHORTEST_WAIT;
    /** Frames that were asked for and have not come. */
    this._awaited = 0;
    this._credit = MOST_CREDIT;
    this._heard = 0;
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this._retry = undefined;
    this._watching = setInterval(() => this._watch(), PING_EVERY);
  }

  /** Open the line now, whatever the wait. */
  open() {
    clearTimeout(this._retry);
    this._socket?.close();
    const socket = new WebSocket(this.url);
    socket.binaryType = "arraybuffer";
    this._socket = socket;
    this._heard = performance.now();
    this.listeners.onState("connecting", 0);
    socket.onopen = () => {
      this._wait = SHORTEST_WAIT;
      this._awaited = 0;
      this.send({ rate: this.rate, ping: performance.now() });
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

  _lose() {
    this._socket = null;
    // Many pages that lose one server do not come back in one instant.
    const wait = this._wait * (0.75 + 0.5 * Math.random());
    this._wait = Math.min(2 * this._wait, LONGEST_WAIT);
    this._retry = setTimeout(() => this.open(), wait);
    this.listeners.onState("lost", wait);
  }

  _watch() {
    if (this._socket?.readyState !== WebSocket.OPEN) return;
    if (performance.now() - this._heard > SILENCE) {
      const socket = this._socket;
      this._lose();
      socket.close();
      return;
    }
    this.send({ ping: performance.now() });
  }

  /** Ask for as many frames as may be on their way. */
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
    if (typeof data === "string") {
      const message = JSON.parse(data);
      if (typeof message.pong === "number") this.roundTrip = performance.now() - message.pong;
      this.listeners.onMessage(message);
      return;
    }
    try {
      if (!isFrame(data)) {
        this.description = decodeDescription(data);
        const fitting = Math.floor(ON_THE_WAY / frameSize(this.description));
        this._credit = Math.max(LEAST_CREDIT, Math.min(MOST_CREDIT, fitting));
        this._ask();
        this.listeners.onDescription(this.description);
        return;
      }
      this._awaited -= 1;
      this._ask();
      if (this.description) {
        const frame = decodeFrame(data, this.description);
        this.listeners.onFrame(frame, arrival, data.byteLength);
      }
    } catch (error) {
      if (!(error instanceof ProtocolError)) throw error;
      this.listeners.onMessage({ unreadable: error.message });
    }
  }
}
