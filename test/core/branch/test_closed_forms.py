# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The closed forms of one tapered branch, against beams that are solved another way."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import linalg, special
from scipy.integrate import quad
from scipy.optimize import brentq

from tree_sway_ros.core.branch import closed_forms as beam
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.errors import ParameterError

TAPERS = np.linspace(0.0, 0.9, 10)


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


@pytest.mark.parametrize("taper", TAPERS)
def test_static_tip_is_the_beams(taper):
    force = 1 - taper / 2
    theta = force * beam.load_lever(1.0, taper) / beam.key_stiffness(1.0, taper, 1.0)
    assert theta == pytest.approx(static_tip(taper), rel=2e-3)


@pytest.mark.parametrize("taper", TAPERS)
def test_first_frequency_is_the_beams(taper):
    square = beam.key_stiffness(1.0, taper, 1.0) / beam.key_inertia(1.0, taper, 1.0, 1.0)
    assert np.sqrt(square) == pytest.approx(first_frequency(taper), rel=2e-3)


def test_the_ritz_solution_is_that_of_the_books():
    assert first_frequency(0.0) == pytest.approx(beam.FIRST_ROOT_UNIFORM, rel=1e-9)
    root = brentq(lambda b: np.cos(b) * np.cosh(b) + 1.0, 1.5, 2.5, xtol=1e-14)
    assert root**2 == pytest.approx(beam.FIRST_ROOT_UNIFORM, rel=1e-9)


def test_a_rigid_key_segment_is_low_by_its_stated_ratio():
    square = beam.key_stiffness(1.0, 0.0, 1.0) / beam.rigid_inertia(1.0, 0.0, 1.0, 1.0)
    assert np.sqrt(square) / 3.5160 == pytest.approx(0.985, rel=5e-3)


@pytest.mark.parametrize("taper", TAPERS)
def test_rigid_inertia_and_lever_are_the_integrals(taper):
    inertia = quad(lambda x: x**2 * (1 - taper * x) ** 2, 0, 1)[0]
    assert beam.rigid_inertia(2.0, taper, 3.0, 5.0) == pytest.approx(15.0 * 8.0 * inertia)
    load = quad(lambda x: 1 - taper * x, 0, 1)[0]
    lever = quad(lambda x: x * (1 - taper * x), 0, 1)[0] / load
    assert beam.load_lever(2.0, taper) == pytest.approx(2.0 * lever)


@pytest.mark.parametrize("taper", TAPERS)
def test_tip_load_stiffness_is_the_beams(taper):
    tip = quad(lambda x: (1 - x) ** 2 / (1 - taper * x) ** 4, 0, 1, epsrel=1e-10)[0]
    assert beam.key_stiffness_tip_load(2.0, taper, 3.0) == pytest.approx(3.0 / 2.0 / tip, rel=1e-9)


def test_scaling_with_length_and_section():
    assert beam.key_stiffness(4.0, 0.3, 6.0) == pytest.approx(beam.key_stiffness(2.0, 0.3, 3.0))
    assert beam.key_inertia(2.0, 0.3, 1.0, 1.0) == pytest.approx(beam.key_inertia(1, 0.3, 1, 1) * 8)
    assert beam.second_moment(2.0) == pytest.approx(np.pi / 4.0)


def test_greenhills_number_is_the_bessel_zero():
    zero = brentq(lambda x: special.jv(-1.0 / 3.0, x), 1.5, 2.2, xtol=1e-13)
    assert beam.greenhill_length(1.0, 1.0) == pytest.approx((2.25 * zero**2) ** (1 / 3), rel=1e-5)


def test_the_volume_rule_is_a_geometric_mean():
    assert beam.volume_rule_stiffness(2.0, 8.0, 3.0) == pytest.approx(12.0)


@pytest.mark.parametrize("taper", [-0.1, 0.95, float("nan")])
def test_a_taper_out_of_the_fit_is_refused(taper):
    for form in (beam.key_stiffness, beam.key_stiffness_tip_load):
        with pytest.raises(ParameterError, match=r"outside 0 \.\. \.9; calibrate by quadrature"):
            form(1.0, taper, 1.0)
    with pytest.raises(ParameterError, match="taper"):
        beam.key_inertia(1.0, taper, 1.0, 1.0)


@pytest.mark.parametrize("model", ["branch", "coupled"])
def test_a_simulated_uniform_stem_has_the_beams_frequency(stem, model):
    sim = SwaySimulator(
        stem(length=2.0, base=0.02, cuts=3), model=model, gravity=0.0, enrich="stem"
    )
    wood = species_named("broadleaf")
    # E I / (rho A L^4) with I / A = d^2 / 16.
    w = 3.5160 * np.sqrt(wood.modulus * 0.02**2 / 16.0 / wood.density / 2.0**4)
    assert sim.frequencies(1)[0] == pytest.approx(w / (2 * np.pi), rel=2e-3)
    if model == "coupled":
        assert sim.frequencies(3)[2] == pytest.approx(22.034 / 3.516 * w / (2 * np.pi), rel=0.02)


@pytest.mark.parametrize("ratio", [0.02, 0.05, 0.12, 0.24])
def test_free_decay_has_the_damping_and_the_frequency_asked_for(stem, ratio):
    tree = stem(length=1.5, base=0.02, tip=0.01)
    sim = SwaySimulator(tree, model="branch", damping_ratio=ratio, gravity=0.0)
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
