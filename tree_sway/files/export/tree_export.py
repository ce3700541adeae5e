# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Write a tree for other programs: our YAML and glTF.

YAML is exact and reads back. glTF sways by a skin or by morph targets; see `gltf_tree`.
"""

from __future__ import annotations

from pathlib import Path

from tree_sway.core.leaves import LeafClusters
from tree_sway.core.species import Species
from tree_sway.core.tree import GrownTree, Tree, tree_and_species
from tree_sway.errors import FormatError
from tree_sway.files.atomic_file import whole_file, write_text_whole
from tree_sway.files.export.gltf_document import GltfDocument
from tree_sway.files.export.yaml_writing import yaml_of_tree
from tree_sway.files.trees.imported_tree import TreeFile

SUFFIXES = ('.yaml', '.yml', '.glb')
"""Suffixes of files that `write_tree` writes."""


def write_tree(
    path: str | Path,
    tree: Tree | GrownTree,
    species: Species | None = None,
    leaves: LeafClusters | None = None,
) -> None:
    """
    Write a tree in the format of the path's suffix.

    Parameters
    ----------
    path
        The file: ``.yaml``, ``.yml`` or ``.glb``; overwritten if it exists.
    tree
        Tree, with or without its species.
    species
        Species, if different from the tree's own; only YAML can store it.
    leaves
        Clusters of leaves to draw; only glTF can store them.

    Raises
    ------
    FormatError
        An unknown suffix, a forest as YAML, or a file that cannot be written.
    SpeciesError
        If the species table does not know the tree's species.

    """
    learned = tree.learned if isinstance(tree, TreeFile) and species is None else None
    if not isinstance(tree, Tree):
        tree, species = tree_and_species(tree, species)
    suffix = Path(path).suffix.lower()
    if suffix not in SUFFIXES:
        raise FormatError(
            f"cannot write '{Path(path).suffix}'",
            where=str(path),
            cure=f'use {", ".join(SUFFIXES)}',
        )
    if suffix == '.glb':
        from tree_sway.files.export.gltf_tree import skinned_tree  # it takes long to load

        write_gltf(path, skinned_tree(tree, leaves))
    else:
        write_text_whole(path, yaml_of_tree(tree, species, learned))


def write_gltf(path: str | Path, document: GltfDocument) -> None:
    """Write a document in the binary form."""
    with whole_file(path) as partial:
        partial.write_bytes(document.glb())
