# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tree in Newton: it is at rest in a calm under its weight, and leans with the wind."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.compare.engines import run_engines
from tree_sway_lab.compare.mujoco_tree import MujocoTree
from tree_sway_lab.example_trees import tapered_stem

from tree_sway.core.species.species import Species

WOOD = Species('example', 'example', 8.0e9, 900.0)


def leaning_stem():
    return tapered_stem(3.0, np.linspace(0.06, 0.02, 7), direction=(0.28, 0.0, 0.96))


@pytest.mark.long
def test_it_is_at_rest_in_a_calm_and_leans_with_the_wind():
    pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    pytest.importorskip('newton', reason='needs Newton (pip install newton)')
    from tree_sway_lab.compare.newton_tree import NewtonTree

    tree = leaning_stem()
    twin = MujocoTree(tree, WOOD, 0.05, even=False, match_beam=False, gravity=9.81)
    calm, cost = NewtonTree(twin, 9.81).race(np.zeros((20, 3)))
    assert cost > 0.0
    assert np.abs(calm - tree.end[-1]).max() < 2e-3
    wind = np.tile([0.0, 12.0, 0.0], (20, 1))
    tips, _ = NewtonTree(twin, 9.81).race(wind)
    truth, _ = twin.race(wind)
    assert tips[-1, 0, 1] == pytest.approx(truth[-1, 0, 1], rel=0.3)


def test_engines_that_are_not_installed_are_named(monkeypatch, capsys):
    pytest.importorskip('mujoco', reason='needs MuJoCo (pip install mujoco)')
    monkeypatch.setattr('importlib.util.find_spec', lambda name: None)
    wind = np.zeros((2, 3))
    assert run_engines(leaning_stem(), WOOD, 0.05, wind, names=('DART', 'Newton')) == {}
    assert capsys.readouterr().err.splitlines() == [
        'without DART: pip install dartpy', 'without Newton: pip install newton',
    ]  # fmt: skip
