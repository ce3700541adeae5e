# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``--learn``: write the tree with what motion sensors have told about it."""

from __future__ import annotations

import argparse
from pathlib import Path
import sys

from tree_sway.commands.arguments import what_was_written
from tree_sway.core.observe.learned_tree import LearnedTree
from tree_sway.core.setup.season import is_in_leaf
from tree_sway.core.tree.grown_tree import GrownTree
from tree_sway.errors import ParameterError
from tree_sway.files.export.yaml_writing import yaml_of_tree
from tree_sway.files.whole_file import write_text_whole


def add_learn_argument(parser: argparse.ArgumentParser) -> None:
    """Add ``--learn``."""
    parser.add_argument(
        '--learn', metavar='FILE',
        help='tree to write with the stiffness, damping and drag that the sensors tell, such as '
        'oak.twin.yaml, which opens like any tree',
    )  # fmt: skip


def check_learn_argument(arguments: argparse.Namespace) -> None:
    """Refuse a file that cannot be written, or without sensors, before slow work."""
    if arguments.learn is None:
        return
    if not arguments.motion:
        what = 'no motion sensor to learn from'
        raise ParameterError(what, where='--learn', cure='give --motion and --at')
    if Path(arguments.learn).suffix.lower() not in {'.yaml', '.yml'}:
        what = f"'{arguments.learn}' cannot store what is learned"
        raise ParameterError(what, where='--learn', cure='write a .yaml file')


def write_learned(
    path: str, grown: GrownTree, learned: LearnedTree | None, in_leaf: bool | None
) -> None:
    """Write a tree with what was learned, and say it; without anything, only say so."""
    if learned is None:
        print(
            f'warning: {path} is not written: the sensors told nothing; 40 s of sway are needed, '
            'and a stretch of 40 periods of the tree',
            file=sys.stderr,
        )
        return
    species = learned.of(grown.species, in_leaf=is_in_leaf(grown.species, in_leaf))
    write_text_whole(path, yaml_of_tree(grown.tree, species, learned))
    print(f'{what_was_written(path, grown.tree)}; {learned}')
