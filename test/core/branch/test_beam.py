# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Quadrature along a branch: exact where it should be, whatever the cut, and the beam's own shapes.

"""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.branch import closed_forms as closed_form
from tree_sway_ros.core.branch.beam import Attachments, BranchBeam
from tree_sway_ros.core.branch.model import branch_models

NONE = np.zeros(0)
NO_CHILDREN = Attachments(np.zeros(0, dtype=np.int64), NONE)


def branch(tree, children=NO_CHILDREN):
    return BranchBeam(tree.start, tree.end, tree.base_diameter, tree.tip_diameter, children)


def bent_by_wind(one):
    return one.slope_shape(one.bending_moment(one.diameter, NONE, NONE))


def test_quadrature_is_exact_for_polynomials_up_to_each_place(stem):
    one = branch(stem(length=2.0, cuts=3), Attachments(np.array([0, 2]), np.array([0.25, 1.0])))
    points, nodes, children = one.from_base(one.place**4)
    assert points == pytest.approx(one.place**5 / 5.0, rel=1e-12, abs=1e-14)
    assert nodes == pytest.approx(one.node**5 / 5.0, rel=1e-12, abs=1e-14)
    assert children == pytest.approx(np.array([1 / 6, 2.0]) ** 5 / 5.0, rel=1e-12, abs=1e-14)
    assert one.integral(one.place**9) == pytest.approx(2.0**10 / 10.0)


def test_a_uniform_branch_has_the_cantilevers_shape(stem):
    one = branch(stem(length=2.0, cuts=5))
    u = one.place / 2.0
    shape = bent_by_wind(one)
    # q L^3 / 6 EI (3 u - 3 u^2 + u^3), over the tip's q L^4 / 8 EI per length.
    assert shape.slope == pytest.approx(4.0 / 3.0 * (3 * u - 3 * u**2 + u**3), rel=1e-12)
    assert shape.deflection / 2.0 == pytest.approx((6 * u**2 - 4 * u**3 + u**4) / 3.0, rel=1e-12)
    assert shape.node_deflection[-1] == pytest.approx(one.chord_length)


def test_stiffness_of_a_uniform_branch(stem):
    one = branch(stem(length=2.0, base=0.02))
    stiff = bent_by_wind(one).stiffness(bent_by_wind(one), 9e9)
    # Energy of the unit shape: EI / L times the integral of (4 (1 - u)^2)^2.
    assert stiff == pytest.approx(3.2 * 9e9 * closed_form.second_moment(0.02) / 2.0)


@pytest.mark.parametrize("taper", [0.0, 0.3, 0.6, 0.9])
def test_tip_and_frequency_agree_with_the_closed_forms(stem, taper):
    length, base, modulus, density = 2.0, 0.02, 9e9, 900.0
    tree = stem(length, base, base * (1 - taper), cuts=6)
    (model,) = branch_models(tree, density, carries=False)
    shape = model.shape
    stiffness = shape.stiffness(shape, modulus)
    rigidity = modulus * closed_form.second_moment(base)
    load = model.beam.integral(model.drag_area * shape.deflection)
    by_form = length * base * (1 - taper / 2) * closed_form.load_lever(length, taper)
    by_form /= closed_form.key_stiffness(length, taper, rigidity)
    assert load / stiffness == pytest.approx(by_form, rel=2e-3)
    inertia = model.beam.integral(model.mass * shape.deflection**2) * model.inertia_share
    calibrated = closed_form.key_stiffness(length, taper, rigidity)
    calibrated /= closed_form.key_inertia(length, taper, density, np.pi / 4 * base**2)
    assert np.sqrt(stiffness / inertia) == pytest.approx(np.sqrt(calibrated), rel=2e-3)


def test_the_share_of_inertia_is_what_is_known_of_it(stem):
    shares = [
        branch_models(stem(tip=0.02 * (1 - tau), cuts=12), 900.0, carries=False)[0].inertia_share
        for tau in (0.0, 0.9)
    ]
    # Rayleigh's quotient of the static shape, 3.2 * 405 / 104, over the exact 3.516^2; never below
    # 1.
    assert shares[0] == pytest.approx(3.2 * 405 / 104 / 3.51602**2, rel=1e-5)
    assert 1.0 <= shares[1] < 1.1


@pytest.mark.parametrize("cuts", [6, 12, 24])
def test_results_do_not_depend_on_how_a_branch_is_cut(stem, cuts):
    def figures(n):
        one = branch(stem(length=2.0, tip=0.008, cuts=n))
        shape = bent_by_wind(one)
        inertia = one.integral(one.area * shape.deflection**2)
        load = one.integral(one.diameter * shape.deflection)
        return np.array([shape.stiffness(shape, 9e9), inertia, load, one.chord_length])

    assert figures(cuts) == pytest.approx(figures(3), rel=2e-5)
    uniform = [bent_by_wind(branch(stem(cuts=n))).slope for n in (3, cuts)]
    assert uniform[1][-1, -1] == pytest.approx(uniform[0][-1, -1], rel=1e-4)


def test_slope_at_a_child_is_that_of_the_branch_there(stem):
    tree = stem(length=2.0, tip=0.01, cuts=4)
    seats = Attachments(np.array([1, 2, 3]), np.array([1.0, 0.0, 0.5]))
    shape = bent_by_wind(branch(tree, seats))
    assert shape.child_slope[0] == pytest.approx(shape.node_slope[2], rel=1e-12)
    assert shape.child_slope[1] == pytest.approx(shape.node_slope[2], rel=1e-12)
    assert shape.child_slope[2] == pytest.approx(shape.slope[3, 2], rel=1e-12)


def test_a_force_and_a_moment_of_a_child_bend_what_lies_below_it(stem):
    one = branch(stem(length=2.0, cuts=2), Attachments(np.array([0]), np.array([1.0])))
    bending = one.bending_moment(np.zeros_like(one.place), np.array([3.0]), np.array([0.5]))
    assert bending[0] == pytest.approx(3.0 * (1.0 - one.place[0]) + 0.5)
    assert np.array_equal(bending[1], np.zeros(5))


def test_total_shear_and_moment_at_the_base_balance_the_load(stem):
    one = branch(stem(length=2.0, tip=0.004, cuts=3))
    bending = one.bending_moment(one.diameter, NONE, NONE)
    clamp = one.integral(one.diameter * one.place)
    slope = (bending[0, 0] - clamp) / one.place[0, 0]
    assert slope == pytest.approx(-one.integral(one.diameter), rel=0.02)
    assert bending[0, 0] < clamp
    assert (np.diff(bending.ravel()) < 0).all()


def test_segment_slopes_carry_the_chord(stem):
    one = branch(stem(length=2.0, tip=0.01, cuts=7))
    shape = bent_by_wind(one)
    assert shape.segment_slope @ one.length == pytest.approx(one.chord_length, rel=1e-12)


def test_displacement_is_across_the_rotation_and_the_branch(stem):
    one = branch(stem(length=2.0, cuts=4, direction=(1.0, 2.0, 2.0)))
    axis = np.array([2.0, 1.0, -2.0]) / 3.0
    shape = bent_by_wind(one)
    points, nodes, _ = shape.displacement(axis)
    assert points @ axis == pytest.approx(0.0, abs=1e-15)
    assert points @ one.chord == pytest.approx(0.0, abs=1e-15)
    assert np.linalg.norm(points, axis=2) == pytest.approx(shape.deflection)
    assert nodes[-1] == pytest.approx(2.0 * np.cross(axis, one.chord))


def test_a_branch_that_turns_back_to_its_base_still_has_a_scale(sketch):
    drawn = sketch()
    drawn.add(None, 0, (1, 0, 0), 1.0, 0.02, 0.02, 1)
    tree = drawn.tree()
    there, back = np.vstack([tree.start, tree.end]), np.vstack([tree.end, tree.start])
    thick = np.full(2, 0.02)
    one = BranchBeam(there, back, thick, thick, NO_CHILDREN)
    assert one.chord_length < 1e-9
    shape = bent_by_wind(one)
    assert np.isfinite(shape.slope).all()
    assert one.integral(shape.slope) == pytest.approx(2.0)


def test_a_unit_shape_has_a_largest_slope_of_one(stem):
    one = branch(stem(cuts=5))
    assert np.abs(one.unit_shape(np.sin(5.0 * one.place)).node_slope).max() <= 1.0
    every = one.unit_shape(np.sin(5.0 * one.place))
    largest = max(np.abs(every.slope).max(), np.abs(every.node_slope).max())
    assert largest == pytest.approx(1.0)


@pytest.mark.parametrize("fraction", [0.02, 0.1, 0.5, 0.83, 1.0])
def test_a_child_within_a_segment_bends_the_rest_as_if_it_were_cut_there(stem, fraction):
    one = branch(stem(length=3.0, cuts=3), Attachments(np.array([1]), np.array([fraction])))
    place = 1.0 + fraction
    still = np.zeros_like(one.place)
    by_force = one.unit_shape(one.bending_moment(still, np.ones(1), np.zeros(1)))
    # A force at c turns the tip by c^2 / 2 EI and moves it by c^2 (3 L - c) / 6 EI.
    assert by_force.node_deflection[-1] / by_force.node_slope[-1] == pytest.approx(
        3.0 - place / 3.0
    )
    by_moment = one.unit_shape(one.bending_moment(still, np.zeros(1), np.ones(1)))
    # A moment at c turns it by c / EI and moves it by c (L - c / 2) / EI.
    assert by_moment.node_deflection[-1] / by_moment.node_slope[-1] == pytest.approx(
        3.0 - place / 2.0
    )
