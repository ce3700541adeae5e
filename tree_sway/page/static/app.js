// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The page: connects the stream to the view, and user input to the stream. */

import { TreeStream } from "./client.js";
import { DAYLIGHT } from "./drawing/backdrop.js";
import { Scene } from "./drawing/scene.js";
import { readLink, recordClip, savePicture, saveTree, viewLink } from "./keepsake.js";
import { keptScene, OwnLine } from "./own_line.js";
import { element, made, Panel } from "./panel.js";
import { distance } from "./quaternions.js";
import { Risk } from "./risk.js";
import { Trace } from "./trace.js";
import { language, motionSensors, setLanguage, windFrom, windSource, word } from "./words.js";

/** Age of the newest frame from which on the stream counts as behind [ms]. */
const BEHIND = 1000;
/** Interval at which numbers are written [ms]. */
const FACTS_EVERY = 400;
/** Largest movement of a pointer in a click [px]. */
const STILL = 4;

/** Write texts that have changed. @param {Record<string, string>} texts by the id of their element */
function write(texts) {
  for (const [id, text] of Object.entries(texts)) {
    if (element(id).textContent !== text) element(id).textContent = text;
  }
}

const canvas = /** @type {HTMLCanvasElement} */ (element("view"));
const shown = /** @type {HTMLSelectElement} */ (element("shown"));
const timeLine = /** @type {HTMLInputElement} */ (element("time"));
const help = /** @type {HTMLDialogElement} */ (element("keys"));
const traces = {
  wind: new Trace(element("wind-trace"), "wind"),
  tip: new Trace(element("tip-trace"), "motion"),
};
const { settings, view } = readLink(location.hash);
/** Address of this page with the token of the stream. The token leaves the address bar, since people pass that on;
 * a cookie keeps it for the next time. */
const address = new URL(location.href);
const query = address.searchParams;
const barAddress = new URL(address);
barAddress.searchParams.delete("token");
history.replaceState(null, "", barAddress);
/** Token for links to this page, which allows looking but no changes. */
let viewersToken = "";
let line = /** @type {"connecting" | "open" | "lost"} */ ("connecting");
let retryAt = 0;
let lastFrameAt = 0;
/** Bytes and frames received, and pictures drawn, since numbers were last written, and the time of that. */
const since = { bytes: 0, frames: 0, drawn: 0, at: performance.now() };
let fps = 0;
/** Time of the drawing [s], which stops while the tree is paused. */
let sceneTime = 0;
let lastDrawn = 0;
let status = /** @type {Record<string, any>} */ ({});
let controls = /** @type {any[]} */ ([]);
let toastTimer = 0;
const days = /** @type {(keyof typeof DAYLIGHT)[]} */ (Object.keys(DAYLIGHT));
let day = days[0];
/** Whether the tree of a link has been asked for and is still to come. */
let isFollowing = false;
/** Controls that say what the tree is: a link carries them. */
const OF_TREE = ["tree", "height", "age", "individual", "month", "model"];
/** Segment that was clicked; -1 if the branch was picked in another way. */
let pointedAt = -1;
let endClip = /** @type {(() => void) | null} */ (null);

setLanguage(settings.lang ?? navigator.language.slice(0, 2));
const kept = await keptScene().catch((error) => giveUp(word("damaged"), word("write_again", error.message)));
// In full quality nothing is left out, even without a graphics unit.
const scene = await (async () => new Scene(canvas, query.get("quality") === "full"))()
  .catch((error) => giveUp(word("blind"), word("cure", error.message)));
