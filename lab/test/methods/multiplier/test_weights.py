# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Coefficients of the implicit methods against the conditions of their order and damping."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods.chain import single_segment
from tree_sway_lab.methods.multiplier.generalized_alpha import GeneralizedAlpha
from tree_sway_lab.methods.multiplier.newmark import Newmark
from tree_sway_lab.methods.multiplier.radau_ggl import NODES, WEIGHTS
from tree_sway_lab.methods.registry import method_named
from tree_sway_lab.methods.trajectory import integrate


def test_radau_satisfies_the_conditions_of_order_five():
    c, b = np.array(NODES), WEIGHTS[-1]
    for k in range(1, 4):
        assert c ** (k - 1) @ WEIGHTS.T == pytest.approx(c**k / k, rel=1e-13), 'collocation'
    for k in range(1, 6):
        assert b @ c ** (k - 1) == pytest.approx(1 / k, rel=1e-13), 'quadrature'
    assert b @ c**5 != pytest.approx(1 / 6, rel=1e-4), 'and not of six'
    assert np.linalg.solve(WEIGHTS.T, b) == pytest.approx([0, 0, 1], abs=1e-12), 'stiffly accurate'


@pytest.mark.parametrize(
    'method',
    [
        GeneralizedAlpha(rho=0.0),
        GeneralizedAlpha(rho=0.5),
        GeneralizedAlpha(rho=1.0),
        Newmark(),
    ],
)
def test_weights_are_those_of_second_order_without_growth(method):
    am, af, beta, gamma = method.weights()
    assert gamma == pytest.approx(0.5 - am + af)
    assert beta == pytest.approx(0.25 * (1 - am + af) ** 2)
    assert am <= af <= 0.5


def amplification(method, ratio):
    """Largest eigenvalue of a linear oscillator's step (Chung and Hulbert 1993, eq. 12)."""
    am, af, beta, gamma = method.weights()
    now = np.array([[1.0, 0.0, -beta], [0.0, 1.0, -gamma], [ratio**2 * (1 - af), 0.0, 1 - am]])
    old = np.array([[1.0, 1.0, 0.5 - beta], [0.0, 1.0, 1 - gamma], [-af * ratio**2, 0.0, -am]])
    return np.abs(np.linalg.eigvals(np.linalg.solve(now, old))).max()


@pytest.mark.parametrize('rho', [0.2, 0.5, 0.8, 1.0])
def test_the_radius_at_infinity_is_the_one_asked_for(rho):
    assert amplification(GeneralizedAlpha(rho=rho), 1e5) == pytest.approx(rho, abs=5e-3)
    assert amplification(GeneralizedAlpha(rho=rho), 1e-2) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(
    ('rho', 'least', 'most'), [(1.0, 0.995, 1.001), (0.8, 0.9, 0.999), (0.0, 0.0, 0.6)]
)
def test_the_smaller_the_radius_the_faster_a_coarse_swing_dies(rho, least, most):
    """A hundred steps of w h = 0.63: Newmark's rule keeps the swing, full damping eats it."""
    chain, method = single_segment(1.0, 0.0), GeneralizedAlpha(rho=rho)
    theta = integrate(method, chain, np.zeros((100, 1, 1, 2)), 0.1, theta=[0.01]).theta[:, 0]
    assert least < np.abs(theta[-12:]).max() / 0.01 < most


def test_linearly_implicit_euler_damps_as_declared():
    """At 0.02 and 2 Hz, 60 steps per second, the decay is that of about 0.12."""
    chain, method = single_segment(2.0, 0.02), method_named('linearly_implicit_euler')
    theta = integrate(method, chain, np.zeros((120, 1, 1, 2)), 1 / 60, theta=[1e-3]).theta[:, 0]
    peaks = np.abs(theta)[1:-1][
        (np.abs(theta)[1:-1] >= np.abs(theta)[:-2]) & (np.abs(theta)[1:-1] > np.abs(theta)[2:])
    ]
    decrement = -np.polyfit(np.arange(len(peaks)), np.log(peaks), 1)[0] / np.pi
    assert decrement / np.sqrt(1 + decrement**2) == pytest.approx(0.12, abs=0.01)
