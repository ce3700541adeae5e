# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The solver of the page against the one in Python, on the tables that both are given."""

from __future__ import annotations

from dataclasses import replace
import json
from pathlib import Path
import shutil
import subprocess
from typing import Any

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway_lab.bench.bench_tree import bench_tree  # noqa: E402
from tree_sway_lab.example_trees import leafy_sapling  # noqa: E402

from tree_sway.core.scene import shared_tables  # noqa: E402
from tree_sway.core.scene.placed_tree import PlacedTree  # noqa: E402
from tree_sway.core.scene.scene import Scene  # noqa: E402
from tree_sway.core.scene.scene_simulator import Simulator  # noqa: E402
from tree_sway.core.settings import Settings  # noqa: E402
from tree_sway.core.setup.preparation import prepare  # noqa: E402
from tree_sway.core.species.species import species_named  # noqa: E402
from tree_sway.errors import FormatError  # noqa: E402
from tree_sway.files.trees.source import open_scene  # noqa: E402
from tree_sway.growth.builtin import BUILTIN_TREES  # noqa: E402
from tree_sway.stream.protocol import decode_description, decode_tables  # noqa: E402
from tree_sway.stream.scene_state import SceneState  # noqa: E402
from tree_sway.stream.tables import tables_of  # noqa: E402

HERE = Path(__file__).parent
ROUNDING = 1e-6
"""Lanes of another number add up products of single precision in another order."""
SCAN = HERE.parent / 'files' / 'data'
DT, STEPS, EVERY = 1.0 / 60.0, 1200, 50


def gusty(steps: int = STEPS) -> Any:
    """Gusts that turn once around, rise and fall, and go beyond the table for a while."""
    time = DT * np.arange(steps)
    speed = 7.0 + 5.0 * np.sin(1.3 * time) + 3.0 * np.sin(5.1 * time)
    speed[800:860] = 80.0
    turn = 0.35 * time + 0.3 * np.sin(3.0 * time)
    up = 0.3 * np.sin(2.2 * time) + 0.7 * (np.abs(time - 5.0) < 0.5)
    return speed[:, None] * np.stack([np.cos(turn), np.sin(turn), up], axis=1)


def exported(simulator: Simulator, folder: Path) -> Any:
    """Write what a receiver is given, and return the Python receiver of it."""
    scene = SceneState(simulator)
    tables = tables_of(simulator, scene.kinds, scene.identity)
    assert tables is not None
    (folder / 'description.bin').write_bytes(scene.description)
    (folder / 'tables.bin').write_bytes(tables)
    return decode_tables(tables).scene(decode_description(scene.description), DT)


