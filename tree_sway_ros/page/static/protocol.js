// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/**
 * The binary form of a swaying tree (doc/streaming.md): a description sent once, then frames that
 * stand for themselves. Reads what tree_sway_ros/page/protocol.py writes.
 */

export const VERSION = 1;
export const FULL_SCALE = 32767;
/** Wind of one unit of its int16 [m/s]. */
export const WIND_UNIT = 0.005;
export const PAUSED = 1;
export const BEYOND_SCALE = 2;
export const RESTARTED = 4;

const MAGIC = 0x44575354; // "TSWD"
const FRAME_KIND = 0x46;
const FRAME_SIZE = 28;

/**
 * @typedef {Float32Array | Int32Array | Int16Array | Uint8Array} NumberArray
 *
 * @typedef {object} TreeEntry
 * @property {string} name
 * @property {string} species
 * @property {number} height [m]
 * @property {number} branches
 * @property {number} segments
 * @property {number} coordinates
 * @property {string} model
 * @property {number} basis_error what the basis leaves out [m]
 *
 * @typedef {object} Description
 * @property {string} name
 * @property {string} frame_id
 * @property {string} identity
 * @property {number} shortIdentity what frames carry of the identity
 * @property {TreeEntry[]} trees
 * @property {string[]} branchNames
 * @property {{gain: number, largest_angle: number} | null} flutter law of the leaves
 * @property {number} nSegments
 * @property {number} nBranches
 * @property {number} nCoordinates
 * @property {number} nKeys key rotations of all trees
 * @property {Record<string, NumberArray>} arrays
 *
 * @typedef {object} Frame
 * @property {number} identity
 * @property {number} sequence
 * @property {number} stamp [ms], of the sender's clock
 * @property {number} flags
 * @property {[number, number, number]} wind blowing to [m/s]
 * @property {Float32Array} coordinates in their own unit
 */

/** What cannot be read; its message is for people. */
export class ProtocolError extends Error {}

const TYPES = { f32: Float32Array, i32: Int32Array, i16: Int16Array, u8: Uint8Array };

/**
 * Read a description.
 *
 * @param {ArrayBuffer} data
 * @returns {Description}
 */
export function decodeDescription(data) {
  const view = new DataView(data);
  if (data.byteLength < 12 || view.getUint32(0, true) !== MAGIC) {
    throw new ProtocolError("not a description: it does not begin with TSWD");
  }
  const version = view.getUint32(4, true);
  if (version !== VERSION) {
    throw new ProtocolError(`a description of version ${version}: this page reads ${VERSION}`);
  }
  const begin = 12 + view.getUint32(8, true);
  if (begin > data.byteLength) throw new ProtocolError("not a whole description");
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 12, begin - 12)));
  /** @type {Record<string, NumberArray>} */
  const arrays = {};
  for (const [name, entry] of Object.entries(header.arrays)) {
    const kind = TYPES[/** @type {keyof typeof TYPES} */ (entry.type)];
    const count = entry.shape.reduce((/** @type {number} */ a, /** @type {number} */ b) => a * b, 1);
    const from = begin + entry.offset;
    if (!kind || from + count * kind.BYTES_PER_ELEMENT > data.byteLength) {
      throw new ProtocolError(`not a whole description: array ${name} is cut short`);
    }
    arrays[name] = new kind(data, from, count);
  }
  const blocks = arrays.basis_block;
  let nKeys = 0;
  for (let i = 1; i < blocks.length; i += 5) nKeys = Math.max(nKeys, blocks[i]);
  const nBranches = arrays.branch_parent.length;
  return {
    name: header.name,
    frame_id: header.frame_id,
    identity: header.identity,
    shortIdentity: parseInt(header.identity.slice(0, 8), 16),
    trees: header.trees,
    branchNames: header.branch_names,
    flutter: header.flutter ?? null,
    nSegments: arrays.segment_length.length,
    nBranches,
    nCoordinates: arrays.basis_scale.length,
    nKeys,
    arrays,
  };
}

/**
 * Whether a message is a frame.
 *
 * @param {ArrayBuffer} data
 */
export function isFrame(data) {
  return data.byteLength >= FRAME_SIZE && new Uint8Array(data, 0, 1)[0] === FRAME_KIND;
}

/**
 * Read a frame.
 *
 * @param {ArrayBuffer} data
 * @param {Description} description
 * @returns {Frame}
 */
export function decodeFrame(data, description) {
  const view = new DataView(data);
  if (!isFrame(data)) throw new ProtocolError("not a frame");
  const count = view.getUint16(26, true);
  if (view.getUint8(1) !== VERSION || data.byteLength !== FRAME_SIZE + 2 * count) {
    throw new ProtocolError(`a frame of ${data.byteLength} bytes for ${count} coordinates`);
  }
  const identity = view.getUint32(4, true);
  if (identity !== description.shortIdentity || count !== description.nCoordinates) {
    throw new ProtocolError("a frame of another description");
  }
  const scale = description.arrays.basis_scale;
  const coordinates = new Float32Array(count);
  for (let i = 0; i < count; i++) {
    coordinates[i] = (view.getInt16(FRAME_SIZE + 2 * i, true) / FULL_SCALE) * scale[i];
  }
  return {
    identity,
    sequence: view.getUint32(8, true),
    stamp: Number(view.getBigInt64(12, true)) / 1e6,
    flags: view.getUint8(2),
    wind: [
      view.getInt16(20, true) * WIND_UNIT,
      view.getInt16(22, true) * WIND_UNIT,
      view.getInt16(24, true) * WIND_UNIT,
    ],
    coordinates,
  };
}
