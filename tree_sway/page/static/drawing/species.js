// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** How each species looks: the colour and pattern of its bark, the shape and size of its leaves. */

import { textOf } from "../files.js";

/**
 * @typedef {"ovate" | "pointed" | "lobed" | "palmate" | "compound" | "needles" | "tufts" | "fronds"} LeafForm
 *
 * @typedef {object} Look
 * @property {number[]} bark colour, red, green and blue from 0 to 1
 * @property {"furrows" | "plates" | "smooth" | "dashes" | "flakes"} pattern of the bark
 * @property {number[]} twig
 * @property {LeafForm} form of a leaf
 * @property {number} size of a leaf or a leaflet, or of a shoot with its needles [m]
 * @property {number} slender width of a leaf over its length
 * @property {number[]} leaf
 * @property {number[]} fresh colour of a leaf with the sun behind it
 * @property {number[] | null} autumn colour of a leaf before it falls; null of an evergreen
 */

/**
 * The average broadleaf whole; what is other of the average conifer, and of each species than of its
 * group.
 * @type {{broadleaf: Look, conifer: Partial<Look>, broadleaves: Record<string, Partial<Look>>,
 * conifers: Record<string, Partial<Look>>}}
 */
const { broadleaf, conifer, broadleaves, conifers } = JSON.parse(await textOf("species.json"));

/** The look of a species; that of an average broadleaf where it is unknown.
 * @param {string} species @returns {Look} */
export function lookOf(species) {
  const group = hasNeedles(species) ? conifer : {};
  return { ...broadleaf, ...group, ...(conifers[species] ?? broadleaves[species]) };
}

/** @param {string} species */
export function hasNeedles(species) {
  return species in conifers;
}

/** @param {string} species */
export function isPotted(species) {
  return species === "benjamina" || species === "goldcrest";
}

/** Numbers from 0 to 1 that are the same on every page. */
export function seeded(state = 12345) {
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) | 0;
    return (state >>> 8) / 16777216;
  };
}
