# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""SUNDIALS IDA beside our own methods."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.battery import sundials_ida
from tree_sway_lab.methods.chain import uniform_chain
from tree_sway_lab.methods.multiplier_form import index1, place
from tree_sway_lab.methods.registry import method_named
from tree_sway_lab.methods.trajectory import integrate, sample

from tree_sway.errors import MissingDependencyError

CHAIN = uniform_chain(2, 2.0, 0.05)


def wind(t):
    load = np.stack([3 * np.sin(1.9 * t), 14 + 8 * np.sin(1.45 * t)], -1)
    return np.repeat(0.5 * load[:, None, :], 2, axis=1)


def test_its_residual_is_none_where_the_equation_holds():
    q, v = place(CHAIN.table, np.array([0.2, -0.1]), np.array([1.0, 2.0]))
    load = wind(np.zeros(1))[0]
    accel, lam = index1(CHAIN.table, q, v, load, 0.0, 0.0)
    y, rate = np.concatenate([q, v, lam, 0 * lam]), np.concatenate([v, accel, 0 * lam, 0 * lam])
    out = np.empty(20)
    sundials_ida.residual(CHAIN.table, y, rate, load, out)
    assert np.abs(out).max() < 1e-11
    sundials_ida.residual(CHAIN.table, y, 1.01 * rate, load, out)
    assert np.abs(out).max() > 1e-3


def test_it_agrees_with_our_reference():
    pytest.importorskip('sksundae', reason="SUNDIALS is not installed (extra 'sundials')")
    loads = sample(wind, sundials_ida.NODES, 1 / 60, 60)
    run = sundials_ida.run_ida(CHAIN, loads, 1 / 60, wind(np.zeros(1))[0])
    reference = method_named('radau_ggl')
    exact = integrate(
        reference,
        CHAIN,
        sample(wind, reference.nodes, 1 / 240, 240),
        1 / 240,
        first=wind(np.zeros(1))[0],
    ).theta[::4]
    assert np.sqrt(np.mean((run.theta - exact) ** 2)) < 1e-4
    assert run.flops > 1000
    assert run.seconds > 0.0


def test_without_it_the_extra_is_named(monkeypatch):
    monkeypatch.setattr(sundials_ida, 'is_installed', lambda: False)
    with pytest.raises(MissingDependencyError, match='pip install scikit-sundae'):
        sundials_ida.run_ida(CHAIN, np.zeros((1, 3, 2, 2)), 1 / 60, np.zeros((2, 2)))
