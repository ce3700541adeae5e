# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Workers for studies: processes of this machine, or those of a Dask cluster elsewhere.

Work is sent, and results come back, over the connection: no folder is shared. Workers elsewhere
must have the same version of this package, which is checked, as others may compute other numbers.
"""

from __future__ import annotations

from _thread import interrupt_main
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, ExitStack, suppress
from functools import cache
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from multiprocessing import active_children, resource_tracker
import signal
import sys
import threading
import time
from types import FrameType
from typing import Any

from tree_sway.cache import ROOT, source_digest
from tree_sway.core.checks import within
from tree_sway.errors import ParameterError, TransportError, TreeSwayError
from tree_sway.extras import PACKAGE
from tree_sway.forest.lost_workers import told_lost_workers

_ATTEMPTS = 4
"""Number of workers that may die of one piece of work before the study ends."""
DEADLINE = 14_400.0
"""Time without a finished piece of work after which a worker is taken to hang [s]."""
ROOMS = 'core', 'files', 'forest', 'growth', 'simulation'
"""Rooms whose source and tables determine the results."""
_LONGEST_REASON = 400
_PATIENCE = 15.0
"""Longest wait for a scheduler and for its first worker [s]."""
_LOOK = 0.05
"""Interval at which finished work is looked for [s]."""
_REPEAT = 2.0
"""Time after which Ctrl-C that had no effect is repeated [s]."""
_KILL_PERIOD = 0.05
"""Interval at which workers that have just started are looked for, to end them [s]."""
_SCHEMES = ('tcp://', 'tls://')
_LIBRARIES = ('numpy', 'scipy')
_NO_LEAKS = 'ignore:resource_tracker'
"""Option of warnings of the process that removes semaphores which others left."""


@cache
def own_version() -> dict[str, str]:
    """Versions of what determines results on this machine: package, source, libraries."""
    found = {'source': ''.join(source_digest(ROOT / room) for room in ROOMS)}
    found['python'] = '.'.join(map(str, sys.version_info[:2]))
    for name in (PACKAGE, *_LIBRARIES):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = 'none'
    return found


@contextmanager
def cluster(workers: int, scheduler: str | None = None) -> Iterator[tuple[Any, Any]]:
    """
    Dask, and a client of a number of processes here, or of a scheduler elsewhere.

    Raises
    ------
    ParameterError
        Text that is no address of a scheduler.
    TransportError
        No scheduler or no worker there, or workers of another version.

    """
    with _processes_here(workers) if scheduler is None else _elsewhere(scheduler) as both:
        with repeated_interrupt():
            yield both


@contextmanager
def repeated_interrupt() -> Iterator[None]:
    """
    Repeat Ctrl-C until it ends the block.

    Python drops a KeyboardInterrupt that is raised in a finalizer or in the callback of a weak
    reference, of which Dask has many: the study would go on as if nobody had pressed anything.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    timers: list[threading.Timer] = []

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        timers.append(threading.Timer(_REPEAT, _interrupt_again))
        timers[-1].daemon = True
        timers[-1].start()
        raise KeyboardInterrupt

    usual = signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, usual)
        for timer in timers:
            timer.cancel()


def refuse_wrong_address(scheduler: str) -> None:
    """Raise a `ParameterError` for a scheduler whose address Dask cannot have."""
    scheme = next((each for each in _SCHEMES if scheduler.startswith(each)), None)
    host, _, port = scheduler.removeprefix(scheme or '').rpartition(':')
    if scheme is None or not host or not port.isdigit() or not 0 < int(port) < 65536:
        what = f"'{scheduler[:80]}' is no address of a scheduler"
        raise ParameterError(what, where='--scheduler', cure='write tcp://host:8786 or tls://...')


def _interrupt_again() -> None:
    """Interrupt the main thread, even while it waits for a lock."""
    main = threading.main_thread().ident
    if hasattr(signal, 'pthread_kill') and main is not None:
        signal.pthread_kill(main, signal.SIGINT)
    else:
        interrupt_main()


