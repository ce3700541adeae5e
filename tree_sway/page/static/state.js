// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** What the page knows of its stream and of its server; nothing is drawn here. */

import { word } from "./words.js";

/** Age of the newest frame from which on the stream counts as behind [ms]. */
const BEHIND = 1000;
/** Controls that say what the tree is: a link carries them. */
export const OF_TREE = ["tree", "height", "age", "individual", "month", "model"];

export class PageState {
  /** @type {"connecting" | "open" | "lost"} */
  line = "connecting";
  retryAt = 0;
  lastFrameAt = 0;
  /** @type {Record<string, any>} */
  status = {};
  /** @type {any[]} */
  controls = [];
  /** Token for links to this page, which allows looking but no changes. */
  viewersToken = "";
  /** Whether the tree of a link has been asked for and is still to come. */
  isFollowing = false;

  /** @param {boolean} isOwn whether the page solves its tree without a server */
  constructor(isOwn) {
    this.isOwn = isOwn;
  }

  /** @param {string} name */
  control(name) {
    return this.controls.find((each) => each.name === name);
  }

  /** State of the stream, and its text. @param {import("./client.js").TreeStream} stream
   * @returns {["live" | "paused" | "behind" | "empty" | "connecting" | "lost", string]} */
  now({ description, playout }) {
    const age = performance.now() - this.lastFrameAt;
    if (this.line !== "open") return [this.line, word(this.line)];
    if (!description) return ["empty", word("empty")];
    if (playout.back) return ["paused", word("back", (playout.back / 1000).toFixed(1))];
    if (!this.lastFrameAt) return ["behind", word("waiting")];
    if (age > BEHIND) return ["behind", word("behind", (age / 1000).toFixed(1))];
    if (this.status.building) return ["behind", word("building")];
    if (playout.isPaused) return ["paused", word("paused")];
    return ["live", word(this.isOwn ? "own" : "live")];
  }

  /** Ask once for the tree of a link. @param {import("./client.js").TreeStream} stream
   * @param {Record<string, string>} settings of the link; those of the tree are taken out
   * @returns {string[]} names of what cannot be asked for, with their values */
  follow(stream, settings) {
    const missed = [];
    for (const name of OF_TREE) {
      const wanted = settings[name];
      delete settings[name];
      const { value: now, choices = [] } = this.control(name) ?? {};
      if (wanted === undefined || wanted === String(now)) continue;
      const value = typeof now === "number" ? Number(wanted) : wanted;
      if (choices.length ? choices.includes(wanted) : Number.isFinite(value)) {
        stream.set(name, value);
        this.isFollowing = true;
      } else missed.push(`${word(name)} ${wanted}`);
    }
    return missed;
  }
}
