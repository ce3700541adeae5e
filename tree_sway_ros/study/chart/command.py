# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway chart``: speed against accuracy, as pictures and tables, and the validation."""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path
from typing import Any

from tree_sway_ros.errors import ParameterError
from tree_sway_ros.files.wind.wind_file import read_wind
from tree_sway_ros.study.validation.report import SECTIONS, write_validation
from tree_sway_ros.tools.progress import waiting

_CHARTS = ('methods', 'fidelity', 'cost', 'portraits', 'habits')
_DATA = Path('../shared/data')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        'what',
        choices=(*_CHARTS, 'validation', 'slopes', 'all'),
        help='methods: of integration; fidelity: models of a tree; cost: against its size; '
        'portraits: trees at rest and in wind, and a film; habits: grown species; '
        'validation: every check with its figure, as validation.md; slopes: its section on '
        'response spectra; all: every picture of the documentation',
    )
    parser.add_argument(
        '-o', '--output', default='.', metavar='FOLDER', help='for what is made (%(default)s)'
    )
    parser.add_argument(
        '--wind', metavar='FILE', help='fidelity: a wind record; simulated if left out'
    )
    parser.add_argument(
        '--only',
        nargs='+',
        default=[],
        metavar='SECTION',
        help=f'validation: {", ".join(SECTIONS)}; all if left out',
    )
    parser.add_argument(
        '--full', action='store_true', help='validation: more trees, longer winds; an hour'
    )
    parser.add_argument(
        '--data',
        metavar='FOLDER',
        help=f'validation: recorded trees and winds ({_DATA}, if it is there)',
    )


def run(arguments: argparse.Namespace) -> int:
    """Measure, draw, and name the files."""
    folder = Path(arguments.output)
    if arguments.what in ('validation', 'slopes'):
        return _validate(folder, arguments)
    for what in _CHARTS if arguments.what == 'all' else (arguments.what,):
        module = importlib.import_module(f'tree_sway_ros.study.chart.{what}')
        options: dict[str, Any] = {}
        if arguments.wind is not None and what == 'fidelity':
            record = read_wind(arguments.wind)
            options['wind'] = (record.time, record.velocity)
            options['source'] = Path(record.source).name
        with waiting(f'drawing {what}'):
            getattr(module, f'chart_{what}')(folder, **options)
        print(f'{what}: drawn in {folder}')
    return 0


def _validate(folder: Path, arguments: argparse.Namespace) -> int:
    """Write the page, and name what misses its limit."""
    data = Path(arguments.data) if arguments.data else _DATA if _DATA.is_dir() else None
    if data is not None and not data.is_dir():
        raise ParameterError(
            f"no folder '{data}'", where='--data', cure='name one, or leave it out'
        )
    only = ['slopes'] if arguments.what == 'slopes' else arguments.only
    for each in write_validation(folder, only, is_full=arguments.full, data=data):
        print(f'misses its limit: {each}')
    return 0
