# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a command writes: where, that nothing is lost by it, and a line about it."""

from __future__ import annotations

import argparse
import itertools
from pathlib import Path

from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.files.export.tree_export import write_tree

OUTPUT_HELP = "file to write; its suffix names the format: .yaml, .obj, .glb, .gltf"


def add_output_arguments(
    parser: argparse.ArgumentParser, what: str, *, required: bool = True
) -> None:
    """Add ``--output`` and ``--force``; `what` is the help of the first."""
    parser.add_argument("-o", "--output", required=required, metavar="FILE", help=what)
    parser.add_argument("--force", action="store_true", help="write over a file that is there")


def output_path(arguments: argparse.Namespace, default: str = "") -> str:
    """
    File to write: the one asked for, or the first of the default's names that is free.

    Raises
    ------
    ParameterError
        If the file asked for is there already and ``--force`` is not given.

    """
    if arguments.output is not None:
        if Path(arguments.output).is_file() and not arguments.force:
            raise ParameterError(
                f"'{arguments.output}' is there already",
                where="--output",
                cure="name another file, or write over it with --force",
            )
        return str(arguments.output)
    path = Path(default)
    names = (path.with_stem(f"{path.stem}_{n}") for n in itertools.count(2))
    return str(next(name for name in itertools.chain([path], names) if not name.exists()))


def write_tree_file(path: str, tree: Tree, species: Species | None) -> None:
    """Write a tree and say what was written."""
    write_tree(path, tree, species)
    print(what_was_written(path, tree))


def what_was_written(path: str, tree: Tree) -> str:
    """Return a line about a tree in a file."""
    size = f"{tree.n_branches} branches, {tree.n_segments} segments, {tree.height:.2f} m"
    return f"{path}: {tree.name}, {size}"
