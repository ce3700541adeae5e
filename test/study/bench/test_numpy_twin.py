"""The compiled simulator and its numpy twin: two programs, one motion."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.simulator.simulator import LOAD_HELD, SwaySimulator
from tree_sway_ros.core.tree.building import tree_from_segments
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.study.bench.bench_tree import bench_tree
from tree_sway_ros.study.bench.numpy_twin import NumpyTwin


def segments_in_all_directions(n=60):
    """A tree without rule: segments of any thickness on the ends of others, with gaps."""
    rng = np.random.default_rng(8)
    start, end, parent = np.zeros((n, 3)), np.zeros((n, 3)), np.full(n, -1)
    end[0] = (0, 0, 1)
    for i in range(1, n):
        parent[i] = rng.integers(max(0, i - 8), i)
        start[i] = end[parent[i]] + rng.normal(0, 0.002, 3)
        end[i] = start[i] + rng.normal(0, 0.2, 3) + np.array([0, 0, 0.1])
    return tree_from_segments(start, end, rng.uniform(0.006, 0.02, n), parent=parent)


@pytest.fixture(scope="module")
def tree():
    return segments_in_all_directions()


@pytest.mark.parametrize(
    ("name", "model"), [("wild", "branch"), ("wild", "subtree"), ("bench", "subtree")]
)
def test_two_hundred_random_steps_agree(tree, name, model):
    sim = SwaySimulator(tree if name == "wild" else bench_tree(), model=model, gravity=0.0)
    twin = NumpyTwin(sim)
    rng = np.random.default_rng(2)
    largest = 0.0
    for k in range(200):
        wind, dt = rng.normal(0, 3, 3), rng.choice([1 / 60, 1 / 30, 0.4])
        assert sim.step(wind, dt) == twin.step(wind, dt)
        if k % 10 == 9:
            poses = sim.place()
            assert np.abs(poses - twin.place()).max() < 1e-9
            largest = max(largest, np.abs(sim.tip_displacement).max())
    assert largest > 0.01


def test_they_agree_where_loads_are_held(tree):
    sim = SwaySimulator(tree, model="subtree", gravity=0.0)
    twin = NumpyTwin(sim)
    held = 0
    for k in range(20):
        wind = [145.0, 30.0 * np.sin(k), 5.0]
        status = sim.step(wind, 1 / 60)
        assert twin.step(wind, 1 / 60) == status
        held += status == LOAD_HELD
    # Beyond a radian the kernel's polynomials are right to 3e-9 of a sine, not to rounding.
    assert np.abs(sim.place() - twin.place()).max() < 1e-6
    assert held > 0


@pytest.mark.parametrize("enrich", ["none", "carriers", "all"])
def test_placing_agrees_for_every_way_to_move(tree, enrich):
    sim = SwaySimulator(tree, model="modes", n_modes=6, enrich=enrich, gravity=0.0)
    twin = NumpyTwin(sim)
    for k in range(20):
        sim.step([9.0, 4.0 * np.sin(k), 1.0], 1 / 30)
        poses = sim.place()
        rotations = sim.bank.oscillators.rotations()
        assert np.abs(poses - twin.place(rotations=rotations)).max() < 1e-9
    assert np.abs(sim.tip_displacement).max() > 1e-3


def test_it_writes_where_it_is_told(tree):
    twin = NumpyTwin(SwaySimulator(tree, model="branch"))
    out = np.zeros((tree.n_segments, 7))
    assert twin.place(out) is out
    assert out[:, :3] == pytest.approx(tree.start, abs=1e-12)


def test_it_does_not_step_modes(tree):
    twin = NumpyTwin(SwaySimulator(tree, model="modes", n_modes=2, gravity=0.0))
    with pytest.raises(ParameterError, match=r"model: .*use 'branch' or 'subtree'"):
        twin.step([1.0, 0.0, 0.0], 1 / 60)
