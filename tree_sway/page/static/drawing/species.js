// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** How each species looks: the colour and pattern of its bark, the shape and size of its leaves. */

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

/** @type {Look} */
const BROADLEAF = {
  bark: [0.42, 0.35, 0.28],
  pattern: "furrows",
  twig: [0.34, 0.28, 0.2],
  form: "ovate",
  size: 0.07,
  slender: 0.5,
  leaf: [0.24, 0.39, 0.12],
  fresh: [0.46, 0.58, 0.2],
  autumn: [0.72, 0.5, 0.13],
};

/** @type {Look} */
const CONIFER = {
  ...BROADLEAF,
  bark: [0.4, 0.31, 0.25],
  pattern: "flakes",
  form: "needles",
  size: 0.08,
  leaf: [0.16, 0.3, 0.16],
  fresh: [0.34, 0.48, 0.2],
  autumn: null,
};

/**
 * @type {Record<string, Partial<Look>>} what is other than of an average broadleaf; of conifers, below,
 * than of an average conifer
 */
const BROADLEAVES = {
  benjamina: { bark: [0.56, 0.5, 0.42], pattern: "smooth", form: "pointed", size: 0.05, slender: 0.46,
    leaf: [0.15, 0.34, 0.12], fresh: [0.36, 0.56, 0.2], autumn: null },
  birch: { bark: [0.87, 0.86, 0.82], pattern: "dashes", twig: [0.33, 0.22, 0.19], form: "pointed",
    size: 0.045, slender: 0.72, leaf: [0.32, 0.47, 0.15], fresh: [0.56, 0.66, 0.24], autumn: [0.86, 0.68, 0.16] },
  oak: { bark: [0.38, 0.33, 0.28], form: "lobed", size: 0.09, slender: 0.55, autumn: [0.6, 0.4, 0.15] },
  beech: { bark: [0.56, 0.56, 0.53], pattern: "smooth", size: 0.065, slender: 0.62,
    leaf: [0.2, 0.38, 0.12], autumn: [0.7, 0.42, 0.14] },
  ash: { bark: [0.52, 0.5, 0.44], form: "compound", size: 0.06, slender: 0.3, leaf: [0.27, 0.44, 0.16],
    autumn: [0.78, 0.68, 0.24] },
  sycamore: { bark: [0.5, 0.46, 0.41], pattern: "flakes", form: "palmate", size: 0.13, slender: 1,
    leaf: [0.2, 0.36, 0.11], autumn: [0.72, 0.52, 0.16] },
  walnut: { bark: [0.47, 0.44, 0.4], form: "compound", size: 0.1, slender: 0.42, leaf: [0.3, 0.44, 0.14],
    autumn: [0.74, 0.62, 0.16] },
  maple: { bark: [0.44, 0.4, 0.35], form: "palmate", size: 0.11, slender: 1, leaf: [0.25, 0.41, 0.13],
    autumn: [0.82, 0.5, 0.13] },
  plane: { bark: [0.68, 0.66, 0.52], pattern: "flakes", form: "palmate", size: 0.16, slender: 1,
    leaf: [0.28, 0.42, 0.16] },
  lime: { size: 0.08, form: "pointed", slender: 0.85, leaf: [0.28, 0.44, 0.16] },
  willow: { form: "pointed", size: 0.06, slender: 0.2, leaf: [0.36, 0.47, 0.25], fresh: [0.56, 0.66, 0.36],
    autumn: [0.78, 0.7, 0.26] },
  poplar: { bark: [0.5, 0.48, 0.43], form: "pointed", slender: 0.8, leaf: [0.3, 0.45, 0.18] },
  alder: { bark: [0.36, 0.33, 0.3], slender: 0.8, leaf: [0.18, 0.34, 0.13] },
  cherry: { bark: [0.44, 0.29, 0.26], pattern: "dashes", form: "pointed" },
  eucalyptus: { bark: [0.72, 0.66, 0.58], pattern: "flakes", form: "pointed", slender: 0.22,
    leaf: [0.34, 0.43, 0.3], fresh: [0.5, 0.58, 0.4], autumn: null },
};

/** @type {Record<string, Partial<Look>>} */
const CONIFERS = {
  conifer: {},
  goldcrest: { bark: [0.45, 0.31, 0.22], form: "fronds", size: 0.03, twig: [0.46, 0.42, 0.17],
    leaf: [0.46, 0.55, 0.12], fresh: [0.74, 0.74, 0.2] },
  spruce: {},
  sitka: { bark: [0.43, 0.38, 0.37], leaf: [0.17, 0.31, 0.22] },
  douglas_fir: { bark: [0.37, 0.29, 0.24], pattern: "furrows", leaf: [0.18, 0.32, 0.15] },
  pine: { bark: [0.62, 0.4, 0.26], pattern: "plates", form: "tufts", size: 0.12,
    leaf: [0.2, 0.33, 0.19], fresh: [0.34, 0.46, 0.22] },
  fir: { bark: [0.55, 0.53, 0.5], pattern: "smooth", leaf: [0.14, 0.3, 0.2] },
  larch: { bark: [0.5, 0.36, 0.29], pattern: "plates", leaf: [0.33, 0.46, 0.2], fresh: [0.5, 0.62, 0.28],
    autumn: [0.8, 0.6, 0.2] },
};

/** The look of a species; that of an average broadleaf where it is unknown.
 * @param {string} species @returns {Look} */
export function lookOf(species) {
  const conifer = CONIFERS[species];
  return conifer ? { ...CONIFER, ...conifer } : { ...BROADLEAF, ...BROADLEAVES[species] };
}

/** @param {string} species */
export function hasNeedles(species) {
  return species in CONIFERS;
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
