// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A camera that orbits a point, moved by mouse, touch and keys. z is up. */

/** Half of the height of the picture over its distance. */
const HALF = Math.tan((16 * Math.PI) / 180);
/** Height from which on the camera looks up at a tree [m]. */
const TALL = 3;
/** Distance from the edge of a stand, over its height, and height of the eye there [m]. */
const NEARBY = 2, EYE = 2.5;
/** Least height of the eye above the ground, but for a small plant [m]. */
const LOWEST = 1.5;

export class Camera {
  azimuth = -0.6;
  elevation = 0.18;
  distance = 3;
  target = /** @type {Vector} */ ([0, 0, 0]);
  aspect = 1;
  matrix = new Float32Array(16);
  eye = /** @type {Vector} */ ([0, 0, 0]);
  /** Part of the picture that nothing covers: left, top, right and bottom, 0 to 1. @type {() => number[]} */
  room = () => [0, 0, 1, 1];
  /** Whether it shows the scene, as nobody has moved it. */
  isHome = true;
  _size = 1;
  _box = /** @type {number[][]} */ ([[0, 0, 0], [1, 1, 1]]);

  /** Take the view of a link. @param {number[]} view azimuth, elevation, distance, target */
  set([azimuth, elevation, distance, x, y, z]) {
    this.isHome = false;
    Object.assign(this, { azimuth, elevation, distance, target: [x, y, z] });
  }

