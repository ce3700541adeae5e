// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Pictures of far trees: each kind is painted once from several sides, then drawn as a picture that leans. */

import { AT_ORIGIN, placed, STRIDE } from "../placing.js";
import { canvasTexture, discard, drawable, drawPart, ELEVATIONS, ROUND, use } from "./gl.js";

/** Numbers per vertex. */
const PER_VERTEX = 13;
/** Alpha from which on a point of the picture is drawn, 0 to 255. */
const SEEN = 0.15 * 255;
/** Slopes of the sides of the trapezium about a tree that are tried. */
const SLOPES = [-0.9, -0.6, -0.3, 0, 0.3, 0.6, 0.9];

export class Impostor {
  count = 0;
  _corners = [[-1, -1], [1, -1], [-1, 1], [1, 1]];

  /** @param {GL} gl @param {Program} used @param {Shape} shape @param {number} most
   * number of trees @param {boolean} isPlain whether to read the nearest point only, which costs less
   * @param {number} tile width of a picture [px] */
  constructor(gl, used, shape, most, isPlain, tile) {
    const { kind, low, high, rest, highest } = shape;
    const leaf = Math.max(0, ...(kind.arrays.leaf_size ?? []));
    const tall = high[2] + 0.7 * leaf;
    this.gl = gl;
    this._tile = tile;
    /** Half width, height of the middle over the root, height [m]. */
    this.box = { wide: leaf + Math.max(...[0, 1].map((c) => Math.max(-low[c], high[c]))), middle: 0.5 * tall, tall };
    /** Highest node at rest, and its displacement per unit of each coordinate. */
    this.tip = Array.from(rest.subarray(STRIDE * highest, STRIDE * highest + 3));
    this._moves = movesOf(shape, this.tip);
    this._atlas = canvasTexture(gl, ROUND * tile, ELEVATIONS.length * tile, gl.RGBA8, true);
    if (isPlain) gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    this._values = new Float32Array(4 * PER_VERTEX * most);
    const indices = Array.from({ length: most }, (_, i) => [0, 1, 2, 1, 3, 2].map((corner) => 4 * i + corner)).flat();
    // Not as instances, each of which costs as much as a picture without a graphics unit.
    this._part = drawable(gl, used, { values: this._values, indices });
  }

  /** Paint the kind from every side. @param {(camera: Float32Array, eye: number[]) => void} paint
   * @param {number[]} color of its leaves, for the edges */
  bake(paint, color) {
    const { gl, _tile: tile } = this;
    const { wide, middle, tall } = this.box;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this._atlas.target);
    gl.clearColor(0.6 * color[0], 0.6 * color[1], 0.6 * color[2], 0);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    ELEVATIONS.forEach((elevation, row) => {
      const ce = Math.cos(elevation), se = Math.sin(elevation);
      const high = 0.5 * tall * ce + wide * se;
      const deep = wide + tall;
      for (let side = 0; side < ROUND; side++) {
        const [c, s] = [Math.cos, Math.sin].map((of) => of((2 * Math.PI * side) / ROUND));
        const axes = [[-s / wide, c / wide, 0], [(-se * c) / high, (-se * s) / high, ce / high],
          [(-ce * c) / deep, (-ce * s) / deep, -se / deep]];
        const camera = [0, 1, 2].flatMap((k) => [...axes.map((axis) => axis[k]), 0]);
        camera.push(...axes.map((axis) => -axis[2] * middle), 1);
        gl.viewport(side * tile, row * tile, tile, tile);
        paint(Float32Array.from(camera), [100 * deep * ce * c, 100 * deep * ce * s, middle + 100 * deep * se]);
      }
    });
    const points = new Uint8Array(4 * ROUND * tile * ELEVATIONS.length * tile);
    gl.readPixels(0, 0, ROUND * tile, ELEVATIONS.length * tile, gl.RGBA, gl.UNSIGNED_BYTE, points);
    this._corners = cornersAbout(points, tile);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** Add a tree to draw. @param {number[]} place @param {number} row of its top @param {number} number
   * @param {number[]} paint its colour and opacity */
  add(place, row, number, paint) {
    const tint = (row < 0 ? 0.55 : 0.86) + 0.28 * ((number * 0.618034) % 1);
    const corners = this._corners.flatMap((at) => [...at, ...place, row, tint, ...paint]);
    this._values.set(corners, 4 * PER_VERTEX * this.count++);
  }

