# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Means of a wind record over frames of one length: nothing is late, all of it is known."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.wind.gate import SECOND, WindGate
from tree_sway.core.wind.limits import FASTEST_WIND

_TIMEOUT, _DECAY, _FINE = 2.0, 3.0, 0.1  # [s], as of `WindAverage`


def frame_means(time: ArrayLike, velocity: ArrayLike, dt: float) -> Floats:
    """
    Means of a wind record [m/s], (m, 3), joined by lines, over frames of dt [s], (t, 3).

    The first frame begins with the first sample, the last ends by the last.
    """
    t, v = np.asarray(time, dtype=np.float64), np.asarray(velocity, dtype=np.float64)
    slope = np.diff(v, axis=0) / np.diff(t)[:, None]
    whole = np.vstack(
        [np.zeros(3), np.cumsum(0.5 * (v[1:] + v[:-1]) * np.diff(t)[:, None], axis=0)]
    )
    edge = t[0] + dt * np.arange(int((t[-1] - t[0]) / dt + 1e-9) + 1)
    k = np.clip(np.searchsorted(t, edge, side='right') - 1, 0, len(slope) - 1)
    past = (edge - t[k])[:, None]
    means: Floats = np.diff(whole[k] + v[k] * past + 0.5 * slope[k] * past**2, axis=0) / dt
    return means


def recorded_means(time: ArrayLike, velocity: ArrayLike, dt: float) -> Floats:
    """
    Means of a record over frames as `frame_means`, as a live sensor is treated.

    What the gate refuses is left out, but for the speed: a record may hold a hurricane. A gap of
    more than 2 s and three periods is held for that time, then it dies down with 3 s.
    """
    gate, kept = WindGate(max_speed=FASTEST_WIND), []
    t, v = np.asarray(time, dtype=np.float64), np.asarray(velocity, dtype=np.float64)
    for each, vector in zip(t.tolist(), v.tolist(), strict=True):
        verdict = gate.offer(round((each - t[0]) * SECOND) + SECOND, vector)
        if verdict.accepted:
            kept.append((each, *verdict.wind))
    good = np.array(kept).reshape(-1, 4)
    gaps = np.diff(good[:, 0])
    longest = max(_TIMEOUT, 3.0 * float(np.median(gaps))) if len(gaps) else _TIMEOUT
    filled = [good]
    for row in np.flatnonzero(gaps > longest).tolist():
        since, *before = good[row].tolist()
        left = np.arange(0.0, gaps[row] - longest, _FINE)
        faded = np.exp(-left / _DECAY)[:, None] * before
        filled.append(np.column_stack([since + longest + left, faded]))
    whole = np.concatenate(filled)
    whole = whole[np.argsort(whole[:, 0])]
    return frame_means(whole[:, 0], whole[:, 1:], dt) if len(whole) > 1 else np.zeros((0, 3))
