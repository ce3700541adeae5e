# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A stand timed: solved and placed as one, and what memory and set-up it takes."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
import resource
import time

import numpy as np

from tree_sway_ros.core.scene.stand import Stand, StandKind, StandTree
from tree_sway_ros.study.bench.bench_tree import bench_tree
from tree_sway_ros.study.bench.measured import Measured
from tree_sway_ros.study.bench.step import gusts
from tree_sway_ros.tools.progress import bar

_DT, _ROUNDS = 1.0 / 60.0, 60
_CHILDREN = ((12, 3, 3), (11, 3, 3), (10, 4, 3), (13, 3, 3))
_SPACING, _NUMBERS = 6.0, 200_000


def bench_stand(n_trees: int, threads: int = 1) -> Stand:
    """Plant so many trees of four kinds of some 1,000 segments, each of its own size and turn."""
    rng = np.random.default_rng(2)
    kinds = {f'kind{k}': StandKind(bench_tree(6, each)) for k, each in enumerate(_CHILDREN)}
    side = round(n_trees**0.5) or 1
    trees = [
        StandTree(
            f'tree{i}',
            f'kind{i % len(kinds)}',
            _SPACING * (i % side),
            _SPACING * (i // side),
            scale=float(rng.uniform(0.7, 1.3)),
            yaw=float(rng.uniform(0.0, 2.0 * np.pi)),
        )
        for i in range(n_trees)
    ]
    return Stand(trees, kinds, threads=threads)


def time_stand(
    make: Callable[[], Stand] | None = None, *, n_trees: int = 1000, frames: int = 60
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
        CPU times of a frame in [ms], medians; set-up in [s] of CPU time, memory in [GB].

    """
    begun = time.process_time()
    stand = bench_stand(n_trees) if make is None else make()
    poses = np.zeros((stand.n_segments, 7))
    winds = gusts(frames)
    stand.step(winds[0], _DT)
    stand.place(poses)
    set_up = time.process_time() - begun
    spent = np.empty((frames, 2))
    for row, wind in zip(spent, bar(list(winds), 'frames of the stand'), strict=True):
        begun = time.thread_time()
        stand.step(wind, _DT)
        stepped = time.thread_time()
        stand.place(poses)
        row[:] = stepped - begun, time.thread_time() - stepped
    solve, place = (1e3 * np.median(spent, axis=0)).tolist()
    what = f'{len(stand.trees)} trees, {stand.n_segments} segments'
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    threaded = []
    if make is None:
        other = bench_stand(n_trees, threads=2)
        faster = times_faster(lambda: stand.place(poses), lambda: other.place(poses))
        threaded = [
            Measured('two threads place, times faster', faster, '-'),
            Measured('two threads that share nothing, times faster', _of_this_machine(), '-'),
        ]
    return [
        Measured(f'solve {what}', solve, 'ms'),
        Measured(f'place {what}', place, 'ms'),
        Measured('both', solve + place, 'ms'),
        Measured('place a segment', 1e6 * place / stand.n_segments, 'ns'),
        Measured('set-up, CPU', set_up, 's'),
        Measured('memory at most', peak, 'GB'),
        *threaded,
    ]


def times_faster(one: Callable[[], object], other: Callable[[], object]) -> float:
    """Run both in turn; return how much less time by the clock the other's quietest run takes."""
    spent = np.empty((2, _ROUNDS))
    for number in range(_ROUNDS):
        for row, run in zip(spent, (one, other), strict=True):
            begun = time.perf_counter()
            run()
            row[number] = time.perf_counter() - begun
    once, twice = spent.min(axis=1).tolist()
    return float(once / twice)


def _of_this_machine() -> float:
    """Tell how much faster two threads on a few numbers are: near 1 where other work runs."""
    halves = np.ones((2, _NUMBERS))
    with ThreadPoolExecutor(1) as pool:

        def together() -> None:
            other = pool.submit(np.sin, halves[1])
            np.sin(halves[0])
            other.result()

        return times_faster(lambda: np.sin(halves), together)
