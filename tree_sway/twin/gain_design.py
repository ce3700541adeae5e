# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Gains for the sensors in use and the present wind, found beside the steps.

A sensor on the stem tells about a hanging twig only what both have in common by the law of the
gusts, and of all that the filter knows, that law is known least for fast gusts: slow ones hold a
whole crown. The sway of a coordinate is corrected where the sensors take away enough of its
variance even if each limb meets gusts of its own; its lean, force over stiffness, where they do so
of any coordinate. Neither is of a hanging twig: its wind damps it so strongly that it streams, and
leans less than its force tells. It is moved by the wind, and by the wood that is corrected
(`dragged_motion`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.twin.gust_strength import BeyondModel, strength_of, UsualLaw
from tree_sway.twin.later_work import LaterWork
from tree_sway.twin.missed_motion import missed_noise
from tree_sway.twin.pushed_twigs import push_of
from tree_sway.twin.sensor_track import as_felt, sensed_rows, SensorTrack
from tree_sway.twin.steady_filter import steady_filter, SteadyFilter, told_shares
from tree_sway.twin.unknown_motion import COMPARED, UnknownMotion

_TELLS_LITTLE, _TELLS_ENOUGH = 0.25, 0.4
"""
Shares of the variance of a coordinate that the sensors take away below and above which its
correction is not applied, and applied whole.
"""

_SWAYS, _STREAMS = 0.15, 0.3
"""Damping ratios in the mean wind below and above which a coordinate leans, and streams [-]."""

_TRIED = 30.0
"""Time in [s] whose samples tell by how much more a sensor misses the model than by its noise."""

_LATER = 1.4
"""How much more of its motion there is when the strength of the gusts is found again."""

_DUE = 45
"""Steps after which new gains are in use."""


_NoiseOf = dict[tuple[int, tuple[int, ...]], Floats]
"""Noise of the measurements of sensors by their numbers and quantities, (3 k,) each."""


class Gains(NamedTuple):
    """
    Gains for some sensors.

    ``used`` are their numbers, ``noise`` that of their measurements, (p,), with what no coordinate
    can have (`missed_noise`), ``noise_of`` that of each by its number and quantities, ``trust``
    the share of the correction of each coordinate to apply, ``leaning`` that of its lean, (n,).
    ``push`` is the force on each coordinate of the model by that of each of these, (n, m).
    """

    used: tuple[int, ...]
    noise_of: _NoiseOf
    noise: Floats
    filter: SteadyFilter
    trust: Floats
    leaning: Floats
    push: Floats


class GainDesign:
    """
    Gains that are being found.

    Parameters
    ----------
    unknown
        Law of the unknown motion.
    tracks
        Sensors.

    """

    def __init__(self, unknown: UnknownMotion, tracks: Sequence[SensorTrack]) -> None:
        self._unknown, self._tracks = unknown, tracks
        self._wanted: tuple[int, ...] = ()
        self._work: LaterWork[Gains] | None = None
        self._again_after = 0
        self._noise: _NoiseOf = {}
        self.used: tuple[int, ...] = ()
        """Sensors for which gains are found, and which are all in use."""

    def advance(self) -> Gains | None:
        """Find gains where others are needed; return them when they are due."""
        in_use = tuple([k for k, track in enumerate(self._tracks) if track.native.in_use])
        if not in_use:
            self.stop()
            return None
        is_known = in_use == self.used and not self._unknown.is_outdated
        if self._work is None and is_known and self._n_seen(in_use) < self._again_after:
            return None
        if self._work is None or in_use != self._wanted:
            self._wanted, self._work = in_use, self._begin(in_use)
        found = self._work.advance()
        if found is not None:
            self._work, self.used = None, found.used
            self._noise |= found.noise_of
        return found

    def stop(self) -> None:
        """Give up what was found."""
        self.used, self._work = (), None

    def _n_seen(self, used: tuple[int, ...]) -> int:
        """Count the steps of the sensor that has seen most of some."""
        return int(max(self._tracks[k].native.count for k in used))

    def _begin(self, used: tuple[int, ...]) -> LaterWork[Gains]:
        """Begin to find the gains of some sensors."""
        unknown = self._unknown
        (law, apart), forces = unknown.find(), unknown.forces
        assert forces is not None
        count = round(COMPARED / unknown.dt)
        self._again_after = round(min(_LATER * self._n_seen(used), self._n_seen(used) + count))
        n_tried = round(_TRIED / unknown.dt)
        tried = {}
        beyond = []
        for k in used:
            track, (rows, least) = self._tracks[k], self.felt(k)
            record, key = track.beyond(count), (k, track.uses)
            tried[key] = rows, least, self._noise.get(key, least), record[-n_tried:]
            by_part = rows[:2].reshape(2, 3, -1)
            beyond.append(BeyondModel(record[:, :2], by_part, least[0]))
        sensed = np.concatenate([rows for rows, *_ in tried.values()])
        usual = UsualLaw(
            unknown.stiffness.copy(),
            unknown.damped,
            unknown.usual_before * forces.covariance,
            forces.time_constant,
            unknown.frequency,
            unknown.dt,
        )

        stiffness = unknown.all_stiffness
        damping_ratio = 0.5 * (unknown.all_damping + np.diag(forces.drag)) / np.sqrt(stiffness)
        streaming = np.clip((damping_ratio - _SWAYS) / (_STREAMS - _SWAYS), 0.0, 1.0)
        leaning = 1.0 - streaming[: unknown.count]
        moved = np.concatenate([self._tracks[k].motion.displacement[:2] for k in used])

        def found_later() -> Gains:
            strength = strength_of(beyond, usual)
            own, others = (replace(each, driven=strength * each.driven) for each in (law, apart))
            noise_of = {key: missed_noise(own, *each) for key, each in tried.items()}
            noise = np.concatenate([*noise_of.values()])
            gains = steady_filter(own, sensed, noise)
            told = told_shares(gains, others, noise)
            beyond_little = (told - _TELLS_LITTLE) / (_TELLS_ENOUGH - _TELLS_LITTLE)
            trust = np.clip(beyond_little, 0.0, 1.0)
            if moved.any():  # not of gauges alone, whose places tell no force
                trust *= leaning
            push = push_of(moved, stiffness, trust, streaming)
            return Gains(used, noise_of, noise, gains, trust, leaning, push)

        return LaterWork(found_later, _DUE)

    def felt(self, which: int) -> tuple[Floats, Floats]:
        """Return the measurements of a sensor by the state, (k, 3 n), and their noise, (k,)."""
        track, unknown = self._tracks[which], self._unknown
        assert track.alignment is not None
        first = track.motion.first(unknown.count)
        rows = sensed_rows(first, unknown.stiffness, unknown.damped)
        felt = as_felt(rows, has_gravity=track.alignment.has_gravity).reshape(3, 3, -1)
        uses = list(track.uses)
        return felt[uses].reshape(3 * len(uses), -1), np.repeat(track.noise[uses], 3)