const stream = new TreeStream(address.href, {
  onState(state, retryIn) {
    line = state;
    retryAt = performance.now() + retryIn;
    showState();
  },
  onDescription(description) {
    const isFirst = !scene.description;
    scene.describe(description);
    if ((isFirst || isFollowing) && view) scene.camera.set(view);
    isFollowing = false;
    const { name, trees, nSegments, kinds } = description;
    const models = new Set(kinds.map(({ model }) => modelName(model)));
    const counts = { trees: grouped(trees.length), segments: grouped(nSegments) };
    const error = Number((1000 * Math.max(...kinds.map((kind) => kind.basis_error))).toPrecision(2));
    write({ name, ...counts, model: [...models].join(", "), error: word("up_to", `${error} mm`) });
    document.title = `${name} – tree sway`;
    showButtons();
    showPanel();
    risk.show();
    pick(isFirst && settings.branch ? Number(settings.branch) : scene.picked);
    showState();
  },
  onFrame(_frame, _arrival, size) {
    lastFrameAt = performance.now();
    since.bytes += size;
    since.frames += 1;
  },
  onMessage({ hello, refused, unreadable, values, status: newStatus }) {
    if (hello) {
      controls = hello.controls;
      showPanel();
      element("panel").hidden = controls.length === 0;
      fit();
      element("pull").hidden = hello.can_pull !== true;
      viewersToken = hello.viewers_token ?? "";
      risk.take(hello.critical_winds);
      followLink();
    }
    if (refused || unreadable) toast(unreadable ?? refused.reason);
    if (values) {
      scene.flower(Number(values.month));
      for (const control of controls) control.value = values[control.name] ?? control.value;
      panel.update(values, Boolean(refused));
    }
    status = newStatus ?? status;
    if (newStatus) {
      hideIdle();
      listAdded(newStatus.facts ?? {});
      scene.grass.gusts.foresee(sceneTime, newStatus.wind_ahead);
    }
    if (Number.isFinite(status.record_time)) panel.update({ record_time: status.record_time });
  },
}, { kept, byWind: query.has("solve") });

const { connection, playout } = stream;
const risk = new Risk(scene);
const hands = /** @type {Hands} */ ({ drag: null, sound: null, headset: null });
const panel = new Panel(element("controls"), (name, value) => stream.set(name, value));
const treeName = () => connection.description?.name ?? "tree";

/** Show why nothing can be drawn, and stop there. @param {string} title @param {string} text
 * @returns {Promise<never>} */
function giveUp(title, text) {
  notice(title, text);
  return new Promise(() => undefined);
}

/** Ask once for the tree of a link; say what of it cannot be asked for. */
function followLink() {
  const missed = OF_TREE.filter((name) => {
    const control = controls.find((each) => each.name === name);
    if (!(name in settings) || String(control?.value) === settings[name]) return false;
    const value = control && typeof control.value === "number" ? Number(settings[name]) : settings[name];
    const isKnown = control && (control.choices?.length ? control.choices.includes(String(value)) : Number.isFinite(value));
    if (isKnown) stream.set(name, value);
    isFollowing ||= Boolean(isKnown);
    return !isKnown;
  });
  if (missed.length) toast(word("of_link", missed.map((name) => `${word(name)} ${settings[name]}`).join(", ")));
  for (const name of OF_TREE) delete settings[name];
}

/** State of the stream, and its text. @returns {["live" | "paused" | "behind" | "empty" | "connecting" | "lost", string]} */
function stateNow() {
  const age = performance.now() - lastFrameAt;
  if (line !== "open") return [line, word(line)];
  if (!connection.description) return ["empty", word("empty")];
  if (playout.back) return ["paused", word("back", (playout.back / 1000).toFixed(1))];
  if (!lastFrameAt) return ["behind", word("waiting")];
  if (age > BEHIND) return ["behind", word("behind", (age / 1000).toFixed(1))];
  if (status.building) return ["behind", word("building")];
  if (playout.isPaused) return ["paused", word("paused")];
  return ["live", word(kept ? "own" : "live")];
}

