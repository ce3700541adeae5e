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
const FEWEST = 0.4, LONG = 10000;

export class HandCamera {
  /** @type {HTMLVideoElement | null} */
  video = null;
  /** @type {HTMLCanvasElement} */
  canvas = element("seen");
  /** Clicked points: x and y [px], and their place on the tree. @type {[number, number, string][]} */
  clicks = [];
  /** Newest answer of the server. */
  _found = { number: 0, places: /** @type {number[][]} */ ([]) };
  /** @type {OpticalFlow | null} */
  _flow = null;
  _goodAt = Infinity;

  /** @param {import("./view.js").View} view */
  constructor(view) {
    this.view = view;
    this.canvas.onclick = (event) => this.video && this._click(event);
    element("camera-known").onchange = () => this.send();
  }

  async toggle() {
    if (this.video) return this.end();
    // A page of another machine has no camera over plain http.
    if (!navigator.mediaDevices) throw new Error(word("camera_needs_https"));
    const srcObject = await navigator.mediaDevices.getUserMedia({ video: WANTED }).catch(({ name }) => {
      throw new Error(word(name));
    });
    this.end(); // one that was asked for at the same time
    const video = this.video = Object.assign(document.createElement("video"), { muted: true, playsInline: true, srcObject });
    srcObject.getVideoTracks()[0].onended = () => this.end("camera_gone");
    this.canvas.width = 0;
    await video.play();
    this._take(video, 0);
  }

  /** Let the camera go. @param {string} [why] key of its text */
  end(why = "") {
    if (!this.video) return;
    for (const track of /** @type {MediaStream} */ (this.video.srcObject).getTracks()) track.stop();
    this.video = null;
    this.view.stream.connection.send({ film: { end: true } });
    write({ "camera-said": word(why) });
    this.view.showButtons();
  }

  /** Take what the server tells of the clicks. @param {{number: number, said: string, places: number[][]}} found */
  take(found) {
    this._found = found;
    this._flow = null;
    this._goodAt = Infinity;
    write({ "camera-said": found.said });
  }

  /** Send the clicks, or say what to click next. */
  send() {
    const { clicks, canvas: { width, height }, view: { stream } } = this;
    if (!this.video) return;
    write({ "camera-said": word(`camera_click_${Math.min(clicks.length, 2)}`) });
    const at = [/** @type {HTMLInputElement} */ (element("camera-known")).value, ...clicks].join(";");
    if (clicks.length > 2) stream.connection.send({ film: { at, size: [width, height] } });
  }

  /** Take a click in the picture: the point that was clicked on the drawn tree, or else foot and top of the stem.
   * @param {MouseEvent} event */
  _click({ offsetX, offsetY }) {
    const { clicks, canvas, view, view: { pointedAt, scene } } = this;
    if (pointedAt < 0 && clicks.length > 1) return;
    const scale = canvas.width / canvas.clientWidth;
    const place = pointedAt < 0 ? `${scene.watched.kind?.branch_names[0]}:${clicks.length}` : `segment:${pointedAt}`;
    clicks.push([scale * offsetX, scale * offsetY, place]);
    view.pick(scene.picked);
    this.send();
  }

  /** Follow the points of a picture. @param {HTMLVideoElement} video @param {number} time when it was taken [ms] */
  _take(video, time) {
    const { canvas, view, view: { stream, scene } } = this;
    if (video !== this.video) return;
    video.requestVideoFrameCallback((now, { captureTime = now }) => this._take(video, captureTime));
    const { videoWidth: width, videoHeight: height } = video;
    if (canvas.width !== width || canvas.height !== height) {
      // Begin, also as a phone was turned.
      Object.assign(canvas, { width, height });
      this.clicks = [];
      view.pick(scene.picked); // a click on the drawn tree counts from here on
      this.take({ number: 0, said: "", places: [] });
      this.send();
    }
    const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", { willReadFrequently: true }));
    context.drawImage(video, 0, 0);
    /** @param {string} color @param {number} size @param {any[][]} marks */
    const mark = (color, size, marks) => {
      context.fillStyle = color;
      for (const [x, y] of marks) context.fillRect(x - size / 2, y - size / 2, size, size);
    };
    const { data } = context.getImageData(0, 0, width, height);
    const { number, places } = this._found;
    if (number) {
      this._flow ??= new OpticalFlow(width, height, data, places);
      if (this._flow.follow(data) > FEWEST) this._goodAt = time;
      else if (time - this._goodAt > LONG) {
        this._goodAt = time;
        this.send();
      }
      const points = Array.from(this._flow.points, (each) => Math.round(100 * each) / 100);
      stream.connection.send({ film: { time, number, points } });
      mark("red", 1, places);
      mark("lime", 5, points.map((each, i) => [each, points[i + 1]]).filter((_, i) => i % 2 === 0));
    }
    mark("orange", 7, this.clicks);
  }
}
