# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
By how much a sensor is late, from its lean in slow gusts and that of the model.

Below a quarter of its first frequency a tree leans with the wind, whatever its wood. What the
model has of that, x, reaches the sensor, y, with a turn and a gain b, less of it the faster, and
a lag t::

    y(f) = b exp(-a |f| - 2 pi i f t) x(f) + n(f)

for east and north as one complex number, whose spectra have both signs of f. The noise n is what
the wind does not tell, its spectrum S(f, t) the mean of what a lag leaves about each line. Of all
lags the likeliest one has the largest (Whittle 1953, Arkiv för Matematik 2, 423-434)::

    L(t) = -sum ln S + |n|^2 / S

less that of a motion that has nothing of the model's.

Across the wind gusts lose what they have in common soon, and the few slow ones that are left seem
to tell more than they can. Of the root coherence g(f) that the law of gusts gives, lags t and 0
differ by 2 g^2 / (1 - g^2) (1 - cos 2 pi f t) in the mean of the logarithm of their likelihood, a
sum over f > 0, as gusts along the wind lean a tree most. A lag is told only where that is enough.

A noise that were the same for all lags, as in a generalised correlation (Knapp & Carter 1976,
IEEE Transactions on Acoustics, Speech, and Signal Processing 24, 320-327), is that of the
likeliest one, and the others seem too unlikely.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Complexes, Floats
from tree_sway.twin.waves import power_of, way_in

_SLOW = 0.25
"""Fastest frequency that is compared, over the first one of the tree [-]."""

_STEP, _OVER = 0.1, 20.0
"""Step from one lag to the next [s], and least time that is compared over the longest lag [-]."""

_CHANCE, _LONG = 8.0, 180.0
"""
Evidence that 3 of 100 motions without anything in common have, and time [s] from which less of it
tells them: a tree 12 m away from its anemometer has 15 to 60 by then.
"""

_EXPECTED = 3.0
"""Least evidence that shared gusts have in the mean, over that of chance, where less tells [-]."""

_LOSSES = (2.0, 5.0, 10.0, 20.0, 40.0)
"""Values of a in [s]: an anemometer 12 m away loses 11 s in 7 m/s."""

_NONE = 0.25
"""Largest lag [s] that is none: gusts do not travel with the mean wind alone."""

_SURE, _OF_FEW = 3.0, 180.0
"""
Least logarithm of the likelihood of a lag over that of none, and what is added to it over the
number of lines: of right sensors 1 in 100 has more within three minutes, 5 within ten.
"""

_ERRORS = 3.0
"""
Least size of a lag over its standard deviation: of four right sensors on a tree 12 m away from its
anemometer, two had 2.1 and 2.6 after 100 s.
"""

_CLEAR, _COMMON, _AWAY = 10.0, 20.0, 1.5
"""
Logarithm of the likelihood of a lag over that of none, its evidence, and its size over its
standard deviation from which it is clear, however short the motion: of right sensors on eleven
drawn trees one had more than 8 of the first, 9.1; of right motions 12 m aside of the wind 1 in 200
has more than all.
"""

_CAN_BE_CLEAR = 1.0
"""Least ``can_differ`` of a lag that is clear."""

_DOUBTED = 0.5
"""Logarithm of the likelihood of a lag over that of none above which a sensor stays left."""

_PER_SECOND = 4.0
"""Samples in which motion is averaged before it is compared, per second."""

_FEWEST, _MANY = 32, 48
"""Numbers of lines of the spectra from which they are compared, and from which they tell a lag."""

_WIDTH, _LEAST_WIDTH = 0.6, 4.5
"""Lines to either side that are averaged to a spectrum, over their number [-], and at least."""

