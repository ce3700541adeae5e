// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** How species look: as the description of a kind says; the outlines of leaves here. */

import { LOOKS } from "../checks.js";

/** The look of an average broadleaf, outlines of leaves, and stems with another bark at their foot: its
 * colour, and up to which share of the height, by the pattern of the bark.
 * @type {{average: Look, outlines: Record<string, number[][]>, feet: Record<string, {color: number[], height: number}>}} */
export const { average, outlines, feet } = LOOKS;

/** The outline of a leaf from its stalk to its tip, an oval one if its form is none. @param {Look} look */
export const outlineOf = ({ form }) => outlines[form] ?? outlines.ovate;

/** The look of a kind; that of an average broadleaf where its description has none. @param {Kind} kind */
export const lookOf = (kind) => kind.look ?? average;

/** Numbers from 0 to 1 that are the same on every page. */
export function seeded(state = 12345) {
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) | 0;
    return (state >>> 8) / 16777216;
  };
}
