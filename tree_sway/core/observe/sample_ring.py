# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The last samples of a motion sensor: checked as they are kept, and read at any time.

A sample is (9,): acceleration, angular rate and rotation, not a number where not measured. A ring
is one record of `RING`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.kernel import kernel

MOST_ACCELERATION, MOST_RATE = 320.0, 2500.0
"""Largest values of sensors: 32 g in [m/s^2]; 2,000 degrees per second, also in degrees."""

KEPT, NOT_FINITE, TOO_LARGE, SATURATED, OUT_OF_ORDER, RESTARTED = 0, 1, 2, 3, 4, 5
"""Results of `keep_sample`; the sample was kept with the first and the last."""

_SATURATED_ACCELERATION, _SATURATED_RATE = 15.0, 4.0
"""Values above which a repeated number is the limit of a sensor; below, one that moves little."""
_REPEATED = 3
_CAPACITY = 4096
_CLOCK_BACK = 1.0
_LONGEST_GAP = 0.25
_SILENT_PERIODS = 4.0
_SAME_TIME = 0.01

RING = np.dtype(
    [
        ('time', 'f8', (_CAPACITY,)),
        ('values', 'f8', (_CAPACITY, 9)),
        ('at', 'i8', (3,)),  # first sample, their number, samples in a row far in the past
        ('clock', 'f8', (2,)),  # time of the newest, and a running median of the period [s]
        ('same', 'i8', (6,)),  # how often each number was repeated
        ('before', 'f8', (6,)),  # numbers of the sample before
    ]
)
FIRST, COUNT, BEHIND = 0, 1, 2
NEWEST, PERIOD = 0, 1


def empty_ring() -> NDArray[Any]:
    """Return a ring without samples, (1,) of `RING`."""
    ring = np.zeros(1, dtype=RING)
    ring['clock'][0] = -math.inf, math.nan
    ring['before'] = math.nan
    return ring


@kernel
def keep_sample(
    rings: Records, time: float, sample: Floats, is_measured: NDArray[np.bool_]
) -> int:
    """
    Check a sample, and keep it in the first ring; return one of `KEPT` to `RESTARTED`.

    Parameters
    ----------
    rings
        Record of `RING`, (1,).
    time
        Time of the sample in [s].
    sample, is_measured
        The sample, and which of its numbers are asked for, (9,).

    """
    here = rings[0]
    at, clock, same, before = here['at'], here['clock'], here['same'], here['before']
    if not math.isfinite(time):
        return NOT_FINITE
    for j in range(9):
        if is_measured[j] and not math.isfinite(sample[j]):
            return NOT_FINITE
    for j in range(6):
        if abs(sample[j]) > (MOST_ACCELERATION if j < 3 else MOST_RATE):
            return TOO_LARGE
    outcome = KEPT
    if time <= clock[NEWEST]:
        # One of the past is refused; several in a row, far back, are those of a new clock.
        if time < clock[NEWEST] - _CLOCK_BACK:
            at[BEHIND] += 1
        if at[BEHIND] < _REPEATED:
            return OUT_OF_ORDER
        at[COUNT] = at[BEHIND] = 0
        clock[NEWEST] = -math.inf
        outcome = RESTARTED
    else:
        at[BEHIND] = 0
        is_saturated = False
        for j in range(6):
            same[j] = same[j] + 1 if sample[j] == before[j] else 0
            before[j] = sample[j]
            most = _SATURATED_ACCELERATION if j < 3 else _SATURATED_RATE
            if same[j] >= _REPEATED and abs(sample[j]) > most:
                is_saturated = True
        if is_saturated:
            return SATURATED
    step = time - clock[NEWEST]
    if step < math.inf:
        # A running median: up or down by a twentieth.
        known = clock[PERIOD]
        if math.isnan(known):
            clock[PERIOD] = step
        elif step != known:
            clock[PERIOD] = known * (1.05 if step > known else 0.95)
    if at[COUNT] == _CAPACITY:
        at[FIRST] = (at[FIRST] + 1) % _CAPACITY
        at[COUNT] -= 1
    row = (at[FIRST] + at[COUNT]) % _CAPACITY
    here['time'][row] = time
    for j in range(9):
        here['values'][row, j] = sample[j]
    at[COUNT] += 1
    clock[NEWEST] = time
    return outcome


@kernel
def read_samples(rings: Records, time: float, dt: float, out: Floats) -> bool:
    """
    Read the motion about a time from the first ring into a sample, (9,), and forget older ones.

    Samples within a step of dt [s] about the time are averaged; elsewhere the samples before and
    after are joined by a line. False where no sample is near.
    """
    here = rings[0]
    at, times, values = here['at'], here['time'], here['values']
    while at[COUNT] > 2 and times[(at[FIRST] + 1) % _CAPACITY] < time - 0.5 * dt:
        at[FIRST] = (at[FIRST] + 1) % _CAPACITY
        at[COUNT] -= 1
    n_within, before, after = 0, -1, -1
    for j in range(9):
        out[j] = 0.0
    for k in range(at[COUNT]):
        row = (at[FIRST] + k) % _CAPACITY
        stamp = times[row]
        if stamp > time + 0.5 * dt:
            if after < 0:
                after = row
            break
        if stamp > time - 0.5 * dt:
            n_within += 1
            for j in range(9):
                out[j] += values[row, j]
        if stamp <= time:
            before = row
        elif after < 0:
            after = row
    if n_within > 1:
        for j in range(9):
            out[j] /= n_within
        return True
    if before < 0:
        return False
    share = 0.0
    if time - times[before] >= _SAME_TIME * dt:
        if after < 0 or times[after] - times[before] > longest_gap(here['clock'][PERIOD]):
            return False
        share = (time - times[before]) / (times[after] - times[before])
    for j in range(9):
        out[j] = values[before, j]
        if share > 0.0:
            out[j] += share * (values[after, j] - values[before, j])
    return True


@kernel
def longest_gap(period: float) -> float:
    """Return the longest time between samples that is bridged in [s]."""
    return _LONGEST_GAP if math.isnan(period) else max(_LONGEST_GAP, _SILENT_PERIODS * period)
