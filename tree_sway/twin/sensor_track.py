# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One sensor over time: first its mounting is found, then it is in use while it agrees.

Until a sensor has seen the tree sway for 20 s, its samples are compared with the motion that the
model has in the wind alone. From then on its mounting is found again after 1.2 times as long, and
so on, from all motion of the last ten minutes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Complexes, Floats, Ints
from tree_sway.core.native import LIBRARY, NativeSensor
from tree_sway.twin.alignment import (
    align,
    Alignment,
    averaged,
    GRAVITY,
    LEAST_NOISE,
    noise_of,
    TELLS_LITTLE,
)
from tree_sway.twin.late_wind import LONGEST_WAY
from tree_sway.twin.motion_sensor import MotionSensor
from tree_sway.twin.sensor_lag import sensor_lag, SensorLag
from tree_sway.twin.sensor_place import PlaceMotion
from tree_sway.twin.sway_azimuth import Sway
from tree_sway.twin.sway_lever import other_lever
from tree_sway.twin.wind_lag import find_lag

_LEARNING = 20.0
"""Motion in [s] from which the mounting of a sensor is found first."""

_LATER, _MEMORY = 1.2, 600.0
_SOON = 4.0
"""Motion in [s] after which a sensor is looked at again whose times may be wrong."""

_LESS_SURE = 1.5
"""
Error of the azimuth over that before, from which the mounting before is kept. One of other units
must be surer: in a calm noise is 57 times the rate of the tree.
"""
_OTHER = 3.0
"""Angle between two mountings over its error from which they are different ones."""

_ABSENT_AFTER = 1.0
_MEAN_EVERY = 30.0
"""
Time in [s] after which the mean difference from the model is found again: with that of another
wind, or of a battery that was warmer, the tree would lean for an hour as it does not.
"""
_KNOCKED = 5.0
_AS_OFTEN = 1.05
"""Time between samples over the one by which their noise is known, up to which it is followed."""

_COMPARED, _LEAST_COMPARED = 8.0, 3.0
"""
Time in [s], and periods of the first sway at least, over which motions are averaged to find a
mounting: gusts of less are not those of a mast 10 m away.
"""

_LONGEST = 4.0
"""Longest lag of a sensor in [s] that is looked for where the way of the wind is known."""

_NEARER = 0.3
"""
By how much nearer to the model a sensor is than another one [s], from which on it is right: what
the wind at the anemometer errs is common to both.
"""

_MIRRORED = 10.0
"""
Logarithm of the likelihoods from which a lean is believed to be mirrored, as by an acceleration of
the opposite sign: 1 of 100 right ones has 6 after a minute.
"""

_ALIEN = (
    'its lean in gusts has nothing of that of the tree in this wind: check that it is of this '
    'tree and time, or bring the anemometer nearer'
)

_AGAIN = 'it was left, and is followed again: its lean in gusts is that of its own times'

_CEILING = np.array([20.0, 10.0, 3.0])
"""Largest noise that a sensor may state, in the same units: above, it tells nothing."""

ROWS = 12
"""Rows of a sensor: acceleration, its part by tilted gravity, rate and rotation, three of each."""


def sensed_rows(motion: PlaceMotion, stiffness: Floats, damping: Floats) -> Floats:
    """
    Rows of a sensor by displacement, rate and force of coordinates of unit mass, (12, 3 m).

    The specific force that a sensor turned by theta feels beyond gravity is ``a + g z x theta`` in
    the frame of the tree.
    """
    still = np.zeros_like(motion.rotation)
    tilted = GRAVITY * np.stack([-motion.rotation[1], motion.rotation[0], still[0]])
    moved = motion.displacement
    return np.concatenate([
        np.hstack([-moved * stiffness, -moved * damping, moved]),
        np.hstack([tilted, still, still]),
        np.hstack([still, motion.rotation, still]),
        np.hstack([motion.rotation, still, still]),
    ])  # fmt: skip


def as_felt(rows: Floats, *, has_gravity: bool = True) -> Floats:
    """Join the rows (12, ...) of a sensor to acceleration, rate and rotation, (9, ...)."""
    out = rows[3:].copy()
    out[:3] = rows[:3] + (rows[3:6] if has_gravity else 0.0)
    return out


def lean_per_load(motion: PlaceMotion, stiffness: Floats, load: Floats) -> Floats:
    """Tilt of a place by the load of coordinates per wind to east and north, (2, m), (2, 2)."""
    east, north, _ = motion.rotation
    return np.stack([-north, east]) / stiffness @ load.T


