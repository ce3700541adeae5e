// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Follows points of a picture through later ones (Lucas & Kanade 1981, coarse to fine as Bouguet 2001). Each is sought from
 * the picture in which it was found, so that nothing drifts, and counts as seen if the way back ends where it began. How
 * bright a window is does not count, as cameras change that by themselves. A picture takes no new memory. */

/** Half of a window, and its width with a border for slopes [px]. */
const HALF = 6;
const WIDE = 2 * HALF + 3;
/** Points of a window in its rows with the border. */
const INNER = Int32Array.from({ length: (WIDE - 2) ** 2 }, (_, k) =>
  (Math.floor(k / (WIDE - 2)) + 1) * WIDE + (k % (WIDE - 2)) + 1);
/** Number of sizes of a picture, each half of the one before. */
const LEVELS = 3;
/** Most steps towards a place, and length of a last one [px]. */
const ROUNDS = 10, LAST = 0.02;
/** How far from its begin a point may come back [px]. */
const RETURNED = 0.7;
/** Least mean square of the slopes of a corner, along any way. */
const FLAT = 2;
const MOST_POINTS = 40;

const [still, moved, across, down] = Array.from({ length: 4 }, () => new Float32Array(WIDE * WIDE));
/** Sums over a window: squares of slopes along x, products with those along y, squares along y. */
let xx = 0, xy = 0, yy = 0;
/** Place that is sought, and where its way back ends. */
const place = new Float64Array(2), back = new Float64Array(2);

/** @typedef {{wide: number, high: number, grey: Float32Array}} Level a picture in one size */

/** Write a picture in each size: its green, which is near to its brightness. @param {Level[]} levels
 * @param {ArrayLike<number>} pixels red, green, blue and opacity of each */
function take(levels, pixels) {
  levels.forEach(({ wide, high, grey }, k) => {
    const { wide: row, grey: fine } = levels[Math.max(k - 1, 0)];
    for (let y = 0, to = 0; y < high; y++) {
      for (let x = 0, at = 2 * y * row; x < wide; x++, to++, at += 2) {
        grey[to] = k ? 0.25 * (fine[at] + fine[at + 1] + fine[at + row] + fine[at + row + 1]) : pixels[4 * to + 1];
      }
    }
  });
}

/** Write the window about a place between pixels; false where it is not within the picture. @param {Level} level
 * @param {number} x @param {number} y @param {Float32Array} out */
function cut({ wide, high, grey }, x, y, out) {
  const left = Math.floor(x), top = Math.floor(y), u = x - left, v = y - top;
  if (!(left > HALF && top > HALF && left + HALF + 2 < wide && top + HALF + 2 < high)) return false;
  for (let to = 0, at = (top - HALF - 1) * wide + left - HALF - 1; to < out.length; at += wide - WIDE) {
    for (const end = to + WIDE; to < end; to++, at++) {
      const upper = grey[at] + u * (grey[at + 1] - grey[at]);
      out[to] = upper + v * (grey[at + wide] + u * (grey[at + wide + 1] - grey[at + wide]) - upper);
    }
  }
  return true;
}

/** Find the slopes in the window about a place, less their means. @param {Level} level @param {number} x @param {number} y
 * @returns {number} mean square of them along the way that has the least; 0 beyond the picture */
function slopes(level, x, y) {
  if (!cut(level, x, y, still)) return 0;
  let meanAcross = 0, meanDown = 0;
  for (const at of INNER) {
    meanAcross += (across[at] = (still[at + 1] - still[at - 1]) / 2) / INNER.length;
    meanDown += (down[at] = (still[at + WIDE] - still[at - WIDE]) / 2) / INNER.length;
  }
  xx = xy = yy = 0;
  for (const at of INNER) {
    const a = (across[at] -= meanAcross), b = (down[at] -= meanDown);
    xx += a * a;
    xy += a * b;
    yy += b * b;
  }
  return (xx + yy - Math.hypot(xx - yy, 2 * xy)) / (2 * INNER.length);
}

/** Find where a place of a picture is in another. @param {Level[]} from @param {Level[]} to @param {number} x @param {number} y
 * @param {Float64Array} at where to begin, and where it is then @returns {boolean} whether it is found */
function seek(from, to, x, y, at) {
  for (let k = LEVELS - 1; k >= 0; k--) {
    const size = 2 ** -k, shift = (size - 1) / 2;
    if (slopes(from[k], size * x + shift, size * y + shift) < FLAT) {
      // Near an edge the coarse windows are beyond it.
      if (k) continue;
      return false;
    }
    const area = xx * yy - xy * xy;
    let u = size * at[0] + shift, v = size * at[1] + shift;
    for (let round = 0, step = 1; round < ROUNDS && step > LAST; round++) {
      if (!cut(to[k], u, v, moved)) return false;
      let p = 0, q = 0;
      for (const each of INNER) {
        p += across[each] * (still[each] - moved[each]);
        q += down[each] * (still[each] - moved[each]);
      }
      const right = (yy * p - xy * q) / area, low = (xx * q - xy * p) / area;
      u += right;
      v += low;
      step = Math.hypot(right, low);
    }
    at[0] = (u - shift) / size;
    at[1] = (v - shift) / size;
  }
  return true;
}

/** Points that are followed. */
export class OpticalFlow {
  /** @param {number} width of the pictures @param {number} height @param {ArrayLike<number>} pixels of the first
   * @param {number[][]} places where points may be, of which the best corners are taken */
  constructor(width, height, pixels, places) {
    const sizes = () => Array.from({ length: LEVELS }, (_, k) =>
      ({ wide: width >> k, high: height >> k, grey: new Float32Array((width >> k) * (height >> k)) }));
    this._first = sizes();
    this._now = sizes();
    take(this._first, pixels);
    const corners = places.map(([x, y]) => ({ at: [x, y], size: slopes(this._first[0], x, y) }))
      .filter(({ size }) => size >= FLAT).sort((one, other) => other.size - one.size);
    this._found = Float64Array.from(corners.slice(0, MOST_POINTS).flatMap(({ at }) => at));
    /** Where each is, x and y [px]; not a number where it is lost. */
    this.points = this._found.slice();
  }

  /** Take the next picture. @param {ArrayLike<number>} pixels @returns {number} share of the points that are seen */
  follow(pixels) {
    const { _first: first, _now: now, _found: found, points } = this;
    let count = 0;
    take(now, pixels);
    for (let i = 0; i < found.length; i += 2) {
      // A lost point is sought where it was found.
      for (let c = 0; c < 2; c++) [back[c], place[c]] = [found[i + c], points[i + c] || found[i + c]];
      const isSeen = seek(first, now, found[i], found[i + 1], place) && seek(now, first, place[0], place[1], back)
        && Math.hypot(back[0] - found[i], back[1] - found[i + 1]) < RETURNED;
      for (let c = 0; c < 2; c++) points[i + c] = isSeen ? place[c] : NaN;
      count += Number(isSeen);
    }
    return count / Math.max(found.length / 2, 1);
  }
}
