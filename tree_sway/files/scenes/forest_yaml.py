# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The YAML form of a forest: which trees, and where each stands.

A tree is the name of a built-in one or a file of any format, found from the forest's own folder.
Keys, kinds and ranges are those of ``forest_schema.json``::

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

from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.tree.species import Species
from tree_sway.errors import TreeSwayError
from tree_sway.files.scenes.tree_names import refuse_same_names
from tree_sway.files.text_file import path_of, read_text
from tree_sway.files.trees.imported_tree import TreeFile
from tree_sway.files.trees.yaml.species_yaml import open_species
from tree_sway.files.yaml_document import packaged_schema, read_yaml

OpenTree = Callable[[str, int], TreeFile]
OpenSpecies = Callable[[str], Species]

_PLACE = ('x', 'y', 'z', 'yaw', 'leaf_on')


def read_forest(path: Path, open_tree: Callable[[str | Path, int], TreeFile]) -> Scene:
    """
    Read a forest from a YAML file, its trees opened by their names or paths, with a seed.

    Raises
    ------
    FormatError
        Not YAML, or not what the schema says; names file, line and key.
    TreeSwayError
        A tree that cannot be opened; names the line, the tree, and what is wrong with it.

    """

    def opened(name: str, seed: int) -> TreeFile:
        beside = path.parent / path_of(name)
        return open_tree(beside if beside.is_file() else name, seed)

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
) -> Scene:
    """Read a forest from YAML text; see `read_forest`."""
    document = read_yaml(text, source, packaged_schema('forest_schema.json'))
    values = document.values
    names = [entry['name'] for entry in values['trees']]
    refuse_same_names(names, lambda number: document.where('trees', number))
    trees, notes = [], []

    @cache
    def opened(tree: str, seed: int, species: str | None) -> TreeFile:
        """Open a tree once, so that all of its kind share it."""
        file = open_tree(tree, seed)
        return file if species is None else file.of_species(open_species(species))

    for number, entry in enumerate(values['trees']):
        where = document.where('trees', number)
        name = entry['name']
        try:
            file = opened(entry['tree'], entry.get('seed', 0), entry.get('species'))
        except TreeSwayError as error:
            inner = f'{error.where}: {error.what}' if error.where else error.what
            raise type(error)(inner, where=f"{where}: tree '{name}'", cure=error.cure) from None
        place: dict[str, Any] = {key: entry[key] for key in _PLACE if key in entry}
        trees.append(PlacedTree(name, file.tree, species=file.species, **place))
        notes += [f'{name}: {note}' for note in file.notes]
    anemometer = values.get('anemometer')
    return Scene(
        trees,
        name=values.get('name', default_name),
        source=source,
        notes=tuple(notes),
        anemometer=None if anemometer is None else tuple(anemometer),
        convection_ratio=values.get('convection_ratio', 1.0),
    )
