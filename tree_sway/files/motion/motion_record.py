# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A record of a motion sensor: what it measured over time, in its own frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.drawn import Drawn

AXES = {'acceleration': 'xyz', 'rate': 'xyz', 'orientation': 'xyzw'}
"""Quantities that a motion sensor measures, and their axes."""


@dataclass(frozen=True, eq=False, repr=False)
class MotionRecord(Drawn):
    """
    Motion over time; a quantity that the sensor does not measure is None.

    Parameters
    ----------
    time
        Time of each sample in [s] after its epoch, or after any moment, (n,).
    acceleration
        Acceleration, with gravity or without, in [m/s^2], (n, 3).
    rate
        Angular rate in [rad/s], (n, 3).
    orientation
        Rotation of the sensor's frame to east, north, up as x y z w, (n, 4).
    source
        Name of the file.
    epoch
        Time in seconds after 1970-01-01 from which times count; None without dates.
    notes
        Choices of the reader, one sentence each.

    """

    time: Floats
    acceleration: Floats | None
    rate: Floats | None
    orientation: Floats | None
    source: str
    epoch: float | None = None
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        """Return source, length and what was measured on one line."""
        measured = [each for each in AXES if getattr(self, each) is not None]
        seconds = float(self.time[-1] - self.time[0]) if len(self.time) else 0.0
        size = f'{len(self.time)} samples, {seconds:.4g} s'
        return f'MotionRecord {self.source!r}: {size}, {", ".join(measured)}'

    def times_after(self, epoch: float | None, offset: float = 0.0) -> Floats:
        """
        Return the times after the start of another record in [s], (n,).

        With dates on both they are those of the clock; else both records begin at the same moment.
        The offset in [s] is added.
        """
        if epoch is not None and self.epoch is not None:
            return np.asarray(self.time + (self.epoch - epoch) + offset)
        return np.asarray(self.time - self.time[0] + offset)
