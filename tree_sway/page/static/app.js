// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The page: what comes over the line onto the screen, what hands do back onto the line. */

import { TreeStream } from "./client.js";
import { DAYLIGHT } from "./drawing/backdrop.js";
import { Scene } from "./drawing/scene.js";
import { Hands } from "./hands.js";
import { readLink, savePicture, viewLink } from "./keepsake.js";
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

const canvas = /** @type {HTMLCanvasElement} */ (element("view"));
const shown = /** @type {HTMLSelectElement} */ (element("shown"));
const speedUnit = () => ({ factor: 1, unit: "m/s", digits: 0 });
const shownUnit = (/** @type {number} */ greatest) => {
  if (shown.value === "strain") return { factor: 1e6, unit: "µm/m", digits: 0 };
  if (greatest < 0.1) return { factor: 1000, unit: "mm", digits: 0 };
  return greatest < 2 ? { factor: 100, unit: "cm", digits: 0 } : { factor: 1, unit: "m", digits: 1 };
};
const traces = {
  wind: new Trace(element("wind-trace"), 4, "--blue", speedUnit),
  tip: new Trace(element("tip-trace"), 0.02, "--green", shownUnit),
};
const link = readLink(location.hash);
/** @type {Scene | null} */
let scene = null;
/** @type {"connecting" | "open" | "lost"} */
let line = "connecting";
let retryAt = 0;
let lastFrameAt = 0;
let bytes = 0;
let frames = 0;
let drawn = 0;
let factsAt = performance.now();
let fps = 0;
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
    if (isFirst && link.settings.branch) pick(Number(link.settings.branch));
    showLeaves();
    element("name").textContent = description.name;
    document.title = `${description.name} – tree sway`;
    element("trees").textContent = description.trees.length.toLocaleString("en");
    element("segments").textContent = description.nSegments.toLocaleString("en");
    const models = new Set(description.kinds.map(({ model }) => modelName(model)));
    element("model").textContent = [...models].join(", ");
    const error = Math.max(...description.kinds.map((kind) => kind.basis_error));
    element("model").title = `± ${(1000 * error).toFixed(1)} mm`;
    pick(scene?.picked ?? -1);
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
  },
}, { kept, byWind: new URLSearchParams(location.search).has("solve") });

const { connection, playout } = stream;
const hands = scene && new Hands({ scene, stream }, toast);
const panel = new Panel(element("controls"), (name, value) => stream.set(name, value));

/** @returns {["live" | "paused" | "behind" | "empty" | "connecting" | "lost", string]} */
function stateNow() {
  const age = performance.now() - lastFrameAt;
  if (line === "lost") return ["lost", word("lost")];
  if (line === "connecting") return ["connecting", word("connecting")];
  if (!connection.description) return ["empty", word("empty")];
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
  const label = element("state-text");
  if (label.textContent !== text) label.textContent = text;
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
  element("notice-title").textContent = title;
  element("notice-text").textContent = text;
  element("retry").hidden = !canRetry;
}

/** @param {string} text */
function toast(text) {
  const box = element("toast");
  box.textContent = text;
  box.hidden = false;
  clearTimeout(toastTimer);
  toastTimer = setTimeout(() => (box.hidden = true), 6000);
}

