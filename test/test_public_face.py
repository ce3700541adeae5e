# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What ``import tree_sway`` offers: some twenty names, none of which costs anything idle."""

from __future__ import annotations

import os
from pathlib import Path
import subprocess
import sys

import numpy as np
import pytest

import tree_sway

SOURCE = Path(tree_sway.__file__)
SEEDLING = Path(__file__).parent / 'files' / 'data' / 'seedling.yaml'


def in_a_fresh_interpreter(program: str) -> str:
    environment = {**os.environ, 'PYTHONPATH': str(SOURCE.parents[1])}
    done = subprocess.run(
        [sys.executable, '-c', program],
        capture_output=True,
        text=True,
        env=environment,
        check=True,
    )
    return done.stdout.strip()


@pytest.mark.parametrize('name', tree_sway.__all__)
def test_every_name_is_there(name: str) -> None:
    assert getattr(tree_sway, name) is getattr(tree_sway, name)
    assert name in dir(tree_sway)


def test_sorted_names_and_no_other() -> None:
    assert sorted(tree_sway.__all__) == list(tree_sway.__all__)
    with pytest.raises(AttributeError, match="has no attribute 'trunk'"):
        _ = tree_sway.trunk


def test_importing_it_imports_nothing_else() -> None:
    program = (
        'import sys; before = set(sys.modules); import tree_sway; tree_sway.__version__;'
        "print(*sorted(m for m in set(sys.modules) - before if 'importlib' not in m))"
    )
    loaded = set(in_a_fresh_interpreter(program).split())
    assert 'tree_sway' in loaded
    assert not {'numpy', 'scipy', 'yaml'} & loaded
    assert {name for name in loaded if name.startswith('tree_sway.')} <= {'tree_sway.faces'}


def test_a_simulator_loads_few_modules_and_no_laboratory() -> None:
    """Modules with code are counted, not their packages."""
    program = (
        'import sys; import tree_sway.core.run.simulator;'
        "ours = [m for n, m in sys.modules.items() if n.startswith('tree_sway.')];"
        "print(*sorted(m.__name__ for m in ours if not hasattr(m, '__path__')))"
    )
    loaded = in_a_fresh_interpreter(program).split()
    assert 'tree_sway.core.run.simulator' in loaded
    assert len(loaded) <= 35, ' '.join(loaded)
    for room in ('forest', 'files', 'commands', 'growth', 'fidelity'):
        assert not [name for name in loaded if name.startswith(f'tree_sway.{room}.')]


def test_from_a_tree_to_a_record_of_its_sway() -> None:
    tree = tree_sway.open_tree('benjamina')
    rng = np.random.default_rng(0)
    wind = tree_sway.simulate_turbulence(5.0, rate=60.0, duration=2.0, rng=rng)
    record = tree_sway.simulate(tree, wind, model='branch', seconds=1.0)
    assert isinstance(record, tree_sway.SwayRecord)


def test_one_default_model_behind_every_door() -> None:
    from tree_sway.commands.cli import _parser, _table
    from tree_sway.core.run.simulator import SwaySimulator
    from tree_sway_ros.parameters.node_parameters import NODE_PARAMETERS

    default = tree_sway.Settings().model
    tree = tree_sway.open_tree(SEEDLING).tree
    doors = (
        tree_sway.make_simulator(tree),
        SwaySimulator(tree_sway.prepare(tree)),
        tree_sway.Scene([tree_sway.PlacedTree('one', tree)]).simulator(),
    )
    assert [each.model for each in doors] == [str(default)] * len(doors)
    (model,) = (each for each in NODE_PARAMETERS['solver'] if each.name == 'model')
    assert model.default == str(default)
    for command, *more in (['demo'], ['show'], ['plot', '-o', 'a.png']):
        parser = _parser(command, _table('')[0], '')
        assert parser.parse_args([command, 'goldcrest', *more]).model == default


def test_a_tree_of_other_units_or_axes_is_refused_or_told() -> None:
    def stem(end: list[float], diameter: float) -> tree_sway.Tree:
        return tree_sway.tree_from_segments([[0.0, 0.0, 0.0]], [end], [diameter])

    with pytest.raises(tree_sway.TreeSwayError, match='give metres'):
        tree_sway.simulate(stem([0.0, 0.0, 4000.0], 100.0), np.ones((2, 3)), model=2)
    with pytest.warns(UserWarning, match='a lean of 90 degrees'):
        tree_sway.simulate(stem([0.0, 4.0, 0.0], 0.1), np.ones((2, 3)), model=2)
