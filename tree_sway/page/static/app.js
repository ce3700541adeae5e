// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The page: what comes over the line onto the screen, what hands do back onto the line. */

import { TreeStream } from "./client.js";
import { DAYLIGHT } from "./drawing/backdrop.js";
import { Scene } from "./drawing/scene.js";
import { Hands } from "./hands.js";
import { readLink, recordClip, savePicture, saveTree, viewLink } from "./keepsake.js";
import { keptScene, OwnLine } from "./own_line.js";
import { Panel } from "./panel.js";
import { Trace } from "./trace.js";
import { language, setLanguage, windFrom, word } from "./words.js";

/** The newest state may be so old before the page says that it is behind [ms]. */
const BEHIND = 1000;
const FACTS_EVERY = 400;
/** How far a pointer may move in a click [px]. */
const STILL = 4;

/** @template {HTMLElement} [T=HTMLElement]
 * @param {string} id
 * @returns {T} */
const element = (id) => /** @type {T} */ (document.getElementById(id));

/** Write a text where it is another. @param {string} id @param {string} text */
function write(id, text) {
  if (element(id).textContent !== text) element(id).textContent = text;
}

/** @type {HTMLCanvasElement} */
const canvas = element("view");
/** @type {HTMLSelectElement} */
const shown = element("shown");
/** @type {HTMLInputElement} */
const timeLine = element("time");
/** Least value of the scale, and units from below a value, of what is shown.
 * @type {Record<string, {least: number, units: [number, Unit][]}>} */
const SHOWN = {
  motion: { least: 0.02, units: [
    [0.1, { factor: 1000, unit: "mm", digits: 0 }], [2, { factor: 100, unit: "cm", digits: 0 }],
    [Infinity, { factor: 1, unit: "m", digits: 1 }]] },
  strain: { least: 1e-4, units: [[Infinity, { factor: 1e6, unit: "µm/m", digits: 0 }]] },
  moment: { least: 0.1, units: [
    [1000, { factor: 1, unit: "N m", digits: 0 }], [Infinity, { factor: 1e-3, unit: "kN m", digits: 1 }]] },
};
const shownUnit = (/** @type {number} */ greatest) =>
  (SHOWN[shown.value].units.find(([below]) => greatest < below) ?? SHOWN[shown.value].units[0])[1];
const traces = {
  wind: new Trace(element("wind-trace"), 4, "--blue", () => ({ factor: 1, unit: "m/s", digits: 0 })),
  tip: new Trace(element("tip-trace"), 0.02, "--green", shownUnit),
};
const link = readLink(location.hash);
/** @type {Scene | null} */
let scene = null;
/** @type {"connecting" | "open" | "lost"} */
let line = "connecting";
let retryAt = 0;
let lastFrameAt = 0;
let [bytes, frames, drawn, fps, factsAt] = [0, 0, 0, 0, performance.now()];
/** Time that leaves flutter by [s]; it stops with the tree. */
let sceneTime = 0;
let lastDrawn = 0;
/** @type {Record<string, any>} */
let status = {};
/** @type {any[]} */
let controls = [];
let toastTimer = 0;
/** @type {keyof typeof DAYLIGHT} */
let day = "light";
/** @type {(() => void) | null} */
let endClip = null;

try {
  scene = new Scene(canvas, new URLSearchParams(location.search).get("quality") === "full");
} catch (error) {
  notice(word("blind"), word("cure", error instanceof Error ? error.message : String(error)), false);
}

const kept = await keptScene().catch((error) => {
  scene = null;
  notice(word("damaged"), word("write_again", error.message), false);
  return null;
});
const stream = new TreeStream(location.href, {
  onState(state, retryIn) {
    line = state;
    retryAt = performance.now() + retryIn;
    showState();
  },
  onDescription(description) {
    const isFirst = !scene?.description;
    scene?.describe(description);
    if (isFirst && link.view) scene?.camera.set(link.view);
    showLeaves();
    write("name", description.name);
    document.title = `${description.name} – tree sway`;
    write("trees", description.trees.length.toLocaleString("en"));
    write("segments", description.nSegments.toLocaleString("en"));
    write("model", [...new Set(description.kinds.map(({ model }) => modelName(model)))].join(", "));
    const error = Math.max(...description.kinds.map((kind) => kind.basis_error));
    element("model").title = `± ${(1000 * error).toFixed(1)} mm`;
    pick(isFirst && link.settings.branch ? Number(link.settings.branch) : scene?.picked ?? -1);
    showState();
  },
  onFrame(_frame, _arrival, size) {
    lastFrameAt = performance.now();
    bytes += size;
    frames += 1;
  },
  onMessage(message) {
    if (message.hello) {
      controls = message.hello.controls;
      panel.build(controls);
      element("panel").hidden = controls.length === 0;
      if (hands) hands.canPull = message.hello.can_pull === true;
    }
    if (message.refused) toast(message.refused.reason);
    if (message.unreadable) toast(message.unreadable);
    if (message.values) {
      for (const control of controls) control.value = message.values[control.name] ?? control.value;
      panel.update(message.values, Boolean(message.refused));
    }
    if (message.status) status = message.status;
    if (Number.isFinite(status.record_time)) panel.update({ record_time: status.record_time });
  },
}, { kept, byWind: new URLSearchParams(location.search).has("solve") });

