# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway compare``: our simulator against MuJoCo, on one tree in one wind, in one run."""

from __future__ import annotations

import argparse

from tree_sway_ros.core.reference.measure import frame_means
from tree_sway_ros.core.simulator.settings import MODELS
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.files.wind.wind_file import read_wind
from tree_sway_ros.study.chart.fidelity import simulated_wind
from tree_sway_ros.study.compare.mujoco_tree import take_warnings
from tree_sway_ros.study.compare.with_mujoco import compare_with_mujoco, FRAME
from tree_sway_ros.tools.arguments import add_tree_arguments, opened_tree


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
        choices=('auto', *MODELS[1:]),
        default='modes',
        help='of ours; auto: the cheapest for 10 %% of the motion (%(default)s)',
    )


def run(arguments: argparse.Namespace) -> int:
    """Run both and print how they compare."""
    if not 0.1 <= arguments.seconds <= 600.0:
        raise ParameterError(f'{arguments.seconds:g} s', where='--seconds', cure='give 0.1 to 600')
    tree_file = opened_tree(arguments)
    if arguments.wind is None:
        time, velocity = simulated_wind(arguments.seconds, seed=1)
    else:
        record = read_wind(arguments.wind)
        time, velocity = record.time, record.velocity
    wind = frame_means(time, velocity, FRAME)[: round(arguments.seconds / FRAME)]
    print(compare_with_mujoco(tree_file.tree, tree_file.species, wind, model=arguments.model))
    for warning in take_warnings():
        print(f'MuJoCo warned: {warning}')
    return 0
