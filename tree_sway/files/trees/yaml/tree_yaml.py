# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The YAML form of a tree, which a person can write by hand.

Each of its ``branches`` has a name, the parent's name and its nodes (x, y, z, diameter), or
``segments`` with start, end and diameter. ``species`` names the wood; ``wood`` replaces its
values by measured ones. Keys, kinds and ranges are those of ``tree_schema.json`` beside this
file::

    name: seedling
    species: oak
    branches:
      - name: stem
        nodes: [[0, 0, 0, 0.02], [0, 0, 0.4, 0.015], [0, 0, 0.8, 0.005]]
      - name: twig
        parent: stem
        at: 0.5                               # half way up the stem; nodes are offsets from there
        nodes: [[0, 0, 0, 0.006], [0.2, 0, 0.1, 0.002]]
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from tree_sway.core.species import Species, species_named
from tree_sway.core.tree import tree_from_segments
from tree_sway.errors import FormatError, SpeciesError
from tree_sway.files.paths import is_file, of_file, path_of
from tree_sway.files.text_file import read_text
from tree_sway.files.trees.imported_tree import TreeFile
from tree_sway.files.trees.yaml.branches import branch_segments
from tree_sway.files.yaml_document import read_yaml, tree_schema, YAML_SUFFIXES, YamlDocument
from tree_sway.twin import LearnedTree


def read_yaml_tree(path: Path) -> TreeFile:
    """
    Read a tree from a YAML file.

    Raises
    ------
    FormatError
        A file that is not YAML or does not match the schema; with file, line and key.
    TreeError
        An impossible tree: cyclic, orphaned, zero length; with file, line and segment.
    SpeciesError
        An unknown species.

    """
    return parse_yaml_tree(read_text(path), str(path), default_name=path.stem)


def parse_yaml_tree(text: str, source: str = 'text', default_name: str = 'tree') -> TreeFile:
    """Read a tree from YAML text; see `read_yaml_tree`."""
    document = read_yaml(text, source, tree_schema())
    values = document.values
    species = _species_of(document)
    name = values.get('name', default_name)
    tree = tree_from_segments(**branch_segments(document), name=name, species=species.key)
    learned = LearnedTree(**values['learned']) if 'learned' in values else None
    notes = () if learned is None else (str(learned),)
    return TreeFile(tree, species, source, notes, learned=learned)


def is_species_file(name: str) -> bool:
    """Whether a text names a file with a species, and not a species of the table."""
    return Path(name).suffix.lower() in YAML_SUFFIXES or is_file(path_of(name))


@of_file
def read_species(path: Path) -> Species:
    """
    Read the species of a YAML file, with the wood that the file measures.

    The file is that of a tree, whose branches are not used, or only has ``species`` and ``wood``.

    Raises
    ------
    FormatError
        A file that is missing, is not YAML, does not match the schema, or has neither ``species``
        nor ``wood``.
    SpeciesError
        An unknown species.

    """
    schema = {**tree_schema(), 'required': []}
    document = read_yaml(read_text(path), str(path), schema)
    if not {'species', 'wood'} & set(document.values):
        raise FormatError('no species and no wood', cure="add 'species' or 'wood' to it")
    return _species_of(document)


def _species_of(document: YamlDocument) -> Species:
    """Return the table's species that a document names, with its wood in place of the table's."""
    values = document.values
    key = values.get('species', 'broadleaf')
    try:
        species = species_named(key)
    except SpeciesError as error:
        raise error.at(document.where('species')) from None
    wood = dict(values.get('wood', {}))
    if 'damping_ratio' in wood:
        ratio = wood.pop('damping_ratio')
        for state in ('damping_bare', 'damping_in_leaf'):
            if state in wood:
                raise FormatError(
                    f'both damping_ratio and {state}',
                    where=document.where('wood', state),
                    cure='give damping_ratio only, or both states',
                )
            wood[state] = ratio
    # A modulus from the file is measured, and not the estimate of the table.
    return replace(species, **wood, is_estimate=species.is_estimate and 'modulus' not in wood)
