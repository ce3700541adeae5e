// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Quaternions x y z w inside arrays, each from an index on. */

/** Product of two, first b, then a. @param {Numbers} a @param {number} i @param {Numbers} b
 * @param {number} j @param {Numbers} out */
export function multiply(a, i, b, j, out) {
  const ax = a[i], ay = a[i + 1], az = a[i + 2], aw = a[i + 3];
  const bx = b[j], by = b[j + 1], bz = b[j + 2], bw = b[j + 3];
  out[0] = aw * bx + ax * bw + ay * bz - az * by;
  out[1] = aw * by - ax * bz + ay * bw + az * bx;
  out[2] = aw * bz + ax * by - ay * bx + az * bw;
  out[3] = aw * bw - ax * bx - ay * by - az * bz;
}

/** A vector turned by a quaternion. @param {Numbers} q @param {Numbers} v @param {number} [i] of q */
export function turned(q, v, i = 0) {
  const qx = q[i], qy = q[i + 1], qz = q[i + 2], qw = q[i + 3];
  const x = v[0], y = v[1], z = v[2];
  const tx = 2 * (qy * z - qz * y);
  const ty = 2 * (qz * x - qx * z);
  const tz = 2 * (qx * y - qy * x);
  return [x + qw * tx + qy * tz - qz * ty, y + qw * ty + qz * tx - qx * tz, z + qw * tz + qx * ty - qy * tx];
}

/** How far two points are from each other. @param {Numbers} a @param {Numbers} b */
export const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

/** The turn from one to another, in the frame of the first. @param {Numbers} a @param {number} i
 * @param {Numbers} b @param {number} j */
export function between(a, i, b, j) {
  const out = [0, 0, 0, 1];
  multiply([-a[i], -a[i + 1], -a[i + 2], a[i + 3]], 0, b, j, out);
  return out;
}
