# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A `SwayModel` as an ``.npz`` file: arrays of numbers by name, and one text. No pickles.

``about`` is a text in JSON with what has no shape: names, species, settings, version and digest.
Arrays of the tree have the prefix ``tree_``. `doc/sway_model.md` documents all of them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import is_dataclass, replace
import json
from pathlib import Path
from typing import Any, get_type_hints
import zipfile

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.model import SwayModel
from tree_sway.core.settings import Settings
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree, tree_in_order
from tree_sway.errors import FormatError, TreeSwayError
from tree_sway.files.paths import of_file

SUFFIX = '.npz'

VERSION = 1
"""Version of the arrays and the law of a step; a reader refuses any other."""

LARGEST = 1 << 30
"""Largest size of all arrays of a file [bytes]."""

FORMAT = 'tree_sway model'
LEAVES = 'leaf_mass', 'leaf_area'
_DIAMETERS = 'base_diameter', 'tip_diameter'
_INDICES = 'segment_parent', 'branch_first'
TREE = ('start', 'end', *_DIAMETERS, *_INDICES)
"""Fields of a `Tree` that are arrays of the file."""

_TEXT_LIMIT = 1 << 24
_FARTHEST = 1e9
"""Bound of all numbers of a tree: coordinates in [m], diameters in [m], indices."""


@of_file
def read_model(path: Path) -> SwayModel:
    """
    Read a model that `write_model` wrote.

    Raises
    ------
    FormatError
        A file that is none, of another version, damaged, too large, or whose arrays do not fit.

    """
    arrays = _read_arrays(path)
    about = _read_about(arrays.pop('about', np.array('')))
    try:
        tree = _tree(about, {name: arrays.pop(f'tree_{name}') for name in TREE})
        leaves = {name: arrays.pop(name) for name in LEAVES if name in arrays}
        species = _made(Species, about['species'])
        settings = replace(_made(Settings, about['settings']), **leaves)
        model = SwayModel.of_arrays(arrays, tree, species, settings)
        digest = model.digest()
    except FormatError:
        raise
    except (LookupError, TypeError, ValueError, OverflowError, TreeSwayError) as error:
        raise _damaged(f'its tree, settings or arrays: {error}') from None
    if digest != about.get('digest'):
        raise _damaged('numbers that are not those that were written')
    return model


def _read_arrays(path: Path) -> dict[str, NDArray[Any]]:
    try:
        with zipfile.ZipFile(path) as archive:
            size = sum(each.file_size for each in archive.infolist())
        if size > LARGEST:
            raise FormatError(
                f'{size >> 20} MiB of arrays',
                cure=f'convert a tree with up to {LARGEST >> 20} MiB',
            )
        with np.load(path) as file:
            return dict(file)
    except FormatError:
        raise
    except Exception as error:  # what readers raise for damaged archives is of any kind
        raise _damaged(f'{type(error).__name__}: {error}') from None


def _read_about(text: NDArray[Any]) -> dict[str, Any]:
    """Read the text of a file; refuse another format, and another version."""
    if text.dtype.kind != 'U' or text.size != 1 or text.nbytes > _TEXT_LIMIT:
        raise _damaged('there is no text about it')
    try:
        about = json.loads(str(text))
    except (ValueError, RecursionError):
        raise _damaged('the text about it is no JSON') from None
    if not isinstance(about, dict) or about.get('format') != FORMAT:
        raise _damaged('it is another format')
    if about.get('version') != VERSION:
        raise FormatError(
            f'version {about.get("version")!r:.20} of a model; this program reads {VERSION}',
            cure='convert the tree again by tree-sway convert',
        )
    return about


def _damaged(what: str) -> FormatError:
    cure = 'give a file that tree-sway convert wrote, or convert the tree again'
    return FormatError(f'no prepared model of a tree: {what[:200]}', cure=cure)


def _tree(about: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> Tree:
    """Make the tree again; refuse arrays that are no tree in depth-first order."""
    names = tuple(map(str, about['branch_names']))
    _check_tree(arrays, names)
    tree = tree_in_order(
        **arrays,
        source_index=np.arange(len(arrays['start']), dtype=np.int64),
        branch_names=names,
        name=str(about['name']),
        species=str(about['tree_species']),
    )
    if not tree.length.all():
        raise _damaged('segments without length')
    carrier = tree.branch_parent.tolist()
    for branch in range(1, tree.n_branches):
        before = branch - 1
        while before > carrier[branch]:
            before = carrier[before]
        if before != carrier[branch]:
            raise _damaged('branches that are not in depth-first order')
    return tree


def _check_tree(arrays: Mapping[str, NDArray[Any]], names: Sequence[str]) -> None:
    """Check types, shapes and numbers of the arrays of a tree, and that parents come first."""
    count = len(arrays['start'])
    first = arrays['branch_first']
    if first[0] != 0 or first[-1] != count or (np.diff(first) < 1).any():
        raise _damaged('branches without segments')
    if len(first) != len(names) + 1:
        raise _damaged(f'{len(names)} branch names for {len(first) - 1} branches')
    shapes = {'start': (count, 3), 'end': (count, 3), 'branch_first': first.shape}
    for name, array in arrays.items():
        expected = np.int64 if name in _INDICES else np.float64
        if array.dtype != expected or array.shape != shapes.get(name, (count,)):
            raise _damaged(f'tree_{name} is {array.dtype} of shape {array.shape}')
        if not (np.abs(array) < _FARTHEST).all() or (name in _DIAMETERS and array.min() <= 0.0):
            raise _damaged(f'tree_{name} has a number that no tree has')
    parent = arrays['segment_parent']
    before = np.arange(-1, count - 1)
    is_base = np.isin(before + 1, first[1:])
    if not ((parent == before) | (is_base & (0 <= parent) & (parent <= before))).all():
        raise _damaged('segments that are not in depth-first order')


def _made(kind: Any, values: Mapping[str, Any]) -> Any:
    """Make a dataclass of numbers and texts that `write_model` wrote; others are refused."""
    if not isinstance(values, dict):
        raise TypeError(f'{values!r:.40} in place of the fields of {kind.__name__}')
    hints = get_type_hints(kind)
    given = {}
    for name, value in values.items():
        hint = hints[name]
        if is_dataclass(hint):
            value = _made(hint, value)
        elif isinstance(value, list):
            value = tuple(map(float, value))
        elif value == 'inf' or (hint is float and not isinstance(value, bool)):
            value = float(value)
        elif hint in (float, bool, str) and not isinstance(value, hint):
            raise ValueError(f'{name} is {value!r:.40}')
        given[name] = value
    return kind(**given)
