# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Cases over all cores, or over a cluster, each once.

A finished case is a file here, written atomically; a study that is run again computes missing
cases. Workers get the trees and winds of files with the cases of a batch, and return rows. The
cases of a lost worker are computed by a different one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
import json
from pathlib import Path
from typing import Any

from tree_sway.commands import bar
from tree_sway.errors import TreeSwayError
from tree_sway.files import write_text_whole
from tree_sway.files.trees import open_tree
from tree_sway.files.wind import read_wind
from tree_sway.forest.cluster import cluster, DEADLINE, run_all
from tree_sway.forest.entries import Plain
from tree_sway.forest.plan import Case

_LARGEST_ROW = 1 << 16
"""Largest row of a case as JSON [bytes]."""
_START, _SET_UP, _STEP = 4.0, 2.5, 2e-4
"""Time to start workers, to set up a tree of 900 branches, and for each of its steps [s]."""
_LARGEST_BATCH = 8
"""Number of cases at most that a lost worker takes with it."""

_Outcome = tuple[Case, Plain | TreeSwayError]
"""A case with its row, or with its error."""


def run_study(
    cases: list[Case],
    folder: Path,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    deadline: float = DEADLINE,
) -> list[Plain]:
    """
    Compute missing cases of a study, and return all rows.

    Parameters
    ----------
    cases
        Cases of the study, computed before or not.
    folder
        Folder of finished cases.
    workers
        Number of processes here; one per core if None.
    scheduler
        Address of a Dask scheduler whose workers compute instead, such as ``tcp://host:8786``.
    deadline
        Time without a finished case after which a worker is taken to hang [s].

    Returns
    -------
    list of dict
        One row per case, in the order of the cases, independent of the order of computation.

    Raises
    ------
    TreeSwayError
        The first case that failed, with its name; the others are stored.
    TransportError
        Workers that end repeatedly or hang, no scheduler, or workers of another version.
    ModuleNotFoundError
        Cases to compute without dask.

    """
    folder.mkdir(parents=True, exist_ok=True)
    missing = missing_cases(cases, folder)
    outcomes: Iterator[_Outcome] = iter(())
    if missing:
        outcomes = _outcomes(missing, workers or cores(), scheduler, deadline)
    failed = list[TreeSwayError]()
    for _, (case, row) in zip(bar(missing, 'cases'), outcomes, strict=True):
        if isinstance(row, TreeSwayError):
            failed.append(row)
        else:
            store_row(case, row, folder)
    if failed:
        raise failed[0]
    rows = [_stored_row(case, folder) for case in cases]
    return [row for row in rows if row is not None]


def missing_cases(cases: list[Case], folder: Path) -> list[Case]:
    """Missing cases of a study, those with a damaged file too."""
    return [case for case in cases if _stored_row(case, folder) is None]


def estimated_time(cases: list[Case], workers: int) -> float:
    """Estimated time of cases in [s], for trees of 900 branches."""
    steps = sum(case.seconds * case.rate for case in cases)
    work = _SET_UP * len(batches(cases, workers)) + _STEP * steps
    return _START + work / workers if cases else 0.0


def result_path(folder: Path, case: Case) -> Path:
    """File of a finished case."""
    return folder / f'{case.name}.json'


def _stored_row(case: Case, folder: Path) -> Plain | None:
    """Return the row of a case; None if it has no file, or a damaged one."""
    try:
        with result_path(folder, case).open('rb') as file:
            row = json.loads(file.read(_LARGEST_ROW))
    except (OSError, ValueError, RecursionError):
        return None
    return row if isinstance(row, dict) and row else None


def store_row(case: Case, row: Plain, folder: Path) -> None:
    """Store the row of a finished case."""
    write_text_whole(result_path(folder, case), json.dumps(row))


def compute_batch(cases: list[Case], files: dict[str, Any]) -> list[_Outcome]:
    """Compute cases one after the other; the contents of their files are by their path."""
    from tree_sway.forest.compute import compute

    outcomes: list[_Outcome] = []
    for case in cases:
        tree, wind = (files.get(part.get('file', '')) for part in (case.tree, case.wind))
        try:
            outcomes.append((case, compute(case, tree=tree, wind=wind)))
        except TreeSwayError as error:
            where = f'tree {case.tree}, wind {case.wind}'
            outcomes.append((case, TreeSwayError(str(error), where=where)))
    return outcomes


def is_outcome(result: Any, cases: list[Case], _files: dict[str, Any]) -> bool:
    """Whether a worker returned the row or the error of each of its cases, and no more."""
    from tree_sway.forest.compute import is_row_of

    try:
        found = [case for case, _ in result]
        rows = [(row, case) for case, row in result if not isinstance(row, TreeSwayError)]
        size = sum(len(json.dumps(row)) for row, _ in rows)
    except (TypeError, ValueError, RecursionError):
        return False
    is_all = found == cases and all(is_row_of(*each) for each in rows)
    return is_all and size <= _LARGEST_ROW * len(cases)


def batches(cases: list[Case], workers: int) -> list[list[Case]]:
    """
    Group cases of one tree with one set of settings.

    Its set-up takes longer than a minute of wind. A tree in many winds is divided into parts, so
    that all workers have work, and little is lost with one.

    """
    most = min(-(-len(cases) // (4 * workers)), _LARGEST_BATCH)
    found: dict[str, list[Case]] = {}
    for case in cases:
        found.setdefault(json.dumps([case.tree, case.settings], sort_keys=True), []).append(case)
    return [same[k : k + most] for same in found.values() for k in range(0, len(same), most)]


def files_of(cases: Sequence[Case], opened: dict[str, Any]) -> dict[str, Any]:
    """Trees and winds of the files of some cases, by path; each is opened once in a season."""
    found = {}
    for case in cases:
        in_leaf = case.settings.get('in_leaf')
        tree = partial(open_tree, in_leaf=in_leaf, warn=False)
        for part, read, season in ((case.tree, tree, f' {in_leaf}'), (case.wind, read_wind, '')):
            path = part.get('file')
            if path is None:
                continue
            if path + season not in opened:
                try:
                    opened[path + season] = read(path)
                except TreeSwayError:
                    # The worker finds the same error, of the case alone.
                    opened[path + season] = None
            found[path] = opened[path + season]
    return found


def _outcomes(
    cases: list[Case], workers: int, scheduler: str | None, deadline: float
) -> Iterator[_Outcome]:
    """Yield each finished case with its row or its error."""
    opened: dict[str, Any] = {}
    work = [(part[0].name, (part, files_of(part, opened))) for part in batches(cases, workers)]
    with cluster(workers, scheduler) as (distributed, client):
        for outcomes in run_all(
            distributed, client, compute_batch, work, is_outcome, deadline=deadline
        ):
            yield from outcomes


def cores() -> int:
    """Return the number of cores of this machine."""
    import os

    return os.cpu_count() or 1
