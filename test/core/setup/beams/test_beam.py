# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Quadrature along a branch: exact where it should be, whatever the cut; the beam's shapes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import linalg
from scipy.integrate import quad
from scipy.optimize import brentq

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.beams.beam import Attachments, BranchBeam, RotationField, SlopeShape
from tree_sway.core.setup.beams.branch_model import TreeBeams
from tree_sway.core.species.species import species_named

NONE = np.zeros(0)
NO_CHILDREN = Attachments(np.zeros(0, dtype=np.int64), NONE)
UNIFORM = 3.5160152685
"""First root of the uniform clamped beam, w1 sqrt(rho A L^4 / EI) (Blevins, 1979)."""


def branch(tree, children=NO_CHILDREN):
    return BranchBeam(tree.start, tree.end, tree.base_diameter, tree.tip_diameter, children)


def bent_by_wind(one):
    return one.slope_shape(one.bending_moment(one.diameter, NONE, NONE))


def unit_shape(one, curvature):
    """Shape of a curvature, scaled so that its largest slope is 1."""
    slope, nodes, _ = one.from_base(curvature)
    return SlopeShape(one, curvature / max(np.abs(slope).max(), np.abs(nodes).max()))


def static_tip(taper):
    """Tip of the clamped beam under a load 1 - tau x, for L = EI0 = 1, by Euler and Bernoulli."""

    def moment(x):
        return quad(lambda s: (s - x) * (1 - taper * s), x, 1)[0]

    return quad(lambda x: moment(x) * (1 - x) / (1 - taper * x) ** 4, 0, 1, epsrel=1e-10)[0]


def first_frequency(taper, n=12):
    """w1 of the clamped beam for L = EI0 = rho A0 = 1, by Ritz on x^2 .. x^(n + 1)."""
    x, weight = np.polynomial.legendre.leggauss(40)
    x, weight = (x + 1) / 2, weight / 2
    powers = np.arange(2, n + 2)
    w = x[:, None] ** powers
    bend = powers * (powers - 1) * x[:, None] ** (powers - 2)
    stiff = (bend * (weight * (1 - taper * x) ** 4)[:, None]).T @ bend
    mass = (w * (weight * (1 - taper * x) ** 2)[:, None]).T @ w
    return np.sqrt(1.0 / linalg.eigh(mass, stiff, eigvals_only=True)[-1])


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
    stiff = bent_by_wind(one).stiffness(9e9)
    # Energy of the unit shape: EI / L times the integral of (4 (1 - u)^2)^2.
    assert stiff == pytest.approx(3.2 * 9e9 * np.pi / 64 * 0.02**4 / 2.0)


@pytest.mark.parametrize('taper', np.linspace(0.0, 0.9, 10))
def test_tip_and_frequency_are_those_of_the_euler_bernoulli_beam(stem, taper):
    length, base, modulus, density = 2.0, 0.02, 9e9, 900.0
    tree = stem(length, base, base * (1 - taper), cuts=6)
    (model,) = TreeBeams(tree, density).models(subtrees=False)
    shape = model.shape
    stiffness = shape.stiffness(modulus)
    rigidity = modulus * np.pi / 64 * base**4
    load = model.beam.integral(model.drag_area * shape.deflection)
    chord_rotation = base * length**3 / rigidity * static_tip(taper)
    assert load / stiffness == pytest.approx(chord_rotation, rel=2e-3)
    inertia = model.beam.integral(model.mass * shape.deflection**2) * model.inertia_share
    scale = np.sqrt(rigidity / (density * np.pi / 4 * base**2 * length**4))
    assert np.sqrt(stiffness / inertia) == pytest.approx(scale * first_frequency(taper), rel=2e-3)


def test_the_share_of_inertia_is_what_is_known_of_it(stem):
    shares = [
        TreeBeams(stem(tip=tip, cuts=12), 900.0).models(subtrees=False)[0].inertia_share
        for tip in (0.02, 0.02 * (1 - 0.9))
    ]
    # Rayleigh's quotient of the static shape, 3.2 * 405 / 104, over the exact 3.516^2; never below
    # 1.
    assert shares[0] == pytest.approx(3.2 * 405 / 104 / 3.51602**2, rel=1e-5)
    assert 1.0 <= shares[1] < 1.1


@pytest.mark.parametrize('cuts', [6, 12, 24])
def test_results_do_not_depend_on_how_a_branch_is_cut(stem, cuts):
    def figures(n):
        one = branch(stem(length=2.0, tip=0.008, cuts=n))
        shape = bent_by_wind(one)
        inertia = one.integral(one.area * shape.deflection**2)
        load = one.integral(one.diameter * shape.deflection)
        return np.array([shape.stiffness(9e9), inertia, load, one.chord_length])

    assert figures(cuts) == pytest.approx(figures(3), rel=2e-5)
    uniform = [bent_by_wind(branch(stem(cuts=n))).slope for n in (3, cuts)]
    assert uniform[1][-1, -1] == pytest.approx(uniform[0][-1, -1], rel=1e-4)