  /** Show a scene, a stand of trees from its edge. @param {number[][]} box its lowest and its highest corner */
  home([low, high] = this._box) {
    this._box = [low, high];
    const wide = Math.hypot(high[0] - low[0], high[1] - low[1]);
    const tall = high[2] - low[2];
    this._size = Math.hypot(wide, tall);
    this.azimuth = -0.6;
    // A tree is seen from the ground, against the sky; a plant from higher up; a stand from its edge, between its trees.
    const isTree = tall > TALL && wide < 2 * tall;
    const isStand = wide > 3 * tall;
    this.target = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2];
    const [left, top, right, bottom] = this.room();
    const [across, down] = [right - left, bottom - top].map((each) => Math.max(0.2, each));
    // A crown is round: its box has corners that it does not reach; its leaves go beyond the top.
    const [round, deep] = isTree ? [0.75, 0.14] : [1, 0.16];
    const half = 0.54 * Math.max((tall + deep * wide) / down, (round * wide) / this.aspect / across);
    this.distance = isStand ? 0.6 * Math.min(high[0] - low[0], 1.5 * (high[1] - low[1])) + NEARBY * tall : half / HALF + 0.3 * wide;
    this.elevation = isTree ? -0.07 : isStand ? (EYE - 0.5 * tall) / this.distance : deep;
    this.pan(0.5 * this.aspect * (left + right - 1), 0.5 * (top + bottom - 1));
    this.isHome = true;
  }

  /** @param {number} dx [px] @param {number} dy */
  orbit(dx, dy) {
    this.isHome = false;
    this.azimuth -= dx * 0.006;
    this.elevation = Math.min(Math.max(this.elevation + dy * 0.005, -0.12), 1.5);
  }

  /** @param {number} dx share of the height @param {number} dy */
  pan(dx, dy) {
    this.isHome = false;
    const span = 2 * this.distance * HALF;
    this.target[0] += Math.sin(this.azimuth) * dx * span;
    this.target[1] -= Math.cos(this.azimuth) * dx * span;
    this.target[2] += dy * span;
  }

  /** @param {number} factor below 1 comes nearer */
  zoom(factor) {
    this.isHome = false;
    this.distance = Math.min(Math.max(this.distance * factor, 0.05 * this._size), 20 * this._size);
  }

  /** Axes of the picture at distance 1 from the eye: half its width, half its height, and the direction to the eye. */
  axes() {
    const [[ca, sa], [ce, se]] = [this.azimuth, this.elevation].map((angle) => [Math.cos(angle), Math.sin(angle)]);
    const right = [-sa, ca, 0].map((each) => HALF * this.aspect * each);
    const up = [-se * ca, -se * sa, ce].map((each) => HALF * each);
    return { right, up, back: [ce * ca, ce * sa, se] };
  }

  /** Find the matrix from the scene to clip space. @returns {Float32Array} column by column */
  update() {
    // The camera stays above the grass.
    const above = this.target[2] - this._box[0][2] - Math.min(LOWEST, 0.1 * this._size);
    this.elevation = Math.max(this.elevation, -Math.asin(Math.min(1, Math.max(-0.9, above / this.distance))));
    const { right, up, back } = this.axes();
    const [x, y, z] = this.target.map((each, c) => each + this.distance * back[c]);
    this.eye = [x, y, z];
    const near = 0.02 * this.distance;
    const far = this.distance + 30 * this._size;
    const sizes = [(HALF * this.aspect) ** -2, HALF ** -2, (far + near) / (near - far), -1];
    [right, up, back, back].forEach((axis, r) => {
      for (let c = 0; c < 3; c++) this.matrix[4 * c + r] = sizes[r] * axis[c];
      this.matrix[12 + r] = -sizes[r] * axis.reduce((sum, each, c) => sum + each * this.eye[c], 0);
    });
    this.matrix[14] += (2 * far * near) / (near - far);
    return this.matrix;
  }

  /** Place of a point in the picture, 0 to 1 from the left and from the top. @param {ArrayLike<number>} p */
  project(p) {
    const m = this.matrix;
    const [x, y, w] = [0, 1, 3].map((r) => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
    return [0.5 + (0.5 * x) / w, 0.5 - (0.5 * y) / w];
  }

  /** Ray from the eye through a place of the picture, of depth 1. @param {number[]} at 0 to 1 from left and top */
  ray([x, y]) {
    const { right, up, back } = this.axes();
    return right.map((each, c) => (2 * x - 1) * each + (1 - 2 * y) * up[c] - back[c]);
  }

  /** Point under a place of the picture at the depth of another point. @param {number[]} at @param {number[]} p */
  under(at, p) {
    const { back } = this.axes();
    const depth = this.eye.reduce((sum, each, c) => sum + (each - p[c]) * back[c], 0);
    return this.ray(at).map((each, c) => this.eye[c] + depth * each);
  }

  /** Let mouse, touch and keys move the camera. @param {HTMLElement} element */
  listen(element) {
    /** @type {Map<number, PointerEvent>} */
    const pointers = new Map();
    element.onpointerdown = (event) => {
      element.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, event);
    };
    element.onpointerup = element.onpointercancel = ({ pointerId }) => pointers.delete(pointerId);
    element.onpointermove = (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const dx = event.clientX - before.clientX, dy = event.clientY - before.clientY;
      const share = 1 / element.clientHeight / pointers.size;
      const other = [...pointers.values()].find(({ pointerId }) => pointerId !== event.pointerId);
      if (other) {
        const [was, is] = [before, event].map((each) =>
          Math.max(1, Math.hypot(each.clientX - other.clientX, each.clientY - other.clientY)));
        this.zoom(was / is);
      }
      if (other || event.shiftKey || event.buttons & 6) this.pan(share * dx, share * dy);
      else this.orbit(dx, dy);
      pointers.set(event.pointerId, event);
    };
    element.oncontextmenu = (event) => event.preventDefault();
    element.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(0.0012 * Math.max(-400, Math.min(400, event.deltaY))));
    }, { passive: false });
    const move = (/** @type {number} */ x, /** @type {number} */ y) => (/** @type {boolean} */ isShifted) =>
      isShifted ? this.pan(0.05 * x, 0.05 * y) : this.orbit(18 * x, 14 * y);
    const [nearer, home] = [() => this.zoom(0.88), () => this.home()];
    /** @type {Record<string, (isShifted: boolean) => void>} */
    const keys = {
      ArrowLeft: move(1, 0), ArrowRight: move(-1, 0), ArrowUp: move(0, 1), ArrowDown: move(0, -1),
      "+": nearer, "=": nearer, "-": () => this.zoom(1.14), 0: home, Home: home,
    };
    element.onkeydown = (event) => {
      if (!(event.key in keys)) return;
      keys[event.key](event.shiftKey);
      event.preventDefault();
    };
  }
}
