# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway lab battery``: the cases where methods of integration fail, and what ours does."""

from __future__ import annotations

import argparse

from tree_sway.commands import refuse_overwriting
from tree_sway_lab.battery.report import CASES, run_battery


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('case', nargs='*', help=f'{", ".join(CASES)}; all if left out')
    parser.add_argument('--full', action='store_true', help='all steps and runs: some minutes')
    parser.add_argument('--json', metavar='FILE', help='write the rows there')
    parser.add_argument('--force', action='store_true', help='write over a file that is there')


def run(arguments: argparse.Namespace) -> int:
    """Run the cases; 1 if a row is not as it should be."""
    if arguments.json is not None and not arguments.force:
        refuse_overwriting(arguments.json, '--json')
    return run_battery(arguments.full, arguments.json, arguments.case or None)
