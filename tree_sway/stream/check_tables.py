# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Checks of tables before a receiver solves by them; ``static/checks.js`` has the same.

The native core that reads tables checks no bounds, as for those of a description.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tree_sway.errors import FormatError, inside
from tree_sway.stream.check_description import (
    Array,
    Arrays,
    forms_of,
    is_finite,
    Json,
    require,
    sizes_of,
)

_MOST_SLOPES = 400_000
"""
Largest number of tables times the squared number of coordinates.

The slopes of a table are unpacked to 1.5 kB for each.
"""

_MOST_STATES = 50_000_000
"""Largest number of trees times the number of coordinates of a table."""

_FASTEST = 1e6
"""Largest wind of a tree over that of its kind."""

_LEAST_RATIO = 0.1
"""Smallest `convection_ratio`."""

_FORMS = forms_of('tables')
_LAW = 3
_NOT_NEGATIVE = 'limit', 'own_damping', 'motion', 'cross_damping'


def check_tables(
    header: Json,
    kinds: Sequence[Arrays],
    speeds: Array,
    described: Sequence[Arrays],
    n_trees: int,
) -> None:
    """
    Refuse tables whose header or arrays are inconsistent, or do not fit a description.

    Parameters
    ----------
    header
        Names and numbers, from JSON.
    kinds
        Arrays of each kind by name.
    speeds
        The array ``tree_speed``.
    described
        Arrays of each kind of the description.
    n_trees
        Number of its trees.

    Raises
    ------
    FormatError
        The first array or entry that is missing, of a wrong type or shape, not finite, or out of
        its range.

    """
    require('kinds', len(kinds) == len(described))
    most = 0
    for number, (entry, arrays) in enumerate(zip(header['kinds'], kinds, strict=True)):
        with inside(f'kind {number}'):
            most = max(most, _check_kind(entry, arrays, described[number]))
    require('tree_speed', speeds.dtype == '<f4' and speeds.shape == (n_trees,))
    # Comparisons with not-a-number are false.
    require('tree_speed', (speeds >= 0.0) & (speeds < _FASTEST))
    anemometer = header['anemometer']
    ratio = header['convection_ratio']
    is_place = isinstance(anemometer, list) and len(anemometer) == 3
    require('anemometer', anemometer is None or (is_place and all(map(is_finite, anemometer))))
    require('convection_ratio', ratio is None or (is_finite(ratio) and ratio >= _LEAST_RATIO))
    for what, count, limit in (
        ('slopes of all tables', len(kinds) * most**2, _MOST_SLOPES),
        ('coordinates of all trees', n_trees * most, _MOST_STATES),
    ):
        if count > limit:
            raise FormatError(f'{count} {what}', cure=f'send up to {limit}')


def _check_kind(entry: Json, arrays: Arrays, described: Arrays) -> int:
    """Refuse an inconsistent table; return its number of coordinates."""
    size = sizes_of(arrays, _FORMS)
    m = size['m']
    require('stiffness', m > 0)
    require('shapes of the slopes', size['m m'] == m * m)
    n_keys, n_coordinates = described['basis_matrix'].shape
    require('state', size['n'] == n_coordinates)
    has_rows = size['keys'] == n_keys
    has_columns = size['keys of a branch'] >= described['branch_keys'].max()
    require('branch_compliance', has_rows and has_columns)
    require('stiffness', arrays['stiffness'] > 0.0)
    for name in _NOT_NEGATIVE:
        array = arrays[name]
        require(name, (array >= 0.0).all(axis=tuple(range(1, array.ndim))))
    require('levels', (np.diff(arrays['levels'], axis=1) >= 0.0).all(axis=1))
    for name in ('most_pressure', 'most_energy'):
        require(name, is_finite(entry[name]) and entry[name] > 0.0)
    law = entry['drag_law']
    require('drag_law', isinstance(law, list) and len(law) == _LAW and all(map(is_finite, law)))
    return m
