// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
// Gusts on their way over the ground: `node --test test/page/gusts.test.mjs`.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Gusts, PLACES } from "../../tree_sway/page/static/drawing/gusts.js";

const MEAN = 5;
const REACH = 40;
/** Distance downwind of each place [m]. */
const FAR = Array.from({ length: PLACES }, (_, i) => REACH * ((2 * i) / (PLACES - 1) - 1));

/** Wind of 5 m/s with a gust of 10 m/s from 8 s to 9 s, that the page has seen up to a time. @param {number} until */
function gustsUntil(until) {
  const gusts = new Gusts();
  for (let time = 0; time <= until; time += 1 / 60) gusts.add(time, time >= 8 && time < 9 ? 10 : MEAN);
  return gusts;
}

/** Middle of the places where it blows harder than the mean [m]. @param {Gusts} gusts */
function front({ speeds }) {
  const hard = FAR.filter((_, i) => speeds[i] > 0.5 * (MEAN + 10));
  return hard.reduce((sum, far) => sum + far, 0) / hard.length;
}

test("a gust that has passed goes on downwind by the mean wind", () => {
  const gusts = gustsUntil(12);
  gusts.spread(12, MEAN, REACH);
  assert.ok(Math.abs(front(gusts) - MEAN * (12 - 8.5)) < 2, String(front(gusts)));
  gusts.spread(14, MEAN, REACH);
  assert.ok(Math.abs(front(gusts) - MEAN * (14 - 8.5)) < 2);
});

test("a gust that is known to come is upwind; of a measured wind nobody knows", () => {
  const gusts = gustsUntil(5);
  gusts.spread(5, MEAN, REACH);
  assert.ok(gusts.speeds.every((speed) => Math.abs(speed - MEAN) < 1e-6));
  gusts.foresee(5, { every: 0.5, speeds: Array.from({ length: 20 }, (_, i) => (i >= 6 && i < 8 ? 10 : MEAN)) });
  gusts.spread(5, MEAN, REACH);
  assert.ok(Math.abs(front(gusts) + MEAN * 3.25) < 2, String(front(gusts)));
  gusts.foresee(5);
  gusts.spread(5, MEAN, REACH);
  assert.ok(gusts.speeds.every((speed) => Math.abs(speed - MEAN) < 1e-6));
});

test("a clock that goes back or far ahead forgets", () => {
  const gusts = gustsUntil(12);
  gusts.add(1000, MEAN);
  gusts.add(3, MEAN);
  gusts.spread(3, MEAN, REACH);
  assert.ok(gusts.speeds.every((speed) => Number.isFinite(speed)));
});