class OtherSensor(NamedTuple):
    """
    Another sensor on the tree: its name, its mounting, and its last samples, (n, 9).

    ``about`` is its lag behind the crown by the way of the gusts, ``late`` the one found last [s].
    """

    name: str
    alignment: Alignment
    sensed: Floats
    about: float
    late: float


class LagRange(NamedTuple):
    """
    Earliest and latest lag of the wind in steps, and the least change of it that counts.

    ``about`` and ``none`` are the lag of a sensor that gusts have on their way through the crown,
    and how far from it they may be [s]; ``is_told`` is whether the way of the wind is known: what
    is late then is the sensor. ``left_for`` is the lag for which it was left when it was looked at
    last [s], 0 if it was that of another wind, None if it was followed; ``later`` gives the gusts
    that it shares with its model (`sensor_lag`), ``others`` are further sensors of the tree.
    ``of_wind`` is by how many steps the wind of the model is known to be late, ``is_whole``
    whether it was never silent: beyond a silence the lean of a model seems late for minutes.
    """

    earliest: int
    latest: int
    least: int
    about: float = 0.0
    none: float = 0.0
    is_told: bool = False
    left_for: float | None = None
    later: Callable[[Floats], Complexes] | None = None
    others: tuple[OtherSensor, ...] = ()
    of_wind: int = 0
    is_whole: bool = True


NO_LAG = LagRange(0, 0, 1)
"""Range of a wind whose lag is not in question."""


class FoundMounting(NamedTuple):
    """
    How a sensor is mounted, and its mean difference from the model then, (9,).

    ``lag`` is by how many steps the tree moves later than the model, ``left_for`` the lag
    [s] for which the sensor is not to be followed, 0 if it is that of another wind, and None if it
    is right. ``late`` is its likeliest lag [s], ``is_suspect`` whether to look again soon.
    """

    alignment: Alignment
    bias: Floats
    lag: int = 0
    left_for: float | None = None
    late: float = 0.0
    is_suspect: bool = False


