// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** What the page shows around its picture: state, facts, traces, buttons, controls; and the picture, frame by frame. */

import { DAYLIGHT } from "./drawing/backdrop.js";
import { notice, write } from "./notices.js";
import { element, made, Panel } from "./panel.js";
import { distance } from "./quaternions.js";
import { Risk } from "./risk.js";
import { Trace } from "./trace.js";
import { language, sentences, setLanguage, windFrom, windSource, word } from "./words.js";

/** Interval at which numbers are written [ms]. */
const FACTS_EVERY = 400;
/** Drawings per second below which every other frame is left to the visitor's camera. */
const FEW = 25;
const DAYS = /** @type {(keyof typeof DAYLIGHT)[]} */ (Object.keys(DAYLIGHT));

/** A whole number in groups of three digits, apart by a thin space as in French: a comma or point is a decimal one elsewhere.
 * @param {number} count */
const grouped = (count) => count.toLocaleString("fr");

/** Name of a model for people. @param {string} model */
const modelName = (model) => (/^\d+(\/\d+)?$/.test(model) ? word("coordinates", model) : model);

export class View {
  /** @type {Hands} */
  hands = { drag: null, sound: null, headset: null, film: null };
  /** @type {HTMLSelectElement} */
  shown = element("shown");
  traces = { wind: new Trace(element("wind-trace"), "wind"), tip: new Trace(element("tip-trace"), "motion") };
  /** @type {(() => void) | null} */
  endClip = null;
  /** Segment that was clicked; -1 if the branch was picked in another way. */
  pointedAt = -1;
  fps = 0;
  /** Time of the drawing [s], which stops while the tree is paused. */
  time = 0;
  day = DAYS[0];
  _lastDrawn = 0;
  /** Whether the last frame was left to the camera. */
  _skips = false;
  /** Bytes and frames received, and pictures drawn, since numbers were last written, and the time of that. */
  _since = { bytes: 0, frames: 0, drawn: 0, at: performance.now() };

  /** @param {import("./drawing/scene.js").Scene} scene @param {import("./client.js").TreeStream} stream
   * @param {import("./state.js").PageState} state */
  constructor(scene, stream, state) {
    this.scene = scene;
    this.stream = stream;
    this.state = state;
    this.risk = new Risk(scene);
    this.panel = new Panel(element("controls"), (name, value) => stream.set(name, value));
    const { camera, canvas } = scene;
    const cell = /** @type {HTMLElement} */ (canvas.parentElement);
    camera.room = () => {
      const { left, top, right, bottom } = cell.getBoundingClientRect();
      const { clientWidth: width, clientHeight: height } = canvas;
      return [left / width, top / height, right / width, bottom / height];
    };
    // Fit the scene between the cards, unless someone has moved the camera.
    new ResizeObserver(() => camera.isHome && camera.home()).observe(cell);
  }

  get treeName() {
    return this.stream.description?.name ?? "tree";
  }

  /** Show a scene that has come. @param {Description} description */
  describe({ name, trees, nSegments, kinds }) {
    const models = new Set(kinds.map(({ model }) => modelName(model)));
    const counts = { trees: grouped(trees.length), segments: grouped(nSegments) };
    const error = Number((1000 * Math.max(...kinds.map((kind) => kind.basis_error))).toPrecision(2));
    write({ name, ...counts, model: [...models].join(", "), error: word("up_to", `${error} mm`) });
    document.title = `${name} – tree sway`;
    this.showButtons();
    this.showPanel();
    this.risk.show();
  }

  /** Count a frame that has come. @param {number} size [bytes] */
  count(size) {
    this._since.bytes += size;
    this._since.frames += 1;
  }

  showState() {
    const { state, stream } = this;
    const [name, text] = state.now(stream);
    element("state").dataset.state = name;
    // Changes would go nowhere.
    element("controls").inert = state.line !== "open";
    write({ "state-text": text });
    const seconds = Math.max(0, Math.ceil((state.retryAt - performance.now()) / 1000));
    if (name === "lost") notice(text, word("again", seconds), true);
    else if (name === "empty") notice(text, word("soon"));
    else if (name !== "connecting") element("notice").hidden = true;
    else if (!stream.description) notice(text, word("seeking"));
  }

