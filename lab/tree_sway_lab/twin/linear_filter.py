# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a linear filter fitted to the true tips leaves, as a bound for a tree with sensors.

It takes what the sensors and the mast measure, up to four seconds back, and is fitted by ridge
regression (Hoerl & Kennard 1970, Technometrics 12, 55-67) to the true motion of every tip, four
fifths of the record at a time, and scored on the fifth between. It needs no model: no filter that
moves linearly with what is measured errs much less, but one that knows the tree can where a
record is too short to fit this one.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.signal import butter, sosfilt

from tree_sway.core.arrays import Floats
from tree_sway_lab.twin.simulated_sensor import SimulatedSensor
from tree_sway_lab.twin.true_tree import DT, TrueMotion

_PASSED, _EVERY = 4.0, 6
"""Low-pass in [Hz] before the fit, and steps from one row of it to the next."""

_LAGS = (*range(10), *range(10, 40, 4))
"""Rows back that it reads."""

_FOLDS = 5
_RIDGES = np.logspace(1.0, 3.5, 6)
"""Ridges over the variance of what is measured; the best one is taken."""


def linear_filter(true: TrueMotion, places: Sequence[str], seed: int = 7) -> tuple[Floats, Floats]:
    """
    Fit tips to what sensors at places and the mast measure.

    Returns
    -------
    tuple
        Tips by the filter and the true ones, about their means, (n, b, 3) each.

    """
    rng = np.random.default_rng(seed)
    measured = [true.wind[:, :2]]
    for place in places:
        motion = SimulatedSensor().measured(true.poses[place], DT, rng)
        measured += [motion.acceleration, motion.rate]
    tips = true.tips.reshape(len(true.tips), -1)
    inputs, wanted = (_passed(each) for each in (np.column_stack(measured), tips))
    inputs /= inputs.std(axis=0)
    most = max(_LAGS)
    rows = np.column_stack([inputs[most - lag : len(inputs) - lag] for lag in _LAGS])
    wanted = wanted[most:]
    found = [_held_out(rows, wanted, float(ridge)) for ridge in _RIDGES]
    best = min(found, key=lambda each: float(np.square(each - wanted).sum()))
    shape = len(wanted), *true.tips.shape[1:]
    return best.reshape(shape), wanted.reshape(shape)


def _passed(values: Floats) -> Floats:
    """Low-pass values (n, k) about their means, and take some of the rows."""
    sections = butter(4, _PASSED, fs=1.0 / DT, output='sos')
    return np.asarray(sosfilt(sections, values - values.mean(axis=0), axis=0)[::_EVERY])


def _held_out(rows: Floats, wanted: Floats, ridge: float) -> Floats:
    """Predict each part of what is wanted, (n, k), by a fit to the others."""
    found = np.empty_like(wanted)
    ends = np.linspace(0, len(rows), _FOLDS + 1).astype(int)
    for first, last in pairwise(ends):
        apart = np.ones(len(rows), dtype=np.bool_)
        apart[max(first - max(_LAGS), 0) : last + max(_LAGS)] = False
        seen = rows[apart]
        normal = seen.T @ seen + ridge * np.eye(rows.shape[1])
        found[first:last] = rows[first:last] @ np.linalg.solve(normal, seen.T @ wanted[apart])
    return found
