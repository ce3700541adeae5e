// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The native core (native/ of the source, doc/sway_model.md) in WebAssembly: its functions, its memory, its models. */

import { need, ProtocolError } from "./checks.js";
import { bytesOf } from "./files.js";

const program = await bytesOf("sway.wasm", () => new URL("./sway.wasm", import.meta.url));
if (!globalThis.WebAssembly?.validate(program)) {
  const text = "This browser has no WebAssembly with SIMD, or it is switched off: take Chrome 91, Firefox 89, Safari 16.4 or later.";
  Object.assign(globalThis.document?.getElementById("notice") ?? {}, { hidden: false, textContent: text });
  throw new Error(text);
}

/** Functions of native/sway.h and native/page.cpp; addresses are numbers. The core has no library: powers, sines and
 * the like are those of the browser. @type {Record<string, any>} */
export const core = (await WebAssembly.instantiate(program, { env: /** @type {any} */ (Math) })).instance.exports;

/** Frees the memory of objects that are no longer used. */
const unused = new FinalizationRegistry((/** @type {() => void} */ free) => free());

/** Free what the core made when its owner is no longer used; throws a `ProtocolError` if it made nothing.
 * @param {object} owner @param {number} made its address @param {string} free function @returns {number} address */
export function owned(owner, made, free) {
  if (!made) throw new ProtocolError("memory is short");
  unused.register(owner, () => core[free](made), owner);
  return made;
}

/** Numbers in the memory of the core, at first 0. @template {Float32Array | Float64Array | BigInt64Array | Uint32Array | Uint8Array} T */
export class Block {
  /** @param {{new (buffer: ArrayBuffer, at: number, count: number): T, BYTES_PER_ELEMENT: number}} type
   * @param {number} count @param {number} [at] address; memory of its own if left out */
  constructor(type, count, at) {
    this.at = at ?? owned(this, core.calloc(count + 1, type.BYTES_PER_ELEMENT), "free");
    this._type = type;
    this._count = count;
    this._values = new type(core.memory.buffer, this.at, count);
  }

  /** The numbers, until more memory is taken. */
  get values() {
    const { buffer } = core.memory;
    if (this._values.buffer !== buffer) this._values = new this._type(buffer, this.at, this._count);
    return this._values;
  }

  /** Free them now, where they are many. */
  free() {
    unused.unregister(this);
    core.free(this.at);
  }
}

/** Types of arrays by their number in the bytes of a model. */
const TYPES = [Float64Array, Float32Array, BigInt64Array];
/** Bytes of the head of a model, of an entry of its list, and for an error. */
const HEAD = 16, ENTRY = 72, ROOM = 300;

/** Call with room for an error, which becomes a `ProtocolError`. @param {object} owner of what is made
 * @param {string} free function @param {(at: number, room: number) => number} make @returns {number} address */
export function made(owner, free, make) {
  const error = new Block(Uint8Array, ROOM);
  const found = make(error.at, ROOM);
  const text = new TextDecoder().decode(error.values.slice(0, error.values.indexOf(0)));
  if (!found) throw new ProtocolError(text);
  return owned(owner, found, free);
}

/** A model of the core. */
export class Model {
  /** @param {Record<string, {values: any, shape: number[]}>} arrays of doc/sway_model.md; refuses those that are of no tree */
  constructor(arrays) {
    const entries = Object.entries(arrays);
    let size = HEAD + ENTRY * entries.length;
    const offsets = entries.map(([, { values }]) => {
      const from = size;
      size += 8 * Math.ceil(values.byteLength / 8);
      return from;
    });
    need(size < 2 ** 32 - 2 ** 16, "size of the model");
    const block = new Block(Uint8Array, size);
    const bytes = block.values;
    const view = new DataView(bytes.buffer, block.at);
    const write = (/** @type {string} */ text, /** @type {number} */ at) => bytes.set(new TextEncoder().encode(text), at);
    write("SWAYTREE", 0);
    view.setUint32(8, 1, true);
    view.setUint32(12, entries.length, true);
    entries.forEach(([name, { values, shape }], i) => {
      const at = HEAD + ENTRY * i;
      write(name, at);
      view.setUint32(at + 24, TYPES.indexOf(values.constructor), true);
      view.setUint32(at + 28, shape.length, true);
      shape.forEach((count, axis) => view.setBigUint64(at + 32 + 8 * axis, BigInt(count), true));
      view.setBigUint64(at + 64, BigInt(offsets[i]), true);
      bytes.set(new Uint8Array(values.buffer, values.byteOffset, values.byteLength), offsets[i]);
    });
    try {
      this.at = made(this, "sway_model_close", (error, room) => core.sway_model_open(block.at, size, error, room));
    } finally {
      block.free();
    }
  }
}
