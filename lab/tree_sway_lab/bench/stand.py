# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A stand timed: solved and placed as one, and what memory and set-up it takes."""

from __future__ import annotations

from collections.abc import Callable
import resource
import time

import numpy as np

from tree_sway.commands import bar
from tree_sway.core.scene import PlacedTree, Scene, SceneSimulator
from tree_sway.core.settings import Settings
from tree_sway_lab.bench.bench_tree import bench_tree
from tree_sway_lab.bench.measured import Measured
from tree_sway_lab.bench.step import gusts

_DT = 1.0 / 60.0
_CHILDREN = ((12, 3, 3), (11, 3, 3), (10, 4, 3), (13, 3, 3))
_SPACING = 6.0


def bench_stand(n_trees: int) -> SceneSimulator:
    """Plant trees of four kinds of some 1,000 segments, each of its own size and turn."""
    rng = np.random.default_rng(2)
    kinds = [bench_tree(6, each) for each in _CHILDREN]
    side = round(n_trees**0.5) or 1
    trees = [
        PlacedTree(
            f'tree{i}',
            kinds[i % len(kinds)],
            _SPACING * (i % side),
            _SPACING * (i // side),
            scale=float(rng.uniform(0.7, 1.3)),
            yaw=float(rng.uniform(0.0, 2.0 * np.pi)),
        )
        for i in range(n_trees)
    ]
    return SceneSimulator(Scene(trees), Settings())


def time_stand(
    make: Callable[[], SceneSimulator] | None = None, *, n_trees: int = 1000, frames: int = 60
) -> list[Measured]:
    """
    Time a stand.

    Parameters
    ----------
    make
        Makes the stand; `bench_stand` of ``n_trees`` if None.
    n_trees
        How many trees are planted then.
    frames
        How many frames are timed.

    Returns
    -------
    list of Measured
        Times of a frame in [ms], medians, by the processors that the process may use (one under
        ``taskset -c 0``), and CPU time of all of them; set-up in [s] of CPU time; memory in [GB].

    """
    begun = time.process_time()
    stand = bench_stand(n_trees) if make is None else make()
    poses = stand.place()
    winds = gusts(frames)
    stand.step(winds[0], _DT)
    stand.place(poses)
    set_up = time.process_time() - begun
    spent = np.empty((frames, 3))
    for row, wind in zip(spent, bar(list(winds), 'frames of the stand'), strict=True):
        cpu, begun = time.process_time(), time.perf_counter()
        stand.step(wind, _DT)
        stepped = time.perf_counter()
        stand.place(poses)
        row[:] = stepped - begun, time.perf_counter() - stepped, time.process_time() - cpu
    solve, place, cpu = (1e3 * np.median(spent, axis=0)).tolist()
    what = f'{len(stand.names)} trees, {len(poses)} segments'
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    return [
        Measured(f'solve {what}', solve, 'ms'),
        Measured(f'place {what}', place, 'ms'),
        Measured('both', solve + place, 'ms'),
        Measured('both, CPU', cpu, 'ms'),
        Measured('place a segment', 1e6 * place / len(poses), 'ns'),
        Measured('set-up, CPU', set_up, 's'),
        Measured('memory at most', peak, 'GB'),
    ]
