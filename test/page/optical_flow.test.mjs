// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
// Points followed through pictures of a texture whose motion is known: `node --test test/page/optical_flow.test.mjs`.
import assert from "node:assert/strict";
import { test } from "node:test";
import { OpticalFlow } from "../../tree_sway/page/static/optical_flow.js";

const [WIDTH, HEIGHT] = [640, 480];
/** Waves of a texture, along x and y [rad/px] and their phase: it is known between pixels as well. */
const WAVES = Array.from({ length: 12 }, (_, k) => {
  const [turn, length] = [2.4 * k, 9 + 3.5 * k];
  return [(2 * Math.PI * Math.cos(turn)) / length, (2 * Math.PI * Math.sin(turn)) / length, 1.7 * k];
});
/** @param {number} x @param {number} y */
const brightness = (x, y) => WAVES.reduce((sum, [a, b, phase]) => sum + 9 * Math.sin(a * x + b * y + phase), 120);

/** A picture of the texture, moved by some pixels. @param {number} dx @param {number} dy @param {number} [brighter]
 * @param {(x: number, y: number) => number | undefined} [hidden] what is before it */
function picture(dx, dy, brighter = 0, hidden = () => undefined) {
  const pixels = new Uint8ClampedArray(4 * WIDTH * HEIGHT);
  for (let y = 0, at = 0; y < HEIGHT; y++) {
    for (let x = 0; x < WIDTH; x++, at += 4) pixels.fill(hidden(x, y) ?? brighter + brightness(x - dx, y - dy), at, at + 4);
  }
  return pixels;
}

/** Places on a grid. @param {number} spacing [px] */
function grid(spacing) {
  const places = [];
  for (let y = 60; y < HEIGHT - 60; y += spacing) for (let x = 60; x < WIDTH - 60; x += spacing) places.push([x, y]);
  return places;
}

/** Largest distance of the points from where they should be [px]. @param {OpticalFlow} flow @param {Float64Array} found
 * @param {number} dx @param {number} dy */
const worst = ({ points }, found, dx, dy) => points.reduce((most, each, i) => Math.max(most, Math.abs(each - found[i] - (i % 2 ? dy : dx))), 0);

test("a texture that moves by a known part of a pixel is followed to 0.05 px, far motion from the last place", () => {
  const flow = new OpticalFlow(WIDTH, HEIGHT, picture(0, 0), grid(40));
  const found = flow.points.slice();
  assert.equal(found.length, 80);
  for (const [dx, dy] of [[0, 0], [0.3, -0.2], [0.81, 0.47], [-2.35, 1.6], [-7.1, 4.45], [-13.3, 9.2]]) {
    assert.equal(flow.follow(picture(dx, dy)), 1, `moved by ${dx}, ${dy}`);
    const error = worst(flow, found, dx, dy);
    assert.ok(error < 0.05, `moved by ${dx}, ${dy}: ${error} px`);
  }
});

test("a picture that a camera takes brighter or darker moves nothing", () => {
  const flow = new OpticalFlow(WIDTH, HEIGHT, picture(0, 0), grid(40));
  const found = flow.points.slice();
  for (const brighter of [-10, 10]) {
    assert.equal(flow.follow(picture(1.3, -0.6, brighter)), 1);
    const error = worst(flow, found, 1.3, -0.6);
    assert.ok(error < 0.04, `${error} px`);
  }
});

test("points that something hides are lost, and found again behind it", () => {
  const flow = new OpticalFlow(WIDTH, HEIGHT, picture(0, 0), grid(40));
  const found = flow.points.slice();
  const stripes = (/** @type {number} */ x, /** @type {number} */ y) => (x < 300 ? 120 + 80 * Math.sin(0.9 * x + 0.4 * y * y) : undefined);
  flow.follow(picture(0.5, 0.25, 0, stripes));
  let hidden = 0;
  for (let i = 0; i < found.length; i += 2) {
    if (found[i] < 290) hidden += Number(!Number.isNaN(flow.points[i]));
    if (found[i] > 315) assert.ok(Math.abs(flow.points[i] - found[i] - 0.5) < 0.04, `point at ${found[i]}`);
  }
  assert.ok(hidden <= 1, `${hidden} points were seen that are hidden`);
  assert.equal(flow.follow(picture(0.75, 0)), 1);
  assert.ok(worst(flow, found, 0.75, 0) < 0.04);
});

test("an edge along which everything looks alike, and an even wall, give no points", () => {
  const edge = new Uint8ClampedArray(4 * WIDTH * HEIGHT);
  for (let i = 0; i < edge.length; i++) edge[i] = (i / 4) % WIDTH < 320 ? 40 : 200;
  for (const pixels of [edge, edge.slice().fill(90)]) {
    const flow = new OpticalFlow(WIDTH, HEIGHT, pixels, [[320, 200], [322, 300], [100, 100], [2, 2], [NaN, 5]]);
    assert.equal(flow.points.length, 0);
    assert.equal(flow.follow(pixels), 0);
  }
});

test("a picture takes no new memory, and a time that is told", () => {
  const pictures = [picture(0, 0), picture(1.2, 0.4), picture(-0.7, 1.1)];
  const flow = new OpticalFlow(WIDTH, HEIGHT, pictures[0], grid(120).slice(0, 12));
  assert.equal(flow.points.length, 24);
  for (let i = 0; i < 30; i++) flow.follow(pictures[i % 3]);
  const before = process.cpuUsage();
  const { points } = flow;
  for (let i = 0; i < 90; i++) flow.follow(pictures[i % 3]);
  const { user } = process.cpuUsage(before);
  assert.equal(flow.points, points);
  console.log(`12 points of 640 x 480: ${(user / 90 / 1000).toFixed(2)} ms a picture`);
});