_PASSES = 2


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
    for_own
        Logarithm of the likelihood of no lag over that of the lag for which it was left.
    motion
        Time in [s] that was compared.
    n_lines
        Number of lines of the spectra that were compared.
    can_differ, expected
        Means of ``over_none`` and of ``evidence`` by the law of gusts, infinite without one.

    """

    seconds: float = 0.0
    error: float = np.inf
    evidence: float = 0.0
    over_none: float = 0.0
    motion: float = 0.0
    n_lines: int = 0
    for_own: float = 0.0
    can_differ: float = np.inf
    expected: float = np.inf

    @property
    def is_long(self) -> bool:
        """Whether enough motion was compared for a sensor to be left for what the wind tells."""
        return self.motion >= _LONG

    @property
    def is_clear(self) -> bool:
        """Whether a sensor is left for it, however short the motion that was compared."""
        is_no_chance = self.over_none > _CLEAR and self.evidence > _COMMON
        is_away = abs(self.seconds) > _AWAY * self.error and self.can_differ > _CAN_BE_CLEAR
        return is_no_chance and is_away

    @property
    def is_suspect(self) -> bool:
        """Whether it is likelier than none by enough to be looked at again soon."""
        return self.over_none > _SURE and not self.is_long

    @property
    def is_by_chance(self) -> bool:
        """Whether the motion has nothing of the model's, long enough for that to be known."""
        can_tell = self.is_long and self.expected > _EXPECTED * _CHANCE
        return self.evidence < _CHANCE and can_tell

    @property
    def is_sure(self) -> bool:
        """Whether the lag is believed."""
        is_beyond_chance = self.evidence > _CHANCE and self.n_lines >= _MANY
        least = _SURE + _OF_FEW / max(self.n_lines, 1)
        is_large = abs(self.seconds) > _ERRORS * self.error and self.can_differ > _SURE
        return self.over_none > least and is_beyond_chance and is_large

    @property
    def is_doubtful(self) -> bool:
        """Whether the lag is likelier than none by enough for a sensor to stay left."""
        return self.over_none > _DOUBTED

    @property
    def is_cleared(self) -> bool:
        """Whether its own times are so much likelier that a sensor that was left may return."""
        return not self.is_doubtful and self.for_own > _SURE

    def said_of(self, other: str) -> str:
        """Say why a sensor is left for its times, beside another motion."""
        if self.is_doubtful:
            return f'{self} that of {other}: check its clock'
        return f'its times were off, and those of {other} do not clear it yet: check its clock'

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
    about: float = 0.0,
    none: float = 0.0,
    left_for: float | None = None,
    later: Callable[[Floats], Complexes] | None = None,
) -> SensorLag:
    """
    Find by how much a sensor is behind a model, whose first frequency is given in [Hz].

    Motions are to east and north at equal steps of dt [s], (n, 2). One that is too short tells
    nothing. Lags are looked for up to the longest [s] from the one ``about`` which a right sensor
    is [s]; those up to ``none`` [s] beyond those of the wind are none. ``left_for`` is the lag for
    which it was left [s], None if it was not. ``later`` gives the gusts that model and tree
    share at frequencies [Hz], root coherence and phase over that which the model has of them.
    """
    block = max(round(1.0 / (_PER_SECOND * dt)), 1)
    count = len(sensed) // block
    period = count * block * dt
    slow = np.arange(1, int(_SLOW * frequency * period) + 1)
    slow = slow[slow < count // 2]
    if 2 * len(slow) < _FEWEST:
        return SensorLag()
    # Bins of both signs: the last ones of a transform are those below 0.
    bins = np.concatenate([slow, -slow])
    hertz = bins / period
    y, x = (_lines(rows, block)[bins] for rows in (sensed, model))
    shared = np.ones(len(slow), dtype=np.complex128)
    if later is not None:
        shared = later(hertz[: len(slow)])
        x = x * np.exp(1j * np.angle(np.concatenate([shared, shared.conj()])))
    # By the law of gusts: power that both share over that which they do not, at each f > 0.
    power = np.minimum(power_of(shared), 1.0 - 1e-9)
    common = power / (1.0 - power)
    circular = 2.0 * np.pi * hertz[: len(slow)]
    least_error = max(float(2.0 * common @ np.square(circular)), 1e-300) ** -0.5
    most = round(min(longest, period / _OVER) / _STEP)
    lags = _STEP * np.arange(-most, most + 1)
    back = np.exp(-2j * np.pi * hertz * (about + lags[:, None]))
    share = _near(np.abs(bins))
    noise = share @ power_of(y)

    def told(loss: float) -> Complexes:
        return x * np.exp(-loss * np.abs(hertz)) * back

    loss = max(_LOSSES, key=lambda each: _likelihood(y, told(each), noise))
    likelihood = _over_noise(y, told(loss), share)
    at = np.argmax(likelihood)
    near = lags[likelihood > likelihood[at] - 0.5]
    own = likelihood[np.abs(lags) <= _NONE + none].max()
    for_own = np.inf
    if left_for is not None and abs(left_for) > _NONE + none:
        for_own = own - likelihood[np.argmin(np.abs(lags - left_for))]
    return SensorLag(
        lags[at],
        max(0.5 * (near[-1] - near[0]) + _STEP, least_error),
        likelihood[at],
        likelihood[at] - own,
        period,
        len(bins),
        for_own,
        2.0 * common @ (1.0 - np.cos(circular * lags[at])),
        2.0 * np.log1p(common).sum(),
    )


def _lines(rows: Floats, block: int) -> Complexes:
    """Spectrum of a motion (n, 2), averaged in blocks, faded in and out, of both signs."""
    count = len(rows) // block
    averages = rows[: count * block].reshape(count, block, 2).mean(axis=1)
    both = averages[:, 0] + 1j * averages[:, 1]
    fade = 0.5 - 0.5 * np.cos(np.pi * way_in(count))
    return np.fft.fft((both - both.mean()) * fade)


def _near(bins: Floats) -> Floats:
    """Weights of the lines whose mean is the spectrum about each line, (f, f)."""
    width = np.maximum(_LEAST_WIDTH, _WIDTH * bins)
    near = (np.abs(bins[:, None] - bins) <= width[:, None]).astype(float)
    return near / near.sum(axis=1, keepdims=True)


def _likelihood(y: Complexes, told: Complexes, noise: Floats) -> float:
    """Largest logarithm of the likelihood of what is told at a lag, (l, f), in a known noise."""
    shared = (y * told.conj() / noise).sum(axis=1)
    size = (power_of(told) / noise).sum(axis=1)
    return float((power_of(shared) / np.maximum(size, 1e-300)).max())


def _over_noise(y: Complexes, told: Complexes, share: Floats) -> Floats:
    """Logarithm of the likelihood of each lag with its own noise, (l,)."""
    alone = share @ power_of(y)
    noise = np.broadcast_to(alone, told.shape)
    for _ in range(_PASSES):
        size = (power_of(told) / noise).sum(axis=1)
        gain = (y * told.conj() / noise).sum(axis=1) / np.maximum(size, 1e-300)
        left = power_of(y - gain[:, None] * told)
        noise = left @ share.T
    own = np.log(noise) + left / noise
    return (np.log(alone) + power_of(y) / alone - own).sum(axis=1)
