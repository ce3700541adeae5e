# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A `SwayModel` as an ``.npz`` file: arrays of numbers by name, and one text. No pickles.

``about`` is a text in JSON with what has no shape: names, species, settings, version and digest.
Arrays of the tree have the prefix ``tree_``. `doc/sway_model.md` documents all of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
import json
import math
from pathlib import Path
from typing import Any, get_type_hints
import zipfile

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.model.settings import Settings
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.tree.tree import Tree
from tree_sway.core.tree.wood import Species
from tree_sway.errors import FormatError, inside, ParameterError, TreeError
from tree_sway.files.paths import path_of
from tree_sway.files.whole_file import whole_file

SUFFIX = '.npz'

VERSION = 1
"""Version of the arrays and the law of a step; a reader refuses any other."""

LARGEST = 1 << 30
"""Largest size of all arrays of a file [bytes]."""

_FORMAT = 'tree_sway model'
_TREE = 'start', 'end', 'base_diameter', 'tip_diameter', 'segment_parent', 'branch_first'
_LEAVES = 'leaf_mass', 'leaf_area'
_TEXT_LIMIT = 1 << 24


def write_model(path: str | Path, model: SwayModel) -> None:
    """
    Write a model as an ``.npz`` file, with its tree, species and settings.

    Raises
    ------
    FormatError
        A file that cannot be written.

    """
    tree, settings = model.tree, model.settings
    about = {
        'format': _FORMAT,
        'version': VERSION,
        'name': tree.name,
        'tree_species': tree.species,
        'branch_names': list(tree.branch_names),
        'species': _plain(model.species),
        'settings': _plain(settings),
        'digest': model.digest(),
    }
    arrays: dict[str, Any] = {f'tree_{name}': getattr(tree, name) for name in _TREE}
    arrays |= {**model.arrays(), 'about': np.array(json.dumps(about))}
    for name in _LEAVES:
        if getattr(settings, name) is not None:
            arrays[name] = np.asarray(getattr(settings, name), dtype=np.float64)
    with whole_file(path) as partial, partial.open('wb') as file:
        np.savez_compressed(file, **arrays)


def read_model(path: str | Path) -> SwayModel:
    """
    Read a model that `write_model` wrote.

    Raises
    ------
    FormatError
        A file that is none, of another version, damaged, too large, or whose arrays do not fit.

    """
    where = path_of(path)
    with inside(str(where)):
        arrays = _read_arrays(where)
        about = _read_about(arrays.pop('about', np.array('')))
        try:
            tree = _tree(about, {name: arrays.pop(f'tree_{name}') for name in _TREE})
            leaves = {name: arrays.pop(name) for name in _LEAVES if name in arrays}
            species = _made(Species, about['species'])
            settings = replace(_made(Settings, about['settings']), **leaves)
        except (KeyError, TypeError, ValueError, TreeError, ParameterError) as error:
            raise _damaged(f'its tree or settings: {error}') from None
        model = SwayModel.of_arrays(arrays, tree, species, settings)
        if model.digest() != about.get('digest'):
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
    except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile) as error:
        raise _damaged(str(error)) from None


def _read_about(text: NDArray[Any]) -> dict[str, Any]:
    """Read the text of a file; refuse another format, and another version."""
    if text.dtype.kind != 'U' or text.size != 1 or text.nbytes > _TEXT_LIMIT:
        raise _damaged('there is no text about it')
    try:
        about = json.loads(str(text))
    except (ValueError, RecursionError):
        raise _damaged('the text about it is no JSON') from None
    if not isinstance(about, dict) or about.get('format') != _FORMAT:
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
    """Build a tree again, with all checks; refuse one whose segments are in another order."""
    first = arrays['branch_first']
    sizes = np.diff(first)
    if (sizes < 1).any() or int(sizes.sum()) != len(arrays['start']):
        raise _damaged('branches without segments')
    tree = tree_from_segments(
        arrays['start'],
        arrays['end'],
        np.stack([arrays['base_diameter'], arrays['tip_diameter']], axis=1),
        parent=arrays['segment_parent'],
        branch=np.repeat(np.arange(len(sizes)), sizes),
        branch_names=[str(name) for name in about['branch_names']],
        name=str(about['name']),
        species=str(about['tree_species']),
    )
    if not np.array_equal(tree.branch_first, first) or not np.array_equal(
        tree.start, arrays['start']
    ):
        raise _damaged('segments that are not in depth-first order')
    return tree


def _plain(value: Any) -> Any:
    """Return a dataclass as numbers and texts for JSON, which has no infinity, without arrays."""
    if is_dataclass(value):
        own = {each.name: getattr(value, each.name) for each in fields(value)}
        return {name: _plain(each) for name, each in own.items() if name not in _LEAVES}
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value.item() if isinstance(value, np.generic) else value


def _made(kind: Any, values: Mapping[str, Any]) -> Any:
    """Make a dataclass of numbers and texts that `_plain` returned; others are refused."""
    hints, given = get_type_hints(kind), {}
    for name, value in values.items():
        hint = hints[name]
        if is_dataclass(hint):
            given[name] = _made(hint, value)
        elif isinstance(value, list):
            given[name] = tuple(float(each) for each in value)
        elif value == 'inf':
            given[name] = math.inf
        elif hint is float:
            given[name] = float(value)
        elif hint in (bool, str) and not isinstance(value, hint):
            raise ValueError(f'{name} is {value!r:.40}')
        else:
            given[name] = value
    return kind(**given)