def _mounting(
    sensed: Floats,
    computed: Floats,
    sensor: MotionSensor,
    window: int,
    lags: LagRange,
    sway: Sway,
    samples: tuple[Floats, float],
) -> FoundMounting:
    """
    Find a mounting by motion (n, 9), rows of the model, (12, n), and what is known of the sway.

    Motions are averaged over the steps of a window at most. ``samples`` are the last ones as they
    came, (m, 9), and the steps from one to the next.
    """
    whole = sensed
    now, later = _lagging(-min(lags.of_wind, len(sensed) // 2), len(sensed))
    sensed, computed = sensed[now], computed[:, later]
    upright, free = (as_felt(computed, has_gravity=each).T for each in (True, False))
    known = sensor.reference, min(window, len(sensed) // 2), sensor.place.facing

    def mounted(sign: float) -> Alignment:
        return align(sensed, upright, free, *known, sign, sway, *samples)

    sign = 0.0
    found = mounted(sign)
    model = upright if found.has_gravity else free
    lag = _lag(sensed, model, sway.period, lags, has_gravity=found.has_gravity)
    left = SensorLag()
    if not lag and found.problem != TELLS_LITTLE:
        left = _slow_lag(found.motion(sensed), model, sway, lags)
        if found.has_gravity and np.isfinite(sensed[:, :3]).all():
            # Of opposite sign, a lean is mirrored.
            rival_sign = -math.copysign(1.0, found.scale[0])
            rival = mounted(rival_sign)
            other = _slow_lag(rival.motion(sensed), model, sway, lags)
            if other.evidence > left.evidence + _MIRRORED:
                found, left, sign = rival, other, rival_sign
        steps = round(left.seconds / sway.dt)
        is_of_wind = left.is_sure and lags.earliest <= steps <= lags.latest
        if is_of_wind and abs(steps) >= lags.least:
            lag, left = steps, SensorLag()
    if lag:
        later, earlier = _lagging(lag, len(sensed))
        sensed, upright, free = sensed[later], upright[earlier], free[earlier]
        found = mounted(sign)
    if found.problem:
        lag = 0
    bias = np.zeros(9)
    if not found.problem:
        model = upright if found.has_gravity else free
        moved = found.motion(sensed)
        bias = (moved - model).mean(axis=0)
        pull = GRAVITY * found.has_gravity
        where = other_lever(moved, model, sway.frequency, sway.dt, pull)
        found = replace(found, notes=(*found.notes, *filter(None, [where])))
    left_for: float | None = None
    said = ''
    apart = None if found.problem else _apart(found.motion(whole), sway, lags, left.seconds)
    if apart is not None:
        left_for, said = apart
    elif left.is_by_chance:
        left_for, said = 0.0 if sensor.place.facing is None else None, _ALIEN
    elif (left.is_clear and lags.is_whole) or (
        _is_off(left, lags) and (left.is_long or lags.left_for is not None)
    ):
        left_for = _lag_left_for(left, lags) if lags.is_told else None
        said = left.said_of('the tree in this wind')
    elif lags.left_for is not None and not found.problem:
        said = _AGAIN
    if left_for is not None:
        found = replace(found, problem=found.problem or said)
    elif said:
        found = replace(found, notes=(*found.notes, said))
    is_suspect = left.is_suspect and left_for is None
    return FoundMounting(found, bias, lag, left_for, left.seconds, is_suspect)


def _is_off(found: SensorLag, lags: LagRange) -> bool:
    """Whether the times of a sensor are off, or were and are not known to be right."""
    return found.is_sure or (lags.left_for is not None and not found.is_cleared)


def _lag_left_for(found: SensorLag, lags: LagRange) -> float:
    """Return the lag that a sensor must be unlikely to have before it returns [s]."""
    return found.seconds if found.is_doubtful or lags.left_for is None else lags.left_for


def _apart(moved: Floats, sway: Sway, lags: LagRange, late: float) -> tuple[float, str] | None:
    """
    Tell from which other sensors the motion of one, (n, 9), is apart in time; None from few.

    Returns the lag for which it is left [s], and what is said.

    Limbs lean together in slow gusts. Of several sensors that one is blamed which differs from
    most others; of two both are, unless one is nearer to the model.
    """
    said: list[tuple[float, str]] = []
    for other in lags.others:
        motion = other.alignment.motion(other.sensed)
        if not len(motion) or _first_rows(motion) != _first_rows(moved):
            continue
        about = lags.about - other.about
        beside = lags._replace(about=about, none=abs(about), is_told=True, later=None)
        found = _slow_lag(moved[-len(motion) :], motion, sway, beside)
        if _is_off(found, lags):
            said.append((_lag_left_for(found, lags), found.said_of(other.name)))
    if 2 * len(said) <= len(lags.others):
        return None
    is_nearer = len(lags.others) == 1 and abs(late) + _NEARER < abs(lags.others[0].late)
    return None if is_nearer else said[0]


def _first_rows(moved: Floats) -> slice:
    """East and north of the lean, or else of the first quantity that is measured, (n, 9)."""
    first = int(np.argmax(np.isfinite(moved).all(axis=0)))
    return slice(first, first + 2)


def _slow_lag(moved: Floats, model: Floats, sway: Sway, lags: LagRange) -> SensorLag:
    """Find the lag of a sensor (n, 9) by its lean, or else by the first quantity it measures."""
    rows = _first_rows(moved)
    return sensor_lag(
        moved[:, rows],
        model[:, rows],
        sway.frequency,
        sway.dt,
        longest=_LONGEST if lags.is_told else LONGEST_WAY,
        about=lags.about,
        none=lags.none,
        left_for=lags.left_for,
        later=lags.later,
    )


def _lag(sensed: Floats, model: Floats, period: int, lags: LagRange, *, has_gravity: bool) -> int:
    """
    By how many steps a sensor moves later than the model, where that is sure; else 0.

    Gravity tells the lean in gusts, which a softer tree has in common with its model. The rest is
    sway, which resembles itself a period later.
    """
    if lags.earliest == lags.latest:
        return 0
    told = [rows for rows in (slice(0, 3), slice(3, 6)) if np.isfinite(sensed[:, rows]).all()]
    if has_gravity and slice(0, 3) in told:
        told = told[:1]
    pairs = [
        (averaged(sensed[:, rows], period), averaged(model[:, rows], period)) for rows in told
    ]
    if not pairs:
        return 0
    found = find_lag(pairs, lags.earliest, lags.latest, period)
    return found.steps if found.is_sure and abs(found.steps) >= lags.least else 0


def _lagging(lag: int, count: int) -> tuple[slice, slice]:
    """Rows of a sensor, and those of a model by a lag before, of a number of rows each."""
    return slice(max(lag, 0), count + min(lag, 0)), slice(max(-lag, 0), count + min(-lag, 0))


class SensorTrack:
    """
    A sensor, what is known about it, and whether it is in use.

    Parameters
    ----------
    sensor
        The sensor.
    frequency
        First frequency of the model in [Hz].
    dt
        Time step in [s].
    reach
        Way from the middle of the crown to east and north in [m].

    """

    def __init__(
        self,
        sensor: MotionSensor,
        frequency: float,
        dt: float,
        reach: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        self.sensor, self._dt, self.reach = sensor, dt, reach
        self.alignment: Alignment | None = None
        self.motion = PlaceMotion(*np.zeros((2, 3, 0)))
        """How the coordinates of the model move its place."""
        self.bend = np.eye(2)
        """Lean of its place per load to east and north, of any unit (`lean_per_load`), (2, 2)."""
        self.tells_little = False
        """Whether it is in use, and tells too little of any coordinate to correct the tree."""
        self._mounting = np.zeros(21)
        self.bias = self._mounting[12:]
        """Mean difference from the model, which no sensor can tell from its mounting, (9,)."""
        self.uses: tuple[int, ...] = ()
        """Quantities that correct the tree: 0 acceleration, 1 rate, 2 rotation."""
        self.picked = slice(0, 0)
        """Rows of a sample, (9,), of these."""
        # Written, not only asked for: its memory is all there from the beginning.
        self._sensed = np.full((round(_MEMORY / dt), 9), 0.0)
        self._computed = np.full((len(self._sensed), ROWS), 0.0)
        period = 1.0 / frequency
        self.window = max(round(period / dt), 1)
        """Steps in a period of the first sway."""
        self._compared = max(round(max(_COMPARED, _LEAST_COMPARED * period) / dt), 1)
        self._next_fit = round(_LEARNING / dt)
        self._next_mean = 0
        self._noise_period = math.inf
        self._quantities = sensor.quantities
        self._left_for: float | None = None
        self.late = 0.0
        """Its likeliest lag behind the model when its mounting was found last [s]."""
        self._behind, self._whole_from = 0, 0
        self._moved = np.zeros(9)
        self.native = NativeSensor(
            ring=sensor.ring.memory, mounting=self._mounting, kept=self._sensed,
            computed=self._computed, moved=self._moved, rows=len(self._sensed), dt=dt,
            newest=sensor.ring.newest, excess=1.0, usual=math.inf, heard=-math.inf, came=-math.inf,
            is_awaited=1,
        )  # fmt: skip
        """Its state in the native core."""

    @property
    def fitted(self) -> int:
        """Quantity whose spectrum is compared with the model's: the rate where there is one."""
        return 1 if 1 in self.uses else self.uses[0]

    @property
    def noise(self) -> Floats:
        """Standard deviation of the noise at each step, at least a usual or stated one, (3,)."""
        stated = np.minimum(self.sensor.stated_noise, _CEILING)
        return np.maximum(self._own_noise, np.maximum(stated, LEAST_NOISE) * math.sqrt(self._held))

    @property
    def _own_noise(self) -> Floats:
        """Standard deviation of the noise that it has at each step, (3,)."""
        known = np.zeros(3) if self.alignment is None else self.alignment.noise
        return known * math.sqrt(self._held)

    @property
    def _held(self) -> float:
        """Steps that have the same noise: samples are joined by lines, or averaged."""
        period = self.sensor.ring.period
        return 1.0 if math.isnan(period) else period / self._dt

    @property
    def fitted_noise(self) -> float:
        """Standard deviation of the noise at each step of the fitted quantity."""
        return float(self._own_noise[self.fitted])

    @property
    def watched_noise(self) -> float:
        """
        Standard deviation of the noise at each step of the watched quantity, the acceleration.

        Without one, the first of the others is watched. The acceleration tells more of fast sway
        than the angular rate, which is less above its noise.
        """
        return float(self._own_noise[self.uses[0]])

    @property
    def in_use(self) -> bool:
        """Whether its motion corrects the tree."""
        return bool(self.native.in_use)

    @property
    def excess(self) -> float:
        """Squared innovations over those expected, a running mean [-]."""
        return float(self.native.excess)

    @property
    def problem(self) -> str:
        """Why it does not correct the tree, and what to do; empty if it does."""
        name, native = self.sensor.name, self.native
        if self.in_use:
            return f'{name}: {TELLS_LITTLE}' if self.tells_little else ''
        counts = self.sensor.counts
        if counts.accepted == 0 and counts.refused:
            return f'{name}: all of {counts.refused} samples were refused: {counts.why_refused}'
        if counts.accepted == 0:
            return f'{name}: no sample yet'
        if self.is_silent and self.sensor.trouble:
            return f'{name}: refused for {native.absent:.0f} s: {self.sensor.trouble}'
        is_heard = native.unheard <= _ABSENT_AFTER < native.absent - native.unheard
        if self.is_silent and is_heard:
            return f'{name}: its times are {native.apart:+.1f} s from the steps: check its clock'
        if self.is_silent:
            return f'{name}: silent for {native.absent:.0f} s: check its battery and connection'
        if self.alignment is None:
            left = max(math.ceil((self._next_fit - native.count) * self._dt - 1e-9), 1)
            return f'{name}: its mounting is found within {left} s of sway'
        if self.alignment.problem:
            return f'{name}: {self.alignment.problem}'
        if native.is_refused:
            return f'{name}: it disagrees with the tree: check that it is still fixed'
        return f'{name}: it is followed from the next sample on'

    @property
    def is_silent(self) -> bool:
        """Whether there was no sample for longer than networks delay one."""
        return bool(self.native.absent > _ABSENT_AFTER)

    def heed(self) -> bool:
        """
        Heed what has become of the sensor since the last step.

        Returns whether it measures other quantities, of which no mounting is known.
        """
        native, counts = self.native, self.sensor.counts
        alignment = self.alignment
        if native.in_use and native.count >= self._next_mean and alignment is not None:
            self._follow(alignment)
        counts.silent = native.silences
        if native.disagreements != counts.disagreed:
            counts.disagreed = native.disagreements
            # A knock may have moved it: its mounting is found from what comes after.
            native.count = -round(_KNOCKED / self._dt)
            self._next_fit = round(_LEARNING / self._dt)
        if (given := self.sensor.quantities) == self._quantities:
            return False
        self._quantities = given
        self.alignment = None
        native.in_use = native.is_mounted = native.is_refused = native.count = 0
        native.is_awaited = 1
        native.excess, native.usual = 1.0, math.inf
        self._next_fit = round(_LEARNING / self._dt)
        return True

    def _follow(self, alignment: Alignment) -> None:
        """Let the noise and the mean difference from the model be those of the last minutes."""
        noise = noise_of(alignment.motion(self.sensor.ring.newest_samples()))
        self.alignment = replace(alignment, noise=self._known_noise(noise))
        every = round(_MEAN_EVERY / self._dt)
        self._next_mean = self.native.count + every
        missed = self._missed(alignment, every)
        share = len(missed) / len(self._sensed)
        self.bias += share * (missed.mean(axis=0) - self.bias)

    def _known_noise(self, found: Floats) -> Floats:
        """
        Return the noise of a sample as it is known with the newest samples, (3,).

        The farther samples are apart, the more of the sway is between them, and taken for noise:
        of fewer a second than before only less noise is believed.
        """
        period = self.sensor.ring.period
        if self.alignment is not None and period > _AS_OFTEN * self._noise_period:
            return np.minimum(found, self.alignment.noise)
        self._noise_period = period
        return found

    @property
    def is_due(self) -> bool:
        """Whether it has seen enough motion for its mounting to be found again."""
        return bool(self.native.count >= self._next_fit)

    def search(self, lags: LagRange = NO_LAG) -> Callable[[], FoundMounting]:
        """Return what finds its mounting from the motion so far."""
        self._next_fit = math.ceil(_LATER * self.native.count)
        rows = self._last(len(self._sensed))
        model = self._computed[rows].T.copy()
        lags = lags._replace(left_for=self._left_for)
        sway = Sway(self.bend, 1.0 / (self.window * self._dt), self._dt)
        samples = self.sensor.ring.newest_samples(), self._held
        return partial(
            _mounting, self._sensed[rows], model, self.sensor, self._compared, lags, sway, samples
        )

    def _last(self, most: int) -> Ints:
        """Rows of the last steps that are remembered, of a number of them at most."""
        count, size = self.native.count, len(self._sensed)
        return np.arange(max(count - min(most, size), 0), count) % size

    def _missed(self, alignment: Alignment, most: int) -> Floats:
        """Motion less that of the model in the last steps, of a number of them at most, (n, 9)."""
        rows = self._last(most)
        model = as_felt(self._computed[rows].T, has_gravity=alignment.has_gravity).T
        return alignment.motion(self._sensed[rows]) - model

    def beyond(self, most: int) -> Floats:
        """
        Return what it measured beyond the model in the last steps, of a number of them at most.

        These are the three axes of each quantity that it is used for, (n, 3 k).
        """
        assert self.alignment is not None
        return (self._missed(self.alignment, most) - self.bias)[:, self.picked]

    def note_step(self, step: int) -> None:
        """Note by how many steps it is behind; if by more than before, some are missing."""
        if (behind := step - self.native.count) != self._behind:
            self._behind, self._whole_from = behind, self.native.count

    @property
    def is_comparable(self) -> bool:
        """Whether its motion is known, in use or left for its times."""
        return bool(self.native.is_mounted) or self._left_for is not None

    @property
    def whole(self) -> int:
        """Number of the last steps of which none is missing."""
        return min(max(self.native.count - max(self._whole_from, 0), 0), len(self._sensed))

    def beside(self, track: SensorTrack, about: float) -> OtherSensor:
        """Return it as another sensor beside one, by their last samples of the same steps."""
        assert self.alignment is not None
        sensed = self._sensed[self._last(min(self.whole, track.whole))]
        return OtherSensor(self.sensor.name, self.alignment, sensed, about, self.late)

    def delay_model(self, lag: int) -> None:
        """Remember the model as if its wind had been later by a number of steps."""
        rows = self._last(len(self._sensed))
        later, earlier = _lagging(lag, len(rows))
        kept = max(len(rows) - abs(lag), 0)
        self._sensed[:kept] = self._sensed[rows[later]]
        self._computed[:kept] = self._computed[rows[earlier]]
        gone = self.native.count - kept
        if gone > 0:
            self._next_fit -= gone
            self.native.count = kept

    def take(self, mounting: FoundMounting) -> None:
        """Read the sensor by another mounting from now on, unless the one before is surer."""
        found, native = mounting.alignment, self.native
        self._left_for, self.late = mounting.left_for, mounting.late
        if mounting.is_suspect:
            self._next_fit = min(self._next_fit, native.count + round(_SOON / self._dt))
        is_left = mounting.left_for is not None
        is_kept = native.is_mounted and not native.is_refused and not is_left
        if is_kept and (found.problem or self._is_less_sure(found)):
            return
        noise = self._known_noise(found.noise)
        self.alignment = found if noise is found.noise else replace(found, noise=noise)
        native.is_awaited, native.is_mounted = 0, not found.problem
        native.in_use = native.is_mounted and not native.is_refused
        if found.problem:
            return
        given = self._quantities
        first = tuple(k for k, name in enumerate(('acceleration', 'rate')) if name in given)
        is_felt = 'acceleration' in given or 'orientation' not in given
        self.uses = first if is_felt else (*first, 2)
        self.picked = slice(3 * self.uses[0], 3 * self.uses[-1] + 3)
        written = self._mounting
        written[:9], written[9:11] = found.turn.ravel(), found.scale
        written[11] = GRAVITY if found.has_gravity else 0.0
        self.bias[:] = mounting.bias
        self._next_mean = native.count + round(_MEAN_EVERY / self._dt)

    def _is_less_sure(self, found: Alignment) -> bool:
        """Whether a mounting is less sure than the present one, as that of a calm is."""
        known = self.alignment
        if known is None:
            return False
        cosine = 0.5 * (np.vdot(found.turn, known.turn) - 1.0)
        angle = math.acos(np.clip(cosine, -1.0, 1.0))
        is_other = angle > _OTHER * math.hypot(found.azimuth_error, known.azimuth_error)
        if is_other and self.native.count <= len(self._sensed):
            return False  # it is of all that the present one is of, and of more
        has_its_units = np.allclose(np.abs(found.scale), np.abs(known.scale))
        if not has_its_units:
            return found.azimuth_error >= known.azimuth_error
        return found.azimuth_error > _LESS_SURE * known.azimuth_error

    def judge(self, size: float) -> None:
        """Judge it by the mean square of its innovations over that expected."""
        LIBRARY.sway_judge(self.native.at, size)
