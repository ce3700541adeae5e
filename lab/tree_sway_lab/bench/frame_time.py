# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""CPU time of a frame, for models in turn, so that all meet the same load of the machine."""

from __future__ import annotations

from collections.abc import Mapping
import time
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree
from tree_sway_lab.tip_error import Swaying

_QUIET = 0.1
_BLOCK = 20


class FrameTime(NamedTuple):
    """CPU time of a step and of placing in [ns]."""

    step: float
    place: float


def frame_times(
    models: Mapping[str, Swaying], tree: Tree, wind: Floats, dt: float, *, frames: int = 300
) -> dict[str, FrameTime]:
    """
    Time every model.

    Parameters
    ----------
    models
        Models of one tree, by name.
    tree
        The tree.
    wind
        Wind of each frame in [m/s], (t, 3), from the start again when it ends.
    dt
        Length of a frame in [s].
    frames
        How many are timed.

    Returns
    -------
    dict
        By name, the time that one frame in ten stays below: what a frame takes when nothing else
        runs, less what it takes to read the clock, a system call of some 0.4 us.

    """
    poses = np.empty((tree.n_segments, 7))
    spent = np.empty((len(models), frames, 3))
    for first in range(0, frames, _BLOCK):
        # In blocks: a model that has just run finds its code and data in the cache.
        for row, model in zip(spent, models.values(), strict=True):
            for frame in range(first, min(first + _BLOCK, frames)):
                begin = time.process_time_ns()
                model.step(wind[frame % len(wind)], dt)
                between = time.process_time_ns()
                model.place(poses)
                end = time.process_time_ns()
                clock = time.process_time_ns() - end
                row[frame] = between - begin, end - between, clock
    quiet = np.quantile(spent, _QUIET, axis=1)
    frame_time = quiet[:, :2] - quiet[:, 2:]
    return {name: FrameTime(*row) for name, row in zip(models, frame_time.tolist(), strict=True)}
