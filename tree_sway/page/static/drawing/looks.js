// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Look of a kind: colours come with its description, outlines of leaves from looks.json. */

import { LOOKS } from "../checks.js";

/** Look of an average broadleaf; outlines of leaves; and, by pattern of the bark, the colour and height (over that of the
 * tree) of a different bark at the foot; brightness of the ground of each pattern and its marks (number,
 * raggedness, then least and range of light, half width and half height [px]); colours of the flowers in a candle; place along the stalk, angle and size of leaflets; corners of a
 * picture, along and across from its middle, and of a triangle of the same area that shows most of it; and numbers that
 * the modules explain which take them.
 * @type {{average: Look, outlines: Record<string, number[][]>, feet: Record<string, {color: number[], height: number}>,
 * barks: Record<string, {ground: number, marks: any[][]}>, places: Record<string, number[][]>,
 * shapes: Record<"square" | "triangle", number[][]>, numbers: Record<string, any>}} */
export const { average, outlines, shapes, feet, barks, places, numbers } = LOOKS;

/** Outline of a leaf from stalk to tip, an oval one for unknown forms. @param {Look} look */
export const outlineOf = ({ form }) => outlines[form] ?? outlines.ovate;

/** The look of a kind; that of an average broadleaf where its description has none. @param {Kind} kind */
export const lookOf = (kind) => kind.look ?? average;

/** Whether twigs hang: those of a plant in a pot are soft. @param {Look} look */
export const hangs = ({ droop = 0, is_potted: isPotted }) => droop > (isPotted ? 0.3 : 0.5);

/** Random numbers from 0 to 1, the same on every page. */
export function seeded(state = 12345) {
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) | 0;
    return (state >>> 8) / 16777216;
  };
}
