# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway lab chart``: speed against accuracy, as pictures and tables."""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path

from tree_sway.commands import waiting

_CHARTS = ('methods', 'fidelity', 'cost', 'portraits', 'habits', 'twin')
_OF_BROWSER = ('sprays',)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        'what',
        choices=(*_CHARTS, *_OF_BROWSER, 'all'),
        help='methods: of integration; fidelity: models of a tree; cost: against its size; '
        'portraits: trees at rest and in wind, and a film; habits: grown species; '
        'twin: a film of a true tree, the model in the wind, and the model with a sensor; '
        'sprays: leaves and bark as the page paints them, for files, by Chromium; '
        'all: every picture of the documentation',
    )
    parser.add_argument(
        '-o', '--output', default='.', metavar='FOLDER', help='for what is made (%(default)s)'
    )


def run(arguments: argparse.Namespace) -> int:
    """Measure, draw, and name the files."""
    folder = Path(arguments.output)
    for what in _CHARTS if arguments.what == 'all' else (arguments.what,):
        module = importlib.import_module(f'tree_sway_lab.chart.{what}')
        with waiting(f'drawing {what}'):
            getattr(module, f'chart_{what}')(folder)
        print(f'{what}: drawn in {folder}')
    return 0
