// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Checks of received messages before they are used, as in tree_sway/stream/check_description.py. */

import { textOf } from "./files.js";

/** A message that cannot be used; the text is for people. */
export class ProtocolError extends Error {}

const MOST_SEGMENTS = 500000;
export const MOST_POSES = 10000000;
export const MOST_COORDINATES = 65535;
/** Largest number of tables times their squared coordinates, and of trees times coordinates of a table. */
const MOST_SLOPES = 400000;
const MOST_STATES = 50000000;
/** Largest wind of a tree over that of its kind, and smallest speed of gusts over the mean wind. */
const FASTEST = 1e6;
const LEAST_RATIO = 0.1;
/** Largest magnitude of any number, such as a height [m]. */
const GREATEST = 1e18;

export const TYPES = { f32: Float32Array, i32: Int32Array, i16: Int16Array, u8: Uint8Array };

/** Type and axes of each array of a kind; leaf arrays are absent on bare trees.
 * @type {{description: Forms, tables: Forms}} */
export const FORMS = JSON.parse(await textOf("arrays.json", () => new URL("./arrays.json", import.meta.url)));

/** Looks of leaves and bark. */
export const LOOKS = JSON.parse(await textOf("looks.json", () => new URL("./looks.json", import.meta.url)));

const BY_BRANCH = ["branch_parent", "branch_base_segment", "branch_coordinate", "branch_keys", "branch_base_turn",
  "branch_turn"];

/** Throw a `ProtocolError` unless a condition holds. @param {boolean} holds @param {string} name of the part */
export function need(holds, name) {
  if (!holds) throw new ProtocolError(`${name} does not fit the rest, or is not finite`);
}

/** @param {unknown} value */
const isFinite = (value) => typeof value === "number" && Math.abs(value) < GREATEST;

/** Whether a look has the same fields as the average one, of the same type and in a sane range.
 * @param {any} look @param {any} like @returns {boolean} */
function fits(look, like) {
  if (typeof like === "number") return isFinite(look) && look > 0 && look < 100;
  if (Array.isArray(like)) {
    return Array.isArray(look) && look.length >= like.length && look.length < 9 && look.every((each) => isFinite(each) && Math.abs(each) < 10);
  }
  if (!isObject(like)) return typeof look === typeof like;
  return isObject(look) && Object.entries(like).every(([name, each]) =>
    (name === "autumn" && look.autumn === null) || fits(look[name], each));
}

/** Arrays without their shapes. @param {Arrays} parts @returns {Record<string, any>} */
export const valuesOf = (parts) => Object.fromEntries(Object.entries(parts).map(([name, { values }]) => [name, values]));

/** Sizes of the axes of arrays, which have their forms. @param {Arrays} parts @param {Forms} forms */
function sizesOf(parts, forms) {
  /** @type {Record<string, number>} */
  const size = {};
  for (const [name, [type, ...axes]] of Object.entries(forms)) {
    const { values, shape } = parts[name] ?? {};
    need(values?.constructor === TYPES[type] && shape.length === axes.length, name);
    axes.forEach((axis, i) => {
      if (typeof axis === "string") size[axis] ??= shape[i];
      need(shape[i] === (typeof axis === "string" ? size[axis] : axis), name);
    });
    need(values.every(isFinite), name);
  }
  return size;
}

/** A kind with its arrays and its sizes; one whose arrays do not fit each other is refused.
 * @param {Kind} kind as its header has it @param {Arrays} parts its arrays @returns {Kind} */
export function checkedKind(kind, parts) {
  /** @type {Kind["arrays"]} */
  const arrays = valuesOf(parts);
  const forms = Object.entries(FORMS.description).filter(([name]) => arrays.leaf_segment || !name.startsWith("leaf"));
  const size = sizesOf(parts, Object.fromEntries(forms));
  const { branches: b, segments: n, keys: nKeys, coordinates, rows } = size;
  need(b > 0 && size["branches + 1"] === b + 1, "branch_first");
  need(arrays.basis_scale.every((value) => value > 0), "basis_scale");
  need(typeof kind.species === "string" && typeof kind.model === "string", "species");
  need(kind.look === undefined || fits(kind.look, LOOKS.average), "look");
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
  for (const [i, tree] of trees.entries()) {
    need(Number.isInteger(tree.kind) && tree.kind in kinds, `trees[${i}]`);
    need(typeof tree.name === "string", `trees[${i}]`);
    need(own.tree_place.values[5 * i + 4] > 0, `tree_place[${i}]`);
  }
  const segments = kinds.reduce((sum, kind) => sum + kind.nSegments, 0);
  need(Object.values(header.flutter ?? {}).every(isFinite), "flutter");
  need(segments <= MOST_SEGMENTS, "number of segments");
}

