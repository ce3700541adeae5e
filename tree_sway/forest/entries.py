# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees and winds of a study, as cases have them.

One that no case can compute is refused at its line, before workers start.
"""

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
from tree_sway.files.wind import EXAMPLES
from tree_sway.growth import BUILTIN_TREES, refuse_height

Plain = dict[str, Any]


def trees_of(document: YamlDocument, folder: Path) -> list[Plain]:
    """
    List the trees of a study.

    Parameters
    ----------
    document
        The study, which matches its schema.
    folder
        Folder that names of files are relative to.

    Raises
    ------
    FormatError
        An unknown tree, or one that is not either a file or grown.
    SpeciesError
        An unknown species.
    ParameterError
        A height out of its range.

    """
    found: list[Plain] = []
    for number, entry in enumerate(document.values['trees']):
        with _at(document, 'trees', number):
            if isinstance(entry, dict) and ('file' in entry) == ('grow' in entry):
                raise FormatError('a tree is a file or grown', cure='give one of file and grow')
            name = entry if isinstance(entry, str) else entry.get('file')
            if name is not None:
                beside = folder / path_of(name)
                if not is_file(beside) and name not in BUILTIN_TREES:
                    raise unknown_tree(name)
                found.append({'file': str(beside)} if is_file(beside) else {'name': name})
                continue
        grow = entry['grow']
        for species, height in itertools.product(listed(grow['species']), listed(grow['height'])):
            with _at(document, 'trees', number, 'grow', 'species'):
                wood = species_named(species)
            with _at(document, 'trees', number, 'grow', 'height'):
                refuse_height(wood, height)
            found += [
                {'species': species, 'height': float(height), 'seed': seed}
                for seed in range(grow.get('seeds', 1))
            ]
    return found


def winds_of(document: YamlDocument, folder: Path) -> list[Plain]:
    """
    List the winds of a study; arguments are those of `trees_of`.

    Raises
    ------
    FormatError
        A wind that is not either a file or a speed.
    ParameterError
        A speed or intensity out of its range.

    """
    found: list[Plain] = []
    for number, entry in enumerate(document.values['winds']):
        with _at(document, 'winds', number):
            if ('file' in entry) == ('speed' in entry):
                raise FormatError('a wind is a file or a speed', cure='give one of them')
            if 'file' in entry:
                beside = folder / path_of(entry['file'])
                is_built_in = entry['file'] in EXAMPLES and not is_file(beside)
                path = entry['file'] if is_built_in else str(beside)
                scales = listed(entry.get('scale', 1.0))
                found += [{'file': path, 'scale': float(scale)} for scale in scales]
                continue
            intensities = listed(entry.get('intensity', 0.2))
            for speed, intensity in itertools.product(listed(entry['speed']), intensities):
                Turbulence(speed, intensity=intensity)
                found += [
                    {'speed': float(speed), 'intensity': float(intensity), 'seed': seed}
                    for seed in range(entry.get('seeds', 1))
                ]
    return found


def listed(value: Any) -> list[Any]:
    """Return the values of a key, which are a list or one value."""
    return value if isinstance(value, list) else [value]


@contextmanager
def _at(document: YamlDocument, *path: str | int) -> Iterator[None]:
    """Give errors the line of the value at a path of keys and positions."""
    try:
        yield
    except TreeSwayError as error:
        raise error.inside(document.where(*path)) from None
