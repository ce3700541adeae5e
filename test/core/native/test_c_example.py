# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The example in C, compiled against the header and the library, gives the poses of Python."""

from __future__ import annotations

from pathlib import Path
import shutil
import subprocess

from drawn_trees import weeping
import numpy as np
import pytest

from tree_sway.core.native.library import FILE
from tree_sway.core.native.model import bytes_of
from tree_sway.core.scene.make import make_simulator

ROOT = Path(__file__).parents[3]
SOURCE = ROOT / 'examples' / 'native' / 'sway.c'
COMPILER = shutil.which('cc') or shutil.which('gcc') or shutil.which('clang')


@pytest.fixture(scope='module')
def program(tmp_path_factory):
    if COMPILER is None or not SOURCE.is_file():
        pytest.skip('no C compiler, or the sources are not here')
    made = tmp_path_factory.mktemp('example') / 'sway'
    command = [COMPILER, '-std=c11', '-Wall', '-Wextra', '-Werror', str(SOURCE)]
    command += ['-I', str(ROOT / 'native'), str(FILE), f'-Wl,-rpath,{FILE.parent}']
    command += ['-o', str(made)]
    subprocess.run(command, check=True, timeout=120)
    return made


@pytest.mark.parametrize('kind', ['fork', 'limp'])
def test_it_gives_the_poses_of_python(fork, program, tmp_path, kind):
    tree = fork() if kind == 'fork' else weeping(twigs=3)
    simulator = make_simulator(tree, model=12)
    assert simulator.models[0].is_limp == (kind == 'limp')
    path = tmp_path / 'tree.sway'
    path.write_bytes(bytes_of(simulator.models[0].native_arrays()))
    done = subprocess.run([program, path], capture_output=True, text=True, check=True, timeout=60)
    found = np.array([line.split() for line in done.stdout.splitlines()], dtype=float)
    expected = []
    for frame in range(300):
        simulator.step((8.0 if frame < 120 else 3.0, 1.0, 0.0), 1.0 / 60.0)
        expected.append(simulator.place()[-1, :3] - simulator.tree.start[0])
    np.testing.assert_allclose(found, expected, atol=1e-8)
    assert np.ptp(found, axis=0).max() > 0.01


def test_a_file_that_is_not_there_is_named(program, tmp_path):
    done = subprocess.run(
        [program, tmp_path / 'no.sway'], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 1
    assert 'no.sway: No such file' in done.stderr


def test_a_damaged_file_is_refused_by_name(fork, program, tmp_path):
    path = tmp_path / 'fork.sway'
    arrays = make_simulator(fork(), model=12).models[0].native_arrays()
    path.write_bytes(bytes_of(arrays)[:5000])
    done = subprocess.run([program, path], capture_output=True, text=True, timeout=60)
    assert done.returncode == 1
    assert "array '" in done.stderr
    assert 'cut off' in done.stderr
