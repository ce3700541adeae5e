// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Controls as the server describes them: sliders, choices, buttons; a refusal puts them back. */

import { hasWord, windFrom, word } from "./words.js";

const SEND_EVERY = 80;
const STEPS = 400;

/**
 * @typedef {object} Control
 * @property {string} name
 * @property {string} label
 * @property {string} description
 * @property {string} unit
 * @property {number | string | boolean | null} value
 * @property {number | null} minimum
 * @property {number | null} maximum
 * @property {string[]} choices
 * @property {boolean} is_action
 */

/** How a number is shown and put on a slider. */
class Scale {
  /** @param {Control} control */
  constructor(control) {
    this.low = control.minimum ?? 0;
    this.high = control.maximum ?? 1;
    this.unit = control.unit;
    this.isBearing = control.name === "bearing_to";
    this.isAngle = control.unit === "rad";
    this.isLog = this.low > 0 && this.high / this.low > 1000;
  }

  /** @param {number} value */
  toSlider(value) {
    const share = this.isLog
      ? Math.log(value / this.low) / Math.log(this.high / this.low)
      : (value - this.low) / (this.high - this.low);
    return Math.round(STEPS * share);
  }

  /** @param {number} slider */
  toValue(slider) {
    const share = slider / STEPS;
    if (this.isLog) return this.low * (this.high / this.low) ** share;
    return Math.min(this.high, this.low + share * (this.high - this.low));
  }

  /** @param {number} value */
  text(value) {
    if (this.isBearing) return windFrom(Math.sin(value), Math.cos(value));
    if (this.isAngle) return `${Math.round((value * 180) / Math.PI)}°`;
    if (this.unit === "m" && value < 0.1) return `${Number((1000 * value).toPrecision(2))} mm`;
    return `${Number(value.toPrecision(2))} ${this.unit}`.trim();
  }
}

/** @param {Control} control */
function labelOf(control) {
  return hasWord(control.name) ? word(control.name) : control.label;
}

export class Panel {
  /** @param {HTMLElement} form @param {(name: string, value: any) => void} send */
  constructor(form, send) {
    this.form = form;
    this.send = send;
    /** @type {Map<string, (value: any) => void>} */
    this._show = new Map();
    /** @type {string} the one that is being moved */
    this._inHand = "";
  }

  /** @param {Control[]} controls */
  build(controls) {
    this._show.clear();
    const buttons = document.createElement("div");
    buttons.className = "buttons";
    const fields = [];
    for (const control of controls) {
      if (control.is_action || typeof control.value === "boolean") {
        buttons.append(this._button(control));
      } else {
        fields.push(control.choices.length ? this._choice(control) : this._slider(control));
      }
    }
    this.form.replaceChildren(...fields, buttons);
  }

  /** Show values that hold now.
   * @param {Record<string, any>} values
   * @param {boolean} [isRefusal] whether also those in hand are put back */
  update(values, isRefusal = false) {
    for (const [name, value] of Object.entries(values)) {
      if (isRefusal || name !== this._inHand) this._show.get(name)?.(value);
    }
  }

  /** @param {Control} control @param {HTMLElement} input */
  _field(control, input) {
    const field = document.createElement("div");
    field.className = "field";
    const label = document.createElement("label");
    input.id = `control-${control.name}`;
    input.title = control.description;
    label.htmlFor = input.id;
    label.append(labelOf(control));
    const shown = document.createElement("span");
    label.append(shown);
    field.append(label, input);
    return { field, shown };
  }

  /** @param {Control} control */
  _slider(control) {
    const scale = new Scale(control);
    const input = document.createElement("input");
    input.type = "range";
    input.min = "0";
    input.max = String(STEPS);
    const { field, shown } = this._field(control, input);
    let timer = 0;
    const show = (/** @type {number} */ value) => {
      shown.textContent = scale.text(value);
      input.setAttribute("aria-valuetext", scale.text(value));
    };
    input.addEventListener("input", () => {
      this._inHand = control.name;
      show(scale.toValue(Number(input.value)));
      clearTimeout(timer);
      timer = setTimeout(() => this.send(control.name, scale.toValue(Number(input.value))), SEND_EVERY);
    });
    input.addEventListener("change", () => setTimeout(() => (this._inHand = ""), 600));
    this._show.set(control.name, (value) => {
      input.value = String(scale.toSlider(value));
      show(value);
    });
    this._show.get(control.name)?.(control.value);
    return field;
  }

  /** @param {Control} control */
  _choice(control) {
    const input = document.createElement("select");
    for (const choice of control.choices) {
      const option = document.createElement("option");
      option.value = choice;
      option.textContent = choice;
      input.append(option);
    }
    const { field } = this._field(control, input);
    input.addEventListener("change", () => this.send(control.name, input.value));
    this._show.set(control.name, (value) => (input.value = value));
    this._show.get(control.name)?.(control.value);
    return field;
  }

  /** @param {Control} control */
  _button(control) {
    const button = document.createElement("button");
    button.type = "button";
    button.id = `control-${control.name}`;
    button.textContent = labelOf(control);
    button.title = control.description;
    if (control.is_action) {
      button.addEventListener("click", () => this.send(control.name, null));
      return button;
    }
    const show = (/** @type {boolean} */ value) => button.setAttribute("aria-pressed", String(value));
    button.addEventListener("click", () => {
      this.send(control.name, button.getAttribute("aria-pressed") !== "true");
    });
    this._show.set(control.name, show);
    show(Boolean(control.value));
    return button;
  }
}
