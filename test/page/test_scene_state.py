# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""From a running tree to frames and back: rebuilt poses against the solver's own."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tree_sway_ros.core.growth.builtin import BUILTIN_TREES
from tree_sway_ros.core.growth.grow import grow
from tree_sway_ros.core.scene.make import make_simulator
from tree_sway_ros.core.scene.placed_tree import PlacedTree
from tree_sway_ros.core.scene.stand import Stand, StandKind, StandTree
from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.files.trees.source import open_tree
from tree_sway_ros.files.trees.yaml.forest_file import ForestFile
from tree_sway_ros.page import scene_state
from tree_sway_ros.page.placer import Placer
from tree_sway_ros.page.protocol import decode_description, decode_frame
from tree_sway_ros.page.scene_state import SceneState

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


@pytest.fixture(scope="module")
def tall() -> tuple[SceneState, list[bytes], list[Any]]:
    """A broadleaf of 8 m in a wind of 7 m/s."""
    tree = grow("broadleaf", 8.0, rng=np.random.default_rng(0))
    simulator = make_simulator(tree, species_named(tree.species), model="modes")
    state = SceneState(simulator)
    return state, *swayed(simulator, state, 7.0)


def gaps(rebuilt: list[Any], exact: list[Any]) -> Any:
    """Distance of every segment's start from where the solver has it, in [m]."""
    both = zip(rebuilt, exact, strict=True)
    return np.concatenate([np.linalg.norm(a[:, :3] - b[:, :3], axis=1) for a, b in both])


def test_python_rebuilds_a_tree_of_8_m_within_a_millimetre(tall: Any) -> None:
    state, frames, exact = tall
    placer = Placer(decode_description(state.description))
    rebuilt = [placer.place(decode_frame(frame)) for frame in frames]
    rest = np.linalg.norm(exact[-1][:, :3] - exact[0][:, :3], axis=1).max()
    assert rest > 0.01
    assert np.quantile(gaps(rebuilt, exact), 0.99) < 1e-3


def test_javascript_rebuilds_it_as_well(tall: Any, tmp_path: Path) -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("node is not installed here")
    state, frames, exact = tall
    (tmp_path / "description.bin").write_bytes(state.description)
    for i, frame in enumerate(frames):
        (tmp_path / f"{i}.frame").write_bytes(frame)
    program = tmp_path / "rebuild.mjs"
    program.write_text(REBUILD, encoding="utf-8")
    static = HERE.parents[1] / "tree_sway_ros" / "page" / "static"
    command = [node, str(program), str(static), str(tmp_path), str(len(frames))]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    rebuilt = [
        np.fromfile(tmp_path / f"{i}.poses", dtype=np.float32).reshape(-1, 8)
        for i in range(len(frames))
    ]
    assert np.quantile(gaps(rebuilt, exact), 0.99) < 1e-3


@pytest.mark.parametrize("name", BUILTIN_TREES)
def test_a_frame_of_any_tree_of_the_package_is_small(name: str) -> None:
    state = SceneState(open_tree(name).simulator(model="modes"))
    assert len(state.frame(0)) <= 96


@pytest.mark.parametrize("fidelity", ["branch", "wind_basis", "auto", "segments"])
def test_every_model_can_be_told(fidelity: str) -> None:
    source = open_tree(HERE.parent / "files" / "data" / "seedling.yaml")
    simulator = source.simulator(model=fidelity)
    state = SceneState(simulator)
    frames, exact = swayed(simulator, state, 4.0)
    placer = Placer(decode_description(state.description))
    rebuilt = [placer.place(decode_frame(frame)) for frame in frames]
    assert np.quantile(gaps(rebuilt, exact), 0.99) < 1e-3


def test_trees_of_one_shape_share_a_basis_wherever_they_stand() -> None:
    source = open_tree(HERE.parent / "files" / "data" / "seedling.yaml")
    trees = tuple(
        PlacedTree(f"t{i}", source.tree, x=2.0 * i, yaw=0.7 * i, species=source.species)
        for i in range(3)
    )
    simulator = ForestFile("three", trees, "").simulator(model="modes")
    state = SceneState(simulator)
    assert state.bases[0].matrix is state.bases[1].matrix is state.bases[2].matrix
    frames, exact = swayed(simulator, state, 5.0)
    placer = Placer(decode_description(state.description))
    rebuilt = [placer.place(decode_frame(frame)) for frame in frames]
    assert np.quantile(gaps(rebuilt, exact), 0.99) < 1e-3
    assert json.dumps(state.coordinate_names).startswith('["t0/c0"')


def test_a_simulator_that_stands_finds_its_own_basis_and_is_as_before() -> None:
    source = open_tree(HERE.parent / "files" / "data" / "seedling.yaml")
    simulator = source.simulator(model="modes")
    for _ in range(30):
        simulator.step((6.0, 1.0, 0.0), 1.0 / 60.0)
    before = simulator.state().values
    own = SceneState(simulator, is_running=False)
    np.testing.assert_array_equal(simulator.state().values, before)
    assert own.description == SceneState(simulator).description


def test_a_stand_is_told_on_a_basis_per_kind() -> None:
    source = open_tree(HERE.parent / "files" / "data" / "seedling.yaml")
    kinds = {"seedling": StandKind(source.tree, source.species)}
    standing = [
        StandTree("one", "seedling"),
        StandTree("two", "seedling", x=3.0, yaw=0.7, scale=1.4),
        StandTree("own", "seedling", y=2.0, yaw=2.0, fidelity="modes"),
        StandTree("still", "seedling", y=4.0, yaw=1.0, fidelity="frozen"),
    ]
    stand = Stand(standing, kinds)
    state = SceneState(stand)
    assert state.bases[0].matrix is state.bases[1].matrix is state.bases[3].matrix
    frames, exact = swayed(stand, state, 5.0)
    placer = Placer(decode_description(state.description))
    rebuilt = [placer.place(decode_frame(frame)) for frame in frames]
    moved = np.ptp(np.array(exact)[:, :, :3], axis=0).max(axis=1)
    for told in standing[:3]:
        rows = stand.segments_of(told.name)
        each = gaps([poses[rows] for poses in rebuilt], [poses[rows] for poses in exact])
        assert np.quantile(each, 0.99) < 0.02 * moved[rows].max()
    assert moved[stand.segments_of("still")].max() == 0.0
    assert np.quantile(gaps(rebuilt, exact), 0.99) < 1e-4
    assert json.dumps(state.coordinate_names).startswith('["one/c0"')


def test_a_scene_too_large_to_describe_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scene_state, "MOST_SEGMENTS", 5)
    with pytest.raises(ParameterError, match="by their poses"):
        SceneState(open_tree("goldcrest").simulator(model="frozen"))
