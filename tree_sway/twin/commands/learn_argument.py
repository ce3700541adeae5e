# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``--learn``: write the tree with what motion sensors have told about it."""

from __future__ import annotations

import argparse

from tree_sway.commands import say
from tree_sway.errors import inside, ParameterError
from tree_sway.files.commands import what_was_written
from tree_sway.files.trees import LearnedFile, refuse_no_learned_file
from tree_sway.twin import LearnedTree


def add_learn_argument(parser: argparse.ArgumentParser) -> None:
    """Add ``--learn``."""
    parser.add_argument(
        '--learn', metavar='FILE',
        help='tree to write with the stiffness, damping and drag that the sensors tell, such as '
        'oak.twin.yaml, which opens like any tree; where it is already there, its wood is used '
        'and its hours add up',
    )  # fmt: skip


def check_learn_argument(arguments: argparse.Namespace) -> None:
    """Refuse a file that cannot be written, or without sensors, before slow work."""
    if arguments.learn is None:
        return
    if not arguments.motion:
        what = 'no motion sensor to learn from'
        raise ParameterError(what, where='--learn', cure='give --motion and --at')
    with inside('--learn'):
        refuse_no_learned_file(arguments.learn)


def write_learned(file: LearnedFile, learned: LearnedTree | None) -> None:
    """Write a tree with what was learned, and say it; without anything, only say so."""
    if learned is None or learned is file.opened.learned:
        say(
            f'{file.path} is not written: the sensors told nothing; 40 s of sway are needed, and '
            'a stretch of 40 periods of the tree',
            'warning',
        )
        return
    file.write(learned)
    print(f'{what_was_written(file.path, file.opened.tree)}; {learned}')
