# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Internal forces of a tree at rest against statics by hand."""

import numpy as np
import pytest
from scipy.integrate import trapezoid
from scipy.spatial.transform import Rotation
from tree_sway_lab.frame.element import POINTS
from tree_sway_lab.frame.self_weight import self_weight, SelfWeight

DENSITY = 9000.0
UP, ASIDE = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])


def cone_weight(length, base, tip):
    return DENSITY * np.pi / 12 * length * (base * base + base * tip + tip * tip)


def test_a_column_carries_what_is_on_it():
    found = self_weight(
        np.array([0, 1]), np.zeros((2, 3)), np.tile(UP, (2, 1)), np.array([1.0, 2.0]),
        np.array([0.1, 0.1]), np.zeros(2), DENSITY,
    )  # fmt: skip
    line = DENSITY * np.pi / 4 * 0.01
    above = np.array([3.0 - POINTS, 2.0 * (1.0 - POINTS)])
    assert found.force[..., 2] == pytest.approx(-line * above)
    assert found.base_force[:, 2] == pytest.approx([-3.0 * line, -2.0 * line])
    assert np.abs(found.moment).max() < 1e-12


def test_a_level_beam_bears_the_cantilevers_moment():
    found = self_weight(
        np.array([0]),
        np.zeros((1, 3)),
        ASIDE[None],
        np.array([2.0]),
        np.array([0.1]),
        np.zeros(1),
        DENSITY,
    )
    left = 2.0 * (1.0 - POINTS)
    line = DENSITY * np.pi / 4 * 0.01
    assert found.moment[0, :, 1] == pytest.approx(0.5 * line * left**2)
    assert np.abs(found.moment[0][:, [0, 2]]).max() < 1e-12


def test_a_fork_adds_up_with_its_levers():
    """A stem, and two tapered arms at its end: one over an offset, neither in one plane."""
    arms = np.array([[0.6, 0.0, 0.8], [0.0, -0.8, 0.6]])
    axis = np.vstack([UP, arms])
    length, width = np.array([2.0, 1.0, 1.5]), np.array([0.2, 0.1, 0.12])
    step = np.array([0.0, -0.05, -0.06])
    offset = np.array([[0, 0, 0], [0, 0, 0], [0.0, -0.1, 0.02]])
    found = self_weight(np.array([0, 1, 1]), offset, axis, length, width, step, DENSITY)
    weights = [cone_weight(h, w, w + s) for h, w, s in zip(length, width, step, strict=True)]
    assert found.base_force[0, 2] == pytest.approx(-sum(weights))
    lever = np.zeros(3)
    for k in (1, 2):
        s = np.linspace(0.0, 1.0, 20001)
        area = np.pi / 4 * (width[k] + step[k] * s) ** 2
        centre = trapezoid(area * s, s) / trapezoid(area, s) * length[k]
        lever += weights[k] * (offset[k] + centre * axis[k])
    expected = np.cross(lever, [0.0, 0.0, -1.0])
    # Upright itself, the stem passes the moment of the arms on unchanged.
    assert found.moment[0] == pytest.approx(np.tile(expected, (5, 1)), rel=1e-6)


@pytest.mark.parametrize('seed', range(3))
def test_offset_stiffness_is_the_curvature_of_the_loads_potential(seed, differences):
    rng = np.random.default_rng(seed)
    force, offset = rng.normal(size=(1, 3)), rng.normal(size=(1, 3))
    weight = SelfWeight(np.zeros((1, 5, 3)), np.zeros((1, 5, 3)), force)

    def potential(turn):
        return -force[0] @ Rotation.from_rotvec(turn).apply(offset[0])

    def slope(turn):
        return differences(potential, turn)

    assert weight.offset_stiffness(offset)[0] == pytest.approx(
        differences(slope, np.zeros(3)), abs=1e-6
    )
