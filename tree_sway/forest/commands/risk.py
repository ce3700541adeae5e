# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway risk``: the wind at which each tree of an inventory reaches its strength."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
import sys
import time

from tree_sway.commands import bar, refuse_overwriting, RowFile
from tree_sway.core.checks import within
from tree_sway.errors import ParameterError
from tree_sway.files import path_of, read_head, refuse_unwritable
from tree_sway.files.scenes import inventory_of, inventory_table
from tree_sway.forest.commands.study import add_cluster_arguments, refuse_wrong_cluster
from tree_sway.forest.risk import risk_rows, risk_work, Row
from tree_sway.forest.runner import cores
from tree_sway.forest.table import write_table
from tree_sway.simulation.commands import add_exposure_arguments, refuse_spacing_in_the_open

_LEFT_OUT = (
    'rot, wounds and forks, wet or shallow soil and pruning are not included; '
    'it is no verdict on a tree'
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('inventory', metavar='INVENTORY', help='trees: species, height or dbh')
    parser.add_argument(
        '-o', '--output', default='risk.csv', metavar='FILE',
        help='table, .csv, a row per tree; written as it is computed (%(default)s)',
    )  # fmt: skip
    add_cluster_arguments(parser)
    add_exposure_arguments(parser, with_anemometer=False)
    parser.add_argument(
        '--seed', type=int, default=0, metavar='N', help='of grown trees and gusts (%(default)s)'
    )
    parser.add_argument('--force', action='store_true', help='write over a file that is there')


def run(arguments: argparse.Namespace) -> int:
    """Compute a row per tree, write the table."""
    within('--seed', arguments.seed, 0, 2**31)
    if arguments.spacing is not None:
        within('--spacing', arguments.spacing, 0.1, 100.0, 'm')
    refuse_wrong_cluster(arguments)
    output = path_of(arguments.output)
    if output.suffix.lower() != '.csv':
        raise ParameterError(f"'{output}' is no table", where='--output', cure='end it with .csv')
    if not arguments.force:
        refuse_overwriting(output, '--output')
    refuse_unwritable(output)
    path = path_of(arguments.inventory)
    inventory = inventory_of(inventory_table(path, read_head(path)), needs_place=False)
    is_open = {each or arguments.exposure for each in inventory.exposures} == {'open'}
    if arguments.spacing is not None and is_open:
        refuse_spacing_in_the_open()
    for note in inventory.notes:
        print(f'note: {note}', file=sys.stderr)
    work = risk_work(
        inventory, arguments.seed, exposure=arguments.exposure, spacing=arguments.spacing
    )
    workers = arguments.workers or cores()
    print(
        f'{len(inventory.names)} trees of {len(work.kinds)} kinds; {_LEFT_OUT}',
        file=sys.stderr, flush=True,
    )  # fmt: skip
    began = time.monotonic()
    kinds = risk_rows(
        work, workers=workers, scheduler=arguments.scheduler, deadline=arguments.deadline
    )
    results = chain.from_iterable(rows for _, rows in kinds)
    rows = _written(output, results, len(inventory.names))
    write_table(sorted(rows, key=lambda row: row['line']), output)
    n_failed = sum(row['critical_wind_10m [m/s]'] is None for row in rows)
    failed = f', {n_failed} of them without a wind (column assumed)' if n_failed else ''
    print(f'{output}: {len(rows)} trees{failed} in {time.monotonic() - began:.1f} s')
    return 0


def _written(output: Path, results: Iterator[Row], n_trees: int) -> list[Row]:
    """Write rows as their kinds are done, so that an interrupted table can be read."""
    rows = list[Row]()
    file = RowFile(output)
    try:
        for _, row in zip(bar(range(n_trees), 'trees'), results, strict=True):
            file.write(list(row), list(row.values()))
            rows.append(row)
            if file.failure:
                break
    finally:
        file.close()
    return rows
