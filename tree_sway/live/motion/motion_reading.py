# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A sample of a motion sensor."""

from __future__ import annotations

from dataclasses import dataclass

from tree_sway.files.motion import AXES

Numbers = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class MotionReading:
    """
    One sample, in the sensor's own frame (REP-145); what it does not measure is None.

    Parameters
    ----------
    time
        Time on the clock of the sender, in its own unit; None for that of arrival. Samples of
        `LiveMotion` have times of `time.monotonic` [s].
    acceleration
        Acceleration, x y z, in [m/s^2] or in g.
    rate
        Angular rate, x y z, in [rad/s] or in degrees per second.
    orientation
        Rotation to east, north, up as x y z w.

    """

    time: float | None
    acceleration: Numbers | None = None
    rate: Numbers | None = None
    orientation: Numbers | None = None

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names of what is measured."""
        return tuple(name for name in AXES if getattr(self, name) is not None)
