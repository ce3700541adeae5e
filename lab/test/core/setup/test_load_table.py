# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The drag in a table of loads takes energy from every motion of every kind of tree."""

from types import SimpleNamespace

import numpy as np
import pytest
from tree_sway_lab.kinds.kinds import kind_called, KINDS
from tree_sway_lab.validation.trial import judged_simulator

from tree_sway.stream.table_export import arrays_of_table, exported_table

MORE = 'whips 4', 'palm 7', 'straight 2', 'broad 3', 'limbs16 5', 'shrub 2'
TRIED = ['crooked 8', *(pytest.param(kind, marks=pytest.mark.long) for kind in (*KINDS, *MORE))]


def least_share(damping):
    """
    Least rate at which slopes by rates (..., m, m) take energy, over the largest.

    A step uses weighted means of the table's entries, whose least rate is no less.
    """
    rates = np.linalg.eigvalsh(-0.5 * (damping + np.swapaxes(damping, -1, -2)))
    return float((rates.min(axis=-1) / rates.max(axis=-1)).min())


@pytest.mark.parametrize('kind', TRIED)
def test_no_motion_gains_energy_by_drag(kind):
    model = judged_simulator('default', kind_called(kind)).models[0]
    assert least_share_of_table(model) > -1e-5  # single precision
    table = arrays_of_table(*exported_table(model, model.own_damping))
    assert least_share_of_table(SimpleNamespace(**table)) > -1e-5


def least_share_of_table(table):
    """Least rate at which the drag of a table takes energy, over the largest."""
    both = table.damping, table.steep_damping
    return min(least_share(slopes.astype(np.float64)) for slopes in both)
