# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway risk``: the wind at which each tree of an inventory reaches its strength."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from importlib.util import find_spec
from itertools import chain
import math
from pathlib import Path
import sys
import time
from typing import TYPE_CHECKING

from tree_sway.commands import bar, RowFile, say
from tree_sway.core.checks import within
from tree_sway.errors import ParameterError
from tree_sway.files import path_of, read_head
from tree_sway.files.commands import output_path
from tree_sway.files.scenes import expected, inventory_of, inventory_table
from tree_sway.forest.climate import Climate, climate_of
from tree_sway.forest.commands.study import add_cluster_arguments, refuse_wrong_cluster
from tree_sway.forest.risk import add_classes, CRITICAL, is_beyond, risk_rows, risk_work, Row
from tree_sway.forest.runner import cores
from tree_sway.forest.table import write_table
from tree_sway.pictures import new_figure, save_figure
from tree_sway.simulation.commands import add_exposure_arguments, refuse_spacing_in_the_open

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LEFT_OUT = (
    'rot, wounds and forks, wet or shallow soil and pruning are not included; '
    'it is no verdict on a tree'
)
_ERRS = (
    'it errs early: in eight storms 1.2 to 2.6 times as many trees fall here as were counted, '
    'rotten ones among them'
)
_NAMED = 40
"""Most trees whose names are drawn."""

_COLORS = ('#b2182b', '#ef8a62', '#cccccc', '#67a9cf', '#2166ac')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('inventory', metavar='INVENTORY', help='trees: species, height or dbh')
    parser.add_argument(
        '-o', '--output', default='risk.csv', metavar='FILE',
        help='table, .csv, a row per tree; written as it is computed (%(default)s)',
    )  # fmt: skip
    add_cluster_arguments(parser)
    add_exposure_arguments(parser, with_anemometer=False)
    parser.set_defaults(exposure='street')
    parser.add_argument(
        '--climate', default='22.5', metavar='V',
        help='mean wind of ten minutes at 10 m that comes once in 50 years, the basic wind of EN '
        '1991-1-4 [m/s], or scale and shape of a Weibull distribution, 4.5,2 (%(default)s: inland '
        'in Germany, zone 1; 27.5 at its coast, zone 3)',
    )  # fmt: skip
    parser.add_argument('--sort', action='store_true', help='the tree that falls first is first')
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
    output_path(arguments)
    path = path_of(arguments.inventory)
    with expected(path, 'inventory'):
        inventory = inventory_of(inventory_table(path, read_head(path)), needs_place=False)
    places = {each or arguments.exposure for each in inventory.exposures}
    if arguments.spacing is not None and places <= {'open', 'street'}:
        refuse_spacing_in_the_open()
    for note in inventory.notes:
        say(note)
    climate = climate_of(arguments.climate)
    work = risk_work(
        inventory, arguments.seed, exposure=arguments.exposure, spacing=arguments.spacing,
        climate=climate,
    )  # fmt: skip
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
    add_classes(rows)
    rows.sort(key=lambda row: row['line'])
    if arguments.sort:
        rows.sort(key=lambda row: row[CRITICAL] or math.inf)
    write_table(rows, output)
    picture = _drawn(rows, climate, output)
    n_failed = sum(row[CRITICAL] is None for row in rows)
    failed = f', {n_failed} of them without a wind (column assumed)' if n_failed else ''
    n_beyond = sum(row[CRITICAL] is not None and is_beyond(row) for row in rows)
    if n_beyond:
        failed += f', {n_beyond} beyond the winds that were computed (column assumed)'
    took = time.monotonic() - began
    print(f'{output}{picture}: {len(rows)} trees{failed} in {took:.1f} s; climate: {climate}')
    print(_ERRS)
    return 0


def _drawn(rows: list[Row], climate: Climate, table: Path) -> str:
    """Draw the trees that have a critical wind beside the table, and name the file."""
    drawn = sorted((row for row in rows if row[CRITICAL] is not None), key=lambda r: r[CRITICAL])
    if not drawn or find_spec('matplotlib') is None:
        return ''
    return f', {save_figure(risk_figure(drawn, climate), table.with_suffix(".png"))}'


def risk_figure(drawn: list[Row], climate: Climate) -> Figure:
    """Return a figure of critical winds with their bands, and a colour for each class."""
    figure = new_figure(8.0, min(max(0.25 * len(drawn), 1.0), 8.0) + 1.5)
    axes = figure.add_subplot()
    low, middle, high = (
        [row[name] for row in drawn] for name in ('low_80 [m/s]', CRITICAL, 'high_80 [m/s]')
    )
    places = range(len(drawn))
    colors = [_COLORS[row['class'] - 1] for row in drawn]
    axes.hlines(places, low, high, colors=colors)
    beyond = [is_beyond(row) for row in drawn]
    faces = ['white' if far else color for far, color in zip(beyond, colors, strict=True)]
    axes.scatter(middle, places, c=faces, edgecolors=colors, s=16.0)
    for number in sorted({row['class'] for row in drawn}):
        what = {1: 'falls first', len(_COLORS): 'falls last'}.get(number, '')
        axes.plot([], [], 'o', color=_COLORS[number - 1], label=f'class {number} {what}'.strip())
    if any(beyond):
        label = 'beyond the winds that were computed'
        axes.plot([], [], 'o', mfc='white', mec='black', label=label)
    axes.legend(loc='lower left', bbox_to_anchor=(1.0, 0.0), fontsize='small')
    names = [f'{row["name"]}, {row["species"]}' for row in drawn] if len(drawn) <= _NAMED else []
    axes.set_yticks(places[: len(names)], names)
    axes.set(
        xlim=(0.0, None), xlabel='mean wind at 10 m that fells it, and 80 % of such trees [m/s]'
    )
    if climate.shape is None:
        axes.axvline(climate.speed, color='black', lw=0.8)
    axes.set_title(f'{"black: " * (climate.shape is None)}{climate}', fontsize='medium')
    figure.tight_layout()
    return figure


def _written(output: Path, results: Iterator[Row], n_trees: int) -> list[Row]:
    """Write rows as their kinds are done, so that an interrupted table can be read."""
    rows = list[Row]()
    file = RowFile(output)
    try:
        for _, row in zip(bar(range(n_trees), 'computing trees'), results, strict=True):
            file.write(list(row), list(row.values()))
            rows.append(row)
            if file.failure:
                break
    finally:
        file.close()
    return rows
