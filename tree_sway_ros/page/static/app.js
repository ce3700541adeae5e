// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The page: what comes over the line onto the screen, what hands do back onto the line. */

import { TreeStream } from "./client.js";
import { Panel } from "./panel.js";
import { LOOKS, Scene } from "./scene.js";
import { Trace } from "./trace.js";

/** The newest state may be so old before the page says that it is behind [ms]. */
const BEHIND = 1000;
const FACTS_EVERY = 400;

/**
 * @template {HTMLElement} [T=HTMLElement]
 * @param {string} id
 * @returns {T}
 */
const element = (id) => /** @type {T} */ (document.getElementById(id));

const canvas = /** @type {HTMLCanvasElement} */ (element("view"));
const traces = {
  wind: new Trace(element("wind-trace"), 4, "--blue"),
  tip: new Trace(element("tip-trace"), 0.02, "--green"),
};
/** @type {Scene | null} */
let scene = null;
/** @type {"connecting" | "open" | "lost"} */
let line = "connecting";
let retryAt = 0;
/** @type {number[]} */
let tipAtRest = [0, 0, 0];
let lastFrameAt = 0;
let bytes = 0;
let frames = 0;
let drawn = 0;
let factsAt = performance.now();
let fps = 0;
/** Time that leaves flutter by [s]; it stands still with the tree. */
let sceneTime = 0;
let lastDrawn = 0;
/** @type {Record<string, any>} */
let status = {};
let toastTimer = 0;

try {
  scene = new Scene(canvas);
} catch (error) {
  notice("This browser cannot draw the tree", String(error), false);
}

const stream = new TreeStream(location.href, {
  onState(state, retryIn) {
    line = state;
    retryAt = performance.now() + retryIn;
    showState();
  },
  onDescription(description) {
    scene?.describe(description);
    if (scene) tipAtRest = scene.tip();
    element("name").textContent = description.name;
    document.title = `${description.name} – tree sway`;
    element("segments").textContent = description.nSegments.toLocaleString("en");
    element("model").textContent = [...new Set(description.kinds.map((kind) => kind.model))].join(", ");
    traces.tip.clear();
    showState();
  },
  onFrame(_frame, _arrival, size) {
    lastFrameAt = performance.now();
    bytes += size;
    frames += 1;
  },
  onMessage(message) {
    if (message.hello) {
      panel.build(message.hello.controls);
      element("panel").hidden = message.hello.controls.length === 0;
    }
    if (message.refused) toast(message.refused.reason);
    if (message.unreadable) toast(message.unreadable);
    if (message.values) panel.update(message.values, Boolean(message.refused));
    if (message.status) status = message.status;
  },
});

const { connection, playout } = stream;
const panel = new Panel(element("controls"), (name, value) => stream.set(name, value));

/** @returns {["live" | "paused" | "behind" | "empty" | "connecting" | "lost", string]} */
function stateNow() {
  const age = performance.now() - lastFrameAt;
  if (line === "lost") return ["lost", "Connection lost"];
  if (line === "connecting") return ["connecting", "Connecting"];
  if (!connection.description) return ["empty", "No tree yet"];
  if (!lastFrameAt || age > BEHIND) {
    return ["behind", lastFrameAt ? `Behind by ${(age / 1000).toFixed(1)} s` : "Waiting for motion"];
  }
  if (status.building) return ["behind", "Building…"];
  return playout.isPaused ? ["paused", "Paused"] : ["live", "Live"];
}

function showState() {
  const [state, text] = stateNow();
  const chip = element("state");
  if (chip.dataset.state !== state) chip.dataset.state = state;
  const label = element("state-text");
  if (label.textContent !== text) label.textContent = text;
  if (!scene) return;
  if (state === "lost") {
    const seconds = Math.max(0, Math.ceil((retryAt - performance.now()) / 1000));
    notice("Connection lost", `Trying again in ${seconds} s.`, true);
  } else if (state === "connecting" && !connection.description) {
    notice("Connecting", "Looking for the solver.", false);
  } else if (state === "empty") {
    notice("No tree yet", "The server has not described one. It will appear here.", false);
  } else if (state !== "connecting") {
    element("notice").hidden = true;
  }
}