/** Sizes of the axes of the arrays of a table; refuses numbers or arrays that are inconsistent, as
 * tree_sway/stream/check_tables.py does. @param {Record<string, any>} numbers @param {Arrays} parts */
export function checkTable(numbers, parts) {
  const size = sizesOf(parts, FORMS.tables);
  const { m } = size;
  need(m > 0 && m * m <= MOST_SLOPES && size["m m"] === m * m, "stiffness");
  need(parts.stiffness.values.every((each) => each > 0), "stiffness");
  for (const name of ["limit", "own_damping", "motion", "cross_damping"]) {
    need(parts[name].values.every((each) => each >= 0), name);
  }
  const { values: levels, shape: [, count] } = parts.levels;
  need(levels.every((level, i) => i % count === 0 || level >= levels[i - 1]), "levels");
  for (const name of ["most_pressure", "most_energy"]) need(isFinite(numbers[name]) && numbers[name] > 0, name);
  const { drag_law: law } = numbers;
  need(Array.isArray(law) && law.length === 3 && law.every(isFinite), "drag_law");
  return size;
}

/** Refuse a header of tables, or winds of trees. @param {Record<string, any>} header
 * @param {number[]} sizes number of coordinates of each table @param {Arrays} own arrays of no kind */
export function checkTablesHeader(header, sizes, own) {
  const { description, anemometer, convection_ratio: ratio } = header;
  const speeds = own.tree_speed;
  const most = Math.max(0, ...sizes);
  need(typeof description === "string", "description");
  const isPlace = Array.isArray(anemometer) && anemometer.length === 3 && anemometer.every(isFinite);
  need(anemometer === null || isPlace, "anemometer");
  need(ratio === null || (isFinite(ratio) && ratio >= LEAST_RATIO), "convection_ratio");
  need(speeds?.values.constructor === Float32Array && speeds.shape.length === 1, "tree_speed");
  need(speeds.values.every((each) => each >= 0 && each < FASTEST), "tree_speed");
  need(sizes.length * most ** 2 <= MOST_SLOPES, "number of slopes");
  need(speeds.values.length * most <= MOST_STATES, "number of coordinates of all trees");
}

/** @param {any} value */
const isObject = (value) => typeof value === "object" && value !== null && !Array.isArray(value);

/** Refuse a text message that doc/streaming.md does not have. @param {Record<string, any>} message of the server */
export function checkMessage(message) {
  need(isObject(message), "message");
  const { pong = 0, refused, hello, status = {}, values = {}, gusts } = message;
  const { sequence = 0, mean = [0, 0, 0], delay = [], wind = [] } = gusts ?? {};
  need(mean.length === 3 && [sequence, ...mean, ...delay, ...wind].every(Number.isFinite), "gusts");
  need(isFinite(pong), "pong");
  need(isObject(status) && isObject(status.wind ?? {}), "status");
  const { said = [], band = [0, 0] } = status.motion ?? {};
  need(Array.isArray(said) && said.every(Array.isArray), "status.motion.said");
  need(Array.isArray(band) && band.length === 2 && band.every(Number.isFinite), "status.motion.band");
  need(isObject(values), "values");
  need(refused === undefined || typeof refused?.reason === "string", "refused");
  const controls = hello === undefined ? [] : hello?.controls;
  need(Array.isArray(controls) && typeof (hello?.viewers_token ?? "") === "string", "hello");
  need(controls.every((/** @type {any} */ each) => isObject(each) && typeof each.name === "string"), "hello");
  return message;
}
