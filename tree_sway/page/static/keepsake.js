// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Exports: a picture, a clip, the tree, and a link that keeps the view. */

import { Quality } from "./drawing/quality.js";
import { toast } from "./notices.js";
import { element, made } from "./panel.js";
import { OF_TREE } from "./state.js";
import { language, word } from "./words.js";

const FRAMES_PER_SECOND = 30;

/** Download a file. @param {Blob} blob @param {string} name @param {string} suffix */
export function save(blob, name, suffix) {
  const download = `${name.replace(/[^\p{L}\p{N}]+/gu, "_")}.${suffix}`;
  const link = made("a", { href: URL.createObjectURL(blob), download });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** Save the picture in full quality. @param {import("./view.js").View} view */
export function savePicture({ scene, treeName, time }) {
  const { quality } = scene;
  scene.quality = new Quality();
  scene.draw(null, time, true);
  scene.canvas.toBlob((blob) => blob && save(blob, treeName, "png"));
  scene.quality = quality;
}

/** Record a clip; the returned function ends it. @param {HTMLCanvasElement} canvas @param {string} name */
export function recordClip(canvas, name) {
  const type = ["video/mp4", "video/webm"].find((each) => MediaRecorder.isTypeSupported(each)) ?? "";
  const recorder = new MediaRecorder(canvas.captureStream(FRAMES_PER_SECOND), { mimeType: type, videoBitsPerSecond: 8e6 });
  /** @type {Blob[]} */
  const parts = [];
  recorder.ondataavailable = ({ data }) => parts.push(data);
  recorder.onstop = () => save(new Blob(parts, { type }), name, type.slice(6));
  recorder.start();
  return () => recorder.stop();
}

/** Save the tree as a file, and say that the server is writing it. @param {"glb" | "html"} suffix @param {string} name
 * @param {string | null} token of the page; without one a cookie may have it */
export async function saveTree(suffix, name, token) {
  toast(word("writing"), false, true);
  // No page of another origin can send this header.
  const headers = { "X-Requested-With": "tree-sway", ...(token && { Authorization: `Bearer ${token}` }) };
  const answer = await fetch(`tree.${suffix}`, { headers }).catch(() => {
    throw new Error(word("lost"));
  });
  if (!answer.ok) throw new Error(await answer.text());
  save(await answer.blob(), name, suffix);
  element("toast").hidden = true;
}

/** Put a link to what is seen into the address bar and the clipboard. @param {import("./view.js").View} view */
export async function copyLink({ scene, day, shown, state: { controls, viewersToken } }) {
  const { leavesShown: leaves, isAutumn: autumn, picked: branch, camera: { azimuth, elevation, distance, target } } = scene;
  const view = [azimuth, elevation, distance, ...target].map((each) => Number(each.toPrecision(5)));
  const own = { view: view.join("_"), day, lang: language(), leaves: `${leaves}`, autumn: `${autumn}`, shown: shown.value };
  const settings = new URLSearchParams(own);
  if (branch >= 0) settings.set("branch", `${branch}`);
  for (const { name, value } of controls) if (OF_TREE.includes(name)) settings.set(name, value);
  history.replaceState(null, "", `#${settings}`);
  const link = new URL(location.href);
  if (viewersToken) link.searchParams.set("token", viewersToken);
  await navigator.clipboard?.writeText(link.href).catch(() => undefined);
  toast(`${word(viewersToken ? "copied_to_look" : "copied")}: ${link.href}`, false);
}

/** The settings of a link, and its camera where it has one. @param {string} hash */
export function readLink(hash) {
  const settings = Object.fromEntries(new URLSearchParams(hash.slice(1)));
  const view = (settings.view ?? "").split("_").map(Number);
  return { settings, view: view.length === 6 && view.every(Number.isFinite) ? view : null };
}
