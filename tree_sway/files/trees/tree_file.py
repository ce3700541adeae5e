# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Read a tree from a file of any known format.

The content decides before the suffix: files of the field come with the suffix of the day. A new
format is one module in `formats`, with a `TreeFormat`.
"""

from __future__ import annotations

from dataclasses import fields, replace
from importlib import import_module
from pathlib import Path
import pkgutil
from typing import Any

from tree_sway.errors import ParameterError
from tree_sway.files.file_format import format_of
from tree_sway.files.text_file import path_of
from tree_sway.files.trees import formats
from tree_sway.files.trees.cylinders.cylinder_tree import CylinderOptions, tree_of_cylinders
from tree_sway.files.trees.file_units import FileUnits
from tree_sway.files.trees.imported_tree import TreeFile
from tree_sway.files.trees.tree_format import TreeFormat

TREE_FORMATS: tuple[TreeFormat, ...] = tuple(
    each
    for module in pkgutil.iter_modules(formats.__path__)
    for each in vars(import_module(f'{formats.__name__}.{module.name}')).values()
    if isinstance(each, TreeFormat)
)
"""Every format, in the order of modules and of their contents."""


def options_of(known: TreeFormat) -> tuple[str, ...]:
    """Return every option that a format takes."""
    shared = [field.name for field in fields(FileUnits)]
    if known.gives_cylinders:
        shared = [*(field.name for field in fields(CylinderOptions)), *shared]
    return tuple(dict.fromkeys((*known.own_options, *shared)))


def read_trees(
    path: str | Path,
    format: str | None = None,  # noqa: A002
    *,
    head: str | None = None,
    **options: Any,
) -> tuple[TreeFile, ...]:
    """
    Read every tree of a file, of a format that is named or found from content and suffix.

    Options are what the reader of the format takes, such as ``species``; for cylinder and skeleton
    formats also those of `CylinderOptions`; for all, those of `FileUnits` that it does not have
    itself. ``head`` is the beginning of the file where it was read before.

    Raises
    ------
    FormatError
        A file of no known format, or one that does not hold what its format promises.
    TreeError
        A tree that cannot be.
    ParameterError
        An option that this format does not have, or has otherwise.

    """
    path = path_of(path)
    chosen = format_of(path, format, TREE_FORMATS, 'tree', head=head)
    chosen.refuse_others(options, options_of(chosen))
    _check_kinds(chosen, options)
    own = {name: options.pop(name) for name in chosen.own_options if name in options}
    shared = {field.name for field in fields(FileUnits)} & set(options)
    units = FileUnits(**{name: options.pop(name) for name in shared})
    content = chosen.read(path, **own)
    if isinstance(content, TreeFile):
        return (units.of_tree(content),)
    settings = CylinderOptions(**options)
    files = tuple(tree_of_cylinders(units.of_cylinders(c), path, settings) for c in content)
    if len({each.tree.name for each in files}) == len(files):
        return files
    return tuple(
        replace(each, tree=replace(each.tree, name=f'{each.tree.name}{number}'))
        for number, each in enumerate(files, start=1)
    )


def read_tree(path: str | Path, format: str | None = None, **options: Any) -> TreeFile:  # noqa: A002, E501
    """
    Read the tree of a file, the first if it holds several; see `read_trees`.

    The notes of the result say how many others there are.
    """
    first, *others = read_trees(path, format, **options)
    if not others:
        return first
    return replace(first, notes=(*first.notes, f'the file holds {len(others)} more trees'))


def _check_kinds(chosen: TreeFormat, options: dict[str, Any]) -> None:
    """Refuse values of another kind than the option's."""
    kinds = {field.name: str(field.type) for field in fields(CylinderOptions)}
    kinds |= {field.name: str(field.type) for field in fields(FileUnits)}
    for name, kind in chosen.read.__annotations__.items():
        kinds[name] = kind.__name__ if isinstance(kind, type) else str(kind)
    for name, value in options.items():
        wanted = kinds[name].split(' ')[0]
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        fits, kind = {
            'float': (is_number, 'a number'),
            'int': (is_number and float(value).is_integer(), 'a whole number'),
            'bool': (isinstance(value, bool), 'true or false'),
            'str': (isinstance(value, str), 'a text'),
        }[wanted]
        if not (fits or (value is None and 'None' in kinds[name])):
            raise ParameterError(f"option {name} is '{value}'", cure=f'give {kind}')
