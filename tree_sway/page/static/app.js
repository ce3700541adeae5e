// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The page: its state, its view and its commands, and the stream that they share. */

import { TreeStream } from "./client.js";
import { listen } from "./commands.js";
import { Scene } from "./drawing/scene.js";
import { readLink } from "./keepsake.js";
import { giveUp, toast } from "./notices.js";
import { keptScene } from "./own_line.js";
import { element } from "./panel.js";
import { PageState } from "./state.js";
import { View } from "./view.js";
import { language, setLanguage, word } from "./words.js";

const { settings, view: seen } = readLink(location.hash);
/** Address of this page with the token of the stream. The token leaves the address bar, since people pass that on;
 * a cookie keeps it for the next time. */
const address = new URL(location.href);
const query = address.searchParams;
const barAddress = new URL(address);
barAddress.searchParams.delete("token");
history.replaceState(null, "", barAddress);

setLanguage(settings.lang ?? navigator.language.slice(0, 2));
const kept = await keptScene().catch((error) => giveUp(word("damaged"), word("write_again", error.message)));
/** @type {HTMLCanvasElement} */
const canvas = element("view");
// In full quality nothing is left out, even without a graphics unit.
const scene = await (async () => new Scene(canvas, query.get("quality") === "full"))()
  .catch((error) => giveUp(word("blind"), word("cure", error.message)));
const state = new PageState(kept !== null);
const stream = new TreeStream(address.href, {
  onState(line, retryIn) {
    state.line = line;
    state.retryAt = performance.now() + retryIn;
    view.showState();
  },
  onDescription(description) {
    const isFirst = !scene.description;
    scene.describe(description);
    if ((isFirst || state.isFollowing) && seen) scene.camera.set(seen);
    state.isFollowing = false;
    view.describe(description);
    view.pick(isFirst && settings.branch ? Number(settings.branch) : scene.picked);
    view.showState();
  },
  onFrame(_frame, _arrival, size) {
    state.lastFrameAt = performance.now();
    view.count(size);
  },
  onMessage({ hello, refused, unreadable, values, status, film }) {
    const { panel, risk, hands } = view;
    if (hello) {
      state.controls = hello.controls;
      state.viewersToken = hello.viewers_token ?? "";
      view.showPanel();
      element("panel").hidden = hello.controls.length === 0;
      element("pull").hidden = hello.can_pull !== true;
      risk.take(hello.critical_winds);
      element("camera").hidden = hello.has_camera !== true;
      element("own-camera").hidden = element("camera-known").hidden = hello.can_film !== true;
      hands.film?.send();
      const missed = state.follow(stream, settings);
      if (missed.length) toast(word("of_link", missed.join(", ")));
    }
    if (film) hands.film?.take(film);
    if (refused?.name === "film") hands.film?.end();
    if (refused || unreadable) toast(unreadable ?? refused.reason);
    if (values) {
      scene.flower(Number(values.month));
      for (const control of state.controls) control.value = values[control.name] ?? control.value;
      panel.update(values, Boolean(refused));
    }
    if (status) {
      state.status = status;
      view.hideIdle();
      view.listAdded(status.facts ?? {});
      view.showCamera();
      scene.grass.gusts.foresee(view.time, status.wind_ahead);
    }
    if (Number.isFinite(state.status.record_time)) panel.update({ record_time: state.status.record_time });
  },
}, { kept, byWind: query.has("solve") });
const view = new View(scene, stream, state);

/** Follow a preference of the browser. @param {string} what @param {(isSo: boolean) => void} take */
function prefers(what, take) {
  const found = window.matchMedia(`(prefers-${what})`);
  found.onchange = () => take(found.matches);
  take(found.matches);
}

prefers("color-scheme: dark", (isDark) => view.setDay(isDark ? "dark" : "light"));
prefers("reduced-motion: reduce", (isCalm) => (scene.flutters = !isCalm));
if (settings.day) view.setDay(settings.day);
scene.dress({ leavesShown: settings.leaves !== "false", isAutumn: settings.autumn === "true" });
if ([...view.shown.options].some(({ value }) => value === settings.shown)) view.shown.value = settings.shown;
// A page that is a file already is its own export.
for (const id of ["glb", "html"]) element(id).hidden = state.isOwn;
listen(view, query.get("token"));
view.speak(language());
/** @type {HTMLDetailsElement} */ (element("panel")).open = window.innerWidth > 700 && window.innerHeight > 560;
stream.open();
requestAnimationFrame(function draw(now) {
  requestAnimationFrame(draw);
  view.draw(now);
});

/** For tests, and for the console. */
Object.assign(window, {
  treeSway: {
    scene, stream, connection: stream.connection, playout: stream.playout,
    traces: view.traces, hands: view.hands, risk: view.risk,
    get fps() { return view.fps; },
    get state() { return state.now(stream)[0]; },
    get status() { return state.status; },
  },
});
