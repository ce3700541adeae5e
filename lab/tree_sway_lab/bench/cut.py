# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Solving timed by how finely branches are cut, which should not matter to key segments."""

from __future__ import annotations

from collections.abc import Sequence
import time

import numpy as np

from tree_sway.core.scene import make_simulator
from tree_sway_lab.bench.bench_tree import bench_tree
from tree_sway_lab.bench.step import gusts
from tree_sway_lab.resegment import resegment

CUTS = (3, 6, 12, 24)
_DT = 1.0 / 60.0
_STEPS_A_ROUND = 20
_QUIET = 0.1


def time_cuts(model: int | str, rounds: int, cuts: Sequence[int] = CUTS) -> dict[int, float]:
    """
    Time the same tree cut in several ways.

    Parameters
    ----------
    model
        Model.
    rounds
        Number of rounds of twenty steps; all cuts take turns, so that they meet the same load of
        the machine.
    cuts
        Segments per branch.

    Returns
    -------
    dict
        By cut, CPU time of a step in [s] that one round in ten stays below.

    """
    tree = bench_tree()
    simulators = [make_simulator(resegment(tree, cut), model=model) for cut in cuts]
    winds = gusts(_STEPS_A_ROUND)
    spent = np.empty((rounds, len(cuts)))
    for row in spent:
        for i, simulator in enumerate(simulators):
            # Once untimed: what the others pushed out of the cache comes back.
            simulator.step(winds[0], _DT)
            begin = time.process_time_ns()
            for wind in winds:
                simulator.step(wind, _DT)
            row[i] = time.process_time_ns() - begin
    quiet = np.quantile(spent, _QUIET, axis=0) * 1e-9 / _STEPS_A_ROUND
    return dict(zip(cuts, quiet.tolist(), strict=True))


def unevenness(by_cut: dict[int, float]) -> float:
    """Most over least, less 1."""
    return max(by_cut.values()) / min(by_cut.values()) - 1.0


def cut_table(rounds: int) -> str:
    """Time all models and lay out what is found."""
    lines = [
        'solve [us], segments per branch'
        + ''.join(f'{cut:9}' for cut in CUTS)
        + '   most over least'
    ]
    for model in ('branch', 20, 60, 'full'):
        by_cut = time_cuts(model, rounds)
        times = ''.join(f'{1e6 * spent:9.1f}' for spent in by_cut.values())
        lines.append(f'  {model!s:27}{times}   {100.0 * unevenness(by_cut):+13.1f} %')
    return '\n'.join(lines)
