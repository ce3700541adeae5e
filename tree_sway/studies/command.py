# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway study``: many trees in many winds with many settings, over all cores."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
import sys
import time

from tree_sway.commands.arguments import refuse_overwriting
from tree_sway.errors import ParameterError
from tree_sway.studies.plan import Case, read_study
from tree_sway.studies.runner import run_study
from tree_sway.studies.table import write_table

_SET_UP, _STEP = 3.0, 3e-4
"""Of a tree of some 1,000 branches: to set it up, and to step and record it once [s]."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('study', metavar='STUDY.yaml', help='trees, winds and settings')
    parser.add_argument(
        '-o', '--output', default='study.csv', metavar='FILE',
        help='table, .csv or .parquet; cases are kept beside it, and reused (%(default)s)',
    )  # fmt: skip
    parser.add_argument(
        '--workers', type=int, metavar='N', help='processes; one per core if left out'
    )
    parser.add_argument(
        '--force', action='store_true', help='write over a table that is of no study of yours'
    )
    parser.add_argument(
        '--scheduler', metavar='ADDRESS', help='of a dask cluster, tcp://HOST:PORT'
    )


def run(arguments: argparse.Namespace) -> int:
    """Compute what is missing, write the table."""
    if arguments.workers is not None and not 1 <= arguments.workers <= 1024:
        raise ParameterError(f'{arguments.workers}', where='--workers', cure='give 1 to 1024')
    cases = read_study(arguments.study)
    output = Path(arguments.output).expanduser()
    kept = output.with_suffix('.cases')
    if not (arguments.force or kept.is_dir()):
        refuse_overwriting(output, '--output')
    progress = Progress(cases, arguments.workers or os.cpu_count() or 1)
    rows = run_study(
        cases, kept, workers=arguments.workers, scheduler=arguments.scheduler, progress=progress
    )
    write_table(rows, output)
    print(f'{output}: {len(rows)} cases in {progress.elapsed:.1f} s')
    return 0


class Progress:
    """
    Says how far a study is and how long it may still take, at once and by each case from then on.

    On a terminal it is one line that changes, elsewhere a line per tenth. Until a case is finished
    the time is that of a tree of some 1,000 branches: see `_SET_UP` and `_STEP`.
    """

    def __init__(self, cases: list[Case], workers: int) -> None:
        trees = len({(str(case.tree), str(case.settings)) for case in cases})
        steps = sum(case.seconds * case.rate for case in cases)
        self._per_case = (_SET_UP * trees + _STEP * steps) / max(len(cases), 1) / workers
        self._began = time.monotonic()
        self._first: int | None = None

    @property
    def elapsed(self) -> float:
        """Time since the study began [s]."""
        return time.monotonic() - self._began

    def __call__(self, done: int, total: int) -> None:
        """Say it after a case; the first call is before all of them."""
        if self._first is None:
            self._first = done
        elif done > self._first:
            self._per_case = self.elapsed / (done - self._first)
        left = span((total - done) * self._per_case)
        text = f'{done} of {total} cases' + f', about {left} left' * (done < total)
        if sys.stderr.isatty():
            end = '\n' if done == total else ''
            print(f'\r\033[K{text}', end=end, file=sys.stderr, flush=True)
        elif done in (self._first, total) or done % max(total // 10, 1) == 0:
            print(text, file=sys.stderr, flush=True)


def span(seconds: float) -> str:
    """Return a length of time in the unit that people would say it in."""
    for unit, size in (('h', 3600.0), ('min', 60.0)):
        if seconds >= 2.0 * size:
            return f'{seconds / size:.0f} {unit}'
    return f'{max(seconds, 1.0):.0f} s'
