# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""From a running tree to frames and back: rebuilt poses against the solver's own."""

from __future__ import annotations

from collections.abc import Callable
import json
from pathlib import Path
import shutil
import subprocess
from threading import Thread
from typing import Any

import numpy as np
import pytest

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.scene.scene_simulator import SceneSimulator
from tree_sway.core.species.species import species_named
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.errors import FormatError
from tree_sway.files.trees.source import open_scene, open_tree
from tree_sway.growth.growing import grow
from tree_sway.stream import check_description
from tree_sway.stream.placing import Placer
from tree_sway.stream.protocol import decode_description, decode_frame
from tree_sway.stream.scene_state import SceneState

HERE = Path(__file__).parent
REBUILD = """
import { readFileSync, writeFileSync } from "node:fs";
const [root, folder, count] = process.argv.slice(2);
const { Placer } = await import(`${root}/placing.js`);
const { decodeDescription, decodeFrame } = await import(`${root}/protocol.js`);
const read = (name) => {
  const b = readFileSync(`${folder}/${name}`);
  return b.buffer.slice(b.byteOffset, b.byteOffset + b.byteLength);
};
const description = decodeDescription(read("description.bin"));
const placer = new Placer(description);
for (let i = 0; i < Number(count); i++) {
  const poses = placer.place(decodeFrame(read(`${i}.frame`), description).coordinates);
  writeFileSync(`${folder}/${i}.poses`, new Uint8Array(poses.buffer));
}
"""


def swayed(simulator: Any, state: SceneState, speed: float) -> tuple[list[bytes], list[Any]]:
    """Frames of 20 s in a turbulent wind, twice a second, and the solver's poses of each."""
    wind = simulate_turbulence(speed, rate=60.0, duration=20.0, rng=np.random.default_rng(3))
    frames, poses = [], []
    for number, each in enumerate(wind):
        simulator.step(each, 1.0 / 60.0)
        if number % 30 == 29:
            frames.append(state.frame(number))
            poses.append(simulator.place().copy())
    return frames, poses


@pytest.fixture(scope='module')
def tall() -> tuple[SceneState, list[bytes], list[Any]]:
    """Make a broadleaf of 8 m in a wind of 7 m/s, some of its branches cut."""
    tree = grow('broadleaf', 8.0, rng=np.random.default_rng(0))
    simulator = make_simulator(tree, species_named(tree.species), model=12)
    state = SceneState(simulator)
    keys = simulator.banks[0].branches['coordinate']
    assert (np.diff(keys) < 0).any()  # key segments in another order than their coordinates
    return state, *swayed(simulator, state, 7.0)


def gaps(rebuilt: list[Any], exact: list[Any]) -> Any:
    """Distance of every segment's start from where the solver has it, in [m]."""
    both = zip(rebuilt, exact, strict=True)
    return np.concatenate([np.linalg.norm(a[:, :3] - b[:, :3], axis=1) for a, b in both])


def test_python_rebuilds_a_tree_of_8_m_within_a_millimetre(tall: Any) -> None:
    state, frames, exact = tall
    placer = Placer(decode_description(state.description))
    rebuilt = [
        placer.place(placer.description.coordinates(decode_frame(frame))) for frame in frames
    ]
    rest = np.linalg.norm(exact[-1][:, :3] - exact[0][:, :3], axis=1).max()
    assert rest > 0.01
    assert np.quantile(gaps(rebuilt, exact), 0.99) < 1e-3


def test_javascript_rebuilds_it_as_well(tall: Any, tmp_path: Path) -> None:
    state, frames, exact = tall
    assert np.quantile(gaps(rebuilt_by_javascript(state, frames, tmp_path), exact), 0.99) < 1e-3


def rebuilt_by_javascript(state: SceneState, frames: list[bytes], tmp_path: Path) -> list[Any]:
    """Poses of every frame as the page places them, each (n, 8)."""
    node = shutil.which('node')
    if node is None:
        pytest.skip('node is not installed here')
    (tmp_path / 'description.bin').write_bytes(state.description)
    for i, frame in enumerate(frames):
        (tmp_path / f'{i}.frame').write_bytes(frame)
    program = tmp_path / 'rebuild.mjs'
    program.write_text(REBUILD, encoding='utf-8')
    static = HERE.parents[1] / 'tree_sway' / 'page' / 'static'
    command = [node, str(program), str(static), str(tmp_path), str(len(frames))]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    return [
        np.fromfile(tmp_path / f'{i}.poses', dtype=np.float32).reshape(-1, 8)
        for i in range(len(frames))
    ]