function showState() {
  const [state, text] = stateNow();
  element("state").dataset.state = state;
  // Changes would go nowhere.
  element("controls").inert = line !== "open";
  write({ "state-text": text });
  const seconds = Math.max(0, Math.ceil((retryAt - performance.now()) / 1000));
  if (state === "lost") notice(text, word("again", seconds), true);
  else if (state === "empty") notice(text, word("soon"));
  else if (state !== "connecting") element("notice").hidden = true;
  else if (!connection.description) notice(text, word("seeking"));
}

/** Show the controls. */
function showPanel() {
  panel.build(controls);
  hideIdle();
}

/** Hide the controls that have no effect. */
function hideIdle() {
  panel.hide("tolerance", !connection.description?.kinds.some(({ model }) => model === "auto"));
  for (const name of ["height", "individual", "month"]) panel.hide(name, !status.is_grown);
  // Without a measured stem an age says nothing.
  panel.hide("age", !status.is_grown || !status.stem_of);
  panel.note("age", status.stem_of ? `${word("age_of")} ${status.stem_of} (McPherson 2016)` : "");
}

/** List what packages add to the facts. @param {Record<string, string>} facts */
function listAdded(facts) {
  element("facts").querySelectorAll(".added").forEach((each) => each.remove());
  const rows = Object.entries(facts).map(([name, value]) =>
    made("div", { className: "added" }, made("dt", {}, name), made("dd", {}, value)));
  element("facts").append(...rows);
}

/** @param {string} title @param {string} text @param {boolean} [canRetry] */
function notice(title, text, canRetry = false) {
  element("notice").hidden = false;
  write({ "notice-title": title, "notice-text": text });
  element("retry").hidden = !canRetry;
}

/** @param {string} text @param {boolean} [isProblem] @param {boolean} [isLasting] until the next one */
function toast(text, isProblem = true, isLasting = false) {
  write({ toast: text });
  element("toast").classList.toggle("problem", isProblem);
  element("toast").hidden = false;
  clearTimeout(toastTimer);
  if (!isLasting) toastTimer = setTimeout(() => (element("toast").hidden = true), 6000);
}

/** Save the tree as a file, and say that it is being written. @param {"glb" | "html"} suffix */
async function saveFile(suffix) {
  toast(word("writing"), false, true);
  await saveTree(suffix, treeName(), query.get("token"));
  element("toast").hidden = true;
}

function showFacts() {
  const now = performance.now();
  const span = (now - since.at) / 1000;
  if (span < FACTS_EVERY / 1000) return;
  fps = since.drawn / span;
  const { leftOut } = scene.quality;
  const { corrections = 0, largest = 0 } = stream.byWind ?? {};
  element("drawn").title = leftOut ? word("left_out", leftOut.pixels, leftOut.leaves) : "";
  element("stream").title = stream.byWind ? word("corrected", corrections, (100 * largest).toFixed(2)) : "";
  const latency = connection.roundTrip / 2 + Math.max(0, playout.lateness);
  const gusts = traces.wind.statistics;
  const delay = Math.round(playout.delay);
  element("latency").title = word("latency_of_what", Number.isFinite(latency) ? latency.toFixed(0) : "–", delay);
  write({
    drawn: `${Math.round(fps)} fps${leftOut ? ` · ${leftOut.leaves} % ❧` : ""}`,
    stream: `${Math.round(since.frames / span)} Hz, ${(since.bytes / span / 1000).toFixed(1)} kB/s`,
    latency: Number.isFinite(latency) ? `${(latency + delay).toFixed(0)} ms` : "–",
    "wind-now": playout.isWindLost ? "–" : `${Math.hypot(...playout.wind).toFixed(1)} m/s ${windFrom(playout.wind)}`,
    source: windSource(status.wind),
    sensors: motionSensors(status.motion),
    warnings: (status.warnings ?? []).join("; "),
    "band-of": status.motion?.band && shown.value === "motion" && scene.picked < 0 ? word("band") : "",
    gust: gusts ? word("gust", gusts.mean.toFixed(1), gusts.greatest.toFixed(1)) : "",
    ...(status.model && status.trees === 1 && { model: modelName(status.model) }),
    ...(status.rate && { rate: `${status.rate.toFixed(0)} Hz, ${(status.work_us / 1000).toFixed(2)} ms` }),
  });
  Object.assign(since, { bytes: 0, frames: 0, drawn: 0, at: now });
  showState();
  for (const trace of Object.values(traces)) trace.draw();
}

