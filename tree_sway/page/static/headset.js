// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A headset: the tree in stereo at its own size, teleport by trigger, a branch pulled by the grip (WebXR). */

import { Pull } from "./drag.js";
import { xr } from "./hands.js";

/** A branch is pointed at that is within this angle of the ray [rad]. */
const AIM = 0.06;
/** Teleport goes this far at most, and the first stand is that many heights away. */
const [FARTHEST, HEIGHTS_AWAY] = [40, 0.9];

/** The frame of the headset is y up and looks along -z; a scene is z up. */
class Rig {
  /** @param {number[]} origin of its floor in the scene [m] @param {number} heading of its -z [rad] */
  constructor(origin, heading) {
    this.origin = origin;
    this.forward = [Math.cos(heading), Math.sin(heading)];
  }

  /** A direction of the headset in the scene. @param {{x: number, y: number, z: number}} v */
  turned({ x, y, z }) {
    const [c, s] = this.forward;
    return [x * s - z * c, -x * c - z * s, y];
  }

  /** @param {{x: number, y: number, z: number}} p */
  placed(p) {
    return this.turned(p).map((each, c) => each + this.origin[c]);
  }
}

/** One eye, drawn by as a `Camera` is. */
class Eye {
  /** @param {Rig} rig @param {any} view of WebXR */
  constructor(rig, { transform, projectionMatrix: p }) {
    const { matrix: m, position } = transform;
    const [right, up, back] = [0, 4, 8].map((at) => rig.turned({ x: m[at], y: m[at + 1], z: m[at + 2] }));
    this.eye = /** @type {[number, number, number]} */ (rig.placed(position));
    this.matrix = new Float32Array(16);
    const rows = [right, up, back];
    const moved = rows.map((row) => -row.reduce((sum, each, c) => sum + each * this.eye[c], 0));
    for (let c = 0; c < 4; c++) {
      const column = c < 3 ? [...rows.map((row) => row[c]), 0] : [...moved, 1];
      for (let r = 0; r < 4; r++) {
        this.matrix[4 * c + r] = column.reduce((sum, each, k) => sum + p[4 * k + r] * each, 0);
      }
    }
    const wide = right.map((each) => each / p[0]);
    const high = up.map((each) => each / p[5]);
    this._axes = { right: wide, up: high, back: back.map((each, c) => each - p[8] * wide[c] - p[9] * high[c]) };
  }

  axes() {
    return this._axes;
  }

  update() {
    return this.matrix;
  }
}

export class Headset {
  /** @param {import("./drawing/scene.js").Scene} scene @param {import("./client.js").TreeStream} stream */
  constructor(scene, stream) {
    this.scene = scene;
    this.stream = stream;
    /** @type {any} */
    this.session = null;
    this.frames = 0;
    /** What each eye sees. @type {View[]} */
    this.views = [];
    this.rig = new Rig([0, 0, 0], 0);
    /** What each controller pulls at, and how far off it is [m]. @type {Map<any, {pull: Pull, far: number}>} */
    this.pulls = new Map();
  }

  /** Enter, or leave. @param {(isIn: boolean) => void} say that it changed by itself */
  async toggle(say) {
    if (this.session) {
      await this.session.end();
      return false;
    }
    const { gl } = this.scene;
    const session = await xr.requestSession("immersive-vr", { requiredFeatures: ["local-floor"] });
    await /** @type {any} */ (gl).makeXRCompatible();
    const { XRWebGLLayer } = /** @type {any} */ (window);
    await session.updateRenderState({ baseLayer: new XRWebGLLayer(session, gl) });
    this.space = await session.requestReferenceSpace("local-floor");
    const { target, azimuth } = this.scene.camera;
    const away = Math.max(1.2, HEIGHTS_AWAY * this.scene.height);
    const floor = [target[0] + away * Math.cos(azimuth), target[1] + away * Math.sin(azimuth), this.scene.ground];
    this.rig = new Rig(floor, azimuth + Math.PI);
    session.addEventListener("select", (/** @type {any} */ event) => this._teleport(this._ray(event)));
    session.addEventListener("squeezestart", (/** @type {any} */ event) => this._grab(event.inputSource, this._ray(event)));
    session.addEventListener("squeezeend", (/** @type {any} */ { inputSource }) => this._release(inputSource));
    session.addEventListener("end", () => {
      this.session = null;
      for (const source of this.pulls.keys()) this._release(source);
      say(false);
    });
    this.session = session;
    session.requestAnimationFrame((/** @type {number} */ now, /** @type {any} */ frame) => this._draw(now, frame));
    return true;
  }

  /** Where a controller points from and to, in the scene; null where it is not seen.
   * @param {{frame: any, inputSource: any}} event */
  _ray({ frame, inputSource }) {
    const pose = frame.getPose(inputSource.targetRaySpace, this.space);
    if (!pose) return null;
    const { position, matrix: m } = pose.transform;
    return { from: this.rig.placed(position), along: this.rig.turned({ x: -m[8], y: -m[9], z: -m[10] }) };
  }

  /** @param {{from: number[], along: number[]} | null} ray */
  _teleport(ray) {
    if (!ray || ray.along[2] > -0.02) return;
    const far = Math.min(FARTHEST, (this.scene.ground - ray.from[2]) / ray.along[2]);
    const [x, y] = ray.from.map((each, c) => each + far * ray.along[c]);
    this.rig.origin = [x, y, this.scene.ground];
  }

  /** The segment that a ray points at, -1 if none, and its distance [m].
   * @param {{from: number[], along: number[]}} ray */
  _aimed({ from, along }) {
    let [best, segment, far] = [AIM, -1, 0];
    const { kind } = this.scene.watched;
    for (let s = 0; s < kind.nSegments; s++) {
      const to = this.scene.position(s).map((each, c) => each - from[c]);
      const away = Math.hypot(...to);
      const cosine = to.reduce((sum, each, c) => sum + each * along[c], 0) / away;
      const angle = Math.acos(Math.min(1, cosine));
      if (angle < best) [best, segment, far] = [angle, s, away];
    }
    return { segment, far };
  }

  /** @param {any} source @param {{from: number[], along: number[]} | null} ray */
  _grab(source, ray) {
    if (!ray || !this.scene.description) return;
    const { segment, far } = this._aimed(ray);
    if (segment >= 0) this.pulls.set(source, { pull: new Pull(this.scene, this.stream, segment), far });
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
      return { camera: new Eye(this.rig, view), target: layer.framebuffer, area: [x, y, width, height] };
    });
    scene.wind = stream.playout.wind;
    scene.draw(stream.sample(), now / 1000, stream.playout.isPaused, this.views);
    this.frames++;
  }
}
