# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Faults of a sensor beside a mast: each is told in time, and none makes the tree worse."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from tree_sway_lab.twin.gusty_truth import gusty_motion, mast_of, Outside
from tree_sway_lab.twin.sensor_faults import FROM
from tree_sway_lab.twin.trial import Score, twin_score
from tree_sway_lab.twin.true_tree import tree_called, TrueMotion

TREE, SPECIES = tree_called('crooked 2703')
AT = 'b35:0.5'
pytestmark = pytest.mark.long


@cache
def truth() -> TrueMotion:
    outside = Outside(seconds=150.0, seed=903).drawn(TREE)
    return gusty_motion(TREE, SPECIES, [AT], outside, in_leaf=False)


@cache
def scored(fault: str, n_sensors: int = 1, bearing: float | None = None) -> Score:
    return twin_score(
        TREE, SPECIES, truth(), [AT][:n_sensors], in_leaf=False, has_band=False, fault=fault,
        anemometer_distance=12.6, anemometer_bearing=bearing,
    )  # fmt: skip


@pytest.mark.parametrize('fault', ['stuck', 'noise', 'loose', 'silent'])
def test_a_sensor_that_fails_is_left_within_five_seconds(fault: str) -> None:
    assert FROM <= scored(fault).told <= FROM + 5.0
    assert scored(fault).error < 1.05 * scored('none', 0).error


@pytest.mark.parametrize(
    ('fault', 'note'),
    [
        ('opposite', 'acceleration of the opposite sign'),
        ('left-handed', 'left-handed'),
        ('units', 'acceleration in g'),
        ('spikes', 'samples refused'),
    ],
)
def test_a_sensor_of_another_form_is_recognised_and_used(fault: str, note: str) -> None:
    assert any(note in each for each in scored(fault).notes)
    assert scored(fault).error < 0.8 * scored('none', 0).error


@pytest.mark.parametrize(
    ('fault', 'note'),
    # A record that is stamped early ends before the wind.
    [('late 2', 'its motion comes'), ('late -2', 'silent')],
)
def test_a_sensor_whose_times_are_wrong_is_left_after_a_minute(fault: str, note: str) -> None:
    _, bearing = mast_of(Outside())
    assert np.isnan(scored('none', 1, bearing).told)
    found = scored(fault, 1, bearing)
    assert found.told < 70.0
    assert found.error < 1.05 * scored('none', 0, bearing).error
    assert any(note in each for each in found.notes)
