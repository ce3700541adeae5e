// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The programs of shaders.glsl, and the numbers that they share with what feeds them. */

import { textOf } from "../files.js";
import { program } from "./gl.js";

export const TEXTURE_WIDTH = 1024;
/** Directions that an impostor is baked from: round the tree, and elevations [rad]. */
export const ROUND = 8;
export const ELEVATIONS = [0.08, 0.5];

const HEAD = `#version 300 es
#define ROUND ${ROUND}
#define LOW ${ELEVATIONS[0]}
#define HIGH ${ELEVATIONS[1]}
`;

const parts = (await textOf("drawing/shaders.glsl")).split("\n#part ").slice(1).map((part) => {
  const [names, ...lines] = part.split("\n");
  const [name, base] = names.split(" ");
  return { name, base, text: lines.join("\n") };
});

/** A part after those that it builds on. @param {string | undefined} wanted @returns {string} */
function source(wanted) {
  const part = parts.find(({ name }) => name === wanted);
  return part ? source(part.base) + part.text : "";
}

/** A program by its name. @param {WebGL2RenderingContext} gl @param {string} name */
export function shaded(gl, name) {
  return program(gl, HEAD + source(`${name}.vertex`), HEAD + source(`${name}.fragment`));
}