def test_slope_at_a_child_is_that_of_the_branch_there(stem):
    tree = stem(length=2.0, tip=0.01, cuts=4)
    seats = Attachments(np.array([1, 2, 3]), np.array([1.0, 0.0, 0.5]))
    shape = bent_by_wind(branch(tree, seats))
    assert shape.child_slope[0] == pytest.approx(shape.node_slope[2], rel=1e-12)
    assert shape.child_slope[1] == pytest.approx(shape.node_slope[2], rel=1e-12)
    nodes = np.insert(np.linspace(0.0, 2.0, 5), 4, 1.75)
    z = nodes[:, None] * [0.0, 0.0, 1.0]
    thick = 0.02 - 0.005 * nodes
    cut = bent_by_wind(BranchBeam(z[:-1], z[1:], thick[:-1], thick[1:], NO_CHILDREN))
    assert shape.child_slope[2] == pytest.approx(cut.node_slope[4], rel=1e-12)


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
    field = RotationField.about(shape, axis)
    points, nodes = field.points, field.nodes
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


@pytest.mark.parametrize('fraction', [0.02, 0.1, 0.5, 0.83, 1.0])
def test_a_child_within_a_segment_bends_the_rest_as_if_it_were_cut_there(stem, fraction):
    one = branch(stem(length=3.0, cuts=3), Attachments(np.array([1]), np.array([fraction])))
    place = 1.0 + fraction
    still = np.zeros_like(one.place)
    by_force = unit_shape(one, one.bending_moment(still, np.ones(1), np.zeros(1)))
    # A force at c turns the tip by c^2 / 2 EI and moves it by c^2 (3 L - c) / 6 EI.
    assert by_force.node_deflection[-1] / by_force.node_slope[-1] == pytest.approx(
        3.0 - place / 3.0
    )
    by_moment = unit_shape(one, one.bending_moment(still, np.zeros(1), np.ones(1)))
    # A moment at c turns it by c / EI and moves it by c (L - c / 2) / EI.
    assert by_moment.node_deflection[-1] / by_moment.node_slope[-1] == pytest.approx(
        3.0 - place / 2.0
    )


def test_the_ritz_solution_is_that_of_the_books():
    assert first_frequency(0.0) == pytest.approx(UNIFORM, rel=1e-9)
    root = brentq(lambda b: np.cos(b) * np.cosh(b) + 1.0, 1.5, 2.5, xtol=1e-14)
    assert root**2 == pytest.approx(UNIFORM, rel=1e-9)


@pytest.mark.parametrize('model', ['branch', 12])
def test_a_simulated_uniform_stem_has_the_beams_frequency(stem, model):
    sim = make_simulator(
        stem(length=2.0, base=0.02, cuts=3), model=model, gravity=0.0, enrich='stem'
    )
    wood = species_named('broadleaf')
    # E I / (rho A L^4) with I / A = d^2 / 16.
    w = 3.5160 * np.sqrt(wood.modulus * 0.02**2 / 16.0 / wood.density / 2.0**4)
    assert sim.frequencies(1)[0] == pytest.approx(w / (2 * np.pi), rel=2e-3)
    if model == 12:
        assert sim.frequencies(3)[2] == pytest.approx(22.034 / 3.516 * w / (2 * np.pi), rel=0.02)


@pytest.mark.parametrize('ratio', [0.02, 0.05, 0.12, 0.24])
def test_free_decay_has_the_damping_and_the_frequency_asked_for(stem, ratio):
    tree = stem(length=1.5, base=0.02, tip=0.01)
    sim = make_simulator(tree, model='branch', damping_ratio=ratio, gravity=0.0)
    dt = 1.0 / 240.0
    for _ in range(10):
        sim.step([0.3, 0.0, 0.0], dt)
    tip = []
    for _ in range(1200):
        sim.step([0.0, 0.0, 0.0], dt)
        sim.place()
        tip.append(sim.tip_displacement[0])
    y = np.array(tip[5:]) / np.abs(tip).max()
    down = np.flatnonzero((y[:-1] > 0) & (y[1:] <= 0))
    crossing = down + y[down] / (y[down] - y[down + 1])
    n = min(6, len(crossing) - 1)
    period = (crossing[n] - crossing[0]) / n * dt
    f0 = sim.frequencies(1)[0]
    assert 1.0 / period == pytest.approx(f0 * np.sqrt(1 - ratio**2), rel=0.02)
    # A period apart, everything is smaller by the same factor.
    lag = np.arange(len(y)) * dt + n * period
    inside = lag < (len(y) - 1) * dt
    later = np.interp(lag[inside], np.arange(len(y)) * dt, y)
    shrunk = (later @ y[inside]) / (y[inside] @ y[inside])
    decrement = -np.log(shrunk) / n
    measured = decrement / np.hypot(2 * np.pi, decrement)
    assert measured == pytest.approx(ratio, rel=0.02)
