# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The table of a tree that a receiver solves takes energy from every motion, as the tree's own."""

from __future__ import annotations

from drawn_trees import crooked, SETTINGS, weeping, WOOD
import numpy as np
import pytest

from tree_sway.core.setup import prepare
from tree_sway.stream.table_export import arrays_of_table, exported_table


@pytest.mark.parametrize('tree', [crooked(8, 12), weeping(twigs=3)])
def test_no_motion_gains_energy_by_an_exported_drag(tree):
    model = prepare(tree, WOOD, SETTINGS, model=40)
    table = arrays_of_table(*exported_table(model, model.own_damping))
    for name in ('damping', 'steep_damping'):
        slopes = table[name].astype(np.float64)
        rates = np.linalg.eigvalsh(-0.5 * (slopes + np.swapaxes(slopes, -1, -2)))
        assert (rates[..., 0] > -1e-5 * rates[..., -1]).all()