/** Part of the picture that no card covers, as `Camera.room`. */
function room() {
  const [head, lines, form, tools] = ["head", "traces", "panel", "tools"].map((id) => element(id).getBoundingClientRect());
  const [width, height] = [canvas.clientWidth || 1, canvas.clientHeight || 1];
  const isNarrow = head.right > 0.6 * width;
  if (isNarrow) {
    const lowest = [lines, form].filter((each) => each.height).map((each) => each.top);
    return [0, head.bottom / height, 1, Math.min(height, ...lowest) / height];
  }
  const isWall = form.height > 0.3 * height || (form.height > 0 && height < 560);
  const top = !isWall && form.height > 0.12 * height ? form.bottom / height : 0;
  const right = isWall ? form.left : width;
  const left = Math.max(head.right, lines.right);
  // On a tablet there is more room between the two cards on the left than beside them.
  if (right - left < 0.35 * width) return [0, head.bottom / height, right / width, (lines.height ? lines.top : height) / height];
  return [left / width, top, right / width, tools.height ? tools.top / height : 1];
}

/** Fit the scene between the cards, unless someone has moved the camera. */
function fit() {
  if (scene.camera.isHome) scene.camera.home();
}

/** A whole number in groups of three digits, apart by a thin space: a comma or point is a decimal one elsewhere.
 * @param {number} count */
const grouped = (count) => count.toLocaleString("en").replaceAll(",", "\u202f");

/** Name of a model for people. @param {string} model */
const modelName = (model) => (/^\d+(\/\d+)?$/.test(model) ? word("coordinates", model) : model);

/** @param {number} now */
function draw(now) {
  requestAnimationFrame(draw);
  if (hands.headset?.session) return;
  const coordinates = stream.sample();
  const isStill = playout.isPaused || playout.back > 0;
  scene.wind = playout.wind;
  if (!isStill) sceneTime += Math.min(now - lastDrawn, 100) / 1000;
  lastDrawn = now;
  scene.draw(coordinates, sceneTime, isStill);
  since.drawn += 1;
  if (coordinates) {
    const [at, speed] = [scene.position(), Math.hypot(...playout.wind)];
    hands.drag?.frame();
    hands.sound?.follow(speed, scene.leavesShown && scene.hasLeaves, at);
    const value = { motion: distance(at, scene.restPosition()), ...scene.load() }[shown.value] ?? 0;
    if (stateNow()[0] === "live") {
      traces.wind.add(now / 1000, playout.isWindLost ? NaN : speed);
      const isSure = shown.value === "motion" && scene.picked < 0;
      traces.tip.add(now / 1000, value, isSure ? status.motion?.band : undefined);
    }
    write({ "tip-now": traces.tip.textOf(value) });
  }
  showFacts();
}

/** @param {typeof day} time of day */
function setDay(time) {
  day = time;
  document.documentElement.dataset.theme = time === "dark" ? "dark" : "light";
  scene.day = DAYLIGHT[time];
}

/** Show the state of each button; a bare tree has no leaves to show, and glTF holds one tree. */
function showButtons() {
  const { hasLeaves, leavesShown, isAutumn: season } = scene;
  const [pull, sound, headset] = [hands.drag?.isOn, hands.sound?.isOn, hands.headset?.session];
  const pressed = { leaves: hasLeaves && leavesShown, season, clip: endClip, pull, sound, headset };
  for (const [id, isSo] of Object.entries(pressed)) element(id).setAttribute("aria-pressed", String(Boolean(isSo)));
  Object.assign(element("leaves"), { disabled: !hasLeaves, title: word(hasLeaves ? "leaves" : "bare") });
  const isStand = (scene.description?.trees.length ?? 1) > 1;
  Object.assign(element("glb"), { disabled: isStand, title: word(isStand ? "glb_of_one" : "glb") });
}

