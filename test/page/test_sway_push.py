# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A branch pulled in JavaScript against the same in Python: how far, and how it swings after."""

from __future__ import annotations

import json
from pathlib import Path
import shutil
import subprocess
from typing import Any

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway.core.run.pushes import Spring  # noqa: E402
from tree_sway.core.scene.placed_tree import PlacedTree  # noqa: E402
from tree_sway.core.scene.scene import Scene  # noqa: E402
from tree_sway.core.scene.scene_simulator import Simulator  # noqa: E402
from tree_sway.core.settings import Settings  # noqa: E402
from tree_sway.core.tree.tree import Tree  # noqa: E402
from tree_sway.files.trees.source import open_scene  # noqa: E402
from tree_sway.stream.scene_state import SceneState  # noqa: E402

HERE = Path(__file__).parent
DT, STEPS, PUSHED = 1.0 / 60.0, 600, 300
WIND = (0.0, 0.0, 0.0)


def pushed_in_javascript(simulator: Simulator, folder: Path, push: dict[str, Any]) -> Any:
    """Return where the pushed segment is after each step, (STEPS, 3)."""
    node = shutil.which('node')
    if node is None:
        pytest.skip('node is not installed here')
    scene = SceneState(simulator)
    (folder / 'description.bin').write_bytes(scene.description)
    (folder / 'tables.bin').write_bytes(scene.tables() or b'')
    given = {'push': push, 'wind': WIND, 'steps': STEPS, 'steps_pushed': PUSHED}
    (folder / 'push.json').write_text(json.dumps(given), encoding='utf-8')
    command = [node, str(HERE / 'sway_push.mjs'), str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found['refused']
    return np.array(found['places'])


def high_segment(tree: Tree) -> int:
    """Find the segment at seven tenths of the height below the highest tip."""
    segment, chain = int(np.argmax(tree.end[:, 2])), []
    while segment >= 0:
        chain.append(segment)
        segment = int(tree.segment_parent[segment])
    height = tree.start[0, 2] + 0.7 * tree.height
    return min(chain, key=lambda each: abs(float(tree.start[each, 2]) - height))


@pytest.mark.parametrize('kind', ['force', 'spring'])
def test_a_branch_pulled_by_a_tenth_of_the_height_goes_and_swings_as_in_python(
    kind: str, tmp_path: Path
) -> None:
    simulator: Any = open_scene('goldcrest').simulator(Settings(), model=60)
    tree = simulator.tree
    segment = high_segment(tree)
    rest = tree.start[segment]
    to = rest + 0.2 * tree.height * np.array([0.9, 0.4, 0.0])
    simulator.push(segment, (1.0, 0.0, 0.0), 99.0, along=0.0)
    for _ in range(600):
        simulator.step((0.0, 0.0, 0.0), DT)
    stiffness = 1.0 / np.linalg.norm(simulator.place()[segment, :3] - rest)
    push: Any = {'segment': segment, 'to': to.tolist(), 'stiffness': float(stiffness)}
    if kind == 'force':
        push = {'segment': segment, 'force': (0.5 * stiffness * (to - rest)).tolist()}
    simulator.reset()
    simulator.push(segment, (0.0, 0.0, 0.0), 1e-9, along=0.0)
    found = pushed_in_javascript(simulator, tmp_path, push)
    simulator.reset()
    expected = []
    for step in range(STEPS):
        if step < PUSHED:
            force = push.get('force') or Spring(to, stiffness)
            simulator.push(segment, force, 0.5 if step < PUSHED - 1 else DT, along=0.0)
        simulator.step(WIND, DT)
        expected.append(simulator.place()[segment, :3])
    there = np.array(expected) - rest
    moved = float(np.linalg.norm(there[PUSHED - 1]))
    apart = np.linalg.norm(found - expected, axis=1)
    shares = apart[PUSHED - 1] / moved, apart[PUSHED:].max() / moved
    print(f'{kind}: {moved / tree.height:.3f} of the height; apart', *shares)
    assert 0.06 < moved / tree.height < 0.2
    # The description holds the shapes of wind, so that a pull loses some of its own.
    assert apart[PUSHED - 1] < 0.03 * moved
    assert apart[PUSHED:].max() < 0.05 * moved
    assert np.ptp(there[PUSHED:, 0]) > 0.5 * moved  # it swings back


def test_a_limb_gives_way_as_in_python(tmp_path: Path) -> None:
    simulator: Any = open_scene('goldcrest').simulator(Settings(damping_ratio=0.5), model=20)
    tree = simulator.tree
    first, end = tree.branch_first[133:135]
    segment = int(first + round(0.7 * (end - first - 1)))
    push = {'segment': segment, 'force': [0.01, 0.02, 0.03]}
    found = pushed_in_javascript(simulator, tmp_path, push)[PUSHED - 1] - tree.start[segment]
    simulator.reset()
    for _ in range(PUSHED):
        simulator.push(segment, push['force'], 0.5, along=0.0)
        simulator.step(WIND, DT)
    there = simulator.place()[segment, :3] - tree.start[segment]
    assert np.linalg.norm(there) > 1e-3
    assert np.linalg.norm(found - there) < 0.02 * np.linalg.norm(there)


def test_a_tree_of_a_stand_is_pulled_where_it_stands(tmp_path: Path) -> None:
    one = open_scene('goldcrest').trees[0]
    places = [{'x': 0.0, 'yaw': 0.0, 'scale': 1.0}, {'x': 9.0, 'yaw': 0.5 * np.pi, 'scale': 2.0}]
    trees = [
        PlacedTree(f'tree {i}', one.tree, species=one.species, **each)
        for i, each in enumerate(places)
    ]
    simulator = Scene(trees, 'two').simulator(Settings(damping_ratio=0.5), model=20)
    # Four times the force bends a tree of twice the size by the same angles.
    moved = []
    for number, force in enumerate([[4.0, 0.0, 0.0], [0.0, 16.0, 0.0]]):
        push = {'segment': number * one.tree.n_segments + high_segment(one.tree), 'force': force}
        found = pushed_in_javascript(simulator, tmp_path, push)
        moved.append(found[PUSHED - 1] - found[-1])
    x, y, z = moved[0]
    assert x > 0.01
    np.testing.assert_allclose(moved[1], [-2.0 * y, 2.0 * x, 2.0 * z], atol=0.02 * x)
