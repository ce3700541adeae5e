# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Checks of a description before it is used; ``static/checks.js`` has the same.

Kernels check no bounds: an index outside of an array would read, or write, other memory.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import resources
import json
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.core.tree.species import SPECIES
from tree_sway.errors import FormatError, inside

MOST_SEGMENTS = 500_000
"""Largest number of segments of all kinds."""

MOST_POSES = 10_000_000
"""Largest number of segments of all trees."""

MOST_COORDINATES = 65_535
"""Largest number of coordinates of all trees; a frame counts them in two bytes."""

_GREATEST = 1e12
"""Largest height, error or number of the law of the leaves."""

Array = NDArray[Any]

Forms = Mapping[str, tuple[str, Sequence[str | int]]]
"""Type and axes of arrays by name; an axis is its size, or a name of which all are of one size."""

_TYPES = {'f32': '<f4', 'i32': '<i4', 'i16': '<i2', 'u8': 'u1'}


def forms_of(message: str) -> Forms:
    """Return the forms of the arrays of a kind in a ``description`` or in ``tables``."""
    text = resources.files('tree_sway.page').joinpath('static', 'arrays.json').read_text()
    entries = json.loads(text)[message].items()
    return {name: (_TYPES[kind], axes) for name, (kind, *axes) in entries}


_LOOK = SPECIES['broadleaf'].look.described(SPECIES['broadleaf'].leaves, 'broadleaf')
"""A look that has everything a page needs."""

_FORMS = forms_of('description')
"""Arrays of a kind; those of leaves only where it has any."""


def check_description(
    header: Mapping[str, Any], kinds: Sequence[Mapping[str, Array]], places: Array
) -> None:
    """
    Refuse a description whose header or arrays are inconsistent.

    Parameters
    ----------
    header
        Names and numbers, from JSON.
    kinds
        Arrays of each kind by name.
    places
        Places of the trees, the array ``tree_place``.

    Raises
    ------
    FormatError
        The first array or entry that is missing, of a wrong type or shape, not finite, or an index
        out of range.

    """
    require('header', all(isinstance(header[name], str) for name in ('name', 'frame_id')))
    require('kinds', len(kinds) > 0)
    sizes = []
    for number, (kind, arrays) in enumerate(zip(header['kinds'], kinds, strict=True)):
        with inside(f'kind {number}'):
            sizes.append(_check_kind(kind, arrays))
    numbers = [tree['kind'] for tree in header['trees']]
    names = [tree['name'] for tree in header['trees']]
    require('trees', all(isinstance(name, str) for name in names) and len(names) > 0)
    require('kind of a tree', all(type(k) is int and 0 <= k < len(kinds) for k in numbers))
    require('tree_place', places.dtype == '<f4' and places.shape == (len(numbers), 5))
    require('tree_place', np.isfinite(places).all(axis=1) & (places[:, 4] > 0.0))
    require('flutter', all(is_finite(value) for value in header.get('flutter', {}).values()))
    segments, coordinates = np.array(sizes).T
    for what, count, most in (
        ('segments of the kinds', segments.sum(), MOST_SEGMENTS),
        ('segments of the trees', segments[numbers].sum(), MOST_POSES),
        ('coordinates of the trees', coordinates[numbers].sum(), MOST_COORDINATES),
    ):
        if count > most:
            raise FormatError(f'{count} {what}', cure=f'describe up to {most}')


