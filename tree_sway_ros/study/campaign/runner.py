# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Cases over all cores, or over a cluster, each once.

A finished case is a file, written whole or not at all; a study that is run again computes what is
missing. A worker that is killed takes its case with it, which another one then computes.

"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import as_completed, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
import json
import multiprocessing
import os
from pathlib import Path

from tree_sway_ros.errors import MissingDependencyError, TransportError, TreeSwayError
from tree_sway_ros.files.whole_file import write_text_whole
from tree_sway_ros.study.campaign.plan import Case, Plain

ATTEMPTS = 4
"""How often a pool whose worker died is set up again without a finished case in between."""


def run_study(
    cases: list[Case],
    folder: Path,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Callable[[int, int], None] = lambda done, of: None,
) -> list[Plain]:
    """
    Compute what is missing of a study, and return all of it.

    Parameters
    ----------
    cases
        What to compute.
    folder
        Where finished cases are kept.
    workers
        Processes; one per core if None.
    scheduler
        Address of a dask scheduler whose workers compute instead; they see the same folder.
    progress
        Called with how many cases are done, and of how many.

    Returns
    -------
    list of dict
        One row per case, in the order of the cases, whatever the order they were computed in.

    Raises
    ------
    TreeSwayError
        The first case that cannot be computed, by its name; the others are kept.
    TransportError
        Workers that die again and again, or a scheduler that does not answer.
    MissingDependencyError
        A scheduler is asked for and dask is not there.

    """
    folder.mkdir(parents=True, exist_ok=True)
    done = sum(result_path(folder, case).is_file() for case in cases)
    missing = [case for case in cases if not result_path(folder, case).is_file()]
    progress(done, len(cases))
    outcomes = (
        _on_cluster(missing, folder, scheduler)
        if scheduler
        else _on_cores(missing, folder, workers)
    )
    failed: TreeSwayError | None = None
    for outcome in outcomes:
        if isinstance(outcome, TreeSwayError):
            failed = failed or outcome
        else:
            done += 1
            progress(done, len(cases))
    if failed is not None:
        raise failed
    return [json.loads(result_path(folder, case).read_text(encoding='utf-8')) for case in cases]


def result_path(folder: Path, case: Case) -> Path:
    """File of a finished case."""
    return folder / f'{case.name}.json'


def compute_to_file(case: Case, folder: Path) -> None:
    """Compute one case and keep it: its row, and its record if the case asks for that."""
    from tree_sway_ros.study.campaign.compute import compute

    row, record = compute(case)
    if case.series:
        write_text_whole(folder / f'{case.name}.csv', record.to_csv())
    write_text_whole(result_path(folder, case), json.dumps(row))


def compute_batch(cases: list[Case], folder: Path) -> list[TreeSwayError | None]:
    """Compute cases one after the other; of each what is wrong with it, or None."""
    outcomes: list[TreeSwayError | None] = []
    for case in cases:
        try:
            compute_to_file(case, folder)
            outcomes.append(None)
        except TreeSwayError as error:
            where = f'tree {case.tree}, wind {case.wind}'
            outcomes.append(TreeSwayError(str(error), where=where))
    return outcomes


def batches(cases: list[Case], workers: int) -> list[list[Case]]:
    """
    Cases of one tree with one set of settings together.

    Its set-up costs more than a minute of wind does. A tree in many winds is given out in parts,
    so that no worker is left without work.

    """
    most = -(-len(cases) // (4 * workers))
    found: dict[str, list[list[Case]]] = {}
    for case in cases:
        parts = found.setdefault(json.dumps([case.tree, case.settings], sort_keys=True), [[]])
        if len(parts[-1]) == most:
            parts.append([])
        parts[-1].append(case)
    return [part for parts in found.values() for part in parts]


def _on_cores(
    cases: list[Case], folder: Path, workers: int | None
) -> Iterator[TreeSwayError | None]:
    """Outcome of each case as it is finished: None, or what is wrong with it."""
    attempts, workers = 0, workers or os.cpu_count() or 1
    while cases:
        before = len(cases)
        # One thread per process: the same numbers, and no threads that wait for each other.
        os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
        context = multiprocessing.get_context('spawn')
        with ProcessPoolExecutor(workers, mp_context=context) as pool:
            parts = batches(cases, workers)
            futures = {pool.submit(compute_batch, part, folder): part for part in parts}
            try:
                for future in as_completed(futures):
                    outcomes = future.result()
                    cases = [case for case in cases if case not in futures[future]]
                    yield from outcomes
            except BrokenProcessPool:
                kept = [case for case in cases if result_path(folder, case).is_file()]
                cases = [case for case in cases if case not in kept]
                yield from [None] * len(kept)
        attempts = 0 if len(cases) < before else attempts + 1
        if attempts >= ATTEMPTS:
            raise TransportError(
                f'{attempts} sets of processes died in turn',
                where=f'{len(cases)} cases left',
                cure='look for what kills them (memory?), use fewer --workers, and run it again',
            )


def _on_cluster(cases: list[Case], folder: Path, scheduler: str) -> Iterator[TreeSwayError | None]:
    """As `_on_cores`, on the workers of a dask scheduler, which starts a lost case again."""
    try:
        import distributed
    except ImportError:
        raise MissingDependencyError(
            'a cluster needs dask.distributed', cure='pip install distributed'
        ) from None
    try:
        client = distributed.Client(scheduler, timeout=10)
    except OSError as error:
        raise TransportError(
            f'no scheduler answers ({error})', where=scheduler, cure='start dask scheduler'
        ) from None
    with client:
        place, workers = folder.resolve(), max(len(client.scheduler_info()['workers']), 1)
        futures = [
            client.submit(compute_batch, part, place, key=part[0].name, retries=ATTEMPTS)
            for part in batches(cases, workers)
        ]
        for future in distributed.as_completed(futures):
            yield from future.result()
