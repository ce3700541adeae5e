// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** What a description must hold before it is used, as tree_sway/page/check_description.py asks. */

import { textOf } from "./files.js";

/** What cannot be read; its message is for people. */
export class ProtocolError extends Error {}

const MOST_SEGMENTS = 500000;
const MOST_POSES = 10000000;
const MOST_COORDINATES = 65535;
/** Of a height or an error [m]. */
const GREATEST = 1e12;

export const TYPES = { f32: Float32Array, i32: Int32Array, i16: Int16Array, u8: Uint8Array };

/** Type and axes of each array of a kind; those of leaves only where it bears any.
 * @type {{description: Forms, tables: Forms}} */
export const FORMS = JSON.parse(await textOf("arrays.json"));

const BY_BRANCH = ["branch_parent", "branch_base_segment", "branch_coordinate", "branch_keys", "branch_base_turn",
  "branch_turn"];

/** Refuse what does not hold. @param {boolean} holds @param {string} name */
export function need(holds, name) {
  if (!holds) throw new ProtocolError(`${name} does not fit the rest, or is not finite`);
}

/** @param {unknown} value */
const isFinite = (value) => typeof value === "number" && Math.abs(value) < GREATEST;

/** Sizes of the axes of arrays, which have their forms. @param {Arrays} parts @param {Forms} forms */
export function sizesOf(parts, forms) {
  const size = /** @type {Record<string, number>} */ ({});
  for (const [name, [type, ...axes]] of Object.entries(forms)) {
    const { values, shape } = parts[name] ?? {};
    need(values?.constructor === TYPES[type] && shape.length === axes.length, name);
    axes.forEach((axis, i) => {
      if (typeof axis === "string") size[axis] ??= shape[i];
      need(shape[i] === (typeof axis === "string" ? size[axis] : axis), name);
    });
    need(values.every(Number.isFinite), name);
  }
  return size;
}

/** A kind with its arrays and its sizes; one whose arrays do not fit each other is refused.
 * @param {Kind} kind as its header has it @param {Arrays} parts its arrays @returns {Kind} */
export function checkedKind(kind, parts) {
  const named = Object.entries(parts).map(([name, { values }]) => [name, values]);
  const arrays = /** @type {Kind["arrays"]} */ (Object.fromEntries(named));
  const forms = Object.entries(FORMS.description).filter(([name]) => arrays.leaf_segment || !name.startsWith("leaf"));
  const size = sizesOf(parts, Object.fromEntries(forms));
  const { branches: b, segments: n, keys: nKeys, coordinates, rows } = size;
  need(b > 0 && size["branches + 1"] === b + 1, "branch_first");
  need(arrays.basis_scale.every((value) => value > 0), "basis_scale");
  need(typeof kind.species === "string" && typeof kind.model === "string", "species");
  need([kind.height, kind.basis_error, kind.modulus ?? 0].every(isFinite), "height");
  const names = kind.branch_names;
  need(names.length === b && names.every((name) => typeof name === "string"), "branch_names");
  const first = arrays.branch_first;
  need(first[0] === 0 && first[b] === n, "branch_first");
  for (let i = 0; i < b; i++) {
    const [parent, under, key, keys, base, turn] = BY_BRANCH.map((name) => arrays[name][i]);
    const count = first[i + 1] - first[i];
    const holds = [
      i ? parent >= 0 && parent < i : parent === -1,
      i ? under >= first[parent] && under < first[parent + 1] : under === -1,
      key >= 0 && key + keys <= nKeys,
      keys >= 2,
      i ? base >= 0 && base + arrays.branch_keys[parent] <= rows : base === -1,
      turn === -1 ? keys <= 2 : turn >= 0 && turn + count * keys <= rows,
    ];
    need(count > 0, `branch_first[${i}]`);
    need(!holds.includes(false), `${BY_BRANCH[holds.indexOf(false)]}[${i}]`);
  }
  need(arrays.leaf_segment?.every((at) => at >= 0 && at < n) ?? true, "leaf_segment");
  return { ...kind, arrays, nBranches: b, nSegments: n, nCoordinates: coordinates, nKeys };
}

/** Refuse trees that do not fit their kinds. @param {Record<string, any>} header @param {Kind[]} kinds
 * @param {Arrays} own arrays of no kind */
export function checkTrees(header, kinds, own) {
  const { trees } = header;
  need(typeof header.name === "string" && typeof header.frame_id === "string", "name");
  need(/^[0-9a-f]{16}$/.test(header.identity), "identity");
  need(trees.length > 0, "trees");
  sizesOf(own, { tree_place: ["f32", trees.length, 5] });
  let [poses, coordinates] = [0, 0];
  for (const [i, tree] of trees.entries()) {
    need(Number.isInteger(tree.kind) && tree.kind in kinds, `trees[${i}]`);
    need(typeof tree.name === "string", `trees[${i}]`);
    need(own.tree_place.values[5 * i + 4] > 0, `tree_place[${i}]`);
    poses += kinds[tree.kind].nSegments;
    coordinates += kinds[tree.kind].nCoordinates;
  }
  const segments = kinds.reduce((sum, kind) => sum + kind.nSegments, 0);
  need(Object.values(header.flutter ?? {}).every(isFinite), "flutter");
  need(segments <= MOST_SEGMENTS, "number of segments");
  need(poses <= MOST_POSES, "number of segments of all trees");
  need(coordinates <= MOST_COORDINATES, "number of coordinates");
}

/** @param {any} value */
const isObject = (value) => typeof value === "object" && value !== null && !Array.isArray(value);

/** Refuse a text that is none of doc/streaming.md. @param {Record<string, any>} message of the server */
export function checkMessage(message) {
  need(isObject(message), "message");
  const { pong = 0, refused, hello, status = {}, values = {}, gusts } = message;
  const { sequence = 0, mean = [0, 0, 0], delay = [], wind = [] } = gusts ?? {};
  need(mean.length === 3 && [sequence, ...mean, ...delay, ...wind].every(Number.isFinite), "gusts");
  need(isFinite(pong), "pong");
  need(isObject(status), "status");
  need(isObject(values), "values");
  need(refused === undefined || typeof refused?.reason === "string", "refused");
  const controls = hello === undefined ? [] : hello?.controls;
  need(Array.isArray(controls), "hello");
  need(controls.every((/** @type {any} */ each) => isObject(each) && typeof each.name === "string"), "hello");
  return message;
}
