# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees and winds that no case can compute, refused at their line before workers start."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import itertools
from pathlib import Path
from typing import Any

from tree_sway.core.species import species_named
from tree_sway.core.wind import Turbulence
from tree_sway.errors import FormatError, TreeSwayError
from tree_sway.files import is_file, path_of, YamlDocument
from tree_sway.files.trees import unknown_tree
from tree_sway.growth import BUILTIN_TREES, refuse_height


def refuse_impossible(document: YamlDocument, folder: Path) -> None:
    """
    Refuse impossible trees and winds of a study, with the line of each.

    Parameters
    ----------
    document
        The study, which matches its schema.
    folder
        Folder that names of files are relative to.

    Raises
    ------
    FormatError
        An unknown tree, a tree that is not either a file or grown, or a wind that is not either a
        file or a speed.
    SpeciesError
        An unknown species.
    ParameterError
        A height, speed or intensity out of its range.

    """
    for number, entry in enumerate(document.values['trees']):
        with _at(document, 'trees', number):
            if isinstance(entry, dict) and ('file' in entry) == ('grow' in entry):
                raise FormatError('a tree is a file or grown', cure='give one of file and grow')
            if (name := named_tree(entry)) is not None:
                _refuse_unknown_tree(name, folder)
                continue
        _refuse_grown(document, number, entry['grow'])
    for number, entry in enumerate(document.values['winds']):
        with _at(document, 'winds', number):
            _refuse_wind(entry)


def listed(value: Any) -> list[Any]:
    """Return the values of a key, which are a list or one value."""
    return value if isinstance(value, list) else [value]


def named_tree(entry: str | dict[str, Any]) -> str | None:
    """Return the file or built-in tree that an entry of ``trees`` names; None for a grown one."""
    return entry if isinstance(entry, str) else entry.get('file')


def _refuse_unknown_tree(name: str, folder: Path) -> None:
    if name not in BUILTIN_TREES and not is_file(folder / path_of(name)):
        raise unknown_tree(name)


def _refuse_grown(document: YamlDocument, number: int, grow: dict[str, Any]) -> None:
    for species, height in itertools.product(listed(grow['species']), listed(grow['height'])):
        with _at(document, 'trees', number, 'grow', 'species'):
            wood = species_named(species)
        with _at(document, 'trees', number, 'grow', 'height'):
            refuse_height(wood, height)


def _refuse_wind(entry: dict[str, Any]) -> None:
    if ('file' in entry) == ('speed' in entry):
        raise FormatError('a wind is a file or a speed', cure='give one of them')
    speeds = listed(entry.get('speed', []))
    intensities = listed(entry.get('intensity', 0.2))
    for speed, intensity in itertools.product(speeds, intensities):
        Turbulence(speed, intensity=intensity)


@contextmanager
def _at(document: YamlDocument, *path: str | int) -> Iterator[None]:
    """Give errors the line of the value at a path of keys and positions."""
    try:
        yield
    except TreeSwayError as error:
        raise error.inside(document.where(*path)) from None