def test_a_frame_of_twelve_coordinates_is_small_whatever_the_tree() -> None:
    for name in ('goldcrest', str(HERE.parent / 'files' / 'data' / 'fork.treeqsm24.txt')):
        state = SceneState(open_scene(name).simulator(model=12))
        assert len(state.frame(0)) <= 96


@pytest.mark.parametrize('model', ['branch', 60, 'auto', 'full'])
def test_every_model_can_be_described(model: str) -> None:
    source = open_scene(HERE.parent / 'files' / 'data' / 'seedling.yaml')
    simulator = source.simulator(model=model)
    state = SceneState(simulator)
    frames, exact = swayed(simulator, state, 4.0)
    placer = Placer(decode_description(state.description))
    rebuilt = [
        placer.place(placer.description.coordinates(decode_frame(frame))) for frame in frames
    ]
    assert np.quantile(gaps(rebuilt, exact), 0.99) < 1e-3


def test_trees_of_one_kind_share_a_basis_wherever_they_are() -> None:
    source = open_tree(HERE.parent / 'files' / 'data' / 'seedling.yaml')
    trees = tuple(
        PlacedTree(f't{i}', source.tree, x=2.0 * i, yaw=0.7 * i, species=source.species)
        for i in range(3)
    )
    simulator = Scene(trees, 'three').simulator(model=20)
    state = SceneState(simulator)
    assert [kind.numbers for kind in state.kinds] == [[0, 1, 2]]
    frames, exact = swayed(simulator, state, 5.0)
    placer = Placer(decode_description(state.description))
    rebuilt = [
        placer.place(placer.description.coordinates(decode_frame(frame))) for frame in frames
    ]
    assert np.quantile(gaps(rebuilt, exact), 0.99) < 1e-3
    assert json.dumps(state.coordinate_names).startswith('["t0/c0"')


def test_a_simulator_at_rest_finds_its_own_basis_and_is_as_before() -> None:
    source = open_scene(HERE.parent / 'files' / 'data' / 'seedling.yaml')
    simulator = source.simulator(model=12)
    for _ in range(30):
        simulator.step((6.0, 1.0, 0.0), 1.0 / 60.0)
    before = simulator.state().values
    own = SceneState(simulator)
    np.testing.assert_array_equal(simulator.state().values, before)
    assert own.description == SceneState(simulator).description


def test_a_stand_is_reported_on_a_basis_per_kind() -> None:
    source = open_tree(HERE.parent / 'files' / 'data' / 'seedling.yaml')
    trees = [
        PlacedTree('one', source),
        PlacedTree('two', source, x=3.0, yaw=0.7, scale=1.4),
        PlacedTree('own', source, y=2.0, yaw=2.0, model='full'),
        PlacedTree('still', source, y=4.0, yaw=1.0, model=0),
    ]
    stand = Scene(trees).simulator(model=20)
    state = SceneState(stand)
    assert [kind.numbers for kind in state.kinds] == [[0, 1, 3], [2]]
    frames, exact = swayed(stand, state, 5.0)
    placer = Placer(decode_description(state.description))
    rebuilt = [
        placer.place(placer.description.coordinates(decode_frame(frame))) for frame in frames
    ]
    moved = np.ptp(np.array(exact)[:, :, :3], axis=0).max(axis=1)
    for placed in trees[:3]:
        rows = stand.segments_of(placed.name)
        each = gaps([poses[rows] for poses in rebuilt], [poses[rows] for poses in exact])
        assert np.quantile(each, 0.99) < 0.02 * moved[rows].max()
    assert moved[stand.segments_of('still')].max() == 0.0
    assert np.quantile(gaps(rebuilt, exact), 0.99) < 1e-4
    assert json.dumps(state.coordinate_names).startswith('["one/c0"')


def test_a_scene_too_large_to_describe_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(check_description, 'MOST_SEGMENTS', 5)
    with pytest.raises(FormatError, match='segments of the kinds'):
        SceneState(open_scene('goldcrest').simulator(model=0))


