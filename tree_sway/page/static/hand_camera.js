// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The camera of this device before the real tree: its visitor clicks points of the tree in the picture, the server tells
 * where the wood is, and points there are followed. Their places are sent, and no picture. */

import { write } from "./notices.js";
import { OpticalFlow } from "./optical_flow.js";
import { element } from "./panel.js";
import { word } from "./words.js";

const WANTED = { facingMode: "environment", width: 640, height: 480, frameRate: 30 };
/** Share of the points below which most are lost, and time after which points are found anew then [ms]. */
const [FEWEST, LONG] = [0.4, 10000];

export class HandCamera {
  /** @param {import("./view.js").View} view */
  constructor(view) {
    this.view = view;
    this.video = /** @type {HTMLVideoElement | null} */ (null);
    this.canvas = /** @type {HTMLCanvasElement} */ (element("seen"));
    /** Clicked points: x and y [px], and their place on the tree. */
    this.clicks = /** @type {[number, number, string][]} */ ([]);
    /** Newest answer of the server. */
    this._found = { number: 0, places: /** @type {number[][]} */ ([]) };
    this._flow = /** @type {OpticalFlow | null} */ (null);
    this._goodAt = 0;
    this.canvas.addEventListener("click", (event) => this.video && this._click(event));
    element("camera-known").addEventListener("change", () => this.send());
  }

  async toggle() {
    if (this.video) return this.end();
    // A page of another machine has no camera over plain http.
    if (!navigator.mediaDevices) throw new Error(word("camera_needs_https"));
    const video = this.video = Object.assign(document.createElement("video"), { muted: true, playsInline: true });
    const media = await navigator.mediaDevices.getUserMedia({ video: WANTED }).catch(({ name }) => {
      this.video = null;
      throw new Error(word(name));
    });
    video.srcObject = media;
    media.getVideoTracks()[0].onended = () => this.end("camera_gone");
    if (video !== this.video) return stop(video);
    await video.play();
    this._restart();
    this._take(video, 0);
  }

  /** Let the camera go. @param {string} [why] key of its text */
  end(why = "") {
    if (this.video) stop(this.video);
    this.video = null;
    this.view.stream.connection.send({ film: { end: true } });
    write({ "camera-said": word(why) });
    this.view.showButtons();
  }

  _restart() {
    this.clicks = [];
    this.take({ number: 0, said: "", places: [] });
    this.send();
  }

  /** Take what the server tells of the clicks. @param {{number: number, said: string, places: number[][]}} found */
  take(found) {
    this._found = found;
    this._flow = null;
    write({ "camera-said": found.said });
  }

  /** Send the clicks, or say what to click next. */
  send() {
    const { clicks, canvas: { width, height }, view: { stream } } = this;
    if (!this.video) return;
    write({ "camera-said": word(`camera_click_${Math.min(clicks.length, 2)}`) });
    const known = /** @type {HTMLInputElement} */ (element("camera-known")).value;
    const at = [known, ...clicks.map(([x, y, place]) => `${x.toFixed(1)},${y.toFixed(1)},${place}`)].join(";");
    if (clicks.length > 2) stream.connection.send({ film: { at, size: [width, height] } });
  }

  /** Take a click in the picture: the point that was clicked on the drawn tree, or else foot and top of the stem.
   * @param {MouseEvent} event */
  _click({ offsetX, offsetY }) {
    const { clicks, canvas, view, view: { pointedAt, scene } } = this;
    const stem = scene.watched.kind?.branch_names[0];
    if (pointedAt < 0 && clicks.length > 1) return;
    const scale = canvas.width / canvas.clientWidth;
    clicks.push([scale * offsetX, scale * offsetY, pointedAt < 0 ? `${stem}:${clicks.length}` : `segment:${pointedAt}`]);
    view.pick(scene.picked);
    this.send();
  }

  /** Follow the points of a picture. @param {HTMLVideoElement} video @param {number} time when it was taken [ms] */
  _take(video, time) {
    const { canvas, clicks, _found: { number, places }, view: { stream } } = this;
    if (video !== this.video) return;
    video.requestVideoFrameCallback((now, { captureTime = now }) => this._take(video, captureTime));
    const { videoWidth: width, videoHeight: height } = video;
    if (canvas.width !== width || canvas.height !== height) {
      [canvas.width, canvas.height] = [width, height];
      this._restart(); // a phone that was turned
    }
    const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", { willReadFrequently: true }));
    context.drawImage(video, 0, 0);
    /** @param {string} color @param {number} size @returns {(at: ArrayLike<any>) => void} */
    const dot = (color, size) => ({ 0: x, 1: y }) => {
      context.fillStyle = color;
      context.fillRect(x - size / 2, y - size / 2, size, size);
    };
    if (number) {
      const { data } = context.getImageData(0, 0, width, height);
      if (!this._flow) this._goodAt = time;
      const flow = this._flow ??= new OpticalFlow(width, height, data, places);
      if (flow.follow(data) > FEWEST) this._goodAt = time;
      const { points } = flow;
      stream.connection.send({ film: { time, number, points: Array.from(points, (each) => Math.round(100 * each) / 100) } });
      places.forEach(dot("red", 1));
      for (let i = 0; i < points.length; i += 2) dot("lime", 5)(points.subarray(i));
      if (time - this._goodAt > LONG) this.send();
    }
    clicks.forEach(dot("orange", 7));
  }
}

/** @param {HTMLVideoElement} video */
function stop({ srcObject }) {
  for (const track of /** @type {MediaStream} */ (srcObject)?.getTracks() ?? []) track.stop();
}
