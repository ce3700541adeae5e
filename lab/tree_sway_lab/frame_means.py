# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Means of a wind record over frames of one length: nothing is late, all of it is known."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats


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
