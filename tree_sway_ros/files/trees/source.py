# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree or a forest by name or by path: what the command line and the nodes call TREE."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tree_sway_ros.core.growth.builtin import builtin_tree, BUILTIN_TREES
from tree_sway_ros.core.tree.species import species_keys, species_named
from tree_sway_ros.errors import FormatError, nearest, ParameterError
from tree_sway_ros.files.stands.stand_table import is_stand_table, read_stand_table
from tree_sway_ros.files.stands.stand_yaml import is_stand_yaml, read_stand_yaml
from tree_sway_ros.files.text_file import path_of
from tree_sway_ros.files.trees.imported_tree import TreeFile
from tree_sway_ros.files.trees.tree_file import read_tree, read_trees
from tree_sway_ros.files.trees.yaml.forest_file import forest_of_files, ForestFile
from tree_sway_ros.files.trees.yaml.forest_yaml import is_forest, read_forest


def open_tree(name_or_path: str | Path, seed: int = 0, **options: Any) -> TreeFile:
    """
    Open a built-in tree or a tree file.

    Parameters
    ----------
    name_or_path
        One of `BUILTIN_TREES`, or the path of a file; a file of the name of a built-in tree is
        meant by ``./name``.
    seed
        Seed of a built-in tree.
    **options
        Options of the file's reader; see `read_tree`.

    Raises
    ------
    FormatError
        Neither a built-in tree nor a file, or the file of a forest.
    TreeSwayError
        What reading the file may raise.

    """
    text = str(name_or_path)
    if text in BUILTIN_TREES:
        if options:
            raise ParameterError(
                f"option '{next(iter(options))}' for a built-in tree",
                cure='leave it out: it has no file',
            )
        tree = builtin_tree(text, seed)
        return TreeFile(tree, species_named(tree.species), text)
    path = path_of(text)
    if not path.exists():
        guess = nearest(text, BUILTIN_TREES)
        if text in species_keys():
            guess = f'it is a species: tree-sway grow --species {text} --height 10 -o {text}.yaml;'
        cure = f'{guess} give a file, or one of {", ".join(BUILTIN_TREES)}'.lstrip()
        raise FormatError(f"no tree '{text}'", cure=cure)
    if is_forest(path):
        raise FormatError(
            'a forest, where one tree is asked for', where=text, cure='name one of its trees'
        )
    return read_tree(path, **options).checked()


def open_scene(name_or_path: str | Path, seed: int = 0, **options: Any) -> TreeFile | ForestFile:
    """
    Open a built-in tree, a tree file or the file of a forest; either makes its simulator itself.

    Parameters
    ----------
    name_or_path
        As of `open_tree`, or a YAML file with a list of trees, or a file of a format that holds
        several, or a stand: a table with x, y, species and height, or a YAML file that names one.
    seed, **options
        As of `open_tree`; a forest has none.

    Raises
    ------
    ParameterError
        Options for a forest or a built-in tree.
    TreeSwayError
        As `open_tree` and `read_forest`.

    """
    path = path_of(name_or_path)
    is_scene = is_forest(path) or is_stand_yaml(path) or is_stand_table(path)
    if str(name_or_path) not in BUILTIN_TREES and is_scene:
        if options:
            raise ParameterError(
                f"option '{next(iter(options))}' for a forest",
                where=str(path),
                cure='convert its trees first, and name the new files in the forest',
            )
        if is_forest(path):
            return read_forest(path, open_tree)
        if is_stand_yaml(path):
            return read_stand_yaml(path, open_tree)
        return read_stand_table(path, seed=seed)
    if str(name_or_path) in BUILTIN_TREES or not path.exists():
        return open_tree(name_or_path, seed, **options)
    files = [each.checked() for each in read_trees(path, **options)]
    return files[0] if len(files) == 1 else forest_of_files(files, path.stem)
