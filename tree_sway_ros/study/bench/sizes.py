# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model `wind_basis` timed by the size of the tree: the step alone, as the kernel runs it, and
step and placing as a program calls them.

"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.kernel import fused
from tree_sway_ros.core.motion.wind_basis import WindBasisBank, step_instance
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.study.bench.bench_tree import bench_tree
from tree_sway_ros.study.bench.measured import Measured
from tree_sway_ros.study.bench.step import gusts
from tree_sway_ros.tools.progress import bar

SIZES = {121: (12, 3, 2), 1201: (12, 11, 8), 10105: (24, 20, 20)}
"""Branches of the trees, and how many of them sit on one of each order."""

_DT = 1.0 / 60.0
_STEPS, _ROUNDS = 5000, 20


def time_sizes(trees: Sequence[Tree] = ()) -> list[Measured]:
    """
    Time trees of several sizes in turn.

    Parameters
    ----------
    trees
        Which; those of `SIZES` if none are given.

    Returns
    -------
    list of Measured
        CPU times in [us], those of the quietest round.

    """
    if not trees:
        trees = [bench_tree(2, children) for children in SIZES.values()]
    simulators = [SwaySimulator(tree, model="wind_basis") for tree in bar(trees, "tables of winds")]
    winds = gusts(_STEPS)
    least = np.full((len(trees), 3), np.inf)
    poses = [np.empty((tree.n_segments, 7)) for tree in trees]
    for simulator in simulators:
        simulator.step(winds[0], _DT)
        _run(simulator, winds[:2])
    for _ in range(_ROUNDS):
        for row, simulator, out in zip(least, simulators, poses, strict=True):
            begun = time.thread_time()
            _run(simulator, winds)
            stepped = time.thread_time()
            for wind in winds[:200]:
                simulator.step(wind, _DT)
            called = time.thread_time()
            for _ in range(20):
                simulator.place(out)
            placed = time.thread_time()
            spent = (stepped - begun) / _STEPS, (called - stepped) / 200, (placed - called) / 20
            row[:] = np.minimum(row, spent)
    rows = []
    for tree, spent in zip(trees, (1e6 * least).tolist(), strict=True):
        for what, value in zip(("kernel of a step", "step", "place"), spent, strict=True):
            rows.append(Measured(f"{what}, {tree.n_branches} branches", value, "us"))
    kernels = least[:, 0]
    rows.append(Measured("kernel, most over least", float(kernels.max() / kernels.min()), "-"))
    return rows


def _run(simulator: SwaySimulator, winds: Floats) -> None:
    bank = simulator.bank.oscillators
    assert isinstance(bank, WindBasisBank)
    _many(bank.record, bank.pace, bank.instance, winds)


@fused
def _many(tables: Any, paces: Any, instances: Any, winds: Floats) -> None:
    for k in range(len(winds)):
        step_instance(
            tables[0], paces[0], instances[0], False, winds[k, 0], winds[k, 1], winds[k, 2], 0.7
        )
