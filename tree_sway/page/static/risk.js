// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Colours trees by a storm: its mean wind at 10 m against the interval of the critical wind of each tree. */

import { element, made } from "./panel.js";
import { word } from "./words.js";

/** Colours of a wind below the band, within it and above it, for any eye (Okabe & Ito 2008). */
const COLORS = { below: [0, 0.45, 0.7], within: [0.9, 0.62, 0], above: [0.84, 0.25, 0] };
const UNKNOWN = [0.6, 0.6, 0.6];
/** Opacity of the colours. */
const SHARE = 0.8;
const KM_H = 3.6;

/** Whether a wind is below, within or above an interval. @param {number} wind [m/s]
 * @param {[number, number]} band low and high end [m/s] @returns {keyof typeof COLORS} */
function placeIn(wind, [low, high]) {
  if (wind < low) return "below";
  return wind > high ? "above" : "within";
}

export class Risk {
  /** @type {Record<string, [number, number]>} bands by the names of trees [m/s] */
  bands = {};
  /** @type {HTMLInputElement} */
  slider = element("storm");

  /** @param {Scene} scene */
  constructor(scene) {
    this.scene = scene;
    this.slider.oninput = () => this.show();
  }

  /** Take the bands of trees, or none. @param {Record<string, [number, number]> | null | undefined} bands */
  take(bands) {
    this.bands = bands ?? {};
    this.show();
  }

  /** Paint the trees, and count them. */
  show() {
    const storm = Number(this.slider.value);
    const places = (this.scene.description?.trees ?? []).map(({ name }) => this.bands[name] && placeIn(storm, this.bands[name]));
    const isShown = places.some(Boolean);
    element("risk").hidden = !isShown;
    element("facts").hidden = isShown; // there is room for one of them
    this.scene.paint(isShown ? places.map((place) => [...place ? COLORS[place] : UNKNOWN, SHARE]) : []);
    if (!isShown) return;
    const speed = `${storm} m/s, ${Math.round(KM_H * storm)} km/h`;
    element("storm-now").textContent = speed;
    this.slider.setAttribute("aria-valuetext", speed);
    const kinds = Object.entries({ ...COLORS, unknown: UNKNOWN });
    const rows = kinds.map(([kind, color]) => {
      const count = places.filter((place) => (place ?? "unknown") === kind).length;
      const swatch = made("i", {});
      swatch.style.background = `rgb(${color.map((each) => 255 * each).join(" ")})`;
      return made("li", { hidden: kind === "unknown" && !count }, swatch, word(`risk_${kind}`, count));
    });
    element("risk-counts").replaceChildren(...rows);
  }
}
