# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A `SwayModel` is written as an ``.npz`` file, which `model_file` reads, or as native bytes."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.core.checks import refuse_other_kind
from tree_sway.core.model import SwayModel
from tree_sway.core.native import bytes_of
from tree_sway.core.settings import USUAL
from tree_sway.errors import ParameterError
from tree_sway.files.atomic_file import whole_file
from tree_sway.files.models.model_file import FORMAT, LEAVES, TREE, VERSION


def write_model(path: str | Path, model: SwayModel) -> None:
    """
    Write a model as an ``.npz`` file, with its tree, species and settings.

    Raises
    ------
    FormatError
        A file that cannot be written.

    """
    refuse_other_kind('model', model, SwayModel, 'give the result of prepare')
    tree = model.tree
    settings = model.settings
    about = {
        'format': FORMAT,
        'version': VERSION,
        'name': tree.name,
        'tree_species': tree.species,
        'branch_names': list(tree.branch_names),
        'species': _plain(model.species),
        'settings': _plain(settings),
        'digest': model.digest(),
    }
    arrays: dict[str, Any] = {f'tree_{name}': getattr(tree, name) for name in TREE}
    arrays |= {**model.arrays(), 'about': np.array(json.dumps(about))}
    for name in LEAVES:
        if getattr(settings, name) is not None:
            arrays[name] = np.asarray(getattr(settings, name), dtype=np.float64)
    with whole_file(path) as partial, partial.open('wb') as file:
        np.savez_compressed(file, **arrays)


NATIVE_SUFFIX = '.sway'
"""Suffix of the bytes of a model for the native core (``native/sway.h``)."""


def write_native_model(path: str | Path, model: SwayModel) -> None:
    """
    Write the bytes by which programs in C and C++ step and place a tree.

    Raises
    ------
    FormatError
        A file that cannot be written.
    ParameterError
        A model that is no number of coordinates, which only Python solves.

    """
    refuse_other_kind('model', model, SwayModel, 'give the result of prepare')
    if not model.has_table:
        raise ParameterError(
            f"model '{model.settings.model}' has no table to solve it by",
            where='model',
            cure=f'give a number, such as {USUAL}',
        )
    with whole_file(path) as partial:
        partial.write_bytes(bytes_of(model.native_arrays()))


def _plain(value: Any) -> Any:
    """Return a dataclass as numbers and texts for JSON, which has no infinity, without arrays."""
    if is_dataclass(value):
        names = (each.name for each in fields(value) if each.name not in LEAVES)
        return {name: _plain(getattr(value, name)) for name in names}
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value.item() if isinstance(value, np.generic) else value
