# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is known about each sensor of an observed tree, for viewers and diagnostics."""

from __future__ import annotations

import math
from typing import NamedTuple

from tree_sway.twin.motion_sensor import SensorCounts
from tree_sway.twin.observed_tree import ObservedTree
from tree_sway.twin.sway_watch import SwayChange

_MANY_REFUSED = 0.01
"""Share of refused samples from which on it is said why they were."""


class SensorReport(NamedTuple):
    """
    State of a sensor.

    Parameters
    ----------
    name
        Its name.
    in_use
        Whether the tree follows it.
    problem
        Why not, and what to do; empty if it is in use.
    residual
        Size of what remains between it and the corrected tree, over the size that is expected [-].
    rate
        Samples per second [Hz]; 0 before two samples.
    late
        Time by which it is read late in [s].
    counts
        Counts of its samples.
    notes
        Properties that were recognised, such as a unit, how late the wind is, what the sensor
        measures no more or not as numbers, that its clock may be behind, and why many samples
        were refused.
    change
        Whether the tree sways as it did; None before there is a past.

    """

    name: str
    in_use: bool
    problem: str
    residual: float
    rate: float
    late: float
    counts: SensorCounts
    notes: tuple[str, ...]
    change: SwayChange | None = None

    @property
    def refused(self) -> int:
        """Number of refused samples."""
        return self.counts.refused


def sensor_reports(twin: ObservedTree) -> list[SensorReport]:
    """Report every sensor of a tree."""
    found = []
    late = tuple(filter(None, [twin.late_wind.note]))
    fit = twin.observer.fit
    odd: tuple[str, ...] = ()
    if fit is not None and fit.is_odd:
        cure = 'check that it is on this tree, at this place'
        odd = (f'its tree would be {fit} as this one is expected to be: {cure}',)
    for number, track in enumerate(twin.observer.tracks):
        sensor, alignment = track.sensor, track.alignment
        recognised = () if alignment is None else (*alignment.notes, *late)
        lost = [f'it measures no {name} any more: restart it' for name in sensor.lost]
        lost += [
            f'it is used without its {name}, of which some values are no numbers: look at what it '
            'sends'
            for name in sensor.unusable
        ]
        if sensor.is_behind:
            lost.append(
                f'its samples come {sensor.lateness:.1f} s after their times: a slow connection, '
                'or its clock is behind'
            )
        counts = sensor.counts
        if counts.refused > _MANY_REFUSED * counts.accepted:
            lost.append(f'{counts.refused} samples were refused: {counts.why_refused}')
        found.append(
            SensorReport(
                sensor.name,
                track.in_use,
                track.problem,
                math.sqrt(max(track.excess, 0.0)),
                0.0 if math.isnan(sensor.ring.period) else 1.0 / max(sensor.ring.period, 1e-9),
                twin.observer.late * twin.period,
                counts,
                (*recognised, *odd, *lost),
                twin.observer.sway_change(number),
            )
        )
    return found
