// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Exports: a picture, a clip, the tree, and a link that keeps the view. */

import { Quality } from "./drawing/quality.js";
import { word } from "./words.js";

const FRAMES_PER_SECOND = 30;

/** Download a file. @param {Blob} blob @param {string} name @param {string} suffix */
export function save(blob, name, suffix) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = `${name.replace(/[^\p{L}\p{N}]+/gu, "_")}.${suffix}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** Save the picture in full quality. @param {Scene} scene @param {string} name @param {() => void} draw a frame */
export function savePicture(scene, name, draw) {
  const { quality } = scene;
  scene.quality = new Quality();
  draw();
  scene.canvas.toBlob((blob) => blob && save(blob, name, "png"));
  scene.quality = quality;
}

/** Record a clip; the returned function ends it. @param {HTMLCanvasElement} canvas @param {string} name */
export function recordClip(canvas, name) {
  if (!window.MediaRecorder) throw new Error("this browser records no clips: take Chrome 47, Firefox 25, Safari 14.1 or later");
  const type = ["video/mp4", "video/webm"].find((each) => MediaRecorder.isTypeSupported(each)) ?? "";
  const recorder = new MediaRecorder(canvas.captureStream(FRAMES_PER_SECOND), { mimeType: type, videoBitsPerSecond: 8e6 });
  const parts = /** @type {Blob[]} */ ([]);
  recorder.ondataavailable = ({ data }) => parts.push(data);
  recorder.onstop = () => save(new Blob(parts, { type }), name, type.slice(6));
  recorder.start();
  return () => recorder.stop();
}

/** Save the tree as a file that the server writes. @param {"glb" | "html"} suffix @param {string} name
 * @param {string | null} token of the page; without one a cookie may have it */
export async function saveTree(suffix, name, token) {
  // No page of another origin can send this header.
  const headers = { "X-Requested-With": "tree-sway", ...(token && { Authorization: `Bearer ${token}` }) };
  const answer = await fetch(`tree.${suffix}`, { headers }).catch(() => {
    throw new Error(word("lost"));
  });
  if (!answer.ok) throw new Error(await answer.text());
  save(await answer.blob(), name, suffix);
}

/** The view as the end of an address. @param {Scene} scene
 * @param {Record<string, string | number | boolean>} settings */
export function viewLink(scene, settings) {
  const { azimuth, elevation, distance, target } = scene.camera;
  const view = [azimuth, elevation, distance, ...target].map((each) => Number(each.toPrecision(5)));
  const all = { view: view.join("_"), ...settings };
  return `#${new URLSearchParams(Object.entries(all).map(([key, value]) => [key, String(value)]))}`;
}

/** The settings of a link, and its camera where it has one. @param {string} hash */
export function readLink(hash) {
  const settings = Object.fromEntries(new URLSearchParams(hash.slice(1)));
  const view = (settings.view ?? "").split("_").map(Number);
  return { settings, view: view.length === 6 && view.every(Number.isFinite) ? view : null };
}
