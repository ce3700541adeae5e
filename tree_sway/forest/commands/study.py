# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway study``: many trees in many winds with many settings, over all cores."""

from __future__ import annotations

import argparse
import sys
import time

from tree_sway.commands import refuse_overwriting
from tree_sway.core.checks import within
from tree_sway.files import path_of
from tree_sway.files.export import refuse_no_table
from tree_sway.forest.cluster import DEADLINE, refuse_wrong_address
from tree_sway.forest.plan import read_study
from tree_sway.forest.runner import cores, estimated_time, missing_cases, run_study
from tree_sway.forest.table import write_table


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('study', metavar='STUDY.yaml', help='trees, winds and settings')
    parser.add_argument(
        '-o', '--output', default='study.csv', metavar='FILE',
        help='table, .csv or .parquet; cases are stored beside it, and reused (%(default)s)',
    )  # fmt: skip
    add_cluster_arguments(parser)
    parser.add_argument(
        '--force', action='store_true', help='write over a table of a different study'
    )


def add_cluster_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the processes that compute, or a cluster, and how long its workers may take."""
    parser.add_argument(
        '--workers', type=int, metavar='N', help='processes; one per core if left out'
    )
    parser.add_argument(
        '--scheduler', metavar='ADDRESS',
        help='Dask scheduler whose workers compute instead, tcp://host:8786 or tls://host:8786',
    )  # fmt: skip
    parser.add_argument(
        '--deadline', type=float, default=DEADLINE, metavar='S',
        help='seconds without a result after which workers are taken to hang, and it ends; what '
        'is finished is kept (%(default)g)',
    )  # fmt: skip


def refuse_wrong_cluster(arguments: argparse.Namespace) -> None:
    """Raise a `ParameterError` for a wrong number of processes, address or time of a cluster."""
    if arguments.workers is not None:
        within('--workers', arguments.workers, 1, 1024)
    within('--deadline', arguments.deadline, 1.0, 1e7, 's')
    if arguments.scheduler is not None:
        refuse_wrong_address(arguments.scheduler)


def run(arguments: argparse.Namespace) -> int:
    """Compute missing cases, write the table."""
    refuse_wrong_cluster(arguments)
    output = path_of(arguments.output)
    refuse_no_table(output)
    cases = read_study(arguments.study)
    cache = output.with_suffix('.cases')
    if not (arguments.force or cache.is_dir()):
        refuse_overwriting(output, '--output')
    missing = missing_cases(cases, cache)
    workers = arguments.workers or cores()
    print(
        f'{len(missing)} of {len(cases)} cases to compute: some '
        f'{estimated_time(missing, workers):.0f} s on {workers} cores, if trees have 900 branches'
        if arguments.scheduler is None
        else f'{len(missing)} of {len(cases)} cases to compute by {arguments.scheduler}',
        file=sys.stderr, flush=True,
    )  # fmt: skip
    began = time.monotonic()
    rows = run_study(
        cases,
        cache,
        workers=arguments.workers,
        scheduler=arguments.scheduler,
        deadline=arguments.deadline,
    )
    write_table(rows, output)
    print(f'{output}: {len(rows)} cases in {time.monotonic() - began:.1f} s')
    return 0
