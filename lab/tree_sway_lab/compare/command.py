# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway lab compare``: our simulator against MuJoCo, on one tree in one wind, in one run."""

from __future__ import annotations

import argparse

from tree_sway.commands.arguments import add_tree_arguments, opened_tree
from tree_sway.errors import ParameterError
from tree_sway.files.wind.wind_file import read_wind
from tree_sway_lab.compare.mujoco_tree import FRAME, take_warnings
from tree_sway_lab.compare.with_mujoco import compare_with_mujoco
from tree_sway_lab.frame_means import frame_means
from tree_sway_lab.validation.winds import turbulent


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_tree_arguments(parser)
    parser.add_argument('--wind', metavar='FILE', help='a wind record; simulated if left out')
    parser.add_argument(
        '--seconds',
        type=float,
        default=5.0,
        metavar='N',
        help='how long, in the wind (%(default)s)',
    )
    parser.add_argument(
        '--model',
        default='default',
        help='of ours: a number of coordinates, branch, full (%(default)s)',
    )


def run(arguments: argparse.Namespace) -> int:
    """Run both and print how they compare."""
    if not 0.1 <= arguments.seconds <= 600.0:
        raise ParameterError(f'{arguments.seconds:g} s', where='--seconds', cure='give 0.1 to 600')
    tree_file = opened_tree(arguments)
    if arguments.wind is None:
        wind = turbulent(7.0, arguments.seconds, 1)
    else:
        record = read_wind(arguments.wind)
        means = frame_means(record.time, record.velocity, FRAME)
        wind = means[: round(arguments.seconds / FRAME)]
    print(compare_with_mujoco(tree_file.tree, tree_file.species, wind, model=arguments.model))
    for warning in take_warnings():
        print(f'MuJoCo warned: {warning}')
    return 0
