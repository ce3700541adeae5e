# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What ``import tree_sway_ros`` offers: some twenty names, none of which costs anything idle."""

from __future__ import annotations

import ast
import os
from pathlib import Path
import subprocess
import sys

import numpy as np
import pytest

import tree_sway_ros

SOURCE = Path(tree_sway_ros.__file__)


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


@pytest.mark.parametrize('name', tree_sway_ros.__all__)
def test_every_name_is_there(name: str) -> None:
    assert getattr(tree_sway_ros, name) is getattr(tree_sway_ros, name)
    assert name in dir(tree_sway_ros)


def test_about_twenty_names_and_no_other() -> None:
    assert 15 <= len(tree_sway_ros.__all__) <= 25
    assert sorted(tree_sway_ros.__all__) == list(tree_sway_ros.__all__)
    with pytest.raises(AttributeError, match="has no attribute 'trunk'"):
        _ = tree_sway_ros.trunk


def test_type_checkers_are_told_the_same_names_from_the_same_modules() -> None:
    told = {
        alias.name: node.module
        for block in ast.parse(SOURCE.read_text(encoding='utf-8')).body
        if isinstance(block, ast.If)
        for node in block.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    homes = {name: f'tree_sway_ros.{home}' for name, home in tree_sway_ros._HOMES.items()}
    assert told == homes
    assert {*homes, '__version__'} == set(tree_sway_ros.__all__)


def test_importing_it_imports_nothing_else() -> None:
    program = (
        'import sys; before = set(sys.modules); import tree_sway_ros; tree_sway_ros.__version__;'
        "print(*sorted(m for m in set(sys.modules) - before if 'importlib' not in m))"
    )
    loaded = set(in_a_fresh_interpreter(program).split())
    assert 'tree_sway_ros' in loaded
    assert not {'numpy', 'scipy', 'numba', 'yaml'} & loaded
    assert not {name for name in loaded if name.startswith('tree_sway_ros.')}


def test_a_simulator_loads_few_modules_and_no_laboratory() -> None:
    """Counted are modules that hold code, not the rooms they stand in."""
    program = (
        'import sys; import tree_sway_ros.core.simulator.simulator;'
        "ours = [m for n, m in sys.modules.items() if n.startswith('tree_sway_ros.')];"
        "print(*sorted(m.__name__ for m in ours if not hasattr(m, '__path__')))"
    )
    loaded = in_a_fresh_interpreter(program).split()
    assert 'tree_sway_ros.core.simulator.simulator' in loaded
    assert len(loaded) <= 35, ' '.join(loaded)
    for room in ('study', 'files', 'tools', 'core.reference', 'core.growth', 'core.fidelity'):
        assert not [name for name in loaded if name.startswith(f'tree_sway_ros.{room}.')]


def test_from_a_tree_to_a_record_of_its_sway() -> None:
    tree = tree_sway_ros.open_tree('benjamina')
    rng = np.random.default_rng(0)
    wind = tree_sway_ros.simulate_turbulence(5.0, rate=60.0, duration=2.0, rng=rng)
    record = tree_sway_ros.simulate(tree, wind, model='subtree', seconds=1.0)
    assert isinstance(record, tree_sway_ros.SwayRecord)


def test_one_default_model_behind_every_door() -> None:
    from tree_sway_ros.core.simulator.simulator import SwaySimulator
    from tree_sway_ros.ros.parameters.node_parameters import NODE_PARAMETERS
    from tree_sway_ros.tools.cli import _parser

    default = tree_sway_ros.Settings().model
    file = tree_sway_ros.open_tree('goldcrest')
    tree = file.tree
    doors = (
        tree_sway_ros.make_simulator(tree),
        file.simulator(),
        SwaySimulator(tree),
        tree_sway_ros.Forest([tree_sway_ros.PlacedTree('one', tree)]).simulators[0],
    )
    assert [each.model for each in doors] == [default] * len(doors)
    (fidelity,) = (each for each in NODE_PARAMETERS['solver'] if each.name == 'fidelity')
    assert fidelity.default == default
    for command in ('demo', 'show', 'plot'):
        told = vars(_parser(command).parse_args([command, 'goldcrest']))
        assert told.get('fidelity', told.get('model')) == default