  upload() {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this._part.buffers[0]);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, this._values, 0, 4 * PER_VERTEX * this.count);
  }

  /** Place the top of a far tree, linear in its coordinates. @param {ArrayLike<number>} coordinates
   * @param {number} from its first @param {number[]} place @param {Float32Array} poses @param {number} row */
  place(coordinates, from, place, poses, row) {
    const at = this.tip.slice();
    for (let k = from, i = 0; i < this._moves.length; k++) {
      for (let c = 0; c < 3; c++) at[c] += coordinates[k] * this._moves[i++];
    }
    poses.set(placed(place, at), STRIDE * row);
  }

  /** @param {Program} used @param {number} shade of the foot of a tree among others */
  draw(used, shade) {
    const { gl, box, tip } = this;
    const picture = [2, this._atlas.texture];
    use(gl, used, { picture, box: [box.wide, box.middle, box.tall, shade], restTip: tip });
    drawPart(gl, this._part, (6 * this.count) / this._part.count);
  }

  free() {
    this._atlas.release();
    discard(this.gl, this._part);
  }
}

/** The smallest trapezium that contains the tree in all pictures, so that little of the empty rest is drawn.
 * @param {Uint8Array} points of the pictures of all sides @param {number} tile their width
 * @returns {number[][]} its corners, -1 to 1 */
export function cornersAbout(points, tile) {
  const widest = new Float32Array(tile);
  for (let i = 3; i < points.length; i += 4) {
    if (points[i] < SEEN) continue;
    const x = (i >> 2) % tile, y = Math.floor((i >> 2) / (ROUND * tile)) % tile;
    widest[y] = Math.max(widest[y], Math.abs((2 * x + 1) / tile - 1) + 1 / tile);
  }
  const rows = Array.from(widest, (wide, y) => ({ wide, y: (2 * y + 1) / tile - 1 })).filter(({ wide }) => wide);
  if (!rows.length) return [[-1, -1], [1, -1], [-1, 1], [1, 1]];
  const low = rows[0].y - 1 / tile, high = rows[rows.length - 1].y + 1 / tile;
  const fits = SLOPES.map((slope) => {
    const middle = Math.max(...rows.map(({ wide, y }) => wide - slope * y));
    return { slope, middle, area: middle + 0.5 * slope * (low + high) };
  }).filter(({ slope, middle }) => !slope || Math.max(middle + slope * low, middle + slope * high) <= 1);
  const { slope, middle } = fits.reduce((best, each) => (each.area < best.area ? each : best));
  return [low, high].flatMap((y) => [-1, 1].map((side) => [side * (middle + slope * y), y]));
}

/** Displacement of the top per unit of each coordinate, three numbers each. @param {Shape} shape @param {number[]} tip */
function movesOf({ kind, placer, highest }, tip) {
  const row = STRIDE * placer.slots[highest];
  const branches = placer.reached.findIndex((reached) => reached > placer.slots[highest]);
  const poses = new Float32Array(STRIDE * placer.reached[branches]);
  const moved = new Float32Array(kind.nCoordinates);
  return Array.from(kind.arrays.basis_scale).flatMap((scale, k) => {
    moved.fill(0)[k] = 0.5 * scale;
    placer.place(moved, 0, AT_ORIGIN, branches, poses, 0);
    return tip.map((each, c) => (poses[row + c] - each) / (0.5 * scale));
  });
}
