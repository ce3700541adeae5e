# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Cases over all cores, or over a cluster, each once.

A finished case is a file, written atomically; a study that is run again computes missing cases.
The case of a killed worker is computed by a different one.

"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, ExitStack
from importlib import import_module
import json
from multiprocessing import resource_tracker
import os
from pathlib import Path
import signal
import threading
from typing import Any

from tree_sway.commands.progress import bar
from tree_sway.errors import TransportError, TreeSwayError
from tree_sway.files.whole_file import write_text_whole
from tree_sway.studies.plan import Case, Plain

ATTEMPTS = 4
"""Number of workers that a case may end before the study ends."""

_START, _SET_UP, _STEP = 4.0, 2.5, 2e-4
"""Time to start workers, to set up a tree of 900 branches, and for each of its steps [s]."""


def run_study(cases: list[Case], folder: Path, *, workers: int | None = None) -> list[Plain]:
    """
    Compute missing cases of a study, and return all rows.

    Parameters
    ----------
    cases
        Cases of the study, computed before or not.
    folder
        Folder of finished cases.
    workers
        Number of processes; one per core if None.

    Returns
    -------
    list of dict
        One row per case, in the order of the cases, independent of the order of computation.

    Raises
    ------
    TreeSwayError
        The first case that failed, with its name; the others are stored.
    TransportError
        Workers that end repeatedly.
    ModuleNotFoundError
        Cases to compute without dask.

    """
    folder.mkdir(parents=True, exist_ok=True)
    missing = missing_cases(cases, folder)
    outcomes = _outcomes(missing, folder, workers or os.cpu_count() or 1) if missing else iter(())
    failed = [each for _, each in zip(bar(missing, 'cases'), outcomes, strict=True) if each]
    if failed:
        raise failed[0]
    return [json.loads(result_path(folder, case).read_text(encoding='utf-8')) for case in cases]


def missing_cases(cases: list[Case], folder: Path) -> list[Case]:
    """Missing cases of a study."""
    return [case for case in cases if not result_path(folder, case).is_file()]


def estimated_time(cases: list[Case], workers: int) -> float:
    """Estimated time of cases in [s], for trees of 900 branches."""
    steps = sum(case.seconds * case.rate for case in cases)
    work = _SET_UP * len(batches(cases, workers)) + _STEP * steps
    return _START + work / workers if cases else 0.0


def result_path(folder: Path, case: Case) -> Path:
    """File of a finished case."""
    return folder / f'{case.name}.json'


def compute_to_file(case: Case, folder: Path) -> None:
    """Compute one case and store its row."""
    from tree_sway.studies.compute import compute

    if result_path(folder, case).is_file():  # a killed worker had finished it
        return
    write_text_whole(result_path(folder, case), json.dumps(compute(case)))


def compute_batch(cases: list[Case], folder: Path) -> list[TreeSwayError | None]:
    """Compute cases one after the other; return the error of each, or None."""
    outcomes: list[TreeSwayError | None] = []
    for case in cases:
        try:
            compute_to_file(case, folder)
            outcomes.append(None)
        except TreeSwayError as error:
            outcomes.append(TreeSwayError(str(error), where=f'tree {case.tree}, wind {case.wind}'))
    return outcomes


def batches(cases: list[Case], workers: int) -> list[list[Case]]:
    """
    Group cases of one tree with one set of settings.

    Its set-up takes longer than a minute of wind. A tree in many winds is divided into parts, so
    that all workers have work.

    """
    most = -(-len(cases) // (4 * workers))
    found: dict[str, list[Case]] = {}
    for case in cases:
        found.setdefault(json.dumps([case.tree, case.settings], sort_keys=True), []).append(case)
    return [same[k : k + most] for same in found.values() for k in range(0, len(same), most)]


def _outcomes(cases: list[Case], folder: Path, workers: int) -> Iterator[TreeSwayError | None]:
    """Yield the result of each finished case: None, or its error."""
    with _cluster(workers) as (distributed, client):
        futures = [
            client.submit(compute_batch, part, folder.resolve(), key=part[0].name)
            for part in batches(cases, workers)
        ]
        try:
            for future in distributed.as_completed(futures):
                yield from future.result()
        except distributed.KilledWorker as error:
            raise TransportError(
                f'a case took down {ATTEMPTS} workers in turn',
                where=f'case {error.task}',
                cure='find out what ends them (memory?), use fewer --workers, and run it again',
            ) from None


@contextmanager
def _cluster(workers: int) -> Iterator[tuple[Any, Any]]:
    """
    Dask and a client of separate processes, which end at once with the study.

    Only this process handles Ctrl-C, and not before dask is loaded and the cluster up, half of
    which it would leave open. Its log is silent until the last of its threads has ended.
    """
    settings: Plain = {
        'distributed.nanny.pre-spawn-environ.DASK_LOGGING__DISTRIBUTED': 'critical',
        # Pages of dask have no password: neither the scheduler nor the workers have any.
        'distributed.scheduler.http.routes': [],
        'distributed.worker.http.routes': [],
    }
    page = {'dashboard': False, 'dashboard_address': '127.0.0.1:0'}  # none, and at a free port
    with _delayed_interrupt() as delayed:
        dask, distributed = import_module('dask'), import_module('distributed')
        import_module('cryptography')  # keys that exclude other users of this machine
        with (
            dask.config.set(settings),
            distributed.utils.silence_logging_cmgr('CRITICAL'),
            distributed.LocalCluster(
                n_workers=workers, threads_per_worker=1, memory_limit=0, silence_logs='CRITICAL',
                scheduler_kwargs={'allowed_failures': ATTEMPTS - 1, **page}, security=True,
            ) as local,
            distributed.Client(local) as client,
        ):  # fmt: skip
            try:
                delayed.close()
                yield distributed, client
            except BaseException:  # Ctrl-C: running cases are computed in the next run
                for worker in local.workers.values():
                    os.kill(worker.pid, signal.SIGKILL)
                raise


def _delayed_interrupt() -> ExitStack:
    """Delay Ctrl-C until closed; threads and processes started before then never get it."""
    delayed = ExitStack()
    if hasattr(signal, 'pthread_sigmask'):
        resource_tracker.ensure_running()  # it would unblock the signal as it starts
        signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
        delayed.callback(signal.pthread_sigmask, signal.SIG_UNBLOCK, [signal.SIGINT])
        if threading.current_thread() is threading.main_thread():
            # An earlier thread may receive it, for Python to handle here: then it waits here.
            usual = signal.signal(signal.SIGINT, lambda number, _: signal.raise_signal(number))
            delayed.callback(signal.signal, signal.SIGINT, usual)
    return delayed
