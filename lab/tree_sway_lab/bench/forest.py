# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A forest timed: what share of a core it takes to solve and place it sixty times per second."""

from __future__ import annotations

from dataclasses import dataclass
import time

import numpy as np

from tree_sway.core.scene import PlacedTree, Scene, SceneSimulator
from tree_sway.core.settings import Settings
from tree_sway_lab.bench.bench_tree import bench_tree, SEGMENTS_A_BRANCH
from tree_sway_lab.bench.step import gusts

RATE = 60.0
N_TREES = 20
#: On the stem and on branches of the next orders: 85 branches of 6 segments.
_CHILDREN = (12, 3, 1)
_SPACING = 8.0
_GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))
_QUIET = 0.1


@dataclass(frozen=True)
class ForestTiming:
    """
    What a forest costs, in CPU-seconds a simulated second: shares of a core.

    Parameters
    ----------
    model
        Model of every tree.
    n_trees, n_branches, n_segments
        Size of the forest.
    solve, place
        Time that one frame in ten stays below: the cost if nothing else runs.
    median
        Median of solving and placing together, whatever else the machine does.

    """

    model: str
    n_trees: int
    n_branches: int
    n_segments: int
    solve: float
    place: float
    median: float


def bench_forest(
    n_trees: int, model: int | str, segments_a_branch: int = SEGMENTS_A_BRANCH
) -> SceneSimulator:
    """
    Plant trees of 85 branches in rows, each turned another way.

    Parameters
    ----------
    n_trees
        How many.
    model
        Model of every tree.
    segments_a_branch
        How finely branches are cut.

    """
    tree = bench_tree(segments_a_branch, _CHILDREN)
    columns = int(np.ceil(np.sqrt(n_trees)))
    trees = [
        PlacedTree(
            f'tree{i}',
            tree,
            x=_SPACING * (i % columns),
            y=_SPACING * (i // columns),
            yaw=_GOLDEN_ANGLE * i,
        )
        for i in range(n_trees)
    ]
    return SceneSimulator(Scene(trees), Settings(model=model))


def time_forest(forest: SceneSimulator, frames: int = 600) -> ForestTiming:
    """Take a forest through gusts at 60 frames per second and time every frame."""
    winds = gusts(200)
    block = np.zeros((forest.tree.n_segments, 7))
    dt = 1.0 / RATE
    spent = np.empty((frames, 2))
    forest.step(winds[0], dt)
    for frame, row in enumerate(spent):
        begin = time.process_time_ns()
        forest.step(winds[frame % len(winds)], dt)
        between = time.process_time_ns()
        forest.place(block)
        row[:] = between - begin, time.process_time_ns() - between
    share = spent * 1e-9 * RATE
    solve, place = np.quantile(share, _QUIET, axis=0)
    return ForestTiming(
        forest.model,
        len(forest.names),
        forest.tree.n_branches,
        forest.tree.n_segments,
        float(solve),
        float(place),
        float(np.median(share.sum(axis=1))),
    )


def forest_table(n_trees: int = N_TREES) -> str:
    """Time the forest on two models and lay out what is found."""
    timings = [time_forest(bench_forest(n_trees, model)) for model in ('branch', 20)]
    size = timings[0]
    lines = [
        f'{size.n_trees} trees, {size.n_branches} branches, {size.n_segments} segments at '
        f'{RATE:g} Hz',
        'share of a core    solve    place      sum   median',
    ]
    for timing in timings:
        shares = timing.solve, timing.place, timing.solve + timing.place, timing.median
        lines.append(f'  {timing.model:13}' + ''.join(f'{100.0 * each:7.2f} %' for each in shares))
    return '\n'.join(lines)