@pytest.fixture(scope='module')
def avenue() -> tuple[SceneSimulator, SceneState]:
    """Make a thousand trees of two kinds, two of them on a model of their own."""
    source = open_tree(HERE.parent / 'files' / 'data' / 'seedling.yaml')
    larger = PlacedTree('other', source, scale=1.7).placed()
    draw = np.random.default_rng(5)
    trees = [
        PlacedTree(
            f't{i}', larger if i % 3 == 0 else source.tree,
            3.0 * (i % 50), 3.0 * (i // 50), 0.1 * i,
            scale=draw.uniform(0.6, 1.6), yaw=draw.uniform(-3.0, 9.0), species=source.species,
            model='full' if i in (7, 700) else 60,
        )
        for i in range(1000)
    ]  # fmt: skip
    stand = Scene(trees).simulator()
    return stand, SceneState(stand, 50)


def test_a_thousand_trees_are_described_once_per_kind(avenue: Any, tmp_path: Path) -> None:
    stand, state = avenue
    described = decode_description(state.description)
    assert len(described.header['trees']) == 1000
    assert len(described.header['kinds']) == 4
    assert len(state.description) < 300_000
    wind = simulate_turbulence(14.0, rate=60.0, duration=5.0, rng=np.random.default_rng(3))
    for each in wind:
        stand.step(each, 1.0 / 60.0)
    frame = state.frame(0)
    assert len(frame) == 28 + 2 * len(described.scale)
    exact = stand.place()
    rebuilt = Placer(described).place(described.coordinates(decode_frame(frame)))
    assert np.linalg.norm(rebuilt[:, :3] - exact[:, :3], axis=1).max() < 2e-4
    rest = Placer(described).place(np.zeros(len(described.scale)))
    for name in ('t0', 't7', 't8', 't501', 't700', 't999'):
        rows = stand.segments_of(name)
        assert np.linalg.norm(rest[rows, :3] - exact[rows, :3], axis=1).max() > 2e-3
    by_javascript = rebuilt_by_javascript(state, [frame], tmp_path)[0]
    assert np.linalg.norm(by_javascript[:, :3] - exact[:, :3], axis=1).max() < 2e-4


def test_more_coordinates_than_a_frame_can_count_are_refused(
    avenue: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(check_description, 'MOST_COORDINATES', 999)
    with pytest.raises(FormatError, match='coordinates'):
        SceneState(avenue[0])


def pair_of_trees() -> SceneSimulator:
    """Make two trees of one kind, of different sizes."""
    source = open_tree(HERE.parent / 'files' / 'data' / 'seedling.yaml')
    trees = [PlacedTree('one', source), PlacedTree('two', source, x=3.0, yaw=0.7, scale=1.4)]
    return Scene(trees).simulator(model=12)


def gently_tuned(scene: SceneSimulator, is_done: Callable[[], bool]) -> None:
    """Step a scene in a steady wind and tune it again and again, until done and at a goal."""
    number = 0
    while number < 200 or not is_done():
        if number % 40 == 0:
            scene.tune(stiffness_factor=1.5 + 0.5 * (number // 40 % 2), gravity=9.81)
        scene.step((5.0, 1.0, 0.0), 1.0 / 60.0)
        number += 1
    scene.tune(stiffness_factor=2.0)
    for _ in range(60):
        scene.step((5.0, 1.0, 0.0), 1.0 / 60.0)


def test_a_basis_is_found_while_the_scene_is_stepped_and_tuned() -> None:
    scene, undisturbed = pair_of_trees(), pair_of_trees()
    finder = Thread(target=lambda: SceneState(scene))
    finder.start()
    gently_tuned(scene, lambda: not finder.is_alive())
    finder.join()
    gently_tuned(undisturbed, lambda: True)
    # Both have reached the same goal.
    tables = (each._shared._oscillators for each in (scene, undisturbed))
    for own, expected in zip(*tables, strict=True):
        np.testing.assert_allclose(own.modal.stiffness, expected.modal.stiffness, rtol=1e-12)
        np.testing.assert_allclose(own.modal.damping, expected.modal.damping, rtol=1e-12)


def test_a_running_scene_has_the_same_description_and_steps_none_of_its_models() -> None:
    scene = pair_of_trees()
    at_rest = SceneState(pair_of_trees()).description
    assert SceneState(scene).description == at_rest
    assert [group.simulator.counts.steps for group in scene.groups] == [0]


def test_a_seedling_has_no_more_clusters_of_leaves_than_leaves() -> None:
    seedling = open_tree(HERE.parent / 'files' / 'data' / 'seedling.yaml').tree
    (leaves,) = SceneState(make_simulator(seedling, in_leaf=True), 2800).leaves
    assert leaves is not None
    # Its leaves have 0.14 m^2, each about 0.09 m long and half as wide.
    assert 20 < len(leaves.size) < 80


@pytest.mark.long
def test_a_frame_of_the_stand_is_as_large_as_the_page_says() -> None:
    page = (HERE.parents[1] / 'doc' / 'streaming.md').read_text('utf-8')
    scene = open_scene(HERE.parents[1] / 'config' / 'stand.yaml')
    state = SceneState(scene.simulator())
    frame_size = decode_description(state.description).frame_size
    n_poses = sum(each.tree.n_segments for each in scene.trees)
    assert f'| the same as a frame of the stream | {frame_size:,} |' in page
    assert f'| {28 + 56 * n_poses:,} |' in page
