# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Gusts meet limbs one after another: delays, what is shared at once, memory, bad values."""

from __future__ import annotations

import re

from native_headers import code_of
import numpy as np
import pytest

from tree_sway.core.wind.gusts.crown_wind import (
    crown_delays,
    CrownWind,
    N_DELAYS,
)
from tree_sway.errors import ParameterError

DT = 0.02


def delayed(crown, wind, dt=DT):
    """Wind of each delay in each step, (t, d, 3)."""
    return np.array([x + crown.push(*x.tolist(), dt) for x in wind])


def steady(speed, steps):
    return np.tile([speed, 0.0, 0.0], (steps, 1))


def test_the_share_that_is_common_comes_at_once_and_the_rest_after_the_delay():
    spread, coherence = 12.0, 0.7
    wind = np.vstack([steady(6.0, 2000), steady(8.0, 400)])
    winds = delayed(CrownWind(spread, coherence), wind)[2000:, :, 0]
    assert winds[0] == pytest.approx([8.0] + [6.0 + coherence * 2.0] * (N_DELAYS - 1), abs=1e-9)
    share = np.arange(N_DELAYS) / (N_DELAYS - 1)
    arrival = (winds < 7.9).sum(axis=0) * DT
    assert arrival == pytest.approx(share * spread / 6.0, abs=0.12)
    assert winds[-1] == pytest.approx(np.full(N_DELAYS, 8.0), abs=1e-9)


def test_one_wind_for_all_where_all_of_it_is_common():
    rng = np.random.default_rng(0)
    crown = CrownWind(20.0, 1.0)
    for x in rng.normal(0.0, 5.0, (300, 3)):
        assert (crown.push(*x.tolist(), DT) == 0.0).all()


def test_limbs_share_long_gusts_and_not_short_ones():
    rng = np.random.default_rng(3)
    noise = np.repeat(rng.normal((7.0, 0.0, 0.0), 1.0, (4000, 3)), 10, axis=0)
    winds = delayed(CrownWind(10.0, 0.5), noise)[2000:, :, 0]
    fast = winds - winds.mean(axis=0)
    far = np.corrcoef(fast[:, 3], fast[:, 11])[0, 1]
    assert far == pytest.approx(0.5, abs=0.05)  # c^2 of c^2 + (1 - c)^2
    slow = fast.reshape(-1, 1000, N_DELAYS).mean(axis=1)
    assert np.corrcoef(slow[:, 3], slow[:, 11])[0, 1] > 0.95


@pytest.mark.parametrize('dt', [0.004, 1 / 60, 0.11])
def test_means_stay_within_the_samples_at_any_step(dt):
    rng = np.random.default_rng(5)
    wind = rng.uniform(-9.0, 9.0, (400, 3))
    winds = delayed(CrownWind(30.0, 0.4), wind, dt)
    assert (np.abs(winds) <= 9.0 + 1e-9).all()


def test_a_crown_that_was_reset_has_felt_nothing():
    crown = CrownWind(15.0, 0.6)
    delayed(crown, np.random.default_rng(6).normal(5.0, 2.0, (500, 3)))
    crown.reset()
    assert np.abs(crown.push(1.0, 2.0, 3.0, DT)).max() < 1e-12


def test_no_delay_is_longer_than_what_is_remembered():
    crown = CrownWind(1e4, 0.0)
    winds = delayed(crown, np.vstack([steady(3.0, 100), steady(4.0, 900)]))[-1, :, 0]
    assert winds == pytest.approx(np.full(N_DELAYS, 4.0))
    (longest,) = re.findall(r'LONGEST_DELAY = ([\d.]+)', code_of('gusts.cpp'))
    assert 10.0 * DT < float(longest) < 900 * DT


def test_what_a_limb_carries_has_its_delay_and_the_stem_none():
    parent = np.array([-1, 0, 1, 1, 0, 4, 0])
    centre = np.array(
        [[0, 0, 2], [1, 0, 3], [2, 0, 3], [1, 1, 3], [-2, 0, 4], [-3, 0, 4], [0, 1, 1]]
    )
    found = crown_delays(parent, centre.astype(float), np.ones(7))
    assert found.of_branch[0] == 0
    assert len(set(found.of_branch[[1, 2, 3]])) == 1
    assert found.of_branch[4] == found.of_branch[5] != found.of_branch[1]
    assert found.share.sum() == pytest.approx(1.0)
    assert found.share.shape == (N_DELAYS,)


def test_a_stem_alone_has_no_delay():
    found = crown_delays(np.array([-1]), np.array([[0.0, 0.0, 1.0]]), np.ones(1))
    assert found.of_branch.tolist() == [0]
    assert found.share[0] == 1.0


@pytest.mark.parametrize('coherence', [-0.1, 1.1, np.nan])
def test_a_share_that_is_none_is_refused(coherence):
    with pytest.raises(ParameterError, match='crown_coherence'):
        CrownWind(1.0, coherence)
