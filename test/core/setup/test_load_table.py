# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The drag in a table of loads takes energy from every motion of a tree."""

from __future__ import annotations

from drawn_trees import crooked, SETTINGS, weeping, WOOD
import numpy as np
import pytest

from tree_sway.core.setup.load_table import _without_gain
from tree_sway.core.setup.preparation import prepare


def least_share(damping):
    """
    Least rate at which slopes by rates (..., m, m) take energy, over the largest.

    A step uses weighted means of the table's entries, whose least rate is no less.
    """
    rates = np.linalg.eigvalsh(-0.5 * (damping + np.swapaxes(damping, -1, -2)))
    return float((rates.min(axis=-1) / rates.max(axis=-1)).min())


def least_share_of_table(table):
    """Least rate at which the drag of a table takes energy, over the largest."""
    both = table.damping, table.steep_damping
    return min(least_share(slopes.astype(np.float64)) for slopes in both)


@pytest.mark.parametrize('tree', [crooked(8, 12), weeping(twigs=3)])
def test_no_motion_gains_energy_by_drag(tree):
    """Of every kind of tree in the suite of the laboratory."""
    model = prepare(tree, WOOD, SETTINGS, model=40)
    assert least_share_of_table(model) > -1e-5  # single precision


def test_a_gain_is_left_out_and_nothing_else():
    rng = np.random.default_rng(2)
    half = rng.normal(size=(3, 6, 6))
    passive = -half @ np.swapaxes(half, 1, 2)
    turning = half - np.swapaxes(half, 1, 2)
    assert _without_gain(passive + turning) == pytest.approx(passive + turning)
    gaining = passive + 3.0 * np.eye(6)
    assert least_share(gaining) < -0.01
    assert least_share(_without_gain(gaining)) > -1e-9
