# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway lab compare``: our simulator against MuJoCo, on one tree in one wind, in one run."""

from __future__ import annotations

import argparse

from tree_sway.errors import ParameterError
from tree_sway.files.commands import add_tree_arguments, opened_tree
from tree_sway.files.wind import read_wind
from tree_sway_lab.compare.exported_wind import compare_exported_wind, SETTLES
from tree_sway_lab.compare.mujoco_tree import FRAME, take_warnings
from tree_sway_lab.compare.with_mujoco import compare_with_mujoco
from tree_sway_lab.frame_means import frame_means
from tree_sway_lab.validation.winds import turbulent

EXPORTED_SPEED = 8.0
"""Mean wind at which the drag of an exported tree is that of ours [m/s]."""


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
    parser.add_argument(
        '--exported',
        action='store_true',
        help="the exported file in MuJoCo's own wind instead: mean and rms over ours",
    )


def run(arguments: argparse.Namespace) -> int:
    """Run both and print how they compare."""
    least = SETTLES + 1.0 if arguments.exported else 0.1
    if not least <= arguments.seconds <= 600.0:
        cure = f'give {least:g} to 600'
        raise ParameterError(f'{arguments.seconds:g} s', where='--seconds', cure=cure)
    tree_file = opened_tree(arguments)
    if arguments.wind is None:
        speed = EXPORTED_SPEED if arguments.exported else 7.0
        wind = turbulent(speed, arguments.seconds, 1)
    else:
        record = read_wind(arguments.wind)
        means = frame_means(record.time, record.velocity, FRAME)
        wind = means[: round(arguments.seconds / FRAME)]
    tree, species = tree_file.tree, tree_file.species
    if arguments.exported:
        print(compare_exported_wind(tree, species, wind))
    else:
        print(compare_with_mujoco(tree, species, wind, model=arguments.model))
    for warning in take_warnings():
        print(f'MuJoCo warned: {warning}')
    return 0