def compared(simulator: Simulator, folder: Path) -> dict[str, float]:
    """Step both in gusts; what node prints of the differences."""
    node = shutil.which('node')
    if node is None:
        pytest.skip('node is not installed here')
    received, winds, clamped = exported(simulator, folder), gusty(), 0
    expected = []
    for step, wind in enumerate(winds):
        clamped += received.step(wind)
        if (step + 1) % EVERY == 0:
            trees = range(len(received.stand.states.eta))
            expected += [received.coordinates(tree).copy() for tree in trees]
    (folder / 'winds.bin').write_bytes(winds.tobytes())
    (folder / 'expected.bin').write_bytes(np.concatenate(expected).tobytes())
    command = [node, str(HERE / 'sway_vectors.mjs'), str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    found: dict[str, float] = json.loads(done.stdout)
    assert found['compared'] == sum(map(len, expected))
    assert found['reduced'] == received.reduced
    assert clamped > 0
    print(found)
    return found


@pytest.mark.parametrize('model', [60, 20])
@pytest.mark.parametrize(
    'name',
    [
        pytest.param(each, marks=[] if each == 'goldcrest' else [pytest.mark.long])
        for each in BUILTIN_TREES
    ],
)
def test_a_built_in_tree_sways_as_in_python(name: str, model: int, tmp_path: Path) -> None:
    simulator = open_scene(name).simulator(Settings(in_leaf=True), model=model)
    found = compared(simulator, tmp_path)
    assert found['wrong'] <= ROUNDING * max(1.0, found['greatest'])
    assert found['outside'] > 0


def test_a_stand_sways_as_in_python(tmp_path: Path) -> None:
    tree = open_scene('goldcrest').trees[0]
    trees = [
        PlacedTree(f'tree {i}', tree.tree, x=9.0 * i, y=-4.0 * (i % 2), yaw=0.8 * i,
                   scale=1.0 + 0.2 * i, species=tree.species)
        for i in range(4)
    ]  # fmt: skip
    found = compared(Scene(trees, 'row').simulator(Settings(), model=20), tmp_path)
    assert found['wrong'] <= ROUNDING * max(1.0, found['greatest'])


@pytest.fixture
def clamped(monkeypatch: pytest.MonkeyPatch) -> Simulator:
    """Return a stand of which one tree is clamped in an ordinary wind."""

    def prepared(tree: Any, *arguments: Any, **changes: Any) -> Any:
        made = prepare(tree, *arguments, **changes)
        is_first = tree.n_segments == kinds[0].n_segments
        return replace(made, most_energy=1e-4 * made.most_energy) if is_first else made

    monkeypatch.setattr(shared_tables, 'prepare', prepared)
    kinds = bench_tree(), open_scene(str(SCAN / 'fork.treeqsm24.txt')).trees[0].tree
    trees = [PlacedTree(f'tree {i}', kinds[i % 2], x=9.0 * i) for i in range(3)]
    return Scene(trees, 'row').simulator(Settings(), model=20)


def test_trees_that_stay_clamped_go_on_with_fewer_coordinates_as_in_python(
    clamped: Simulator, tmp_path: Path
) -> None:
    found = compared(clamped, tmp_path)
    assert found['reduced'] >= 2
    # Each clamp scales a motion that grows, and its rounding with it.
    assert found['wrong'] <= 10.0 * ROUNDING * max(1.0, found['greatest'])


def test_a_receiver_in_python_leaves_coordinates_out_when_the_simulator_does(
    clamped: Simulator, tmp_path: Path
) -> None:
    received, reduced = exported(clamped, tmp_path), []
    for wind in gusty()[:400]:
        clamped.step(wind, DT)
        received.step(wind)
        reduced.append((clamped.counts.reduced, received.reduced))
        left_out = received.stand.states.left_out
        assert np.array_equal(left_out, clamped._shared.stand.states.left_out)
    assert max(reduced)[0] > 0
    received.correct(received.state() + 0.01)
    states = received.stand.states
    for eta, left_out in zip(states.eta, states.left_out, strict=True):
        assert (eta[20 - int(left_out) :] == 0.0).all()
    received.reset()
    assert (received.stand.states.left_out == 0.0).all()


def test_a_scan_sways_as_in_python(tmp_path: Path) -> None:
    scan = open_scene(str(SCAN / 'fork.treeqsm24.txt'))
    found = compared(scan.simulator(Settings()), tmp_path)
    assert found['wrong'] <= ROUNDING * max(1.0, found['greatest'])


def test_leaves_that_drag_stops_within_a_step_sway_as_in_python(tmp_path: Path) -> None:
    on_petioles = np.ones(13)
    on_petioles[0] = 0.0
    settings = Settings(
        in_leaf=True, leaf_mass=0.0009 * on_petioles, leaf_area=0.006 * on_petioles
    )
    species = replace(species_named('broadleaf'), modulus=9.0e9)
    tree = PlacedTree('tree', leafy_sapling(0.012, 1), species=species)
    found = compared(Scene([tree], 'one').simulator(settings), tmp_path)
    assert found['wrong'] <= 1e3 * ROUNDING  # half a step of drag is 200 times the inertia


def test_what_the_factors_leave_out_is_not_seen(tmp_path: Path) -> None:
    simulator = open_scene('goldcrest').simulator(Settings(), model=20)
    received, farthest, left_out = exported(simulator, tmp_path), 0.0, 0.0
    for wind in gusty(600):
        simulator.step(wind, DT)
        received.step(wind)
        eta = simulator.banks[0].oscillators.memory()[0][0, :20]
        farthest = max(farthest, float(np.abs(eta).max()))
        left_out = max(left_out, float(np.abs(received.coordinates(0) - eta).max()))
    assert left_out <= 1e-3 * farthest


@pytest.fixture(scope='module')
def whole_export(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Export a tree whose tables are as they should be."""
    folder = tmp_path_factory.mktemp('export')
    compared(open_scene('goldcrest').simulator(Settings(), model=6), folder)
    return folder


@pytest.mark.parametrize('cut', [0, 11, -9])
def test_damaged_tables_are_refused_in_a_sentence(
    cut: int, whole_export: Path, tmp_path: Path
) -> None:
    shutil.copytree(whole_export, tmp_path, dirs_exist_ok=True)
    whole = (tmp_path / 'tables.bin').read_bytes()
    (tmp_path / 'tables.bin').write_bytes(whole[:cut])
    node = str(shutil.which('node'))
    command = [node, str(HERE / 'sway_vectors.mjs'), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode != 0
    assert 'ProtocolError' in done.stderr
    with pytest.raises(FormatError, match='tables'):
        decode_tables(whole[:cut])
