# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The YAML form of a forest: which trees, and where each stands.

A tree is the name of a built-in one or a file of any format, found from the forest's own folder.
Keys, kinds and ranges are those of ``forest_schema.json`` beside this file::

    name: glade
    trees:
      - {name: fig, tree: benjamina, x: 0, y: 0, leaf_on: true}
      - {name: cypress, tree: goldcrest, x: 1.5, y: 0.4, yaw: 2.1, seed: 7}
      - {name: old oak, tree: ../scans/oak.mat, species: oak, x: 9, y: 3}
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from tree_sway_ros.core.scene.placed_tree import PlacedTree
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.errors import TreeSwayError
from tree_sway_ros.files.text_file import path_of, read_text
from tree_sway_ros.files.trees.imported_tree import TreeFile
from tree_sway_ros.files.trees.yaml.forest_file import ForestFile, refuse_same_names
from tree_sway_ros.files.trees.yaml.species_yaml import open_species
from tree_sway_ros.files.yaml_document import begins_with_key, packaged_schema, read_yaml

OpenTree = Callable[[str, int], TreeFile]
OpenSpecies = Callable[[str], Species]


def is_forest(path: Path) -> bool:
    """Whether a file looks like a forest: YAML with ``trees`` at its outermost."""
    return begins_with_key(path, 'trees')


def read_forest(path: Path, open_tree: Callable[[str | Path, int], TreeFile]) -> ForestFile:
    """
    Read a forest from a YAML file, its trees opened by their names or paths, with a seed.

    Raises
    ------
    FormatError
        Not YAML, or not what the schema says; names file, line and key.
    TreeSwayError
        A tree that cannot be opened; names the line, the tree, and what is wrong with it.

    """

    @cache
    def opened(name: str, seed: int) -> TreeFile:
        beside = path.parent / path_of(name)
        return open_tree(beside if beside.is_file() else name, seed)

    @cache
    def opened_species(name: str) -> Species:
        beside = path.parent / path_of(name)
        return open_species(beside if beside.is_file() else name)

    return parse_forest(
        read_text(path), opened, str(path), default_name=path.stem, open_species=opened_species
    )


def parse_forest(
    text: str,
    open_tree: OpenTree,
    source: str = 'text',
    *,
    default_name: str = 'forest',
    open_species: OpenSpecies = open_species,
) -> ForestFile:
    """Read a forest from YAML text; see `read_forest`."""
    document = read_yaml(text, source, packaged_schema('forest_schema.json'))
    values = document.values
    names = [entry['name'] for entry in values['trees']]
    refuse_same_names(names, lambda number: document.where('trees', number))
    trees, notes = [], []
    for number, entry in enumerate(values['trees']):
        where = document.where('trees', number)
        standing, file_notes = _standing(entry, open_tree, open_species, where)
        trees.append(standing)
        notes += [f'{standing.name}: {note}' for note in file_notes]
    anemometer = values.get('anemometer')
    return ForestFile(
        name=values.get('name', default_name),
        trees=tuple(trees),
        source=source,
        notes=tuple(notes),
        anemometer=None if anemometer is None else tuple(anemometer),
        convection_ratio=values.get('convection_ratio', 1.0),
    )


def _standing(
    entry: dict[str, Any], open_tree: OpenTree, open_species: OpenSpecies, where: str
) -> tuple[PlacedTree, tuple[str, ...]]:
    """One tree of the list, and the notes of its file."""
    name = entry['name']
    try:
        tree_file = open_tree(entry['tree'], entry.get('seed', 0))
        if 'species' in entry:
            tree_file = tree_file.of_species(open_species(entry['species']))
    except TreeSwayError as error:
        inner = f'{error.where}: {error.what}' if error.where else error.what
        raise type(error)(inner, where=f"{where}: tree '{name}'", cure=error.cure) from None
    place: dict[str, Any] = {key: entry[key] for key in ('x', 'y', 'z', 'yaw') if key in entry}
    standing = PlacedTree(
        name, tree_file.tree, species=tree_file.species, leaf_on=entry.get('leaf_on'), **place
    )
    return standing, tree_file.notes
