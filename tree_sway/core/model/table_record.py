# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The table of a model as a record of `table_layout`, its coordinates filled up, and back."""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.arrays import Records
from tree_sway.core.model.records import table_layout, zeros_in_lines
from tree_sway.core.model.sway_model import MEANINGS, SwayModel

ARRAYS = (
    'levels', 'limit', 'motion', 'harmonics', 'equilibrium', 'amount', 'load', 'cross_damping',
    'lean', 'turning', 'damping', 'steep_turning', 'steep_damping',
)  # fmt: skip
"""Arrays of a model that are fields of the record."""

NUMBERS = 'most_pressure', 'most_energy'


def table_record(model: SwayModel, n_modes: int = 0) -> Records:
    """Return the table of a model with room for a number of coordinates, or its own, (1,)."""
    m = model.n_coordinates
    record = zeros_in_lines(1, table_layout(max(m, n_modes)))
    table = record[0]
    table['n_modes'] = m
    table['stiffness'] = 1.0  # of coordinates that do not exist
    table['stiffness'][:m] = model.stiffness
    for name in NUMBERS:
        table[name] = getattr(model, name)
    for name in ARRAYS:
        values = getattr(model, name)
        table[name][tuple(map(slice, values.shape))] = values
    return record


def arrays_of_record(table: np.void, m: int) -> dict[str, Any]:
    """Return the arrays and numbers of a table of m coordinates, without those filled up."""
    found: dict[str, Any] = {name: float(table[name]) for name in NUMBERS}
    for name in ARRAYS:
        part = tuple(slice(m if axis == 'm' else None) for axis in MEANINGS[name].shape)
        found[name] = np.ascontiguousarray(table[name][part])
    return found
