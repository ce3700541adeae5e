# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Runs the battery and reports what was met: a table in the terminal, JSON, an exit code."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
import json as json_module
from pathlib import Path
import re
import time
from types import ModuleType

from tree_sway.errors import ParameterError
from tree_sway.files import write_text_whole
from tree_sway_lab.battery.row import Row

CASES = {
    'T1': 't01_free_decay', 'T2': 't02_damping', 'T3': 't03_drift', 'T4': 't04_gains',
    'T5': 't05_predictor', 'T6': 't06_tiny_steps', 'T7': 't07_mass_ratio', 'T8': 't08_degenerate',
    'T9': 't09_strong_wind', 'T10': 't10_buckling', 'T11': 't11_parallel', 'T12': 't12_turns',
    'T13': 't13_past_right_angle', 'T14': 't14_redundant_pin', 'T15': 't15_stalls',
    'T16': 't16_exactness', 'T17': 't17_bad_samples', 'T18': 't18_adversary', 'goals': 'goals',
}  # fmt: skip


def load_case(name: str) -> ModuleType:
    """
    Return the module of a case, by its name: ``T4``, ``T04`` or ``t4``.

    Raises
    ------
    ParameterError
        A name that is not T1 to T18 or goals.

    """
    name = re.sub(r'^[tT]0*(?=[1-9])', 'T', name)
    if name not in CASES:
        raise ParameterError(
            f'unknown case {name!r}', where='battery', cure='take one of ' + ', '.join(CASES)
        )
    return import_module(f'{__package__}.rows.{CASES[name]}')


def run_battery(
    full: bool = False, json: str | Path | None = None, only: Iterable[str] | None = None
) -> int:
    """
    Run the cases, print a line per row, write JSON if asked to.

    Parameters
    ----------
    full
        All steps and runs of the long cases: some minutes.
    json
        File for the rows, with the seconds each case took.
    only
        Cases to run, all by default.

    Returns
    -------
    int
        0 if every row is as it should be, 1 otherwise.

    """
    report, failed, total = [], 0, 0
    for name in list(only) if only is not None else list(CASES):
        case = load_case(name)
        started = time.perf_counter()
        rows: list[Row] = case.run(full)
        seconds = time.perf_counter() - started
        print(f'{name}  {case.TITLE}  ({seconds:.1f} s)')
        for row in rows:
            print(f'    {row.case:<58} {row.must_hold:<46} {row.measured:<40} {row.verdict}')
            failed += not row.good
        failed += not rows  # a case that measures nothing has shown nothing
        total += len(rows)
        report.append(
            {
                'case': name,
                'title': case.TITLE,
                'seconds': round(seconds, 2),
                'rows': [{**vars(row), 'good': row.good} for row in rows],
            }
        )
    print(f'{total - failed} of {total} rows as they should be')
    if json is not None:
        document = {'full': full, 'failed': failed, 'cases': report}
        write_text_whole(json, json_module.dumps(document, indent=1) + '\n')
    return 1 if failed else 0
