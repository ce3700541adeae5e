# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The default model timed by the size of the tree, and how far it is from `full`.

The step is timed without placing, as the kernel runs it, and with it, as a program calls both.
"""

from __future__ import annotations

from collections.abc import Sequence
import time

import numpy as np

from tree_sway.commands import bar
from tree_sway.core.arrays import Floats
from tree_sway.core.run import SwaySimulator, TableOscillators
from tree_sway.core.scene import make_simulator
from tree_sway.core.tree import Tree
from tree_sway.core.wind import simulate_turbulence
from tree_sway.errors import ParameterError
from tree_sway_lab.bench.bench_tree import bench_tree
from tree_sway_lab.bench.measured import Measured
from tree_sway_lab.bench.step import gusts

SIZES = {121: (12, 3, 2), 1201: (12, 11, 8), 10105: (24, 20, 20)}
"""
Branches of the trees, and how many of them sit on one of each order; what carries more is thicker.

"""

_DT = 1.0 / 60.0
_STEPS, _ROUNDS = 5000, 20
_SPEEDS, _SECONDS = (2.0, 5.0, 8.0, 12.0), 20.0


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
        CPU times in [us], those of the quietest round; set-up in [s] of CPU time; errors over the
        motion of the segments, of `full`, in gusts and turns.

    """
    if not trees:
        trees = [bench_tree(2, children, bears=True) for children in SIZES.values()]
    simulators, set_up = [], []
    for tree in bar(trees, 'tables of winds'):
        begun = time.process_time()
        simulators.append(make_simulator(tree))
        set_up.append(time.process_time() - begun)
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
        for what, value in zip(('native step', 'step', 'place'), spent, strict=True):
            rows.append(Measured(f'{what}, {tree.n_branches} branches', value, 'us'))
        each = 1e3 * spent[2] / tree.n_segments
        rows.append(Measured(f'place one of {tree.n_segments} segments', each, 'ns'))
    for tree, spent_once in zip(trees, set_up, strict=True):
        rows.append(Measured(f'set-up, CPU, {tree.n_branches} branches', spent_once, 's'))
    rows += errors(simulators)
    kernels = least[:, 0]
    ratio = float(kernels.max() / kernels.min())
    rows.append(Measured('native step, most over least', ratio, '-'))
    return rows


def errors(simulators: Sequence[SwaySimulator]) -> list[Measured]:
    """Measure how far tables are from `full`, of trees that it takes, over the motion."""
    rows = []
    for simulator in bar(simulators, 'against full'):
        tree = simulator.tree
        try:
            species = simulator.models[0].species
            other = make_simulator(tree, species, simulator.settings, model='full')
        except ParameterError:  # more coordinates than `full` takes
            continue
        for speed in _SPEEDS:
            bank, winds = simulator.banks[0].oscillators, gusts_and_turns(speed)
            assert isinstance(bank, TableOscillators)
            before = bank.n_outside
            error = against(simulator, other, winds)
            where = f'in {speed:g} m/s, {tree.name}, {tree.n_branches} branches'
            rows.append(Measured(f'error {where}', error, '-'))
            share = (bank.n_outside - before) / len(winds)
            rows.append(Measured(f'steps outside of the table {where}', share, '-'))
    return rows


def against(simulator: SwaySimulator, other: SwaySimulator, winds: Floats) -> float:
    """Root mean square gap of all segments over that of the other's motion about its mean."""
    simulator.reset()
    other.reset()
    placed, gaps = [], []
    for number, wind in enumerate(winds):
        simulator.step(wind, _DT)
        other.step(wind, _DT)
        if number >= 60 and number % 6 == 0:
            placed.append(other.place()[:, :3].copy())
            gaps.append(np.square(simulator.place()[:, :3] - placed[-1]).sum(axis=1).mean())
    motion = np.array(placed) - np.mean(placed, axis=0)
    return float(np.sqrt(np.mean(gaps) / np.square(motion).sum(axis=2).mean()))


def gusts_and_turns(speed: float, seconds: float = _SECONDS, seed: int = 5) -> Floats:
    """Turbulence of 60 Hz, a gust of 1.6 times, a slow turn and a sudden one by 90 degrees."""
    n = round(seconds / _DT)
    wind = simulate_turbulence(speed, rate=60.0, duration=seconds, rng=np.random.default_rng(seed))
    at = np.arange(n) * _DT
    wind *= (1.0 + 0.6 * np.exp(-0.5 * ((at - 10.0) / 0.4) ** 2))[:, None]
    turn = 0.65 + 0.03 * at + np.where(at > 14.0, 0.5 * np.pi, 0.0)
    x, y, z = wind.T
    cosine, sine = np.cos(turn), np.sin(turn)
    turned: Floats = np.stack([cosine * x - sine * y, sine * x + cosine * y, z], axis=1)
    return turned


def _run(simulator: SwaySimulator, winds: Floats) -> None:
    stand = simulator.banks[0].stand
    for wind in winds.tolist():
        stand.wind[0], stand.wind[1], stand.wind[2] = wind
        stand.step_first()
