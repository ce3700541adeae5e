# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A model of a file is stepped without what made it."""

from __future__ import annotations

import importlib.util
from pathlib import Path
import subprocess
import sys

from tree_sway.core.setup.preparation import prepare
from tree_sway.files.models.model_writer import write_model

ROOT = Path(__file__).resolve().parents[3]

STEPS_A_MODEL_OF_A_FILE = """
import sys
import tree_sway

simulator = tree_sway.make_simulator(tree_sway.read_model(sys.argv[1]))
simulator.step((5.0, 0.0, 0.0), 1 / 60)
simulator.place()
stepped = {name for name in sys.modules if name.partition('.')[0] == 'tree_sway'}
simulator.push(0, (1.0, 0.0, 0.0), 0.1)
simulator.place()
after = {name for name in sys.modules if name.startswith('tree_sway.core.setup.')}
print(*(sys.modules[name].__file__ for name in stepped))
print(*after)
"""

MOST_MODULES, MOST_TOKENS = 32, 20_000
"""Modules that are loaded to step a model of a file, without faces, and tokens of them all."""


def tokens_of(path: str) -> int:
    spec = importlib.util.spec_from_file_location('count', ROOT / '.ci' / 'count.py')
    assert spec is not None
    assert spec.loader is not None
    count = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = count  # where its dataclass looks for the types of its fields
    spec.loader.exec_module(count)
    return int(count.count_of(Path(path)).tokens)


def test_a_model_of_a_file_is_stepped_without_loading_the_set_up(stem, tmp_path):
    path = tmp_path / 'stem.npz'
    write_model(path, prepare(stem(), model=5, cache=None))
    done = subprocess.run(
        [sys.executable, '-c', STEPS_A_MODEL_OF_A_FILE, str(path)],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    stepped, setup = (line.split() for line in done.stdout.splitlines())
    tokens = {name: tokens_of(name) for name in stepped}
    modules = sorted(name for name in stepped if Path(name).name != '__init__.py')
    for name in modules:
        print(f'{tokens[name]:>6}  {Path(name).relative_to(ROOT)}')
    count = sum(tokens[name] for name in modules)
    print(f'{count:>6}  tokens of {len(modules)} modules')
    assert not setup
    assert len(modules) <= MOST_MODULES
    assert count <= MOST_TOKENS