@contextmanager
def _elsewhere(scheduler: str) -> Iterator[tuple[Any, Any]]:
    """Dask and a client of a scheduler, whose work is dropped at once with the study."""
    refuse_wrong_address(scheduler)
    distributed = import_module('distributed')
    with distributed.utils.silence_logging_cmgr('CRITICAL'):
        try:
            client = distributed.Client(scheduler, timeout=_PATIENCE)
        except (OSError, TypeError, ValueError, RuntimeError) as error:
            cure = 'start one: dask scheduler; for tls:// set its certificates (doc/clusters.md)'
            what = f'no scheduler answers ({type(error).__name__})'
            raise TransportError(what, where=scheduler, cure=cure) from None
        try:
            _wait_for_workers(distributed, client, scheduler)
            _refuse_other_versions(client, scheduler)
            yield distributed, client
        finally:
            with suppress(OSError, TimeoutError, distributed.comm.CommClosedError):
                client.close(timeout=2.0)


def _wait_for_workers(distributed: Any, client: Any, scheduler: str) -> None:
    try:
        client.wait_for_workers(1, timeout=_PATIENCE)
    except (TimeoutError, distributed.TimeoutError):
        cure = f'start some: dask worker {scheduler} --nthreads 1 --nworkers auto'
        raise TransportError('a scheduler without workers', where=scheduler, cure=cure) from None


def _refuse_other_versions(client: Any, scheduler: str) -> None:
    """Raise a `TransportError` for a worker with other versions than here."""
    here = own_version()
    try:
        found: dict[str, dict[str, str]] = client.sync(
            client._run, own_version, callback_timeout=_PATIENCE
        )
    except TimeoutError:
        what = f'a worker does not answer within {_PATIENCE:g} s'
        cure = 'end workers that hang, and run it again'
        raise TransportError(what, where=scheduler, cure=cure) from None
    except Exception as error:  # what a worker raises is of any kind
        cure = f'install it there: pip install {PACKAGE}=={own_version()[PACKAGE]}'
        what = f'its workers cannot run tree_sway ({type(error).__name__}: {error})'
        raise TransportError(what, where=scheduler, cure=cure) from None
    for worker, there in found.items():
        differs = [name for name in here if there.get(name) != here[name]]
        if differs:
            pairs = [
                f'{name} {there.get(name, "none")[:12]} instead of {here[name][:12]}'
                for name in differs
            ]
            what = f'worker {worker} has {", ".join(pairs)}'
            cure = 'install the same versions there, as others may compute other numbers'
            raise TransportError(what, where=scheduler, cure=cure)


def run_all(
    distributed: Any,
    client: Any,
    function: Callable[..., Any],
    work: Sequence[tuple[str, tuple[Any, ...]]],
    is_answer: Callable[..., bool] = lambda result, *arguments: True,
    *,
    deadline: float = DEADLINE,
) -> Iterator[Any]:
    """
    Yield the results of a function for pieces of work, in the order in which they are finished.

    Each piece has a name, which has to be its own, and arguments. What a lost worker had is done
    by another, which is reported on standard error. Raises a `TransportError` for a piece that
    ends `_ATTEMPTS` workers, for a result that is no answer to its arguments, for what a worker
    raises, when the scheduler is lost, or when nothing was finished within the deadline [s].
    """
    with told_lost_workers(client, [name for name, _ in work]):
        futures = [
            client.submit(function, *arguments, key=name, pure=False) for name, arguments in work
        ]
        waiting = set(futures)
        asked = dict(work)
        try:
            for future in _completed(distributed, futures, deadline):
                error = future.exception()
                if error is not None:
                    _refuse_error(distributed, future.key, error)
                result = future.result(deadline)
                if not is_answer(result, *asked[future.key]):
                    raise TransportError(
                        f'a worker returned a {type(result).__name__} that is no answer to it',
                        where=future.key,
                        cure='end that worker, and run it again: what is finished is kept',
                    )
                waiting.discard(future)
                future.release()  # its result is not kept on the cluster
                yield result
        except (TimeoutError, distributed.TimeoutError):
            names = sorted(future.key for future in waiting)
            raise TransportError(
                f'no worker finished anything within {deadline:g} s; {len(names)} pieces of work '
                f'are left, the first {names[0]}',
                cure='end workers that hang and run it again, what is finished is kept; or give a '
                'longer --deadline',
            ) from None
        except distributed.KilledWorker as error:
            raise TransportError(
                f'a case took down {_ATTEMPTS} workers in turn',
                where=f'case {error.task}',
                cure='find out what ends them (memory?), use fewer --workers, and run it again',
            ) from None
        except (
            distributed.comm.CommClosedError,
            distributed.client.FutureCancelledError,
        ) as error:
            raise TransportError(
                f'the scheduler is lost ({type(error).__name__})',
                cure='run it again: what is finished is kept',
            ) from None
        finally:
            with suppress(Exception):  # the study has ended in another way, which counts
                client.cancel(list(waiting), force=True)