const { connection, playout } = stream;
const hands = scene && new Hands({ scene, stream }, toast);
const panel = new Panel(element("controls"), (name, value) => stream.set(name, value));
const treeName = () => connection.description?.name ?? "tree";

/** @returns {["live" | "paused" | "behind" | "empty" | "connecting" | "lost", string]} */
function stateNow() {
  const age = performance.now() - lastFrameAt;
  if (line === "lost") return ["lost", word("lost")];
  if (line === "connecting") return ["connecting", word("connecting")];
  if (!connection.description) return ["empty", word("empty")];
  if (playout.back) return ["paused", word("back", (playout.back / 1000).toFixed(1))];
  if (!lastFrameAt || age > BEHIND) {
    return ["behind", lastFrameAt ? word("behind", (age / 1000).toFixed(1)) : word("waiting")];
  }
  if (status.building) return ["behind", word("building")];
  return playout.isPaused ? ["paused", word("paused")] : ["live", word("live")];
}

function showState() {
  const [state, text] = stateNow();
  const chip = element("state");
  if (chip.dataset.state !== state) chip.dataset.state = state;
  write("state-text", text);
  if (!scene) return;
  if (state === "lost") {
    notice(word("lost"), word("again", Math.max(0, Math.ceil((retryAt - performance.now()) / 1000))), true);
  } else if (state === "connecting" && !connection.description) {
    notice(word("connecting"), word("seeking"), false);
  } else if (state === "empty") {
    notice(word("empty"), word("soon"), false);
  } else if (state !== "connecting") {
    element("notice").hidden = true;
  }
}

/** @param {string} title @param {string} text @param {boolean} canRetry */
function notice(title, text, canRetry) {
  element("notice").hidden = false;
  write("notice-title", title);
  write("notice-text", text);
  element("retry").hidden = !canRetry;
}

/** @param {string} text */
function toast(text) {
  write("toast", text);
  element("toast").hidden = false;
  clearTimeout(toastTimer);
  toastTimer = setTimeout(() => (element("toast").hidden = true), 6000);
}

function showFacts() {
  const now = performance.now();
  const span = (now - factsAt) / 1000;
  if (span < FACTS_EVERY / 1000) return;
  fps = drawn / span;
  const leftOut = scene?.leftOut;
  write("drawn", `${Math.round(fps)} fps${leftOut ? ` · ${leftOut.leaves} % ❧` : ""}`);
  element("drawn").title = leftOut ? word("left_out", leftOut.pixels, leftOut.leaves) : "";
  write("stream", `${Math.round(frames / span)} Hz, ${(bytes / span / 1000).toFixed(1)} kB/s`);
  const { corrections = 0, largest = 0 } = stream.byWind ?? {};
  element("stream").title = stream.byWind ? word("corrected", corrections, (100 * largest).toFixed(2)) : "";
  const latency = connection.roundTrip / 2 + Math.max(0, playout.lateness);
  write("latency", Number.isFinite(latency) ? `${latency.toFixed(0)} + ${playout.delay} ms` : "–");
  element("latency").title = "On the way, and delayed so that the motion is smooth";
  if (status.model && status.trees === 1) write("model", modelName(status.model));
  if (status.rate) write("rate", `${status.rate.toFixed(0)} Hz, ${(status.work_us / 1000).toFixed(2)} ms`);
  [bytes, frames, drawn, factsAt] = [0, 0, 0, now];
  showState();
  const [x, y] = playout.wind;
  write("wind-now", `${Math.hypot(...playout.wind).toFixed(1)} m/s ${windFrom(x, y)}`);
  const { mean, greatest } = traces.wind.statistics;
  write("gust", word("gust", mean.toFixed(1), greatest.toFixed(1)));
  traces.wind.draw();
  traces.tip.draw();
}

