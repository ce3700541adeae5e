// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The binary protocol of the stream (doc/streaming.md): a description sent once, then frames that do not depend on each
 * other. Reads the messages of tree_sway/stream/protocol.py. */

import { checkedKind, checkTrees, MOST_COORDINATES, MOST_POSES, need, ProtocolError, TYPES } from "./checks.js";

export { ProtocolError };

/** Versions of descriptions and of frames. */
const VERSION = 2;
const FRAME_VERSION = 1;
const FULL_SCALE = 32767;
/** Resolution of the wind, sent as int16 [m/s]. */
const WIND_UNIT = 0.005;
/** Flags of a frame. */
export const PAUSED = 1;
export const RESTARTED = 4;
export const PART = 8;
/** No sample of the wind has come yet, or the last is too old and its force decays. */
export const WIND_LOST = 16;

/** First bytes of descriptions and tables. */
const MAGIC = { description: "TSWD", tables: "TSWT" };
const FRAME_KIND = 0x46;
export const FRAME_SIZE = 28;

/** Largest description, and largest header in it [bytes]. */
export const LARGEST_DESCRIPTION = 64 * 2 ** 20;
const LARGEST_HEADER = 8 * 2 ** 20;

/** Make a reader of messages with a header and arrays; every failure becomes a `ProtocolError`. Arrays in planes have
 * all first bytes, then all second bytes, which compress better. Own arrays belong to no kind.
 * @template T @param {keyof typeof MAGIC} what @param {(head: any, kinds: Arrays[], own: Arrays) => T} read *
 */
export const reader = (what, read) => (/** @type {ArrayBuffer} */ data, inPlanes = false) => {
  try {
    const view = new DataView(data);
    if (!begins(data, what)) throw new ProtocolError(`no message of ${what}: it does not begin with ${MAGIC[what]}`);
    const version = view.getUint32(4, true);
    if (version !== VERSION) throw new ProtocolError(`a message of version ${version}: this page reads ${VERSION}`);
    const begin = 12 + view.getUint32(8, true);
    need(begin <= Math.min(data.byteLength, LARGEST_HEADER), "size of the header");
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 12, begin - 12)));
    /** @type {Arrays[]} */
    const kinds = header.kinds.map(() => ({}));
    /** @type {Arrays} */
    const own = {};
    for (const [name, { type, shape, offset }] of Object.entries(header.arrays)) {
      const kind = TYPES[/** @type {keyof typeof TYPES} */ (type)];
      need(Boolean(kind) && shape.every((/** @type {number} */ n) => Number.isInteger(n) && n >= 0), name);
      const count = shape.reduce((/** @type {number} */ a, /** @type {number} */ b) => a * b, 1);
      const from = begin + offset, size = kind.BYTES_PER_ELEMENT;
      need(from >= begin && from + count * size <= data.byteLength, name);
      const planes = inPlanes && new Uint8Array(data, from, size * count);
      const whole = planes && planes.map((_, i) => planes[(i % size) * count + Math.floor(i / size)]);
      const [number, field] = name.split("/");
      const values = whole ? new kind(whole.buffer) : new kind(data, from, count);
      (field ? kinds[Number(number)] : own)[field ?? name] = { values, shape };
    }
    return read(header, kinds, own);
  } catch (error) {
    if (error instanceof ProtocolError) throw error;
    throw new ProtocolError(`not a whole message of ${what} (${String(error).slice(0, 200)})`);
  }
};

/** Read a description; refuses indices beyond the arrays that they point into. */
export const decodeDescription = reader("description", (header, parts, own) => {
  const { name, frame_id, identity, flutter = null } = header;
  const kinds = parts.map((part, number) => checkedKind(header.kinds[number], part));
  checkTrees(header, kinds, own);
  let nSegments = 0, nCoordinates = 0, nKeys = 0;
  const trees = Array.from(header.trees, (/** @type {Tree} */ tree, number) => {
    const kind = kinds[tree.kind];
    const place = Array.from(own.tree_place.values.subarray(5 * number, 5 * number + 5));
    const first = { firstSegment: nSegments, firstCoordinate: nCoordinates, firstKey: nKeys };
    nKeys += kind.nKeys;
    nSegments += kind.nSegments;
    nCoordinates += kind.nCoordinates;
    return { ...tree, ...first, place, height: kind.height * place[4] };
  });
  need(nSegments <= MOST_POSES, "number of segments of all trees");
  need(nCoordinates <= MOST_COORDINATES, "number of coordinates");
  const scale = new Float32Array(nCoordinates);
  for (const tree of trees) scale.set(kinds[tree.kind].arrays.basis_scale, tree.firstCoordinate);
  return { name, frame_id, identity, shortIdentity: parseInt(identity.slice(0, 8), 16), kinds, trees, flutter, nSegments, nCoordinates, scale };
});

/** Whether a message begins as a description or tables. @param {ArrayBuffer} data @param {keyof typeof MAGIC} what */
function begins(data, what) {
  return data.byteLength >= 12 && new TextDecoder().decode(new Uint8Array(data, 0, 4)) === MAGIC[what];
}

/** Whether a message has tables. @param {ArrayBuffer} data */
export const isTables = (data) => begins(data, "tables");

/** Whether a message is a frame. @param {ArrayBuffer} data */
export const isFrame = (data) => data.byteLength >= FRAME_SIZE && new Uint8Array(data)[0] === FRAME_KIND;

/** Read a frame; null if it belongs to a description that has not come yet. @param {ArrayBuffer} data
 * @param {Description | null} description @returns {Frame | null} */
export function decodeFrame(data, description) {
  const view = new DataView(data);
  if (!isFrame(data)) throw new ProtocolError("not a frame");
  const count = view.getUint16(26, true);
  const flags = view.getUint8(2);
  const begin = flags & PART ? FRAME_SIZE + 2 : FRAME_SIZE;
  const end = begin + 2 * count;
  if (view.getUint8(1) !== FRAME_VERSION || data.byteLength < end || (data.byteLength - end) % 8) {
    throw new ProtocolError(`a frame of ${data.byteLength} bytes for ${count} coordinates`);
  }
  const identity = view.getUint32(4, true);
  if (identity !== description?.shortIdentity) return null;
  const { scale, nCoordinates } = description;
  const first = flags & PART ? view.getUint16(FRAME_SIZE, true) : 0;
  if (first + count > nCoordinates || (count !== nCoordinates && count && !(flags & PART))) {
    throw new ProtocolError(`a frame of ${count} coordinates, described are ${nCoordinates}`);
  }
  const steps = new Int16Array(data, begin, count);
  const turns = new Float32Array(data.slice(end));
  need(turns.every(Number.isFinite), "frame");
  const coordinates = new Float32Array(count + turns.length);
  coordinates.set(turns, count);
  for (let i = 0; i < count; i++) coordinates[i] = (steps[i] / FULL_SCALE) * scale[first + i];
  const [x, y, z] = [20, 22, 24].map((at) => view.getInt16(at, true) * WIND_UNIT);
  const sequence = view.getUint32(8, true), stamp = Number(view.getBigInt64(12, true)) / 1e6;
  return { identity, sequence, stamp, flags, first, wind: [x, y, z], coordinates };
}