/**
 * @param {string} title
 * @param {string} text
 * @param {boolean} canRetry
 */
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
  const leftOut = scene?.leftOut ?? "";
  element("drawn").textContent = `${Math.round(fps)} fps${leftOut && ", coarser"}`;
  element("drawn").title = leftOut;
  element("stream").textContent = `${Math.round(frames / span)} Hz, ${(bytes / span / 1000).toFixed(1)} kB/s`;
  const half = connection.roundTrip / 2;
  const latency = Number.isFinite(half) ? half + Math.max(0, playout.lateness) : NaN;
  element("latency").textContent = Number.isFinite(latency)
    ? `${latency.toFixed(0)} + ${playout.delay} ms`
    : "–";
  element("latency").title = "On the way, and held back so that the motion is smooth";
  if (status.model) element("model").textContent = status.model;
  if (status.rate) element("rate").textContent = `${status.rate.toFixed(0)} Hz, ${(status.work_us / 1000).toFixed(2)} ms`;
  [bytes, frames, drawn, factsAt] = [0, 0, 0, now];
  showState();
  const speed = Math.hypot(...playout.wind);
  element("wind-now").textContent = `${speed.toFixed(1)} m/s ${bearing(playout.wind)}`;
  traces.wind.draw();
  traces.tip.draw();
}

/**
 * Where the wind comes from, as people say it.
 *
 * @param {number[]} wind
 */
function bearing(wind) {
  if (Math.hypot(wind[0], wind[1]) < 0.05) return "";
  const names = ["N", "NE", "E", "SE", "S", "SW", "W", "NW"];
  const from = Math.atan2(-wind[0], -wind[1]);
  return `from ${names[((Math.round((from / Math.PI) * 4) % 8) + 8) % 8]}`;
}

/** @param {number} now */
function draw(now) {
  requestAnimationFrame(draw);
  if (!scene) return;
  const coordinates = stream.sample();
  scene.wind = playout.wind;
  if (!playout.isPaused) sceneTime += Math.min(now - lastDrawn, 100) / 1000;
  lastDrawn = now;
  scene.draw(coordinates, sceneTime, playout.isPaused);
  drawn += 1;
  if (coordinates && stateNow()[0] === "live") {
    const at = scene.tip();
    const moved = Math.hypot(at[0] - tipAtRest[0], at[1] - tipAtRest[1], at[2] - tipAtRest[2]);
    traces.wind.add(now / 1000, Math.hypot(...playout.wind));
    traces.tip.add(now / 1000, moved);
    element("tip-now").textContent = moved < 0.1 ? `${(1000 * moved).toFixed(0)} mm` : `${(100 * moved).toFixed(0)} cm`;
  }
  showFacts();
}

/** @param {"light" | "dark"} theme */
function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  if (scene) scene.look = LOOKS[theme];
}

function toggleTheme() {
  setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark");
}

function toggleLeaves() {
  if (!scene) return;
  scene.leavesShown = !scene.leavesShown;
  element("leaves").setAttribute("aria-pressed", String(scene.leavesShown));
}

const dark = window.matchMedia("(prefers-color-scheme: dark)");
setTheme(dark.matches ? "dark" : "light");
dark.addEventListener("change", () => setTheme(dark.matches ? "dark" : "light"));
/** @type {HTMLDetailsElement} */ (element("panel")).open = window.innerWidth > 700;
element("theme").addEventListener("click", toggleTheme);
element("leaves").addEventListener("click", toggleLeaves);
element("home").addEventListener("click", () => scene?.camera.home());
element("retry").addEventListener("click", () => stream.open());
document.addEventListener("keydown", (event) => {
  const target = /** @type {HTMLElement} */ (event.target);
  if (target.closest("input, select, button, summary") || event.ctrlKey || event.metaKey) return;
  if (event.key === "t" || event.key === "T") toggleTheme();
  else if (event.key === "l" || event.key === "L") toggleLeaves();
  else if (event.key === " ") element("control-pause")?.click();
});
scene?.camera.listen(canvas);
stream.open();
requestAnimationFrame(draw);

/** For tests and for the curious at the console. */
Object.assign(window, {
  treeSway: {
    stream,
    connection,
    playout,
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