/** A model by its name, or by how many coordinates it has. @param {string} model */
const modelName = (model) => (/^\d+$/.test(model) ? word("coordinates", model) : model);

/** @param {number} now */
function draw(now) {
  requestAnimationFrame(draw);
  if (!scene || hands?.isAway) return;
  const coordinates = stream.sample();
  const isStill = playout.isPaused || playout.back > 0;
  scene.wind = playout.wind;
  if (!isStill) sceneTime += Math.min(now - lastDrawn, 100) / 1000;
  lastDrawn = now;
  scene.draw(coordinates, sceneTime, isStill);
  drawn += 1;
  hands?.frame({ scene, stream });
  if (coordinates) {
    const [at, rest] = [scene.tip(), scene.restTip()];
    const load = scene.load();
    const value = { motion: Math.hypot(...at.map((each, c) => each - rest[c])), ...load }[shown.value] ?? 0;
    if (stateNow()[0] === "live") {
      traces.wind.add(now / 1000, Math.hypot(...playout.wind));
      traces.tip.add(now / 1000, value);
    }
    const { factor, unit, digits } = shownUnit(value);
    write("tip-now", `${(factor * value).toFixed(digits && digits + 1)} ${unit}`);
  }
  showFacts();
}

/** Look at what was, as far back as the time line says. */
function lookBack() {
  playout.back = -1000 * Number(timeLine.value);
  for (const trace of Object.values(traces)) trace.back = -Number(timeLine.value);
  timeLine.setAttribute("aria-valuetext", stateNow()[1]);
  showState();
}

/** @param {keyof typeof DAYLIGHT} time of day */
function setDay(time) {
  day = time;
  document.documentElement.dataset.theme = time === "dark" ? "dark" : "light";
  scene?.setDay(DAYLIGHT[time]);
}

function nextDay() {
  const times = /** @type {(keyof typeof DAYLIGHT)[]} */ (Object.keys(DAYLIGHT));
  setDay(times[(times.indexOf(day) + 1) % times.length]);
}

/** Say on a button whether something is so. @param {string} id @param {boolean} isSo */
function press(id, isSo) {
  element(id).setAttribute("aria-pressed", String(isSo));
}

function toggleLeaves() {
  if (scene?.hasLeaves) {
    scene.leavesShown = !scene.leavesShown;
    scene.repaint();
  }
  showLeaves();
}

/** The button says what is: a tree that was started bare has no leaves to show. */
function showLeaves() {
  /** @type {HTMLButtonElement} */
  const button = element("leaves");
  const hasLeaves = Boolean(scene?.hasLeaves);
  button.disabled = !hasLeaves;
  press("leaves", hasLeaves && Boolean(scene?.leavesShown));
  button.title = word(hasLeaves ? "leaves" : "bare");
}

function toggleSeason() {
  if (!scene) return;
  scene.setAutumn(!scene.isAutumn);
  press("season", scene.isAutumn);
}

/** @param {number} branch to follow; the highest if -1 */
function pick(branch) {
  if (!scene) return;
  const names = scene.watchedKind?.branch_names ?? [];
  scene.picked = names[branch] === undefined ? -1 : branch;
  write("branch", names[branch] ?? word("tallest"));
  traces.tip.least = SHOWN[shown.value].least;
  traces.tip.clear();
}

/** @param {number} step to the next branch, or back */
function pickNext(step) {
  const count = scene?.watchedKind?.branch_names.length ?? 0;
  if (scene && count) pick((scene.picked + step + count) % count);
}

async function copyLink() {
  if (!scene) return;
  const settings = {
    day, lang: language(), leaves: scene.leavesShown, autumn: scene.isAutumn, shown: shown.value,
    ...(scene.picked >= 0 && { branch: scene.picked }),
  };
  history.replaceState(null, "", viewLink(scene, settings));
  await navigator.clipboard?.writeText(location.href).catch(() => undefined);
  toast(`${word("copied")}: ${location.href}`);
}

/** Begin a clip, or end and save it. */
function toggleClip() {
  endClip?.();
  try {
    endClip = endClip ? null : recordClip(canvas, treeName());
  } catch (error) {
    toast(String(error));
  }
  press("clip", endClip !== null);
}

