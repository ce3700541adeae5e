# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A stand from YAML: a table of its trees, and what is not in the table.

Keys, kinds and ranges are those of ``stand_schema.json``::

    name: north slope
    stand: trees.csv
    kinds:
      - {species: oak, tree: scans/oak.mat}
    convection_ratio: 1.4
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tree_sway.core.scene.scene import Scene
from tree_sway.errors import TreeSwayError
from tree_sway.files.scenes.stand_table import read_stand_table
from tree_sway.files.text_file import path_of, read_text
from tree_sway.files.trees.imported_tree import TreeFile
from tree_sway.files.yaml_document import packaged_schema, read_yaml


def read_stand_yaml(path: Path, open_tree: Callable[[str | Path], TreeFile]) -> Scene:
    """
    Read a stand from a YAML file and the table that it names.

    Raises
    ------
    FormatError
        Not YAML, not what the schema says, or a table that cannot be read.
    TreeSwayError
        A kind that cannot be opened; with the line.

    """
    document = read_yaml(read_text(path), str(path), packaged_schema('stand_schema.json'))
    values = document.values
    kinds = {}
    for number, entry in enumerate(values.get('kinds', ())):
        beside = path.parent / path_of(entry['tree'])
        try:
            opened = open_tree(beside if beside.is_file() else entry['tree'])
        except TreeSwayError as error:
            raise error.at(document.where('kinds', number)) from error
        kinds[entry['species']] = opened
    anemometer = values.get('anemometer')
    return read_stand_table(
        path.parent / path_of(values['stand']),
        kinds,
        seed=values.get('seed', 0),
        name=values.get('name', path.stem),
        source=str(path),
        anemometer=None if anemometer is None else tuple(anemometer),
        convection_ratio=values.get('convection_ratio', 1.0),
    )
