// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Sound of the wind: air whose pitch rises with its speed, and leaves that rustle as they move. */

/** Speeds at which air and leaves are loudest [m/s]. */
const LOUD_AIR = 18, LOUD_LEAVES = 10;
/** Time constant of the sound [s]. */
const FOLLOWS = 0.15;

export class Sound {
  context = new AudioContext();
  isOn = false;
  _tip = [0, 0, 0];
  _at = 0;

  constructor() {
    const { context } = this;
    const noise = context.createBuffer(1, 4 * context.sampleRate, context.sampleRate);
    const samples = noise.getChannelData(0);
    for (let i = 0; i < samples.length; i++) samples[i] = 2 * Math.random() - 1;
    this.out = context.createGain();
    this.out.connect(context.destination);
    const voice = (/** @type {BiquadFilterType} */ type, /** @type {number} */ frequency) => {
      const source = new AudioBufferSourceNode(context, { buffer: noise, loop: true });
      const filter = new BiquadFilterNode(context, { type, frequency, Q: 0.8 });
      const gain = new GainNode(context, { gain: 0 });
      source.connect(filter).connect(gain).connect(this.out);
      // Each voice starts at another place of the noise.
      source.start(0, 4 * Math.random());
      return { filter, gain };
    };
    this._air = voice("bandpass", 200);
    this._leaves = voice("highpass", 2500);
  }

  toggle() {
    this.isOn = !this.isOn;
    return this.isOn ? this.context.resume() : this.context.suspend();
  }

  /** Follow the wind and the motion of a tip. @param {number} wind [m/s] @param {boolean} hasLeaves @param {number[]} tip [m] */
  follow(wind, hasLeaves, tip) {
    const { currentTime: now } = this.context;
    const motion = Math.hypot(...tip.map((each, c) => each - this._tip[c])) / Math.max(0.001, now - this._at);
    this._tip = tip;
    this._at = now;
    const air = Math.min(1, wind / LOUD_AIR);
    const leaves = hasLeaves ? Math.min(1, (wind + 2 * motion) / LOUD_LEAVES) : 0;
    this._air.gain.gain.setTargetAtTime(0.5 * air ** 2, now, FOLLOWS);
    this._air.filter.frequency.setTargetAtTime(120 + 500 * air, now, FOLLOWS);
    this._leaves.gain.gain.setTargetAtTime(0.08 * leaves ** 1.5, now, FOLLOWS);
  }
}
