# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree or a forest by name or by path: TREE of the command line and the nodes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any
import warnings

import numpy as np

from tree_sway.core.scene import PlacedTree, Scene
from tree_sway.core.species import species_keys, species_named
from tree_sway.errors import FormatError, nearest, ParameterError
from tree_sway.files.column_names import INVENTORY
from tree_sway.files.file_format import UnknownFormatError
from tree_sway.files.kinds import expected
from tree_sway.files.paths import path_of
from tree_sway.files.scenes.inventory.inventory_file import lacking_columns
from tree_sway.files.scenes.scene_yaml import read_scene_yaml
from tree_sway.files.scenes.stand_table import is_stand_table, read_stand_table
from tree_sway.files.text_file import read_head
from tree_sway.files.trees.imported_tree import said_of, TreeFile
from tree_sway.files.trees.tree_file import read_tree, read_trees
from tree_sway.files.trees.tree_options import same, Wood
from tree_sway.files.yaml_document import begins_with_key
from tree_sway.growth import builtin_tree, BUILTIN_TREES


def open_tree(
    name_or_path: str | Path,
    seed: int = 0,
    *,
    wood: Wood = same,
    in_leaf: bool | None = None,
    warn: bool = True,
    **options: Any,
) -> TreeFile:
    """
    Open a built-in tree or a tree file.

    A description is opened as its file states it. A scan may have faults, which are mended.

    Parameters
    ----------
    name_or_path
        One of `BUILTIN_TREES`, or the path of a file; a file of the same name as a built-in tree
        is ``./name``.
    seed
        Seed of a built-in tree.
    wood
        Function that returns the species to use in place of that of the file: faults of a scan are
        mended by it.
    in_leaf
        Season in which its limbs have to carry themselves; None is by the species: evergreens are
        in leaf, others bare.
    warn
        Whether each fault that was mended is a Python warning too (`TreeFile.warnings` has all).
    **options
        Options of the file's reader; see `read_tree`.

    Raises
    ------
    FormatError
        Neither a built-in tree nor a file, or the file of a forest or a stand.
    TreeSwayError
        An error of reading the file.

    """
    path = path_of(name_or_path)
    text = str(name_or_path)
    if text in BUILTIN_TREES:
        if options:
            raise ParameterError(
                f"option '{next(iter(options))}' for a built-in tree",
                cure='leave it out: it has no file',
            )
        tree = builtin_tree(text, seed)
        built_in = TreeFile(tree, species_named(tree.species), text)
        return built_in.of_species(wood(built_in.species)).checked()
    if not path.exists():
        raise unknown_tree(text)
    head = read_head(path) if path.is_file() else None
    if head is not None:
        _refuse_several_trees(path, head)
    found = read_tree(path, head=head, wood=wood, in_leaf=in_leaf, **options).checked()
    if warn:
        _warn(found.faults)
    return found


def _warn(faults: Sequence[str]) -> None:
    """Make Python warnings of faults, at the line that opens the tree."""
    for fault in faults:
        warnings.warn(fault, UserWarning, stacklevel=3)


def unknown_tree(name: str) -> FormatError:
    """Return the error for a name that is neither that of a built-in tree nor that of a file."""
    path = Path(name)
    beside = [*map(str, path.parent.glob(f'*{path.suffix}'))] if path.suffix else []
    guess = nearest(name, beside or [*BUILTIN_TREES, *species_keys()])
    if name in species_keys():
        line = f'tree-sway grow {name} --height 10 -o {name}.yaml'
        guess = f"it is a species: {line}, or grow('{name}', 10) in Python;"
    cure = f'{guess} give a file, or one of {", ".join(BUILTIN_TREES)}'.lstrip()
    return FormatError(f"no tree '{name}'", cure=cure)


def _refuse_several_trees(path: Path, head: str) -> None:
    """Raise a `FormatError` for a forest or a stand, with how to get one of its trees."""
    what = 'a stand of trees' if begins_with_key(path, head, 'stand') else ''
    cure = (
        'make one of them, such as by tree-sway grow oak --height 12 --diameter 0.3 -o oak.yaml; '
        'info, show, plot and convert take all of them'
    )
    if is_stand_table(head, path):
        what = 'an inventory of trees'
    if begins_with_key(path, head, 'trees'):
        what, cure = 'a forest', 'name one of its trees'
    if what:
        with expected(path, 'scene', 'inventory'):
            raise FormatError(f'{what}, where one tree is expected', where=str(path), cure=cure)


def open_scene(
    name_or_path: str | Path,
    seed: int = 0,
    *,
    exact: bool = False,
    wood: Wood = same,
    in_leaf: bool | None = None,
    warn: bool = True,
    **options: Any,
) -> Scene:
    """
    Open a built-in tree, a tree file, a forest or a stand.

    Parameters
    ----------
    name_or_path
        Name or path as in `open_tree`, or a YAML file with a list of trees, or a file with several
        trees, or a stand: a table with x, y, species and height, or a YAML file that names one.
    exact
        Whether each tree of a stand is grown by itself, as in `read_stand_table`.
    wood, in_leaf, warn
        The same as in `open_tree`, for all trees.
    seed, **options
        Arguments of `open_tree`; not for a forest.

    Raises
    ------
    ParameterError
        Options for a forest or a built-in tree.
    TreeSwayError
        Errors of `open_tree` and `read_scene_yaml`.

    """
    path = path_of(name_or_path)
    opened = partial(open_tree, in_leaf=in_leaf, warn=False)
    if str(name_or_path) in BUILTIN_TREES or not path.is_file():
        scene = scene_of_files([opened(name_or_path, seed, wood=wood, **options)])
    else:
        head = read_head(path)
        stand = partial(read_stand_table, path, seed=seed, exact=exact, head=head)
        if any(begins_with_key(path, head, key) for key in ('trees', 'stand')):
            listed = partial(read_scene_yaml, path, opened, exact=exact)
            scene = _forest(path, listed, wood, options)
        elif is_stand_table(head, path):
            scene = _forest(path, stand, wood, options)
        else:
            try:
                files = read_trees(path, head=head, wood=wood, in_leaf=in_leaf, **options)
                scene = scene_of_files([each.checked() for each in files], path.stem)
            except UnknownFormatError:
                lacking = lacking_columns(head)
                if lacking is None or len(lacking) == len(INVENTORY):
                    raise
                scene = stand()
    if warn:
        _warn(scene.faults)
    return scene


def _forest(path: Path, read: Callable[[], Scene], wood: Wood, options: dict[str, Any]) -> Scene:
    """Read a forest or a stand, which has no options, of its own wood or of another one."""
    if options:
        raise ParameterError(
            f"option '{next(iter(options))}' for a forest",
            where=str(path),
            cure='convert its trees first, and name the new files in the forest',
        )
    with expected(path, 'scene', 'inventory'):
        scene = read()
    if wood is same:
        return scene
    return scene.of_species(wood(scene.trees[0].species)).checked()


def scene_of_files(files: Sequence[TreeFile], name: str = '') -> Scene:
    """Return the trees of one file as a scene: several at their places, the first at 0."""
    one = files[0]
    trees = []
    for each in files:
        tree = each.tree
        x, y, z = (np.subtract(each.origin, one.origin) + tree.start[0]).tolist()
        placed = PlacedTree(tree.name, tree, x, y, z, species=each.species, learned=each.learned)
        trees.append(placed)
    if len(files) == 1:
        return Scene(trees, one.tree.name, one.source, one.notes, faults=one.faults)
    return Scene(trees, name, one.source, **said_of((each.tree.name, each) for each in files))