function showFacts() {
  const now = performance.now();
  const span = (now - factsAt) / 1000;
  if (span < FACTS_EVERY / 1000) return;
  fps = drawn / span;
  const leftOut = scene?.leftOut;
  element("drawn").textContent = `${Math.round(fps)} fps${leftOut ? ` · ${leftOut.leaves} % ❧` : ""}`;
  element("drawn").title = leftOut ? word("left_out", leftOut.pixels, leftOut.leaves) : "";
  element("stream").textContent = `${Math.round(frames / span)} Hz, ${(bytes / span / 1000).toFixed(1)} kB/s`;
  const { corrections = 0, largest = 0 } = stream.byWind ?? {};
  element("stream").title = stream.byWind ? word("corrected", corrections, (100 * largest).toFixed(2)) : "";
  const half = connection.roundTrip / 2;
  const latency = Number.isFinite(half) ? half + Math.max(0, playout.lateness) : NaN;
  element("latency").textContent = Number.isFinite(latency)
    ? `${latency.toFixed(0)} + ${playout.delay} ms`
    : "–";
  element("latency").title = "On the way, and delayed so that the motion is smooth";
  if (status.model && status.trees === 1) element("model").textContent = modelName(status.model);
  if (status.rate) element("rate").textContent = `${status.rate.toFixed(0)} Hz, ${(status.work_us / 1000).toFixed(2)} ms`;
  [bytes, frames, drawn, factsAt] = [0, 0, 0, now];
  showState();
  const [x, y] = playout.wind;
  element("wind-now").textContent = `${Math.hypot(...playout.wind).toFixed(1)} m/s ${windFrom(x, y)}`;
  const { mean, greatest } = traces.wind.statistics;
  element("gust").textContent = word("gust", mean.toFixed(1), greatest.toFixed(1));
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
  scene.wind = playout.wind;
  if (!playout.isPaused) sceneTime += Math.min(now - lastDrawn, 100) / 1000;
  lastDrawn = now;
  scene.draw(coordinates, sceneTime, playout.isPaused);
  drawn += 1;
  hands?.frame({ scene, stream });
  if (coordinates && stateNow()[0] === "live") {
    const [at, rest] = [scene.tip(), scene.restTip()];
    const isStrain = shown.value === "strain";
    const value = isStrain ? scene.load().strain : Math.hypot(...at.map((each, c) => each - rest[c]));
    traces.wind.add(now / 1000, Math.hypot(...playout.wind));
    traces.tip.add(now / 1000, value);
    const { factor, unit } = shownUnit(value);
    element("tip-now").textContent = `${(factor * value).toFixed(unit === "m" ? 2 : 0)} ${unit}`;
  }
  showFacts();
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

function toggleLeaves() {
  if (scene?.hasLeaves) {
    scene.leavesShown = !scene.leavesShown;
    scene.repaint();
  }
  showLeaves();
}

/** The button says what is: a tree that was started bare has no leaves to show. */
function showLeaves() {
  const button = /** @type {HTMLButtonElement} */ (element("leaves"));
  const hasLeaves = Boolean(scene?.hasLeaves);
  button.disabled = !hasLeaves;
  button.setAttribute("aria-pressed", String(hasLeaves && scene?.leavesShown));
  button.title = word(hasLeaves ? "leaves" : "bare");
}

function toggleSeason() {
  if (!scene) return;
  scene.setAutumn(!scene.isAutumn);
  element("season").setAttribute("aria-pressed", String(scene.isAutumn));
}

/** @param {number} branch to follow; the highest if -1 */
function pick(branch) {
  if (!scene) return;
  const names = scene.watchedKind?.branch_names ?? [];
  const isOne = Number.isInteger(branch) && branch >= 0 && branch < names.length;
  scene.picked = isOne ? branch : -1;
  element("branch").textContent = isOne ? names[branch] : word("tallest");
  traces.tip.least = shown.value === "strain" ? 1e-4 : 0.02;
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
  const dialog = /** @type {HTMLDialogElement} */ (element("keys"));
  if (!dialog.open) dialog.showModal();
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

const takePicture = () => scene && savePicture(scene, connection.description?.name ?? "tree",
  () => scene?.draw(null, sceneTime, true));

/** @type {Record<string, () => void>} what keys and buttons do */
const actions = {
  home: () => scene?.camera.home(),
  leaves: toggleLeaves,
  theme: nextDay,
  season: toggleSeason,
  picture: takePicture,
  link: copyLink,
  full: toggleFull,
  help: showHelp,
  retry: () => stream.open(),
  close: () => /** @type {HTMLDialogElement} */ (element("keys")).close(),
};
for (const [id, action] of Object.entries(actions)) element(id).addEventListener("click", action);
/** @type {Record<string, () => void>} */
const keys = {
  t: nextDay, l: toggleLeaves, a: toggleSeason, p: takePicture, k: copyLink, f: toggleFull, "?": showHelp,
  m: () => scene && (scene.hasPerson = !scene.hasPerson),
  " ": () => element("control-pause")?.click(),
  "[": () => pickNext(-1), "]": () => pickNext(1), escape: () => pick(-1),
};
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
element("language").addEventListener("change", (event) =>
  speak(/** @type {HTMLSelectElement} */ (event.target).value));
element("keys").addEventListener("click", (event) => {
  if (event.target === element("keys")) actions.close();
});

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
if (scene) scene.flutters = !calm.matches;
calm.addEventListener("change", () => scene && (scene.flutters = !calm.matches));
if (scene && settings.leaves === "false") scene.leavesShown = false;
if (settings.autumn === "true") toggleSeason();
if (settings.shown === "strain") shown.value = "strain";
speak(settings.lang ?? navigator.language.slice(0, 2));
/** @type {HTMLDetailsElement} */ (element("panel")).open = window.innerWidth > 700;
scene?.camera.listen(canvas);
if (kept || !document.getElementById("scene")) stream.open();
requestAnimationFrame(draw);

/** For tests and for the curious at the console. */
Object.assign(window, {
  treeSway: {
    stream,
    connection,
    playout,
    traces,
    hands,
    get scene() {
      return scene;
    },
    get fps() {
      return fps;
    },
    get state() {
      return stateNow()[0];
    },
    get status() {
      return status;
    },
  },
});
