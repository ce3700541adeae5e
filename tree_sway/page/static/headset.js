// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A headset: the tree in stereo at its own size, teleport by trigger, a branch pulled by the grip (WebXR). */

import { Pull } from "./drag.js";
import { turned } from "./quaternions.js";

/** Largest angle between a ray and the branch that it picks [rad]. */
const AIM = 0.06;
/** Longest teleport [m], and first distance over the height of the tree. */
const FARTHEST = 40, HEIGHTS_AWAY = 0.9;

/** The view of an eye with the interface of `Camera`. @param {any} view of WebXR @returns {View["camera"]} */
function eyeOf({ transform: { matrix: m, position: { x, y, z }, inverse }, projectionMatrix: p }) {
  const matrix = new DOMMatrix([...p]).multiply(new DOMMatrix([...inverse.matrix])).toFloat32Array();
  const column = (/** @type {number} */ at, share = 1) => Array.from(m.slice(at, at + 3), (each) => share * each);
  const right = column(0, 1 / p[0]), up = column(4, 1 / p[5]);
  const axes = { right, up, back: column(8).map((each, c) => each - p[8] * right[c] - p[9] * up[c]) };
  return { matrix, eye: [x, y, z], axes: () => axes, update: () => matrix };
}

export class Headset {
  /** @type {any} */
  session = null;
  frames = 0;
  /** @type {View[]} */
  views = [];
  /** Place of its floor in the scene [m], and its first heading [rad]. */
  origin = [0, 0, 0];
  heading = 0;
  /** Pull of each controller, and its distance [m]. @type {Map<any, {pull: Pull, far: number}>} */
  pulls = new Map();

  /** @param {Scene} scene @param {TreeStream} stream */
  constructor(scene, stream) {
    this.scene = scene;
    this.stream = stream;
  }

  /** Enter, or leave. @param {() => void} onEnd called when it has ended */
  async toggle(onEnd) {
    if (this.session) return this.session.end();
    const { gl } = this.scene;
    const session = await navigator.xr.requestSession("immersive-vr", { requiredFeatures: ["local-floor"] });
    await /** @type {any} */ (gl).makeXRCompatible();
    await session.updateRenderState({ baseLayer: new XRWebGLLayer(session, gl) });
    this._floor = await session.requestReferenceSpace("local-floor");
    const { target, azimuth } = this.scene.camera;
    const away = Math.max(1.2, HEIGHTS_AWAY * this.scene.height);
    this.heading = azimuth + Math.PI;
    this._stand(target[0] + away * Math.cos(azimuth), target[1] + away * Math.sin(azimuth));
    session.addEventListener("select", (/** @type {any} */ event) => {
      const { from = [], along = [0, 0, 0] } = this._ray(event) ?? {};
      if (along[2] > -0.02) return;
      const far = Math.min(FARTHEST, (this.scene.ground - from[2]) / along[2]);
      this._stand(from[0] + far * along[0], from[1] + far * along[1]);
    });
    session.addEventListener("squeezestart", (/** @type {any} */ event) => {
      const ray = this._ray(event);
      if (!ray || !this.scene.description) return;
      const { segment, far } = this.scene.nearest(ray.from, ray.along, AIM);
      if (segment >= 0) this.pulls.set(event.inputSource, { pull: new Pull(this.scene, this.stream, segment), far });
    });
    session.addEventListener("squeezeend", (/** @type {any} */ { inputSource }) => this._release(inputSource));
    session.addEventListener("end", () => {
      this.session = null;
      for (const source of this.pulls.keys()) this._release(source);
      onEnd();
    });
    this.session = session;
    session.requestAnimationFrame((/** @type {number} */ now, /** @type {any} */ frame) => this._draw(now, frame));
  }

  /** Stand somewhere on the ground: the headset is y up and looks along -z, the scene is z up.
   * @param {number} x [m] @param {number} y */
  _stand(x, y) {
    const half = Math.PI / 4 - this.heading / 2;
    const c = Math.SQRT1_2 * Math.cos(half), s = Math.SQRT1_2 * Math.sin(half);
    this.origin = [x, y, this.scene.ground];
    const [right, up, back] = turned([-c, s, s, c], this.origin.map((each) => -each));
    const scene = new XRRigidTransform({ x: right, y: up, z: back }, { x: -c, y: s, z: s, w: c });
    this.space = this._floor.getOffsetReferenceSpace(scene);
  }

  /** Ray of a controller in the scene; null if it is not tracked. @param {{frame: any, inputSource: any}} event */
  _ray({ frame, inputSource }) {
    const pose = frame.getPose(inputSource.targetRaySpace, this.space);
    if (!pose) return null;
    const { position: { x, y, z }, matrix: m } = pose.transform;
    return { from: [x, y, z], along: [-m[8], -m[9], -m[10]] };
  }

  /** @param {any} source */
  _release(source) {
    this.pulls.get(source)?.pull.release();
    this.pulls.delete(source);
  }

  /** @param {number} now [ms] @param {any} frame */
  _draw(now, frame) {
    const { session, scene, stream, space } = this;
    if (!session) return;
    session.requestAnimationFrame((/** @type {number} */ then, /** @type {any} */ next) => this._draw(then, next));
    const pose = frame.getViewerPose(space);
    if (!pose) return;
    for (const [inputSource, { pull, far }] of this.pulls) {
      const ray = this._ray({ frame, inputSource });
      if (ray) pull.to = ray.from.map((each, c) => each + far * ray.along[c]);
      pull.renew(performance.now());
      inputSource.gamepad?.hapticActuators?.[0]?.pulse(Math.min(1, pull.force / 50), 60);
    }
    const { baseLayer: layer } = session.renderState;
    this.views = pose.views.map((/** @type {any} */ view) => {
      const { x, y, width, height } = layer.getViewport(view);
      return { camera: eyeOf(view), target: layer.framebuffer, area: [x, y, width, height] };
    });
    scene.wind = stream.playout.wind;
    scene.draw(stream.sample(), now / 1000, stream.playout.isPaused, this.views);
    this.frames++;
  }
}