  /** Show the controls. */
  showPanel() {
    this.panel.build(this.state.controls);
    this.hideIdle();
  }

  /** Hide the controls that have no effect. */
  hideIdle() {
    const { panel, stream: { description }, state: { status } } = this;
    panel.hide("tolerance", !description?.kinds.some(({ model }) => model === "auto"));
    for (const name of ["height", "individual", "month"]) panel.hide(name, !status.is_grown);
    // Without a measured stem an age says nothing.
    panel.hide("age", !status.is_grown || !status.stem_of);
    panel.note("age", status.stem_of ? `${word("age_of")} ${status.stem_of} (McPherson 2016)` : "");
  }

  /** List what packages add to the facts. @param {Record<string, string>} facts */
  listAdded(facts) {
    element("facts").querySelectorAll(".added").forEach((each) => each.remove());
    const rows = Object.entries(facts).map(([name, value]) =>
      made("div", { className: "added" }, made("dt", {}, name), made("dd", {}, value)));
    element("facts").append(...rows);
  }

  /** Show what the camera sees, while its fold is open. */
  async showCamera() {
    if (!/** @type {HTMLDetailsElement} */ (element("camera")).open) return;
    const answer = await fetch("camera.jpg", { headers: { "X-Requested-With": "page" } }).catch(() => undefined);
    if (answer?.status !== 200) return;
    const picture = await createImageBitmap(await answer.blob());
    /** @type {HTMLCanvasElement} */
    const canvas = element("seen");
    [canvas.width, canvas.height] = [picture.width, picture.height];
    canvas.getContext("2d")?.drawImage(picture, 0, 0);
  }

  _showFacts() {
    const { scene, stream, state: { status }, traces, _since: since } = this;
    const { connection, playout } = stream;
    const now = performance.now();
    const span = (now - since.at) / 1000;
    if (span < FACTS_EVERY / 1000) return;
    this.fps = since.drawn / span;
    const { leftOut } = scene.quality;
    const { corrections = 0, largest = 0 } = stream.byWind ?? {};
    element("drawn").title = leftOut ? word("left_out", leftOut.pixels, leftOut.leaves) : "";
    element("stream").title = stream.byWind ? word("corrected", corrections, (100 * largest).toFixed(2)) : "";
    const latency = connection.roundTrip / 2 + Math.max(0, playout.lateness);
    const gusts = traces.wind.statistics;
    const delay = Math.round(playout.delay);
    element("latency").title = word("latency_of_what", Number.isFinite(latency) ? latency.toFixed(0) : "–", delay);
    write({
      drawn: `${Math.round(this.fps)} fps${leftOut ? ` · ${leftOut.leaves} % ❧` : ""}`,
      stream: `${Math.round(since.frames / span)} Hz, ${(since.bytes / span / 1000).toFixed(1)} kB/s`,
      latency: Number.isFinite(latency) ? `${(latency + delay).toFixed(0)} ms` : "–",
      "wind-now": playout.isWindLost ? "–" : `${Math.hypot(...playout.wind).toFixed(1)} m/s ${windFrom(playout.wind)}`,
      source: windSource(status.wind),
      sensors: sentences(status.motion?.said),
      warnings: (status.warnings ?? []).join("; "),
      "band-of": status.motion?.band && this._showsTip ? word("band") : "",
      gust: gusts ? word("gust", gusts.mean.toFixed(1), gusts.greatest.toFixed(1)) : "",
      ...(status.model && status.trees === 1 && { model: modelName(status.model) }),
      ...(status.rate && { rate: `${status.rate.toFixed(0)} Hz, ${(status.work_us / 1000).toFixed(2)} ms` }),
    });
    Object.assign(since, { bytes: 0, frames: 0, drawn: 0, at: now });
    this.showState();
    for (const trace of Object.values(traces)) trace.draw();
  }

  /** Whether the trace is that of the highest tip, which the band is about. */
  get _showsTip() {
    return this.shown.value === "motion" && this.scene.picked < 0;
  }

