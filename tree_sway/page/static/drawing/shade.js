// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/**
 * Shade within a crown, found once at rest: how open each place is to the sky, and towards where. The
 * light weakens by the leaf area on its way, exp(-A / 2) for leaves in every direction.
 */

const CELLS = 14;
/** Of the light that a leaf stops; it lets some through. */
const EXTINCTION = 0.3;

/**
 * @typedef {object} Shade
 * @property {number} open share of the light of all directions that arrives, 0 to 1
 * @property {number[]} towards where most of it comes from, shorter than 1
 */

/** @param {number[][]} places of leaves [m] @param {number[]} areas of theirs [m^2]
 * @param {number[]} low corner of the box of the tree @param {number[]} high
 * @returns {(place: ArrayLike<number>) => Shade} */
export function crownShade(places, areas, low, high) {
  if (!places.length) return () => ({ open: 1, towards: [0, 0, 0] });
  const size = low.map((l, c) => Math.max(high[c] - l, 0.1) * 1.02);
  const step = size.map((s) => s / CELLS);
  const cellOf = (/** @type {ArrayLike<number>} */ p) => [0, 1, 2].map((c) =>
    Math.min(CELLS - 1, Math.max(0, Math.floor((p[c] - low[c]) / step[c]))));
  const index = (/** @type {number[]} */ [i, j, k]) => i + CELLS * (j + CELLS * k);
  const density = new Float32Array(CELLS ** 3);
  const volume = step[0] * step[1] * step[2];
  places.forEach((place, i) => (density[index(cellOf(place))] += areas[i] / volume));
  /** @type {number[][]} */
  const ways = [];
  for (let i = 0; i < 16; i++) {
    // Most of the sky is above; what comes from below is light off the ground.
    const z = 1 - (1.45 * (i + 0.5)) / 16;
    const turn = 2.399963 * i;
    const flat = Math.sqrt(1 - z * z);
    ways.push([flat * Math.cos(turn), flat * Math.sin(turn), z]);
  }
  const stride = Math.min(...step);
  /** @type {(Shade | null)[]} */
  const found = new Array(CELLS ** 3).fill(null);
  const shadeAt = (/** @type {number[]} */ cell) => {
    const sum = [0, 0, 0];
    let open = 0;
    for (const way of ways) {
      const at = cell.map((i, c) => low[c] + (i + 0.5) * step[c]);
      let passed = 0.35 * density[index(cell)] * stride;
      for (;;) {
        let isOut = false;
        for (let c = 0; c < 3; c++) {
          at[c] += stride * way[c];
          isOut ||= at[c] < low[c] || at[c] > low[c] + size[c];
        }
        if (isOut) break;
        passed += density[index(cellOf(at))] * stride;
      }
      const light = Math.exp(-EXTINCTION * passed);
      open += light / ways.length;
      for (let c = 0; c < 3; c++) sum[c] += (2 * light * (way[c] - (c === 2 ? 0.27 : 0))) / ways.length;
    }
    return { open, towards: sum };
  };
  return (place) => {
    const cell = cellOf(place);
    return (found[index(cell)] ??= shadeAt(cell));
  };
}
