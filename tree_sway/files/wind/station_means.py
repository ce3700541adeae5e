# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""From means over minutes or hours of stations to the wind at a tree."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tree_sway.core.wind import FASTEST_WIND
from tree_sway.errors import ParameterError
from tree_sway.files.wind.record import WindRecord
from tree_sway.simulation.wind import can_be_filled, LEAST_INTERVAL, turbulence_about_means


def filled_means(
    record: WindRecord, turbulence: bool, seed: float, *, least: int = 3
) -> WindRecord:
    """
    Return a record with turbulence about its samples if these are means, with a note.

    Fewer samples than the ``least`` number, as two of a table, may as well be a broken record.
    """
    if not (seed >= 0 and float(seed).is_integer()):
        raise ParameterError(f'seed is {seed:g}', cure='give a whole number of 0 or more')
    if record.period < LEAST_INTERVAL or len(record.time) < least:
        return record
    means = f'samples {record.period:g} s apart are taken as means'
    if not turbulence:
        return record.with_note(f'{means}; the wind between them is interpolated')
    if not can_be_filled(record.duration):
        return record.with_note(f'{means}; too long a record for turbulence about them')
    rng = np.random.default_rng(int(seed))
    time, velocity = turbulence_about_means(record.time, record.velocity, record.gust, rng)
    fast = np.linalg.norm(velocity, axis=1)[:, None] / FASTEST_WIND
    by = 'by their gusts' if record.gust is not None else 'by IEC 61400-1, as there are no gusts'
    note = f'{means}: turbulence is simulated about them {by}, seed {int(seed)}'
    filled = replace(record, time=time, velocity=velocity / np.maximum(fast, 1.0), gust=None)
    return filled.with_note(f'{note}; turbulence=false leaves it out')
