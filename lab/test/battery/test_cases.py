# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every case of the battery: its rows, and what it measures with."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.battery.report import CASES, load_case
from tree_sway_lab.methods.registry import method_named

LONG = ('T1', 'T2', 'T3', 'T4', 'T5', 'T6', 'T7', 'T18')


@pytest.mark.parametrize(
    ('name', 'full'),
    [(name, False) for name in CASES if name not in LONG]
    + [pytest.param(name, k, marks=pytest.mark.long) for name in LONG for k in (False, True)],
)
def test_every_row_is_as_it_should_be(name, full):
    rows = load_case(name).run(full)
    assert rows
    assert [row for row in rows if not row.good] == []


def test_a_frame_of_many_branches_is_timed():
    assert load_case('goals').milliseconds_a_frame(1600, 3) > 0.0


def test_energy_that_grows_is_seen():
    growth = load_case('T1').growth
    assert growth(method_named('semi_implicit_euler'), 2.1, 0.0, 200, 1e-2, float) > 1.0
    assert growth(method_named('rk4'), 1.0, 0.0, 200, 1e-2, float) <= 0.0


def test_the_fit_finds_frequency_and_damping():
    t = np.arange(200) * 0.01
    w, z = 2 * np.pi * 3.0, 0.07
    decay = np.exp(-z * w * t) * np.cos(w * np.sqrt(1 - z * z) * t + 0.3)
    assert load_case('T2').fit(decay, 0.01) == pytest.approx((3.0, 0.07), rel=1e-9)


def test_the_slope_is_read_off_the_last_two_decades():
    marks = np.geomspace(1, 1e6, 40)
    slope = load_case('T3').drift_slope(marks, 1e-9 * marks**1.5 + 1e-9)
    assert slope == pytest.approx(1.5, abs=1e-3)


def test_a_gain_beyond_the_limit_blows_up():
    largest_gap = load_case('T4').largest_gap
    assert np.isinf(largest_gap('semi_implicit_euler', 0.9))
    assert largest_gap('semi_implicit_euler', 0.8) < 1e-2


def test_uneven_steps_hold_their_stalls():
    case = load_case('T15')
    steps = case.uneven_steps(180)
    assert (steps == case.STALL).sum() == 3
    assert steps.min() > 0


def test_the_bound_is_the_resonance_of_a_switching_load():
    bound = load_case('T18').bound
    assert bound(np.array([0.01])) == pytest.approx([2 / (np.pi * 0.01)], rel=1e-3)
    assert bound(np.array([1.0])) == pytest.approx([1.0])
