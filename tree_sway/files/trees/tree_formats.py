# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""All formats of trees: those of the modules of `formats`."""

from __future__ import annotations

from importlib import import_module
import pkgutil

from tree_sway.files.file_format import FileFormat
from tree_sway.files.trees import formats

TREE_FORMATS: tuple[FileFormat, ...] = tuple(
    each
    for module in pkgutil.iter_modules(formats.__path__)
    for each in vars(import_module(f'{formats.__name__}.{module.name}')).values()
    if isinstance(each, FileFormat)
)
"""All formats, in the order of modules and of their contents."""
