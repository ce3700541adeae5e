# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Intake of samples of wind: units and sign, then the gate, then the force plane."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.wind.convention import WindConvention
from tree_sway.core.wind.gate import GateCounts, WindGate
from tree_sway.core.wind.limits import FASTEST_WIND


class GoodWind(NamedTuple):
    """
    An accepted sample with its time [ns], after that before, and its velocity.

    The velocity is ENU in [m/s], on the force plane, (3,).
    """

    time: int
    velocity: Floats


@dataclass
class WindIntake:
    """
    Intake of samples as a source sends them.

    The convention of the source may be replaced between samples; it is None where they are
    velocities on the force plane already. The gate checks them before that projection.
    """

    convention: WindConvention | None = None
    gate: WindGate = field(default_factory=WindGate)
    left_out: float = 0.0
    """Component of the last good sample across the force plane [m/s], which is left out."""

    @staticmethod
    def of_velocities() -> WindIntake:
        """Return the intake of checked samples: their times are in order, and numbers finite."""
        return WindIntake(gate=WindGate(max_speed=FASTEST_WIND, max_rate=1e4))

    @property
    def counts(self) -> GateCounts:
        """Return the counts of accepted and refused samples, by reason."""
        return self.gate.counts

    def offer(
        self,
        stamp: int,
        components: tuple[float, float, float],
        arrival: int | None = None,
        *,
        lead: int = 0,
        lag: int = 0,
        rotation: Floats | None = None,
    ) -> GoodWind | None:
        """
        Check a sample, (3,), in the source's axes, unit and sign; None if refused, and counted.

        Times are those of `WindGate.offer`; the rotation (3, 3) is from the source's frame into
        the trees'.
        """
        reads = self.convention
        velocity = np.array(components) if reads is None else reads.velocity(components)
        if rotation is not None and np.abs(velocity).max() <= FASTEST_WIND:  # else refused
            velocity = rotation @ velocity
        verdict = self.gate.offer(stamp, velocity, arrival, lead=lead, lag=lag)
        if not verdict.accepted:
            return None
        good = np.array(verdict.wind)
        if reads is None:
            return GoodWind(verdict.time, good)
        self.left_out = float(good @ reads.normal)
        return GoodWind(verdict.time, reads.project(good))
