# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The YAML form of a scene: its trees one by one, or the table of a stand and further values.

A tree is the name of a built-in one or a file of any format; files are found from the scene's own
folder. Keys, kinds and ranges are those of ``scene_schema.json``::

    name: glade
    trees:
      - {name: fig, tree: benjamina, x: 0, y: 0, leaf_on: true}
      - {name: old oak, tree: ../scans/oak.mat, species: oak, x: 9, y: 3}

    name: north slope
    stand: trees.csv
    kinds:
      - {species: oak, tree: scans/oak.mat}
    convection_ratio: 1.4
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from tree_sway.core.scene import PlacedTree, Scene
from tree_sway.core.species import species_named
from tree_sway.errors import FormatError, inside
from tree_sway.files.paths import is_file, path_of
from tree_sway.files.scenes.stand_table import read_stand_table
from tree_sway.files.scenes.tree_names import refuse_same_names
from tree_sway.files.text_file import read_text
from tree_sway.files.trees.imported_tree import said_of, TreeFile
from tree_sway.files.yaml_document import packaged_schema, read_yaml, YamlDocument

OpenTree = Callable[..., TreeFile]

_PLACE = {'x', 'y', 'z', 'yaw', 'leaf_on'}


def read_scene_yaml(path: Path, open_tree: OpenTree, *, exact: bool = False) -> Scene:
    """
    Read a scene from a YAML file, its trees opened by their names or paths, with a seed.

    ``exact`` is that of `read_stand_table`.

    Raises
    ------
    FormatError
        A file that is not YAML or does not match the schema, or an unreadable table; with file and
        line.
    TreeSwayError
        A tree that cannot be opened; with line, tree and fault.

    """
    return parse_scene(read_text(path), open_tree, path, exact=exact)


def parse_scene(text: str, open_tree: OpenTree, path: Path, *, exact: bool = False) -> Scene:
    """Read a scene from the YAML text of a file; see `read_scene_yaml`."""
    document = read_yaml(text, str(path), packaged_schema('scene_schema.json'))
    values = document.values
    if ('trees' in values) == ('stand' in values):
        found = 'both trees and stand' if 'trees' in values else 'no trees and no stand'
        raise FormatError(found, where=document.where(), cure='give one of the two')
    common = {
        'name': values.get('name', path.stem),
        'source': str(path),
        'convection_ratio': values.get('convection_ratio', 1.0),
    }
    if 'anemometer' in values:
        common['anemometer'] = tuple(values['anemometer'])
    if 'trees' in values:
        return _scene_of_trees(document, open_tree, path.parent, common)
    kinds = {}
    for number, entry in enumerate(values.get('kinds', ())):
        with inside(document.where('kinds', number)):
            kinds[entry['species']] = open_tree(_beside(path.parent, entry['tree']), 0)
    table = path.parent / path_of(values['stand'])
    return read_stand_table(table, kinds, seed=values.get('seed', 0), exact=exact, **common)


def _scene_of_trees(
    document: YamlDocument, open_tree: OpenTree, folder: Path, common: dict[str, Any]
) -> Scene:
    """Scene of the trees of the list, with notes and faults of their importers."""
    entries = document.values['trees']
    refuse_same_names(
        [entry['name'] for entry in entries], lambda number: document.where('trees', number)
    )

    @cache
    def opened(tree: str, seed: int, species: str | None, leaf_on: bool | None) -> TreeFile:
        """Open a tree once for all of its kind."""
        asked: dict[str, Any] = {} if leaf_on is None else {'in_leaf': leaf_on}
        if species is not None:
            named = species_named(species)
            asked['wood'] = lambda _: named
        return open_tree(_beside(folder, tree), seed, **asked)

    trees = []
    files = []
    for number, entry in enumerate(entries):
        name = entry['name']
        with inside(f"{document.where('trees', number)}: tree '{name}'"):
            file = opened(
                entry['tree'], entry.get('seed', 0), entry.get('species'), entry.get('leaf_on')
            )
        place: dict[str, Any] = {key: entry[key] for key in _PLACE & entry.keys()}
        placed = PlacedTree(name, file.tree, species=file.species, learned=file.learned, **place)
        trees.append(placed)
        files.append((name, file))
    return Scene(trees, **said_of(files), **common)


def _beside(folder: Path, name: str) -> str | Path:
    """File of a name in a folder; the name itself if the folder has no such file."""
    beside = folder / path_of(name)
    return beside if is_file(beside) else name
