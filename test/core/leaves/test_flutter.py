# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The law of flutter, and leaves that ride on their segments."""

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.leaves.flutter import (
    AIR_VISCOSITY,
    flutter_amplitude,
    flutter_angle,
    LARGEST_ANGLE,
)
from tree_sway.core.leaves.foliage import leaf_clusters, LeafClusters
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.tree.tree import Tree


def twig() -> Tree:
    return tree_from_segments([[0, 0, 1.0]], [[0.3, 0.4, 1.2]], [0.004])


def leaves_of(tree: Tree, count: int = 20) -> LeafClusters:
    return leaf_clusters(tree, np.random.default_rng(3), count=count)


@pytest.mark.parametrize('size', [0.03, 0.1])
def test_in_light_wind_the_edge_moves_at_the_measured_speed(size: float) -> None:
    speed, frequency = 1.5, 5.0
    measured = (speed / 740.0) ** 2 * size / AIR_VISCOSITY
    rms_angle = flutter_amplitude(speed, frequency) / np.sqrt(2.0)
    assert 2.0 * np.pi * frequency * rms_angle * 0.5 * size == pytest.approx(measured, rel=1e-2)


@given(st.floats(0.0, 100.0), st.floats(0.0, 100.0), st.floats(0.5, 15.0))
def test_more_wind_never_flutters_less_and_all_is_bounded(
    one: float, other: float, frequency: float
) -> None:
    low, high = np.sort(flutter_amplitude([one, other], frequency))
    assert 0.0 <= low <= high <= LARGEST_ANGLE
    assert flutter_amplitude(min(one, other), frequency) == low


def test_no_wind_no_flutter() -> None:
    assert flutter_amplitude(0.0, 5.0) == 0.0


def test_the_angle_swings_at_the_leaf_own_frequency() -> None:
    leaves = leaves_of(twig(), 1)
    period = 1.0 / leaves.frequency[0]
    times = np.arange(200) / 200.0 * period
    angles = np.array([flutter_angle(leaves, 4.0, time)[0] for time in times])
    amplitude = flutter_amplitude(4.0, leaves.frequency[0])
    assert angles.max() == pytest.approx(amplitude, rel=1e-3)
    assert angles.mean() == pytest.approx(0.0, abs=1e-12)
    assert flutter_angle(leaves, 4.0, period)[0] == pytest.approx(angles[0], abs=1e-12)