  /** Draw the tree of now, with its traces and facts. @param {number} now [ms] */
  draw(now) {
    const { scene, stream, state, traces, hands } = this;
    const { playout } = stream;
    if (hands.headset?.session) return;
    // Pictures of the camera come with the frames, and without a graphics unit a frame waits for the drawing before it.
    if (hands.film?.video && this.fps < FEW && (this._skips = !this._skips)) return;
    const coordinates = stream.sample();
    const isStill = playout.isPaused || playout.back > 0;
    scene.wind = playout.wind;
    if (!isStill) this.time += Math.min(now - this._lastDrawn, 100) / 1000;
    this._lastDrawn = now;
    scene.draw(coordinates, this.time, isStill);
    this._since.drawn += 1;
    if (coordinates) {
      const at = scene.position(), speed = Math.hypot(...playout.wind);
      hands.drag?.frame();
      hands.sound?.follow(speed, scene.leavesShown && scene.hasLeaves, at);
      const value = { motion: distance(at, scene.restPosition()), ...scene.load() }[this.shown.value] ?? 0;
      if (state.now(stream)[0] === "live") {
        traces.wind.add(now / 1000, playout.isWindLost ? NaN : speed);
        traces.tip.add(now / 1000, value, this._showsTip ? state.status.motion?.band : undefined);
      }
      write({ "tip-now": traces.tip.textOf(value) });
    }
    this._showFacts();
  }

  /** Light the scene. @param {string} [time] of day, the next one if left out; another word changes nothing */
  setDay(time = DAYS[(DAYS.indexOf(this.day) + 1) % DAYS.length]) {
    this.day = DAYS.find((each) => each === time) ?? this.day;
    document.documentElement.dataset.theme = this.day === "dark" ? "dark" : "light";
    this.scene.day = DAYLIGHT[this.day];
  }

  /** Show the state of each button; a bare tree has no leaves to show, and glTF holds one tree. */
  showButtons() {
    const { hasLeaves, leavesShown, isAutumn: season, description } = this.scene;
    const [pull, sound, headset] = [this.hands.drag?.isOn, this.hands.sound?.isOn, this.hands.headset?.session];
    const pressed = { leaves: hasLeaves && leavesShown, season, clip: this.endClip, pull, sound, headset, "own-camera": this.hands.film?.video };
    for (const [id, isSo] of Object.entries(pressed)) element(id).setAttribute("aria-pressed", String(Boolean(isSo)));
    Object.assign(element("leaves"), { disabled: !hasLeaves, title: word(hasLeaves ? "leaves" : "bare") });
    const isStand = (description?.trees.length ?? 1) > 1;
    Object.assign(element("glb"), { disabled: isStand, title: word(isStand ? "glb_of_one" : "glb") });
  }

  /** Follow a branch. @param {number} branch the highest if -1 @param {number} [segment] that was clicked */
  pick(branch, segment = -1) {
    const names = this.scene.watched.kind?.branch_names ?? [];
    this.scene.picked = names[branch] === undefined ? -1 : branch;
    write({ branch: names[branch] ?? word("tallest") });
    this.pointedAt = segment;
    element("sensor-here").hidden = segment < 0 || !this.state.control("sensor_at");
    this.traces.tip.show(this.shown.value);
  }

  /** Follow another branch. @param {number} step 1 for the next, -1 for the one before */
  pickNext(step) {
    const count = this.scene.watched.kind?.branch_names.length ?? 0;
    if (count) this.pick((this.scene.picked + step + count) % count);
  }

  /** Show the past. @param {number} back [s] */
  goBack(back) {
    this.stream.playout.lookBack(1000 * back);
    for (const trace of Object.values(this.traces)) trace.back = back;
    element("time").setAttribute("aria-valuetext", this.state.now(this.stream)[1]);
    this.showState();
  }

  /** Change the language of the page. @param {string} chosen */
  speak(chosen) {
    setLanguage(chosen);
    /** @type {HTMLSelectElement} */ (element("language")).value = language();
    element("keys-list").replaceChildren(...word("keys").split("|").map((text) => made("li", {}, text)));
    this.showPanel();
    this.risk.show();
    element("error").parentElement?.setAttribute("title", word("error_of_what"));
    this.showButtons();
    this.pick(this.scene.picked);
    this.showState();
  }
}