/** Follow a branch. @param {number} branch the highest if -1 @param {number} [segment] that was clicked */
function pick(branch, segment = -1) {
  const names = scene.watched.kind?.branch_names ?? [];
  scene.picked = names[branch] === undefined ? -1 : branch;
  write({ branch: names[branch] ?? word("tallest") });
  pointedAt = segment;
  element("sensor-here").hidden = segment < 0 || !controls.some(({ name }) => name === "sensor_at");
  traces.tip.show(shown.value);
}

/** Follow another branch. @param {number} step 1 for the next, -1 for the one before */
function pickNext(step) {
  const count = scene.watched.kind?.branch_names.length ?? 0;
  if (count) pick((scene.picked + step + count) % count);
}

async function copyLink() {
  const { leavesShown: leaves, isAutumn: autumn, picked: branch } = scene;
  const tree = controls.filter(({ name }) => OF_TREE.includes(name)).map(({ name, value }) => [name, value]);
  const all = { day, lang: language(), leaves, autumn, shown: shown.value, ...(branch >= 0 && { branch }), ...Object.fromEntries(tree) };
  history.replaceState(null, "", viewLink(scene, all));
  const link = new URL(location.href);
  if (viewersToken) link.searchParams.set("token", viewersToken);
  await navigator.clipboard?.writeText(link.href).catch(() => undefined);
  toast(`${word(viewersToken ? "copied_to_look" : "copied")}: ${link.href}`, false);
}

/** Change the language of the page. @param {string} chosen */
function speak(chosen) {
  setLanguage(chosen);
  /** @type {HTMLSelectElement} */ (element("language")).value = language();
  element("keys-list").replaceChildren(...word("keys").split("|").map((text) => made("li", {}, text)));
  showPanel();
  risk.show();
  element("error").parentElement?.setAttribute("title", word("error_of_what"));
  showButtons();
  pick(scene.picked);
  showState();
}

