// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Controls as the server describes them: sliders, choices, texts, buttons; a refusal resets them. */

import { language, windPoint, word, wordOr } from "./words.js";

/** Least interval between two values of a slider [ms]. */
const SEND_EVERY = 80;
/** Positions of a slider. */
const STEPS = 400;
/** Ratio of the ends of a range from which on its slider is logarithmic. */
const WIDE = 1000;

/** An element of the page. @template {HTMLElement} T its kind, which the caller knows @param {string} id @returns {T} */
export const element = (id) => /** @type {any} */ (document.getElementById(id));

/** Make an element with properties and children. @template {keyof HTMLElementTagNameMap} T @param {T} tag
 * @param {Record<string, any>} properties @param {...(Node | string)} within */
export function made(tag, properties, ...within) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...within);
  return element;
}

/** @param {Control} control */
const nameOf = ({ name, label }) => wordOr(name, label);
/** @param {Control} control */
const named = ({ name, description }) => ({ id: `control-${name}`, title: wordOr(`${name}_hint`, description) });

/** A number with its unit as text. @param {Control} control @param {number} value */
function textOf({ name, unit }, value) {
  if (name === "bearing_to") return windPoint([Math.sin(value), Math.cos(value)]);
  if (name === "month") {
    return new Date(2001, Math.min(11, Math.floor(value) - 1), 15).toLocaleString(language(), { month: "long" });
  }
  if (name === "age") return value < 1 ? word("age_usual") : `${Math.round(value)}`;
  if (unit === "rad") return `${Math.round((value * 180) / Math.PI)}°`;
  if (unit === "m" && value < 0.1) return `${Number((1000 * value).toPrecision(2))} mm`;
  return `${Number(value.toPrecision(unit === "s" ? 4 : 2))} ${unit}`.trim();
}

/** Range of a slider, and the values of its positions. @param {Control} control
 * @returns {{min: number, max: number, step: number, valueOf: (at: number) => number, positionOf: (value: number) => number}} */
function scaleOf({ name, minimum, maximum }) {
  const low = minimum ?? 0, high = maximum ?? 1;
  // The slider shows degrees that the wind comes from; the value is the angle that it blows to.
  if (name === "bearing_to") {
    return {
      min: 0, max: 360, step: 1,
      valueOf: (at) => ((at + 180) % 360) * (Math.PI / 180),
      positionOf: (value) => Math.round((value * 180) / Math.PI + 900) % 360,
    };
  }
  const isWide = low > 0 && high / low > WIDE;
  const [min, max] = isWide ? [0, Math.log(high / low)] : [low, high];
  return {
    min, max, step: (max - min) / STEPS,
    valueOf: (at) => Math.min(high, isWide ? low * Math.exp(at) : at),
    positionOf: (value) => (isWide ? Math.log(value / low) : value),
  };
}

export class Panel {
  /** @type {Map<string, (value: any) => void>} */
  _show = new Map();
  /** Name of the control that is being moved; its value is not overwritten. @type {string} */
  _inHand = "";

  /** @param {HTMLElement} form @param {(name: string, value: any) => void} send */
  constructor(form, send) {
    this.form = form;
    this.send = send;
  }

  /** @param {Control[]} controls */
  build(controls) {
    this._show.clear();
    const isButton = (/** @type {Control} */ { is_action: isAction, value }) => isAction || typeof value === "boolean";
    const fields = controls.filter((each) => !isButton(each)).map((each) =>
      each.choices.length || typeof each.value === "string" ? this._text(each) : this._slider(each));
    const buttons = controls.filter(isButton).map((each) => this._button(each));
    this.form.replaceChildren(...fields, made("div", { className: "buttons" }, ...buttons));
    for (const { name, value } of controls) this._show.get(name)?.(value);
  }

  /** Show values. @param {Record<string, any>} values @param {boolean} [isRefusal] resets also the one being moved */
  update(values, isRefusal = false) {
    for (const [name, value] of Object.entries(values)) {
      if (isRefusal || name !== this._inHand) this._show.get(name)?.(value);
    }
  }

  /** Hide a control that has no effect now. @param {string} name @param {boolean} isHidden */
  hide(name, isHidden) {
    const field = this._fieldOf(name);
    if (field) field.hidden = isHidden;
  }

  /** @param {string} name @returns {HTMLElement | null | undefined} */
  _fieldOf(name) {
    return this.form.querySelector(`#control-${name}`)?.closest(".field");
  }

  /** Write a note under a control. @param {string} name @param {string} text */
  note(name, text) {
    const field = this._fieldOf(name);
    if (!field) return;
    const note = field.querySelector("small") ?? field.appendChild(made("small", { id: `note-${name}` }));
    if (note.textContent === text) return;
    note.textContent = text;
    field.querySelector("input")?.setAttribute("aria-describedby", note.id);
  }

  /** @param {Control} control @param {HTMLElement} input @param {Node} [shown] its value as text */
  _field(control, input, shown = made("span", {})) {
    return made("div", { className: "field" }, made("label", { htmlFor: input.id }, nameOf(control), shown), input);
  }

  /** @param {Control} control */
  _slider(control) {
    const { name } = control;
    const { min, max, step, valueOf: valueAt, positionOf } = scaleOf(control);
    const input = made("input", { ...named(control), type: "range", min, max, step });
    const valueOf = () => valueAt(Number(input.value));
    const shown = made("span", {});
    const show = (/** @type {number} */ value) => {
      shown.textContent = textOf(control, value);
      input.setAttribute("aria-valuetext", textOf(control, value));
    };
    let timer = 0;
    input.oninput = () => {
      this._inHand = name;
      show(valueOf());
      clearTimeout(timer);
      // The value of now: until it is sent, one from the server may have moved the slider back.
      const value = valueOf();
      timer = setTimeout(() => this.send(name, value), SEND_EVERY);
    };
    input.onchange = () => setTimeout(() => (this._inHand = ""), 600);
    this._show.set(name, (value) => {
      input.value = String(positionOf(value));
      show(value);
    });
    return this._field(control, input, shown);
  }

  /** A text, or one of some. @param {Control} control */
  _text(control) {
    const options = control.choices.map((value) => made("option", { value }, value.replaceAll("_", " ")));
    const input = options.length ? made("select", named(control), ...options)
      : made("input", { ...named(control), type: "text", maxLength: 40 });
    input.onchange = () => this.send(control.name, input.value);
    this._show.set(control.name, (value) => (input.value = value));
    return this._field(control, input);
  }

  /** @param {Control} control */
  _button(control) {
    const button = made("button", { ...named(control), type: "button" }, nameOf(control));
    let isOn = false;
    button.onclick = () => this.send(control.name, control.is_action ? null : !isOn);
    if (!control.is_action) this._show.set(control.name, (value) => button.setAttribute("aria-pressed", String(isOn = Boolean(value))));
    return button;
  }
}
