# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The choice that estimates lead to."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.fidelity.estimate import choose, distance_to, Estimate, tolerance_in_metres
from tree_sway_ros.errors import ParameterError

LADDER = (
    Estimate('frozen', 0, 0.05, 0.04, 5.0),
    Estimate('branch', 0, 0.04, 0.04, 10.0),
    Estimate('modes', 6, 0.004, 0.04, 20.0),
    Estimate('coupled', 0, 0.001, 0.04, 90.0),
)


@pytest.mark.parametrize(
    ('tolerance', 'budget', 'name'),
    [
        (0.1, None, 'frozen'),
        (0.045, None, 'branch'),
        (0.01, None, 'modes 6'),
        (0.002, None, 'coupled'),
        (None, 15.0, 'branch'),
        (None, 50.0, 'modes 6'),
        (0.045, 50.0, 'branch'),
    ],
)
def test_the_least_that_will_do(tolerance, budget, name):
    assert choose(LADDER, tolerance=tolerance, budget=budget).name == name


def test_what_nobody_can_meet_names_the_nearest():
    with pytest.raises(ParameterError, match=r"allow 0.001 m for 'coupled'"):
        choose(LADDER, tolerance=1e-4)
    with pytest.raises(ParameterError, match=r"allow 5 us for 'frozen'"):
        choose(LADDER, budget=1.0)


def test_pixels_become_metres():
    assert tolerance_in_metres(0.5, 20.0, 1000.0) == pytest.approx(0.01)
    with pytest.raises(ParameterError, match='above 0'):
        tolerance_in_metres(0.5, 0.0, 1000.0)


def test_the_distance_is_to_what_is_nearest(fork):
    tree = fork()
    top = tree.end[tree.branch_first[1:] - 1]
    assert distance_to(tree, tree.start[0]) == 0.01
    highest = top[top[:, 2].argmax()]
    assert distance_to(tree, highest + np.array([0.0, 0.0, 7.0])) == pytest.approx(7.0)


def test_a_model_is_named_as_people_say_it():
    names = [Estimate('modes', 6, 0.0, 0.0, 1.0, n).name for n in (0, 20)]
    assert names == ['modes 6', 'modes 6 with 20 branches frozen']
    assert Estimate('subtree', 0, 0.0, 0.0, 1.0).name == 'subtree'
