# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The page of the prepared model suffices: a solver written from it gives the library's poses."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
import re

from drawn_trees import crown, SETTINGS, weeping, WOOD
import numpy as np
import pytest

from tree_sway.core.model.sway_model import MEANINGS
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.wind.turbulence import simulate_turbulence

HERE = Path(__file__).parent
PAGE = (HERE.parents[2] / 'doc' / 'sway_model.md').read_text(encoding='utf-8')
DT = 1 / 60


def write_file(path, model):
    """Write what the solver reads of a file of a model (`files.models` writes the rest)."""
    names = 'start', 'end', 'base_diameter', 'tip_diameter', 'segment_parent', 'branch_first'
    tree = {f'tree_{name}': getattr(model.tree, name) for name in names}
    about = json.dumps({'settings': {'gravity': model.settings.gravity}})
    np.savez(path, about=np.array(about), **tree, **model.arrays())


def page_solver(path, name='PageSolver'):
    spec = importlib.util.spec_from_file_location('page_solver', HERE / 'page_solver.py')
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return getattr(module, name)(path, DT)


@pytest.mark.parametrize(('name', 'speed'), [('fork', 9.0), ('fork', 30.0), ('crown', 14.0)])
def test_a_solver_of_the_page_gives_the_poses_of_the_library(fork, tmp_path, name, speed):
    tree = fork() if name == 'fork' else crown((3, 2), 4)
    path = tmp_path / 'tree.npz'
    model = prepare(tree, model=20)
    write_file(path, model)
    solver, simulator = page_solver(path), SwaySimulator(model)
    rng = np.random.default_rng(11)
    winds = simulate_turbulence(speed, rate=60.0, duration=2.0, rng=rng)
    winds[60:70] = [0.5, 1.0, 7.0]  # steep
    for wind in winds:
        solver.step(wind)
        simulator.step(wind, DT)
    poses = simulator.place()
    found = solver.poses()
    assert np.abs(poses - tree.rest_poses)[:, :3].max() > 0.01 * tree.height
    assert np.abs(found - poses)[:, :3].max() < 1e-5 * tree.height
    same_turn = np.abs(np.sum(found[:, 3:] * poses[:, 3:], axis=1))  # q and -q are one rotation
    half_angle = np.arccos(np.minimum(same_turn, 1.0))
    assert half_angle.max() < 1e-4


@pytest.mark.parametrize(('speed', 'frames'), [(9.0, 25), (22.0, 8), (80.0, 4)])
def test_a_solver_of_the_page_moves_a_limp_tree_as_the_library_does(tmp_path, speed, frames):
    """
    In a wind that takes one part of a frame, in one that takes more, and beyond the limits.

    Each frame begins where the library's does: at 22 m/s twigs whip, and what differs by rounding
    grows tenfold in two frames.
    """
    path = tmp_path / 'limp.npz'
    model = prepare(weeping(1, twigs=3), WOOD, SETTINGS, model=18, cache=None)
    write_file(path, model)
    solver, simulator = page_solver(path, 'LimpPageSolver'), SwaySimulator(model)
    assert simulator.models[0].is_limp
    swing = simulator.banks[0].oscillators.swing
    winds = simulate_turbulence(9.0, rate=60.0, duration=2.0, rng=np.random.default_rng(11))
    for wind in speed / 9.0 * winds[:frames]:
        solver.step(wind)
        simulator.step(wind, DT)
        for own, of_page in zip(swing[:2], (solver.q, solver.v), strict=True):
            np.testing.assert_allclose(own, of_page, atol=1e-7 * np.abs(of_page).max())
            of_page[:] = own
    assert np.abs(simulator.rotations()).max() > 0.3
    assert (solver.n_bounded > 0) == (speed == 80.0)
    assert (simulator.counts.clamped > 0) == (speed == 80.0)
    poses = simulator.place()
    assert np.abs(solver.poses() - poses)[:, :3].max() < 1e-5


def test_the_solver_uses_nothing_of_the_library():
    source = (HERE / 'page_solver.py').read_text(encoding='utf-8')
    assert not re.search(r'^\s*(import|from) tree_sway', source, re.MULTILINE)


def test_every_array_is_on_the_page():
    for name, meaning in MEANINGS.items():
        assert f'| `{name}` |' in PAGE
        assert meaning.text in PAGE