/** @param {"glb" | "html"} suffix */
const takeTree = (suffix) => saveTree(suffix, treeName()).catch((error) => toast(error.message));

function toggleFull() {
  if (document.fullscreenElement) document.exitFullscreen();
  else document.documentElement.requestFullscreen?.().catch(() => undefined);
}

function showHelp() {
  const items = word("keys").split("|").map((text) => {
    const item = document.createElement("li");
    item.textContent = text;
    return item;
  });
  element("keys-list").replaceChildren(...items);
  /** @type {HTMLDialogElement} */ (element("keys")).showModal();
}

/** @param {string} chosen */
function speak(chosen) {
  setLanguage(chosen);
  /** @type {HTMLSelectElement} */ (element("language")).value = language();
  panel.build(controls);
  showLeaves();
  pick(scene?.picked ?? -1);
  showState();
}

/** @type {Record<string, () => void>} what buttons do, and keys that are written beside them */
const actions = {
  home: () => scene?.camera.home(),
  leaves: toggleLeaves,
  theme: nextDay,
  season: toggleSeason,
  picture: () => scene && savePicture(scene, treeName(), () => scene?.draw(null, sceneTime, true)),
  clip: toggleClip,
  glb: () => takeTree("glb"),
  html: () => takeTree("html"),
  link: copyLink,
  full: toggleFull,
  help: showHelp,
  retry: () => stream.open(),
  close: () => /** @type {HTMLDialogElement} */ (element("keys")).close(),
};
for (const [id, action] of Object.entries(actions)) element(id).addEventListener("click", action);
/** @type {Record<string, () => void>} */
const keys = {
  m: () => scene && (scene.hasPerson = !scene.hasPerson),
  " ": () => element("control-pause")?.click(),
  "[": () => pickNext(-1), "]": () => pickNext(1), escape: () => pick(-1),
};
for (const button of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("[data-key]"))) {
  keys[button.dataset.key ?? ""] = actions[button.id];
}
document.addEventListener("keydown", (event) => {
  const target = /** @type {HTMLElement} */ (event.target);
  if (target.closest("input, select, button, summary, dialog") || event.ctrlKey || event.metaKey) return;
  keys[event.key.toLowerCase()]?.();
});
let pressed = [0, 0];
canvas.addEventListener("pointerdown", (event) => (pressed = [event.clientX, event.clientY]));
canvas.addEventListener("click", (event) => {
  if (!scene || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > STILL) return;
  pick(scene.branchAt(event.clientX / canvas.clientWidth, event.clientY / canvas.clientHeight));
});
shown.addEventListener("change", () => pick(scene?.picked ?? -1));
timeLine.addEventListener("input", lookBack);
element("language").addEventListener("change", (event) =>
  speak(/** @type {HTMLSelectElement} */ (event.target).value));

document.addEventListener("dragover", (event) => event.preventDefault());
document.addEventListener("drop", (event) => {
  event.preventDefault();
  const file = event.dataTransfer?.files[0];
  if (file && connection instanceof OwnLine) connection.take(file).catch((error) => toast(error.message));
});

const dark = window.matchMedia("(prefers-color-scheme: dark)");
const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
const { settings } = link;
const asked = /** @type {keyof typeof DAYLIGHT} */ (settings.day);
setDay(asked in DAYLIGHT ? asked : dark.matches ? "dark" : "light");
dark.addEventListener("change", () => setDay(dark.matches ? "dark" : "light"));
if (scene) [scene.flutters, scene.leavesShown] = [!calm.matches, settings.leaves !== "false"];
calm.addEventListener("change", () => scene && (scene.flutters = !calm.matches));
if (settings.autumn === "true") toggleSeason();
if (settings.shown in SHOWN) shown.value = settings.shown;
// A page that is a file is what its `.html` would be.
for (const id of ["glb", "html"]) element(id).hidden = Boolean(kept);
speak(settings.lang ?? navigator.language.slice(0, 2));
/** @type {HTMLDetailsElement} */ (element("panel")).open = window.innerWidth > 700;
scene?.camera.listen(canvas);
if (kept || !document.getElementById("scene")) stream.open();
requestAnimationFrame(draw);

/** For tests and for the curious at the console. */
Object.assign(window, {
  treeSway: {
    stream, connection, playout, traces, hands,
    get scene() { return scene; },
    get fps() { return fps; },
    get state() { return stateNow()[0]; },
    get status() { return status; },
  },
});
