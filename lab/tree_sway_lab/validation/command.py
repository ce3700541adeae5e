# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway lab validate``: every check with its figure, as a page, or single trials."""

from __future__ import annotations

import argparse
from itertools import product
from pathlib import Path

from tree_sway.commands import bar
from tree_sway.errors import ParameterError
from tree_sway_lab.validation.report import SECTIONS, write_validation
from tree_sway_lab.validation.sections.kinds import JUDGED, MODELS, trial_table, WINDS
from tree_sway_lab.validation.trial import has_mujoco, MUJOCO, tried
from tree_sway_lab.validation.truth import FINE, QUICK

_DATA = Path('../shared/data')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        '-o', '--output', default='.', metavar='FOLDER', help='for validation.md (%(default)s)'
    )
    parser.add_argument(
        '--only',
        nargs='+',
        default=[],
        metavar='SECTION',
        help=f'{", ".join(SECTIONS)}; all if left out',
    )
    parser.add_argument(
        '--full', action='store_true', help='more trees, longer winds; takes hours'
    )
    parser.add_argument(
        '--data',
        metavar='FOLDER',
        help=f'recorded trees and winds ({_DATA}, if it is there)',
    )
    trials = parser.add_argument_group('single trials, printed and not written')
    trials.add_argument('--kind', nargs='+', metavar='KIND', help='kinds of trees: willow, palm')
    trials.add_argument('--wind', nargs='+', metavar='WIND', help='9 for 9 m/s, step, up')
    trials.add_argument(
        '--model',
        nargs='+',
        metavar='MODEL',
        help=f'default, 60, full, {MUJOCO} (one joint a segment, one step a frame); default, full '
        f'and {MUJOCO} if it is installed, if left out',
    )
    trials.add_argument(
        '--quick', action='store_true', help=f'a coarser truth: {QUICK} where it is {FINE}'
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the page and name what misses its limit, or print trials."""
    if arguments.kind or arguments.wind or arguments.model:
        models = arguments.model or (*MODELS, *(name for name in [MUJOCO] if has_mujoco()))
        cases = list(product(arguments.kind or JUDGED, arguments.wind or WINDS, models))
        fineness = QUICK if arguments.quick else FINE
        print(trial_table([tried(*case, fineness) for case in bar(cases, 'trials')]), end='')
        return 0
    data = Path(arguments.data) if arguments.data else _DATA if _DATA.is_dir() else None
    if data is not None and not data.is_dir():
        raise ParameterError(
            f"no folder '{data}'", where='--data', cure='name one, or leave it out'
        )
    folder = Path(arguments.output)
    for each in write_validation(folder, arguments.only, is_full=arguments.full, data=data):
        print(f'misses its limit: {each}')
    return 0