/** Actions of the buttons, by their ids, and of the keys that their elements name. @type {Record<string, () => unknown>} */
const actions = {
  home: () => scene.camera.home(),
  leaves: () => scene.hasLeaves && scene.dress({ leavesShown: !scene.leavesShown }),
  theme: () => setDay(days[(days.indexOf(day) + 1) % days.length]),
  season: () => scene.dress({ isAutumn: !scene.isAutumn }),
  picture: () => savePicture(scene, treeName(), () => scene.draw(null, sceneTime, true)),
  clip: () => {
    endClip?.();
    endClip = endClip ? null : recordClip(canvas, treeName());
  },
  glb: () => saveFile("glb"),
  html: () => saveFile("html"),
  link: copyLink,
  full: () => (document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen?.()),
  help: () => help.showModal(),
  retry: () => stream.open(),
  close: () => help.close(),
  "sensor-here": () => stream.set("sensor_at", `segment:${pointedAt}`),
  pull: async () => (hands.drag ??= new (await import("./drag.js")).Drag(scene, stream)).toggle(),
  sound: async () => (hands.sound ??= new (await import("./sound.js")).Sound()).toggle(),
  headset: async () => {
    hands.headset ??= new (await import("./headset.js")).Headset(scene, stream);
    await hands.headset.toggle(showButtons);
  },
};
/** @type {Record<string, () => unknown>} */
const keys = {
  m: () => (scene.hasPerson = !scene.hasPerson),
  " ": () => element("control-pause")?.click(),
  "[": () => pickNext(-1), "]": () => pickNext(1), escape: () => pick(-1),
};
for (const [id, action] of Object.entries(actions)) {
  const act = async () => {
    if (/** @type {HTMLButtonElement} */ (element(id)).disabled) return;
    try {
      await action();
    } catch (error) {
      toast(/** @type {Error} */ (error).message);
    }
    showButtons();
  };
  element(id).addEventListener("click", act);
  keys[element(id).dataset.key ?? id] = act;
}
document.addEventListener("keydown", (event) => {
  const target = /** @type {HTMLElement} */ (event.target);
  if (target.closest("input[type='text'], select, dialog") || event.ctrlKey || event.metaKey) return;
  const own = target.matches("button, summary") ? /^( |Enter)$/ : target.matches("input") ? /^(Arrow|Home|End|Page)/ : /^$/;
  if (own.test(event.key)) return;
  // The camera listens to the picture, also while a button that was clicked has the focus.
  if (target !== canvas) canvas.dispatchEvent(new KeyboardEvent("keydown", event));
  else keys[event.key.toLowerCase()]?.();
});
navigator.xr?.isSessionSupported("immersive-vr").then((/** @type {boolean} */ isSo) => (element("headset").hidden = !isSo), () => undefined);
let pressed = [0, 0];
canvas.addEventListener("pointerdown", (event) => (pressed = [event.clientX, event.clientY]));
canvas.addEventListener("click", (event) => {
  if (Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > STILL) return;
  if (!scene.description) return;
  const { branch, segment } = scene.under(event);
  pick(branch, segment);
});
shown.addEventListener("change", () => pick(scene.picked));
timeLine.addEventListener("input", () => {
  playout.back = -1000 * Number(timeLine.value);
  for (const trace of Object.values(traces)) trace.back = -Number(timeLine.value);
  timeLine.setAttribute("aria-valuetext", stateNow()[1]);
  showState();
});
element("language").addEventListener("change", ({ target }) => speak(/** @type {any} */ (target).value));

document.addEventListener("dragover", (event) => event.preventDefault());
document.addEventListener("drop", (event) => {
  event.preventDefault();
  const file = event.dataTransfer?.files[0];
  if (file && connection instanceof OwnLine) connection.take(file).catch((error) => toast(error.message));
});

/** Follow a preference of the browser. @param {string} what @param {(isSo: boolean) => void} take */
function prefers(what, take) {
  const found = window.matchMedia(`(prefers-${what})`);
  found.addEventListener("change", () => take(found.matches));
  take(found.matches);
}

prefers("color-scheme: dark", (isDark) => setDay(isDark ? "dark" : "light"));
prefers("reduced-motion: reduce", (isCalm) => (scene.flutters = !isCalm));
setDay(days.find((each) => each === settings.day) ?? day);
scene.dress({ leavesShown: settings.leaves !== "false", isAutumn: settings.autumn === "true" });
if ([...shown.options].some(({ value }) => value === settings.shown)) shown.value = settings.shown;
// A page that is a file already is its own export.
for (const id of ["glb", "html"]) element(id).hidden = kept !== null;
speak(language());
/** @type {HTMLDetailsElement} */ (element("panel")).open = window.innerWidth > 700 && window.innerHeight > 560;
scene.camera.room = room;
// A button of the bar that the keyboard reaches comes into the bar whole.
element("tools").addEventListener("focusin", ({ target }) => /** @type {Element} */ (target).scrollIntoView({ inline: "center", block: "nearest" }));
// A card grows when its text comes, or its panel is opened.
const sizes = new ResizeObserver(fit);
for (const id of ["head", "traces", "panel", "tools"]) sizes.observe(element(id));
window.addEventListener("resize", () => requestAnimationFrame(fit));
scene.camera.listen(canvas);
stream.open();
requestAnimationFrame(draw);

/** For tests, and for the console. */
Object.assign(window, {
  treeSway: {
    scene, stream, connection, playout, traces, hands, risk,
    get fps() { return fps; },
    get state() { return stateNow()[0]; },
    get status() { return status; },
  },
});
