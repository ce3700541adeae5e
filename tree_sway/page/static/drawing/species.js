// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** How each species looks: the colour and pattern of its bark, the shape and size of its leaves. */

import { textOf } from "../files.js";

/** @type {Looks} */
const looks = JSON.parse(await textOf("species.json"));
export const { broadleaf, conifer, broadleaves, conifers, patterns, outlines } = looks;

/** The look of a species, or of an average broadleaf. @param {string} species @returns {Look} */
export function lookOf(species) {
  const group = hasNeedles(species) ? conifer : {};
  return { ...broadleaf, ...group, ...(conifers[species] ?? broadleaves[species]) };
}

/** @param {string} species */
export const hasNeedles = (species) => species in conifers;

/** Numbers from 0 to 1 that are the same on every page. */
export function seeded(state = 12345) {
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) | 0;
    return (state >>> 8) / 16777216;
  };
}
