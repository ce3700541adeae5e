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

from tree_sway.core.checks import GREATEST
from tree_sway.core.model import MAX_COORDINATES
from tree_sway.core.species import SPECIES
from tree_sway.errors import FormatError, inside

MOST_SEGMENTS = 500_000
"""Largest number of segments of all kinds."""

MOST_POSES = 10_000_000
"""Largest number of segments of all trees."""

MOST_COORDINATES = 65_535
"""Largest number of coordinates of all trees; a frame counts them in two bytes."""

Array = NDArray[Any]
Json = Mapping[str, Any]
"""An object of JSON."""

Arrays = dict[str, Array]
"""Arrays by name."""

_Forms = Mapping[str, tuple[str, Sequence[str | int]]]
"""Type and axes of arrays by name; an axis is its size, or a name of which all are of one size."""

TYPES = {'f32': '<f4', 'i32': '<i4', 'i16': '<i2', 'u8': 'u1'}
"""Types of arrays by their names in messages."""


def forms_of(message: str) -> _Forms:
    """Return the forms of the arrays of a kind in a ``description`` or in ``tables``."""
    text = resources.files('tree_sway.page').joinpath('static', 'arrays.json').read_text()
    entries = json.loads(text)[message].items()
    return {name: (TYPES[kind], axes) for name, (kind, *axes) in entries}


_LOOK = SPECIES['broadleaf'].look.described(SPECIES['broadleaf'].leaves, 'broadleaf')
"""A look that has everything a page needs."""

_FORMS = forms_of('description')
"""Arrays of a kind; those of leaves only where it has any."""


def check_description(header: Json, kinds: Sequence[Arrays], places: Array) -> None:
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
    require('header', _are_words([header['name'], header['frame_id']]))
    require('kinds', len(kinds) > 0)
    n_segments, n_coordinates = np.zeros((2, len(kinds)), dtype=np.int64)
    for number, (kind, arrays) in enumerate(zip(header['kinds'], kinds, strict=True)):
        with inside(f'kind {number}'):
            size = _check_kind(kind, arrays)
        n_segments[number], n_coordinates[number] = size['segments'], size['coordinates']
    kind_of_trees = _check_trees(header['trees'], len(kinds), places)
    require('flutter', all(is_finite(value) for value in header.get('flutter', {}).values()))
    _refuse_more('segments of the kinds', n_segments.sum(), MOST_SEGMENTS)
    _refuse_more('segments of the trees', n_segments[kind_of_trees].sum(), MOST_POSES)
    _refuse_more('coordinates of the trees', n_coordinates[kind_of_trees].sum(), MOST_COORDINATES)


def _refuse_more(what: str, count: int, most: int) -> None:
    if count > most:
        raise FormatError(f'{count} {what}', cure=f'describe up to {most}')


def _check_trees(trees: Sequence[Json], n_kinds: int, places: Array) -> list[int]:
    """Refuse inconsistent trees; return the number of the kind of each."""
    kinds = [tree['kind'] for tree in trees]
    require('trees', len(trees) > 0 and _are_words([tree['name'] for tree in trees]))
    require('kind of a tree', all(type(kind) is int and 0 <= kind < n_kinds for kind in kinds))
    require('tree_place', places.dtype == '<f4' and places.shape == (len(trees), 5))
    scale = places[:, 4]
    require('tree_place', np.isfinite(places).all(axis=1) & (scale > 0.0))
    return kinds


def _check_kind(kind: Json, arrays: Arrays) -> dict[str, int]:
    """Refuse an inconsistent kind; return the sizes of its axes by name."""
    has_leaves = 'leaf_segment' in arrays
    forms = {
        name: form for name, form in _FORMS.items() if has_leaves or not name.startswith('leaf')
    }
    size = sizes_of(arrays, forms)
    require('branch_parent', size['branches'] > 0)
    require('basis_scale', arrays['basis_scale'] > 0.0)
    require('species', _are_words([kind['species'], kind['model']]))
    require('look', 'look' not in kind or _fits(kind['look'], _LOOK))
    numbers = kind['height'], kind['basis_error'], kind.get('modulus', 0.0)
    require('height', all(map(is_finite, numbers)))
    names = kind['branch_names']
    require('branch_names', len(names) == size['branches'] and _are_words(names))
    _check_joints(arrays, size)
    _check_turns(arrays, size)
    if has_leaves:
        require('leaf_segment', _is_within(arrays['leaf_segment'], 0, size['segments']))
    return size


