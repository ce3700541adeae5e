// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Shade within a crown, computed once at rest: how open each place is to the sky, and in which direction. Light is
 * attenuated by the leaf area on its path (Beer's law). */

/** Cells along each side of the crown's box and of a rim of one cell about it, into which leaves reach beyond the wood: those
 * at the top would else be in the shade of each other. */
const CELLS = 16;
/** Attenuation per leaf area: 1/2 for opaque leaves in all directions, less as they let some light through. */
const EXTINCTION = 0.24;
/** Directions of light: mostly from the sky, some from the ground. */
const WAYS = Array.from({ length: 16 }, (_, i) => {
  const z = 1 - (1.45 * (i + 0.5)) / 16;
  const flat = Math.sqrt(1 - z * z);
  return [flat * Math.cos(2.399963 * i), flat * Math.sin(2.399963 * i), z];
});

/** Make a function from places to their shade. @param {number[][]} places of leaves [m]
 * @param {number[]} areas of theirs [m^2] @param {number[]} low corner of the box of the tree @param {number[]} high
 * @returns {(place: ArrayLike<number>) => Shade} */
export function crownShade(places, areas, low, high) {
  if (!places.length) return () => ({ open: 1, towards: [0, 0, 0] });
  const step = low.map((l, c) => (Math.max(high[c] - l, 0.1) * 1.02) / (CELLS - 2));
  const stride = Math.min(...step);
  const cellOf = (/** @type {ArrayLike<number>} */ p) => [0, 1, 2].map((c) => Math.floor((p[c] - low[c]) / step[c] + 1));
  const inside = (/** @type {number[]} */ cell) => cell.map((i) => Math.min(CELLS - 1, Math.max(0, i)));
  const index = (/** @type {number[]} */ [i, j, k]) => i + CELLS * (j + CELLS * k);
  const density = new Float32Array(CELLS ** 3);
  places.forEach((place, i) => (density[index(inside(cellOf(place)))] += areas[i] / (step[0] * step[1] * step[2])));
  const found = /** @type {Map<number, Shade>} */ (new Map());
  const shadeAt = (/** @type {number[]} */ cell) => {
    const towards = [0, 0, 0];
    let open = 0;
    for (const way of WAYS) {
      let passed = 0.35 * density[index(cell)] * stride;
      const middle = cell.map((i, c) => low[c] + (i - 0.5) * step[c]);
      for (let far = stride; ; far += stride) {
        const next = cellOf(middle.map((each, c) => each + far * way[c]));
        if (next.some((i) => i < 0 || i >= CELLS)) break;
        passed += density[index(next)] * stride;
      }
      const light = Math.exp(-EXTINCTION * passed) / WAYS.length;
      open += light;
      way.forEach((each, c) => (towards[c] += 6 * light * (each - (c === 2 ? 0.27 : 0))));
    }
    return { open, towards };
  };
  return (place) => {
    const cell = inside(cellOf(place));
    const known = found.get(index(cell)) ?? shadeAt(cell);
    found.set(index(cell), known);
    return known;
  };
}
