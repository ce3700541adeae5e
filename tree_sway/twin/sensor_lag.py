# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
By how much a sensor is late, from its lean in slow gusts and that of the model.

Below a quarter of its first frequency a tree leans with the wind, whatever its wood. What the
model has of that, x, reaches the sensor, y, with a turn and a gain b, less of it the faster, and
a lag t::

    y(f) = b exp(-a |f| - 2 pi i f t) x(f) + n(f)

for east and north as one complex number, whose spectra have both signs of f. The noise n is what
the wind does not tell, its spectrum S that of what is left. Of all lags the likeliest one has the
largest (Knapp & Carter 1976, IEEE Transactions on Acoustics, Speech, and Signal Processing 24,
320-327, with this law in place of a measured coherence)::

    L(t) = |sum y x* g / S|^2 / sum |x g|^2 / S,    g = exp(-a |f| - 2 pi i f t)

L is the logarithm of the likelihood over that of a motion that has nothing of the model's.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Complexes, Floats

_SLOW = 0.25
"""Fastest frequency that is compared, over the first one of the tree [-]."""

_STEP, _OVER = 0.05, 20.0
"""Step from one lag to the next [s], and least time that is compared over the longest lag [-]."""

_CHANCE, _LONG = 8.0, 180.0
"""
Evidence that 3 of 100 motions without anything in common have, and time [s] from which less of it
tells them: a tree 12 m away from its anemometer has 15 to 60 by then.
"""

_LOSSES = (2.0, 5.0, 10.0, 20.0, 40.0)
"""Values of a in [s]: an anemometer 12 m away loses 11 s in 7 m/s."""

_NONE, _SURE = 0.4, 4.5
"""
Largest lag [s] that is none, by which the wind expected at a tree errs itself (`far_wind`); and
least logarithm of the likelihood of one over that of none, 3 standard deviations.
"""

_PER_SECOND = 4.0
"""Samples in which motion is averaged before it is compared, per second."""

_FEWEST, _MANY = 32, 48
"""Numbers of lines of the spectra from which they are compared, and from which they tell a lag."""

_TAPERED = 0.1
_PASSES = 3


class SensorLag(NamedTuple):
    """
    Lag of a sensor behind its model.

    Parameters
    ----------
    seconds, error
        The likeliest lag, and its standard deviation [s].
    evidence
        Logarithm of its likelihood over that of a motion that has nothing of the model's.
    over_none
        The same over that of any lag that is none.
    motion
        Time in [s] that was compared.
    turn
        Angle from east to north by which it is turned from the model [rad].
    n_lines
        Number of lines of the spectra that were compared.

    """

    seconds: float = 0.0
    error: float = np.inf
    evidence: float = 0.0
    over_none: float = 0.0
    motion: float = 0.0
    turn: float = 0.0
    n_lines: int = 0

    @property
    def turn_error(self) -> float:
        """
        Standard deviation of the turn [rad].

        It is 1.4 times that of the likelihood's curvature: the noise is found of the same lines.
        """
        is_known = self.evidence > _CHANCE and self.n_lines >= _MANY
        return self.evidence**-0.5 if is_known else np.inf

    @property
    def is_by_chance(self) -> bool:
        """Whether the motion has nothing of the model's, long enough for that to be known."""
        return self.evidence < _CHANCE and self.motion >= _LONG

    @property
    def is_sure(self) -> bool:
        """Whether the lag is believed."""
        is_beyond_chance = self.evidence > _CHANCE and self.n_lines >= _MANY
        return self.over_none > _SURE and is_beyond_chance

    def __str__(self) -> str:
        side = 'after' if self.seconds > 0.0 else 'before'
        return f'its motion comes {abs(self.seconds):.1f} s (+- {self.error:.1f}) {side}'


def sensor_lag(
    sensed: Floats,
    model: Floats,
    frequency: float,
    dt: float,
    *,
    longest: float = 4.0,
    none: float = 0.0,
) -> SensorLag:
    """
    Find by how much a sensor is behind a model, whose first frequency is given in [Hz].

    Motions are to east and north at equal steps of dt [s], (n, 2). One that is too short tells
    nothing. Lags are looked for up to the longest [s]; those up to ``none`` [s]
    beyond those of the wind are none.
    """
    block = max(round(1.0 / (_PER_SECOND * dt)), 1)
    lines = [_lines(rows, block) for rows in (sensed, model)]
    period = len(sensed) // block * block * dt
    slow = np.arange(1, int(_SLOW * frequency * period) + 1)
    slow = slow[slow < len(lines[0]) // 2]
    if 2 * len(slow) < _FEWEST:
        return SensorLag()
    # Bins of both signs: the last ones of a transform are those below 0.
    bins = np.concatenate([slow, -slow])
    hertz = bins / period
    y, x = (each[bins] for each in lines)
    most = round(min(longest, period / _OVER) / _STEP)
    lags = _STEP * np.arange(-most, most + 1)
    back = np.exp(2j * np.pi * hertz * lags[:, None])
    power = np.square(np.abs(y))
    for _ in range(_PASSES):
        noise = _smoothed(np.abs(bins), power)
        found = [_likelihood(y, x * np.exp(-a * np.abs(hertz)), noise, back) for a in _LOSSES]
        best = int(np.argmax([each.max() for each, _ in found]))
        likelihood, gain = found[best]
        at = int(np.argmax(likelihood))
        told = gain[at] * x * np.exp(-_LOSSES[best] * np.abs(hertz)) * back[at].conj()
        power = np.square(np.abs(y - told))
    near = lags[likelihood > likelihood[at] - 0.5]
    return SensorLag(
        float(lags[at]),
        float(0.5 * (near[-1] - near[0]) + _STEP),
        float(likelihood[at]),
        float(likelihood[at] - likelihood[np.abs(lags) <= _NONE + none].max()),
        period,
        float(np.angle(gain[at])),
        len(bins),
    )


def _lines(rows: Floats, block: int) -> Complexes:
    """Spectrum of a motion (n, 2), averaged in blocks, faded in and out, of both signs."""
    count = len(rows) // block
    averages = rows[: count * block].reshape(count, block, 2).mean(axis=1)
    both = averages[:, 0] + 1j * averages[:, 1]
    fade = np.minimum((np.arange(count) + 0.5) / (_TAPERED * count), 1.0)
    fade = 0.5 - 0.5 * np.cos(np.pi * np.minimum(fade, fade[::-1]))
    return np.asarray(np.fft.fft((both - both.mean()) * fade))


def _smoothed(bins: Floats, power: Floats) -> Floats:
    """Average powers over a third of their frequency about it, and three bins at least."""
    width = np.maximum(2.5, 0.3 * bins)
    near = np.abs(bins[:, None] - bins) <= width[:, None]
    return np.asarray(near @ power / near.sum(axis=1))


def _likelihood(
    y: Complexes, x: Complexes, noise: Floats, back: Complexes
) -> tuple[Floats, Complexes]:
    """Logarithm of the likelihood at each lag, (l,), and the turn and gain there."""
    size = float((np.square(np.abs(x)) / noise).sum())
    gain = back @ (y * x.conj() / noise) / max(size, 1e-300)
    return np.square(np.abs(gain)) * size, gain