def _check_joints(arrays: Arrays, size: Mapping[str, int]) -> None:
    """Refuse branches whose parents, segments and base segments do not fit together."""
    parent, first, base_segment = _whole(arrays, 'parent', 'first', 'base_segment')
    branch = np.arange(size['branches'])
    # Parents come first; only the stem has none.
    lowest = np.minimum(branch - 1, 0)
    require('branch_parent', (lowest <= parent) & (parent < branch))
    require('branch_first', size['branches + 1'] == size['branches'] + 1)
    require('branch_first', first[0] == 0 and first[-1] == size['segments'])
    require('branch_first', np.diff(first) > 0)
    on_parent = _is_within(base_segment, first[parent], first[parent + 1])
    require('branch_base_segment', np.where(branch == 0, base_segment == -1, on_parent))


def _check_turns(arrays: Arrays, size: Mapping[str, int]) -> None:
    """Refuse branches whose key rotations, or rows of turns, are not in the arrays."""
    keys, coordinate, parent, first = _whole(arrays, 'keys', 'coordinate', 'parent', 'first')
    base_turn, turn = _whole(arrays, 'base_turn', 'turn')
    n_segments = np.diff(first)
    rows = size['rows']
    is_stem = np.arange(size['branches']) == 0

    require('branch_keys', _is_within(keys, 2, MAX_COORDINATES + 1))
    require('branch_coordinate', _is_within(coordinate, 0, size['keys'] - keys + 1))
    has_base_turn = _is_within(base_turn, 0, rows - keys[parent] + 1)
    require('branch_base_turn', np.where(is_stem, base_turn == -1, has_base_turn))
    has_turn = _is_within(turn, 0, rows - n_segments * keys + 1)
    # A branch without rows of its own turns by its key rotations alone.
    require('branch_turn', np.where(turn == -1, keys <= 2, has_turn))


def _whole(arrays: Arrays, *names: str) -> list[Array]:
    """Return numbers of each branch, wide enough for their sums."""
    return [arrays[f'branch_{name}'].astype(np.int64) for name in names]


def _is_within(values: Array, lowest: Array | int, end: Array | int) -> Array:
    """Whether values are from the lowest on and below the end."""
    return (lowest <= values) & (values < end)


def _are_words(values: Sequence[object]) -> bool:
    return all(isinstance(value, str) for value in values)


def _fits(look: Any, like: Any) -> bool:
    """Whether a look has everything that another has, of the same type, and within reason."""
    if isinstance(like, bool):
        return type(look) is bool
    if isinstance(like, (int, float)):
        return is_finite(look) and abs(look) < 100.0
    if isinstance(like, dict):
        return isinstance(look, dict) and all(
            _fits(look.get(name), value) or (name == 'autumn' and look.get(name, 0) is None)
            for name, value in like.items()
        )
    if isinstance(like, (list, tuple)):
        if not isinstance(look, (list, tuple)) or not len(like) <= len(look) < 9:
            return False
        return all(is_finite(value) and abs(value) < 10.0 for value in look)
    return type(look) is type(like)


def sizes_of(arrays: Arrays, forms: _Forms) -> dict[str, int]:
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
            is_good = np.abs(array) < GREATEST
            require(name, is_good.all(axis=tuple(range(1, array.ndim))))
    return sizes


def is_finite(value: object) -> bool:
    """Whether a value of JSON is a number, and not beyond `GREATEST`."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    return -GREATEST < value < GREATEST


def require(name: str, holds: ArrayLike) -> None:
    """Refuse a false condition, or the first row where it is false."""
    rows = np.atleast_1d(holds)
    if not rows.all():
        row = f'[{np.argmin(rows)}]' if np.ndim(holds) else ''
        what = 'inconsistent with the rest, not finite, or a number that no tree has'
        raise FormatError(what, where=f'{name}{row}')
