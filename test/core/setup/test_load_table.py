# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The drag in a table of loads takes energy from every motion of every kind of tree."""

import numpy as np
import pytest
from tree_sway_lab.kinds.kinds import kind_called, KINDS
from tree_sway_lab.validation.trial import judged_simulator

from tree_sway.core.setup.load_table import _without_gain


def least_share(damping):
    """
    Least rate at which slopes by rates (..., m, m) take energy, over the largest.

    A step uses weighted means of the table's entries, whose least rate is no less.
    """
    rates = np.linalg.eigvalsh(-0.5 * (damping + np.swapaxes(damping, -1, -2)))
    return float((rates.min(axis=-1) / rates.max(axis=-1)).min())


@pytest.mark.parametrize('kind', [*KINDS, 'crooked 8', 'straight 2'])
def test_no_motion_gains_energy_by_drag(kind):
    table = judged_simulator('default', kind_called(kind)).banks[0].oscillators.record[0]
    m = int(table['n_modes'])
    for name in ('damping', 'steep_damping'):
        least = least_share(table[name][..., :m, :m].astype(np.float64))
        print(f'{kind}: least over largest rate of {name} {least:.2g}')
        assert least > -1e-5  # single precision


def test_a_gain_is_left_out_and_nothing_else():
    rng = np.random.default_rng(2)
    half = rng.normal(size=(3, 6, 6))
    passive = -half @ np.swapaxes(half, 1, 2)
    turning = half - np.swapaxes(half, 1, 2)
    assert _without_gain(passive + turning) == pytest.approx(passive + turning)
    gaining = passive + 3.0 * np.eye(6)
    assert least_share(gaining) < -0.01
    assert least_share(_without_gain(gaining)) > -1e-9
