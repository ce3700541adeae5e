# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The step's own stability function, its drag, and the damping it is asked for."""

import numpy as np
import pytest
from tree_sway_lab.example_trees import forked_tree, tapered_stem
from tree_sway_lab.segments.articulated import ArticulatedTree
from tree_sway_lab.segments.articulated_step import drag, GAMMA, Laws

E, RHO = 8.0e9, 900.0


def laws(exponent=0.0):
    none = np.zeros((0, 1, 3))
    no_modes = np.zeros(0), np.zeros(0), none, none
    return Laws(0.0, 0.0, 0.0, *no_modes, 0.6, exponent, 4.0, 20.0)


def stability(z):
    """Of ROS2 with an exact Jacobian (Verwer et al. 1999)."""
    return (1 + (1 - 2 * GAMMA) * z + (0.5 - 2 * GAMMA + GAMMA**2) * z * z) / (1 - GAMMA * z) ** 2


@pytest.mark.parametrize('damping', [0.0, 2e-3])
@pytest.mark.parametrize('ratio', [0.1, 1.0, 30.0])
def test_a_small_swing_grows_as_the_stability_function_says(ratio, damping):
    """One joint is linear for small turns, and its spring and damper are the whole Jacobian."""
    model = ArticulatedTree(
        tapered_stem(2.0, [0.05, 0.05]), E, RHO, 0.0, 0.0, rayleigh=(0.0, damping)
    )
    w = 2.0 * np.pi * model.linear_modes(1)[0][0]
    dt, tiny, columns = ratio / w, 1e-7, []
    for turn, rate in ((tiny, 0.0), (0.0, tiny)):
        model.reset()
        model.state.turn[0, 1] = 0.5 * turn
        model.state.rate[0, 0] = rate
        model.step(np.zeros(3), dt)
        columns.append([2.0 * model.state.turn[0, 1] / tiny, model.state.rate[0, 0] / tiny])
    found = np.linalg.eigvals(np.array(columns).T)
    poles = np.roots([1.0, damping * w * w, w * w])
    expected = stability(poles * dt)
    assert np.sort_complex(found) == pytest.approx(np.sort_complex(expected), abs=1e-6)
    assert np.abs(expected).max() <= 1.0 + 1e-12


def test_stiff_springs_are_killed():
    assert abs(stability(-1e8)) < 1e-7
    assert abs(stability(1e8j)) < 1e-7


def test_drag_is_across_the_segment_and_with_the_square():
    up, still = (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
    assert drag(laws(), up, (3.0, 4.0, 9.0), still) == pytest.approx((9.0, 12.0, 0.0))
    assert drag(laws(), up, (0.0, 0.0, 9.0), still) == (0.0, 0.0, 0.0)
    assert drag(laws(), up, (3.0, 4.0, 0.0), (3.0, 4.0, 7.0)) == (0.0, 0.0, 0.0), 'carried along'
    assert drag(laws(), up, still, (2.0, 0.0, 0.0)) == pytest.approx((-2.4, 0.0, 0.0)), (
        'still air brakes'
    )


@pytest.mark.parametrize(
    ('speed', 'counted'), [(1.0, 4.0), (4.0, 4.0), (9.0, 9.0), (20.0, 20.0), (50.0, 20.0)]
)
def test_crowns_streamline_between_two_speeds(speed, counted):
    found = drag(laws(0.5), (0.0, 0.0, 1.0), (speed, 0.0, 0.0), (0.0, 0.0, 0.0))[0]
    assert found == pytest.approx(0.6 * speed**2 * counted**-0.5)


def test_even_damping_gives_each_mode_its_ratio_up_to_the_last():
    tree, ratio = forked_tree(0.5, 0.6, generations=2), 0.04
    model = ArticulatedTree(tree, E, RHO, ratio, damped_modes=8)
    circular = 2.0 * np.pi * model.linear_modes(8)[0]
    slow = len(model.laws.mode_damping)
    assert 1 < slow <= 8
    rate = model.laws.mode_damping + model.laws.stiffness_damping * circular[:slow] ** 2
    assert rate / (2.0 * circular[:slow]) == pytest.approx(np.full(slow, ratio))
    assert model.laws.mode_damping[-1] == pytest.approx(0.0, abs=1e-9)


def test_wind_given_to_each_segment_and_by_factors_is_the_same():
    tree = forked_tree(0.5, 0.6, generations=2)
    factor = np.linspace(0.2, 1.0, tree.n_segments)
    by_factor = ArticulatedTree(tree, E, RHO, subdivisions=2, wind_factor=factor)
    by_rows = ArticulatedTree(tree, E, RHO, subdivisions=2)
    for _ in range(20):
        by_factor.step([9.0, 3.0, 0.0], 1 / 60)
        by_rows.step(factor[:, None] * [9.0, 3.0, 0.0], 1 / 60)
    assert by_factor.place() == pytest.approx(by_rows.place(), abs=1e-14)
    assert np.abs((by_factor.node_positions - tree.end)[tree.branch_first[1:] - 1]).max() > 1e-3


def test_reset_is_rest():
    tree = forked_tree(0.5, 0.6, generations=2)
    model = ArticulatedTree(tree, E, RHO)
    rest, out = model.place(), np.empty((tree.n_segments, 7))
    model.step([20.0, 0.0, 0.0], 1 / 60)
    assert model.place(out) is out
    assert not np.allclose(out, rest)
    model.reset()
    assert np.array_equal(model.place(), rest)
