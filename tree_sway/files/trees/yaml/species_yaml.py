# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A species by its key, or a file of one's own beside the table.

The file says which entry of the table the species is like and what is measured otherwise, in the
keys of a tree's YAML; leaves are those of that entry::

    name: elm of the park
    species: ash
    wood: {modulus: 7.2e9, density: 980, damping_bare: 0.03}
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from tree_sway.core.tree.species import Species, species_keys, species_named
from tree_sway.errors import SpeciesError
from tree_sway.files.text_file import path_of, read_text
from tree_sway.files.trees.yaml.tree_yaml import species_of
from tree_sway.files.yaml_document import read_yaml, Schema, tree_schema, YAML_SUFFIXES


def open_species(key_or_path: str | Path) -> Species:
    """
    Open a species by its key in the species table, or from a YAML file.

    Raises
    ------
    SpeciesError
        A key that the table does not know, and no file.
    FormatError
        Not YAML, or not what the schema says; names file, line and key.

    """
    text = str(key_or_path)
    path = path_of(text)
    if path.suffix.lower() not in YAML_SUFFIXES:
        return species_named(text)
    if not path.exists():
        raise SpeciesError(
            f"no species file '{text}'",
            cure=f'give a file, or one of: {", ".join(sorted(species_keys()))}',
        )
    return parse_species(read_text(path), str(path))


def parse_species(text: str, source: str = 'text') -> Species:
    """Read a species from YAML text; see `open_species`."""
    document = read_yaml(text, source, species_schema())
    species = species_of(document)
    return replace(species, title=document.values.get('name', species.title))


def species_schema() -> Schema:
    """Return the JSON schema of a species file: that of a tree's YAML without the tree."""
    whole = tree_schema()
    known = ('tree_sway', 'name', 'species', 'wood')
    return {
        'type': 'object',
        'additionalProperties': False,
        'required': ['species'],
        'properties': {key: whole['properties'][key] for key in known},
        '$defs': whole['$defs'],
    }