def _completed(distributed: Any, futures: Sequence[Any], deadline: float) -> Iterator[Any]:
    """Yield futures as they are done; a `TimeoutError` if none is within the deadline [s]."""
    completed = distributed.as_completed(futures)
    latest = time.monotonic()
    while completed.count():
        if done := completed.next_batch(block=False):
            yield from done
            latest = time.monotonic()
        elif time.monotonic() - latest > deadline:
            raise TimeoutError
        else:
            time.sleep(_LOOK)


def _refuse_error(distributed: Any, name: str, error: BaseException) -> None:
    """Raise what a worker raised; an error that is none of this package in one line."""
    own = TreeSwayError, distributed.KilledWorker, distributed.client.FutureCancelledError
    if isinstance(error, (*own, distributed.comm.CommClosedError)):
        raise error
    what = f'a worker failed ({type(error).__name__}: {error})'
    cure = 'see to that worker, and run it again: what is finished is kept'
    raise TransportError(what[:_LONGEST_REASON], where=name, cure=cure) from None


@contextmanager
def _processes_here(workers: int) -> Iterator[tuple[Any, Any]]:
    """
    Dask and a client of worker processes on this machine, which end at once with the study.

    Only this process handles Ctrl-C, and only once the scheduler is up: an interrupted start would
    leave half of it running. Workers, which take seconds, start after that. The log is silent
    until the last thread has ended.
    """
    within('--workers', workers, 1, 1024)
    settings: dict[str, Any] = {
        'distributed.nanny.pre-spawn-environ.DASK_LOGGING__DISTRIBUTED': 'critical',
        # Pages of dask have no password: neither the scheduler nor the workers have any.
        'distributed.scheduler.http.routes': [],
        'distributed.worker.http.routes': [],
    }
    page = {'dashboard': False, 'dashboard_address': '127.0.0.1:0'}  # no page
    dask = import_module('dask')
    distributed = import_module('distributed')
    import_module('cryptography')  # keys that exclude other users of this machine
    parents: list[Any] = []

    def parent(*arguments: Any, **options: Any) -> Any:
        parents.append(distributed.Nanny(*arguments, **options))
        return parents[-1]

    with delayed_interrupt() as delayed:
        with (
            dask.config.set(settings),
            distributed.utils.silence_logging_cmgr('CRITICAL'),
            distributed.LocalCluster(
                n_workers=0, processes=True, worker_class=parent, threads_per_worker=1,
                memory_limit=0, silence_logs='CRITICAL',
                scheduler_kwargs={'allowed_failures': _ATTEMPTS - 1, **page}, security=True,
            ) as local,
            distributed.Client(local) as client,
        ):  # fmt: skip
            try:
                delayed.close()
                local.scale(workers)
                yield distributed, client
            except BaseException:  # Ctrl-C: running cases are computed in the next run
                is_closed = threading.Event()
                delayed.callback(is_closed.set)
                threading.Thread(target=_kill_workers, args=(parents, is_closed)).start()
                raise


def _kill_workers(parents: Sequence[Any], is_closed: threading.Event) -> None:
    """Kill the workers of Dask's nannies, and those that still start, until it is closed."""
    while not is_closed.wait(_KILL_PERIOD):
        own = {parent.pid for parent in parents}
        for process in active_children():
            if process.pid in own:
                process.kill()


def delayed_interrupt() -> ExitStack:
    """Delay Ctrl-C until closed; threads and processes started before then never get it."""
    delayed = ExitStack()
    if hasattr(signal, 'pthread_sigmask'):
        # It would unblock the signal as it starts. Where SIGTERM ends this process, it cleans up,
        # for which it is there, without a warning.
        sys.warnoptions.append(_NO_LEAKS)
        resource_tracker.ensure_running()
        sys.warnoptions.remove(_NO_LEAKS)
        signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
        delayed.callback(signal.pthread_sigmask, signal.SIG_UNBLOCK, [signal.SIGINT])
        if threading.current_thread() is threading.main_thread():
            # An earlier thread may receive it, for Python to handle here: then it waits here.
            usual = signal.signal(signal.SIGINT, lambda number, _: signal.raise_signal(number))
            delayed.callback(signal.signal, signal.SIGINT, usual)
    return delayed
