# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree with its prepared model, an ``.npz`` file of `write_model`."""

from __future__ import annotations

from pathlib import Path

from tree_sway.core.model import PREPARED
from tree_sway.core.tree_state import digest_of
from tree_sway.files.file_format import contains, FileFormat
from tree_sway.files.models.model_file import read_model, SUFFIX
from tree_sway.files.trees.imported_tree import TreeFile


def read_prepared(path: Path) -> TreeFile:
    """
    Read the tree of a prepared model, and let simulators with its settings use the model.

    Raises a `FormatError` for a damaged file.
    """
    model = read_model(path)
    source = digest_of(model.tree, model.species, model.settings)
    PREPARED.add(source, model.arrays())
    settings = model.settings
    leaves = 'in leaf' if settings.in_leaf else 'bare'
    note = (
        f'prepared on model {settings.model}, {leaves}; another species, season or number of '
        'coordinates is set up anew'
    )
    return TreeFile(model.tree, model.species, str(path), (note,))


FORMAT = FileFormat('npz', (SUFFIX,), contains(r'\APK\x03\x04[\s\S]{,292}\.npy'), read_prepared)
