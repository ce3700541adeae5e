# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""An estimate moves by its law; its calm motion is quiet, and not late where the tree is free."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.arrays import Floats
from tree_sway.core.native.library import address, LIBRARY
from tree_sway.core.native.structures import NativeCorrection, NativeReadings, NativeSensor
from tree_sway.twin.estimate import Estimate
from tree_sway.twin.steady_filter import steady_filter, SteadyFilter, sway_law

M, P, DT = 4, 6, 1.0 / 60.0
ROWS = np.array([0, 1, 2, 9, 10, 11])
"""A quantity of each of two sensors."""


class Sensors:
    """Two sensors in use, and what they measure, (P,)."""

    def __init__(self) -> None:
        self.beyond, self.is_known = np.zeros((2, 9)), np.ones(2, dtype=np.bool_)
        self.each = [
            NativeSensor(dt=DT, is_mounted=1, in_use=1, excess=1.0, usual=1.0) for _ in range(2)
        ]
        self.native = NativeReadings(
            sensors=2, sensor=np.array([each.at for each in self.each], dtype=np.int64),
            beyond=self.beyond, is_known=self.is_known,
        )  # fmt: skip

    def measure(self, values: Floats, *is_known: bool) -> NativeReadings:
        self.beyond.ravel()[ROWS] = values
        self.is_known[:] = is_known
        return self.native


@pytest.fixture
def gains() -> SteadyFilter:
    rng = np.random.default_rng(11)
    law = sway_law(np.geomspace(9.0, 90.0, M), np.full(M, 0.3), np.eye(M), 0.6, DT)
    return steady_filter(law, rng.normal(size=(P, 3 * M)), np.full(P, 0.5))


def test_it_moves_by_its_law_and_is_corrected_by_what_is_not_thrown(
    gains: SteadyFilter,
) -> None:
    rng = np.random.default_rng(12)
    estimate, sensors, law = Estimate(gains, ROWS), Sensors(), gains.law.matrix
    state, calm = np.zeros((2, 3 * M))
    largest, n_thrown = 0.0, 0
    for k in range(40):
        n_periods, is_there = 1 + k % 3, k % 7 > 0
        # Now and then a measurement beyond the limit.
        beyond = rng.normal(size=P) * (50.0 if k % 5 == 0 else 1.0)
        for each in sensors.each:
            each.excess, each.in_use, each.is_refused = 1.0, 1, 0
        estimate.advance(sensors.measure(beyond, True, is_there), n_periods)
        for _ in range(n_periods):
            state, calm = law @ state, law @ calm
        innovation = beyond - gains.sensed @ state
        innovation[3:] *= is_there
        sizes = np.square(innovation / gains.deviation).reshape(2, 3).mean(axis=1)
        size = sizes[1]
        largest = max(largest, float(size))
        excess = 1.0 + DT / 2.0 * (min(size, 400.0) - 1.0) * is_there
        assert sensors.each[1].excess == pytest.approx(excess)
        limited = np.clip(innovation, -6.0 * gains.deviation, 6.0 * gains.deviation)
        thrown = sizes > 100.0
        n_thrown += int(thrown.sum())
        limited[np.repeat(thrown, 3)] = 0.0
        state = state + gains.gain @ limited
        calm = calm + 0.15 * (state - calm)
        np.testing.assert_allclose(estimate.state.ravel(), state, atol=1e-11)
        np.testing.assert_allclose(estimate.calm.ravel(), calm, atol=1e-11)
    assert largest > 36.0
    assert n_thrown > 3


@pytest.mark.parametrize('late', [0, 5])
def test_the_calm_motion_is_carried_to_the_present(gains: SteadyFilter, late: int) -> None:
    rng = np.random.default_rng(14)
    ahead, calm = gains.law.ahead(late), rng.normal(size=(3, M))
    wanted, before, stiffness, leaning = rng.random((4, M))
    swing = rng.normal(size=(2, M))
    trust = before + 0.3 * (wanted - before)
    by_matrix = np.linalg.matrix_power(gains.law.matrix, late) @ calm.ravel()
    eta, rate, force = by_matrix.reshape(3, M)
    lean = np.maximum(trust.max() * leaning - trust, 0.0) * force / stiffness
    expected = np.stack([trust * eta + lean, trust * rate, trust * force])
    moved, energies = np.zeros((3, M)), np.zeros(2)
    native = NativeCorrection(
        coordinates=M, stiffness=stiffness, wanted=wanted, trust=before,
        leaning=leaning, moved=moved, energies=energies,
    )  # fmt: skip
    arrays = ahead, calm, swing[0], swing[1]
    ahead_at, calm_at, *swing_at = map(address, arrays)
    LIBRARY.sway_carry(native.at, ahead_at, calm_at, 0.3, *swing_at)
    np.testing.assert_allclose(before, trust, atol=1e-12)
    np.testing.assert_allclose(moved, expected, atol=1e-12)
    both = swing + expected[:2], swing
    own = [stiffness @ np.square(eta) + np.square(rate).sum() for eta, rate in both]
    np.testing.assert_allclose(energies, own)


def test_the_calm_motion_is_quiet_but_not_late(gains: SteadyFilter) -> None:
    rng = np.random.default_rng(13)
    estimate, sensors = Estimate(gains, ROWS), Sensors()
    told, calm = [], []
    true = np.zeros((3, M))
    true[0] = 5.0
    estimate.state[:] = estimate.calm[:] = true
    for _ in range(400):
        true = (gains.law.step * true).sum(axis=1)
        beyond = gains.sensed @ true.ravel() + 0.5 * rng.normal(size=P)
        estimate.advance(sensors.measure(beyond, True, True), 1)
        told.append(estimate.state[0] - true[0])
        calm.append(estimate.calm[0] - true[0])
    rough = [np.square(np.diff(each[100:], 2, axis=0)).sum() for each in (told, calm)]
    wrong = [np.square(each[100:]).sum() for each in (told, calm)]
    assert rough[1] < 0.2 * rough[0]
    assert wrong[1] < 1.1 * wrong[0]


def test_what_is_not_known_corrects_nothing(gains: SteadyFilter) -> None:
    estimate, sensors = Estimate(gains, ROWS), Sensors()
    sensors.each[1].in_use = 0
    estimate.advance(sensors.measure(np.full(P, 1e3), False, True), 1)
    assert not estimate.state.any()
    assert not estimate.calm.any()
    assert [each.excess for each in sensors.each] == [1.0, 1.0]
