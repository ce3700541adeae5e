# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""An estimate moves by its law; its calm motion is quiet, and not late where the tree is free."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.kernel import WHY_PLAIN
from tree_sway.core.observe.estimate import carry, carry_in_numpy, Estimate
from tree_sway.core.observe.steady_filter import steady_filter, SteadyFilter, sway_law

M, P, LAG, DT = 4, 6, 3, 1.0 / 60.0
KNOWN = np.ones(P, dtype=np.bool_)


@pytest.fixture
def gains() -> SteadyFilter:
    rng = np.random.default_rng(11)
    law = sway_law(np.geomspace(9.0, 90.0, M), np.full(M, 0.3), np.eye(M), 0.6, DT)
    return steady_filter(law, rng.normal(size=(P, 3 * M)), np.full(P, 0.5), LAG)


@pytest.mark.skipif(bool(WHY_PLAIN), reason='nothing is compiled')
def test_compiled_and_in_numpy_it_is_the_same(gains: SteadyFilter) -> None:
    rng = np.random.default_rng(12)
    one, other = Estimate(gains, plain=False), Estimate(gains, plain=True)
    for k in range(40):
        is_known = KNOWN.copy()
        is_known[3:] = k % 7 > 0
        # Now and then a measurement beyond the limit.
        beyond = rng.normal(size=P) * (50.0 if k % 5 == 0 else 1.0)
        for each in (one, other):
            each.advance(beyond, is_known, 1 + k % 3)
        for name in ('state', 'calm', 'innovation', 'innovations', 'sizes'):
            np.testing.assert_allclose(getattr(one, name), getattr(other, name), atol=1e-11)
        np.testing.assert_allclose(one.past_change(), other.past_change(), atol=1e-11)


@pytest.mark.parametrize('late', [0, 5])
def test_the_calm_motion_is_carried_to_the_present_as_in_numpy(
    gains: SteadyFilter, late: int
) -> None:
    rng = np.random.default_rng(14)
    ahead, calm = gains.law.ahead(late), rng.normal(size=(3, M))
    wanted, before = rng.random((2, M))
    trust = before + 0.3 * (wanted - before)
    by_matrix = np.linalg.matrix_power(gains.law.matrix, late) @ calm.ravel()
    expected = trust * by_matrix.reshape(3, M)[:2]
    for each in (carry, carry_in_numpy):
        moved, found = np.zeros((2, M)), before.copy()
        each(ahead, calm, wanted, 0.3, found, moved)
        np.testing.assert_allclose(found, trust, atol=1e-12)
        np.testing.assert_allclose(moved, expected, atol=1e-12)


@pytest.mark.parametrize('plain', [bool(WHY_PLAIN), True])
def test_the_calm_motion_is_quiet_but_not_late(gains: SteadyFilter, plain: bool) -> None:
    rng = np.random.default_rng(13)
    estimate = Estimate(gains, plain=plain)
    told, calm = [], []
    true = np.zeros((3, M))
    true[0] = 5.0
    estimate.state[:] = estimate.calm[:] = true
    for _ in range(400):
        true = (gains.law.step * true).sum(axis=1)
        beyond = gains.sensed @ true.ravel() + 0.5 * rng.normal(size=P)
        estimate.advance(beyond, KNOWN, 1)
        told.append(estimate.state[0] - true[0])
        calm.append(estimate.calm[0] - true[0])
    rough = [np.square(np.diff(each[100:], 2, axis=0)).sum() for each in (told, calm)]
    wrong = [np.square(each[100:]).sum() for each in (told, calm)]
    assert rough[1] < 0.2 * rough[0]
    assert wrong[1] < 1.1 * wrong[0]


def test_what_is_not_known_corrects_nothing(gains: SteadyFilter) -> None:
    estimate = Estimate(gains)
    estimate.advance(np.full(P, 1e3), ~KNOWN, 1)
    assert not estimate.state.any()
    assert not estimate.calm.any()