def _check_kind(kind: Mapping[str, Any], arrays: Mapping[str, Array]) -> tuple[int, int]:
    """Refuse an inconsistent kind; return its numbers of segments and coordinates."""
    has_leaves = 'leaf_segment' in arrays
    forms = {n: form for n, form in _FORMS.items() if has_leaves or not n.startswith('leaf')}
    size = sizes_of(arrays, forms)
    b, n, rows = size['branches'], size['segments'], size['rows']
    require('branch_parent', b > 0)
    require('basis_scale', arrays['basis_scale'] > 0.0)
    require('species', isinstance(kind['species'], str) and isinstance(kind['model'], str))
    require('look', 'look' not in kind or _fits(kind['look'], _LOOK))
    numbers = kind['height'], kind['basis_error'], kind.get('modulus', 0.0)
    require('height', all(map(is_finite, numbers)))
    names = kind['branch_names']
    require('branch_names', len(names) == b and all(isinstance(name, str) for name in names))

    parent, under, coordinate, keys, base_turn, turn = (
        arrays[f'branch_{name}'].astype(np.int64)
        for name in ('parent', 'base_segment', 'coordinate', 'keys', 'base_turn', 'turn')
    )
    first = arrays['branch_first'].astype(np.int64)
    row = np.arange(b)
    require('branch_parent', (parent < row) & (parent >= np.minimum(row - 1, 0)))
    require('branch_first', size['branches + 1'] == b + 1 and first[0] == 0 and first[-1] == n)
    count = np.diff(first)
    require('branch_first', count > 0)
    # Here, as it loads the compiler, which is not needed before a description.
    from tree_sway.core.beams.field_counts import MAX_COORDINATES

    is_stem = row == 0
    on_it = (first[parent] <= under) & (under < first[parent + 1])
    require('branch_base_segment', np.where(is_stem, under == -1, on_it))
    require('branch_keys', (keys >= 2) & (keys <= MAX_COORDINATES))
    require('branch_coordinate', (coordinate >= 0) & (coordinate + keys <= size['keys']))
    within = (base_turn >= 0) & (base_turn + keys[parent] <= rows)
    require('branch_base_turn', np.where(is_stem, base_turn == -1, within))
    within = (turn >= 0) & (turn + count * keys <= rows)
    require('branch_turn', np.where(turn == -1, keys <= 2, within))
    if 'leaf_segment' in arrays:
        require('leaf_segment', (arrays['leaf_segment'] >= 0) & (arrays['leaf_segment'] < n))
    return n, size['coordinates']


def _fits(look: Any, like: Any) -> bool:
    """Whether a look has everything that another has, of the same type, and within reason."""
    if isinstance(like, bool) or not isinstance(like, (int, float, list, tuple, dict)):
        return type(look) is type(like)
    if isinstance(like, dict):
        return isinstance(look, dict) and all(
            (name == 'autumn' and look.get(name, 0) is None) or _fits(look.get(name), value)
            for name, value in like.items()
        )
    if isinstance(like, (list, tuple)):
        own = look if isinstance(look, (list, tuple)) else ()
        return len(like) <= len(own) < 9 and all(is_finite(x) and abs(x) < 10.0 for x in own)
    return is_finite(look) and abs(look) < 100.0


def sizes_of(arrays: Mapping[str, Array], forms: Forms) -> dict[str, int]:
    """
    Sizes of the named axes of arrays.

    Raises a `FormatError` for a missing array, a wrong type or shape, or a number that is not
    finite.
    """
    sizes: dict[str, int] = {}
    for name, (kind, axes) in forms.items():
        array = arrays.get(name)
        if array is None:
            raise FormatError('it is missing', where=name)
        require(f'type of {name}', array.dtype == kind)
        require(f'shape of {name}', array.ndim == len(axes))
        for axis, size in zip(axes, array.shape, strict=True):
            wanted = axis if isinstance(axis, int) else sizes.setdefault(axis, size)
            require(f'shape of {name}', size == wanted)
        if kind == '<f4':
            require(name, np.isfinite(array).all(axis=tuple(range(1, array.ndim))))
    return sizes


def is_finite(value: object) -> bool:
    """Whether a value of JSON is a number, and not beyond `_GREATEST`."""
    return type(value) in (int, float) and -_GREATEST < value < _GREATEST  # type: ignore[operator]


def require(name: str, holds: ArrayLike) -> None:
    """Refuse a false condition, or the first row where it is false."""
    rows = np.atleast_1d(holds)
    if not rows.all():
        row = f'[{int(np.argmin(rows))}]' if np.ndim(holds) else ''
        raise FormatError('inconsistent with the rest, or not finite', where=f'{name}{row}')
