# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The examples for engines put the wood where Python has it, in the axes of the engine.

Each is compiled with `stubs`, which stand for what it takes from its engine, and run in a wind.
"""

from __future__ import annotations

from pathlib import Path
import re
import shutil
import subprocess

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tree_sway.core.native.library import FILE
from tree_sway.core.scene.make import make_simulator
from tree_sway.files.models.model_writer import write_native_model

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / 'examples' / 'native'
STUBS = Path(__file__).with_name('stubs')
STEPS = 64
#: The axes of each engine in ours, and its unit, by doc/conventions.md.
AXES = {
    'unity': (((1, 0, 0), (0, 0, 1), (0, 1, 0)), 1.0),
    'godot': (((1, 0, 0), (0, 0, 1), (0, -1, 0)), 1.0),
    'unreal': (((1, 0, 0), (0, -1, 0), (0, 0, 1)), 100.0),
    'gazebo': (((1, 0, 0), (0, 1, 0), (0, 0, 1)), 1.0),
}
SOURCES = {
    'unity': ('SwayTree.cs', 'TreeInUnity.cs'),
    'godot': ('SwayTree.cs', 'TreeInGodot.cs'),
    'unreal': ('TreeInUnreal.h',),
    'gazebo': ('tree_in_gazebo.cc',),
}


def compiled(engine: str, folder: Path) -> list[str]:
    """Compile an example, and return the command that runs it."""
    if not EXAMPLES.is_dir():
        pytest.skip('the examples are not here')
    shutil.copy(FILE, folder / 'libsway.so')
    made = folder / 'program.exe'
    if engine in {'unity', 'godot'}:
        compiler, runtime = shutil.which('mcs'), shutil.which('mono')
        if compiler is None or runtime is None:
            pytest.skip('no Mono')
        sources = [STUBS / f'{engine}.cs', *(EXAMPLES / name for name in SOURCES[engine])]
        command = [compiler, '-warnaserror', '-nowarn:169,649', *map(str, sources)]
        subprocess.run([*command, f'-out:{made}'], check=True, timeout=120)
        return [runtime, str(made)]
    compiler = shutil.which('c++')
    if compiler is None:
        pytest.skip('no C++ compiler')
    # What the example includes of its engine is in the stub already.
    for name in SOURCES[engine]:
        text = (EXAMPLES / name).read_text(encoding='utf-8')
        for header in re.findall(r'#include [<"](.+\.(?:hh|h))[>"]', text):
            (folder / header).parent.mkdir(parents=True, exist_ok=True)
            (folder / header).touch()
    command = [compiler, '-std=c++17', '-Wall', '-Wextra', '-Werror', f'-I{folder}']
    command += [f'-I{EXAMPLES}', f'-I{ROOT / "native"}', str(STUBS / f'{engine}.cc')]
    command += [str(folder / 'libsway.so'), f'-Wl,-rpath,{folder}', '-o', str(made)]
    subprocess.run(command, check=True, timeout=240)
    return [str(made)]


@pytest.mark.parametrize('engine', AXES)
def test_the_wood_is_where_python_has_it(fork, engine, tmp_path):
    command = compiled(engine, tmp_path)
    simulator = make_simulator(fork(), model=12)
    write_native_model(tmp_path / 'tree.sway', simulator.models[0])
    environment = {'LD_LIBRARY_PATH': str(tmp_path), 'PATH': '/usr/bin:/bin'}
    done = subprocess.run(
        [*command, str(tmp_path)], env=environment, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    found = np.array([line.split() for line in done.stdout.splitlines()], dtype=float)
    axes, unit = np.array(AXES[engine][0], dtype=float), AXES[engine][1]

    turned = Rotation.from_quat([0.1, 0.7, -0.5, 0.5]).apply([1.0, 2.0, 3.0])
    np.testing.assert_allclose(found[0], unit * axes @ turned, rtol=1e-5)

    at_rest = simulator.tree.start - simulator.tree.start[0]
    for _ in range(STEPS):
        simulator.step((8.0, 1.0, 0.0), 1.0 / 64.0)
    poses = simulator.place()
    start = poses[:, :3] - simulator.tree.start[0]
    length = np.linalg.norm(simulator.tree.end - simulator.tree.start, axis=1)
    along = Rotation.from_quat(poses[:, 3:]).apply([1.0, 0.0, 0.0])
    end = start + length[:, None] * along
    lower, upper, side = (found[1 + k :: 3] for k in range(3))
    np.testing.assert_allclose(lower, unit * start @ axes.T, atol=2e-6 * unit)
    np.testing.assert_allclose(upper, unit * end @ axes.T, atol=2e-6 * unit)
    thick = 0.5 * (simulator.tree.base_diameter + simulator.tree.tip_diameter)
    np.testing.assert_allclose(
        np.linalg.norm(side - lower, axis=1), 0.5 * unit * thick, atol=2e-6 * unit
    )
    across = np.einsum('ij,ij->i', side - lower, upper - lower)
    np.testing.assert_allclose(across, 0.0, atol=2e-6 * unit**2)
    assert np.abs(start - at_rest).max() > 0.01


@pytest.mark.parametrize('engine', ['unreal', 'gazebo'])
def test_a_file_that_is_not_there_is_named(engine, tmp_path):
    environment = {'LD_LIBRARY_PATH': str(tmp_path), 'PATH': '/usr/bin:/bin'}
    command = [*compiled(engine, tmp_path), str(tmp_path)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60)
    assert 'tree.sway: cannot be opened' in done.stderr


@pytest.mark.parametrize('engine', AXES)
def test_a_file_that_is_no_tree_is_named(engine, tmp_path):
    command = compiled(engine, tmp_path)
    (tmp_path / 'tree.sway').write_bytes(b'no tree')
    environment = {'LD_LIBRARY_PATH': str(tmp_path), 'PATH': '/usr/bin:/bin'}
    done = subprocess.run(
        [*command, str(tmp_path)], env=environment, capture_output=True, text=True, timeout=60
    )
    assert 'model' in done.stderr, done.stderr
    assert 'signal' not in done.stderr
