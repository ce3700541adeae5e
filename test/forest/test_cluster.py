# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Studies on a Dask cluster that was started apart: the same table, whatever is lost."""

from __future__ import annotations

from collections.abc import Iterator
import multiprocessing
import os
from pathlib import Path
import re
import signal
import socket
import subprocess
import sys
import threading
import time

import pytest

from test.forest.conftest import SeparateCluster, StartCluster
from tree_sway.commands import cli
from tree_sway.errors import ParameterError, TransportError
from tree_sway.forest import cluster
from tree_sway.forest.cluster import own_version, refuse_wrong_address, run_all
from tree_sway.forest.plan import Case
from tree_sway.forest.runner import compute_batch, files_of, result_path, run_study

pytest.importorskip('distributed', reason='needs dask.distributed')
pytestmark = pytest.mark.skipif(os.name != 'posix', reason='ends processes by signals')

SEEDLING = Path(__file__).parents[1] / 'files' / 'data' / 'seedling.yaml'
DEADLINE = 120.0


def cases(folder: Path, seeds: int = 6, seconds: float = 1.0) -> list[Case]:
    """Cases of a tree in a file that this process alone has, in gusts and in a record."""
    tree, wind = folder / 'own' / 'tree.yaml', folder / 'own' / 'wind.csv'
    tree.parent.mkdir(exist_ok=True)
    tree.write_bytes(SEEDLING.read_bytes())
    wind.write_text('time,u,v\n' + '\n'.join(f'{0.1 * k},{4 + k % 3},0' for k in range(20)))
    given = {'settings': {'model': 'branch'}, 'seconds': seconds}
    winds = [{'speed': 4.0, 'intensity': 0.2, 'seed': k} for k in range(seeds - 1)]
    winds.append({'file': str(wind), 'scale': 1.0})
    return [Case({'file': str(tree)}, each, **given) for each in winds]


@pytest.fixture(scope='module')
def apart(start_cluster: StartCluster) -> SeparateCluster:
    return start_cluster(2)


@pytest.fixture
def empty(start_cluster: StartCluster) -> SeparateCluster:
    return start_cluster(0)


def alone(asked: list[Case]) -> list[object]:
    """Rows computed in this process, one after the other."""
    return [row for _, row in compute_batch(asked, files_of(asked, {}))]


def test_workers_elsewhere_give_the_same_rows_bit_for_bit(
    apart: SeparateCluster, tmp_path: Path
) -> None:
    asked = cases(tmp_path)
    files_of_asked = files_of(asked, {})
    assert len(files_of_asked) == 2
    rows = run_study(asked, tmp_path / 'cases', scheduler=apart.address)
    assert rows == alone(asked)


def test_a_killed_worker_loses_nothing(
    apart: SeparateCluster, tmp_path: Path, monkeypatch, capsys: pytest.CaptureFixture[str]
) -> None:
    # Long enough that the doomed worker has a case when the second one is done.
    asked = cases(tmp_path, 8, seconds=30.0)
    doomed = apart.start_worker()
    apart.wait_for_workers()
    began = threading.Event()

    def kill_in_the_middle(found: list[Case], _: str) -> Iterator[Case]:
        for done, case in enumerate(found):
            if done == 2:
                doomed.send_signal(signal.SIGKILL)
                doomed.wait(20.0)
                began.set()
            yield case

    monkeypatch.setattr('tree_sway.forest.runner.bar', kill_in_the_middle)
    rows = run_study(asked, tmp_path / 'cases', workers=1, scheduler=apart.address)
    assert began.is_set()
    assert rows == alone(asked)
    assert capsys.readouterr().err.count('a worker was ended') == 1


def test_the_command_computes_there_and_again_only_what_is_missing(
    apart: SeparateCluster, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study, table = tmp_path / 'study.yaml', tmp_path / 'study.csv'
    study.write_text(
        f'trees: [{SEEDLING}]\nwinds: [{{speed: 4, seeds: 3}}]\nsettings: {{model: branch}}\n'
        'seconds: 1\n'
    )
    words = ['study', str(study), '-o', str(table), '--scheduler', apart.address]
    assert cli.main(words) == 0
    assert f'3 of 3 cases to compute by {apart.address}' in capsys.readouterr().err
    first = table.read_bytes()
    assert cli.main(words) == 0
    assert '0 of 3' in capsys.readouterr().err
    assert table.read_bytes() == first


def test_a_case_that_cannot_be_leaves_the_others(apart: SeparateCluster, tmp_path: Path) -> None:
    asked = cases(tmp_path, 3)
    wrong = Case({'file': str(tmp_path / 'nowhere.yaml')}, asked[0].wind, seconds=1.0)
    with pytest.raises(Exception, match=r'no such file|no tree'):
        run_study([wrong, *asked], tmp_path / 'cases', scheduler=apart.address)
    assert all(result_path(tmp_path / 'cases', case).is_file() for case in asked)


def test_other_versions_are_refused_by_a_sentence(
    apart: SeparateCluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = {**own_version(), 'tree_sway_ros': '9.9'}

    def differs() -> dict[str, str]:
        return other

    run = cluster._refuse_other_versions
    monkeypatch.setattr(cluster, 'own_version', differs)

    class Client:
        _run = None

        def sync(self, *_: object, **__: object) -> dict[str, dict[str, str]]:
            return {'tcp://there:1': {**other, 'tree_sway_ros': '0.1.0'}}

    with pytest.raises(TransportError, match=r'there:1 has tree_sway_ros 0\.1\.0 inst.* 9\.9'):
        run(Client(), 'tcp://there:2')


def test_a_worker_that_does_not_answer_at_first_is_told(
    start_cluster: StartCluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    stopped = start_cluster(1)
    stopped.wait_for_workers()
    monkeypatch.setattr(cluster, '_PATIENCE', 2.0)
    stopped.workers[0].send_signal(signal.SIGSTOP)
    with pytest.raises(TransportError, match='a worker does not answer within 2 s; end workers'):
        with cluster.cluster(1, stopped.address):
            pass


@pytest.mark.parametrize('address', ['host:8786', 'tcp://host', 'http://host:1', 'tcp://host:0'])
def test_a_wrong_address_is_refused_at_once(address: str) -> None:
    with pytest.raises(ParameterError, match='write tcp://host:8786'):
        refuse_wrong_address(address)


def test_no_scheduler_and_no_workers_are_told(
    empty: SeparateCluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, '_PATIENCE', 3.0)
    with socket.socket() as nobody:
        nobody.bind(('127.0.0.1', 0))
        address = f'tcp://127.0.0.1:{nobody.getsockname()[1]}'
    with pytest.raises(TransportError, match=rf'{re.escape(address)}: no scheduler answers'):
        run_study(cases(tmp_path, 2), tmp_path / 'cases', scheduler=address)
    monkeypatch.setattr(cluster, '_PATIENCE', 10.0)
    with pytest.raises(TransportError, match='a scheduler without workers; start some'):
        run_study(cases(tmp_path, 2), tmp_path / 'cases', scheduler=empty.address)


def test_results_come_as_they_are_done(apart: SeparateCluster) -> None:
    with cluster.cluster(1, apart.address) as (distributed, client):
        work = [(f'piece {k}', (k,)) for k in range(5)]
        assert sorted(run_all(distributed, client, abs, work)) == [0, 1, 2, 3, 4]


def test_a_worker_that_lies_or_fails_is_told(apart: SeparateCluster) -> None:
    with cluster.cluster(1, apart.address) as (distributed, client):
        work = [('piece 1', ('x',))]
        with pytest.raises(TransportError, match='piece 1: a worker returned a str that is no'):
            list(run_all(distributed, client, str, work, lambda result, _: result == 'y'))
        with pytest.raises(TransportError, match=r'piece 2: a worker failed .ValueError'):
            list(run_all(distributed, client, int, [('piece 2', ('x',))]))


def study_that_hangs(done: list[None], deadline: float) -> None:
    """Do four pieces of work, of which the first does not end by itself."""
    work = [('piece 0', (DEADLINE,)), *((f'piece {k}', (0.0,)) for k in range(1, 4))]
    with cluster.cluster(2) as (distributed, client):
        assert list(run_all(distributed, client, abs, [('first', (1,))])) == [1]
        for each in run_all(distributed, client, time.sleep, work, deadline=deadline):
            done.append(each)
            if len(done) == 3 and deadline == cluster.DEADLINE:
                threading.Timer(0.5, signal.raise_signal, (signal.SIGINT,)).start()


@pytest.mark.parametrize(
    ('deadline', 'error', 'said'),
    [
        (2.0, TransportError, 'within 2 s; 1 pieces of work are left, the first piece 0;.*--d'),
        (cluster.DEADLINE, KeyboardInterrupt, None),
    ],
)
def test_work_that_hangs_is_ended_by_the_deadline_or_ctrl_c_and_keeps_what_is_done(
    deadline: float, error: type[BaseException], said: str | None
) -> None:
    done: list[None] = []
    with pytest.raises(error, match=said):
        study_that_hangs(done, deadline)
    assert len(done) == 3
    until(lambda: not multiprocessing.active_children())


def study_with_another(started: list[multiprocessing.process.BaseProcess]) -> None:
    """Start a worker, then a process that is none, and press Ctrl-C."""
    with cluster.cluster(1):
        until(multiprocessing.active_children)
        started += multiprocessing.active_children()
        context = multiprocessing.get_context('spawn')
        started.append(context.Process(target=time.sleep, args=(DEADLINE,)))
        started[-1].start()
        signal.raise_signal(signal.SIGINT)


@pytest.mark.skipif(not hasattr(signal, 'pthread_sigmask'), reason='delays Ctrl-C by a mask')
def test_ctrl_c_in_a_study_ends_its_own_workers_alone() -> None:
    """A program that calls the library may have processes of its own, also younger ones."""
    started: list[multiprocessing.process.BaseProcess] = []
    with pytest.raises(KeyboardInterrupt):
        study_with_another(started)
    *workers, other = started
    until(lambda: not any(each.is_alive() for each in workers))
    is_alive = other.is_alive()
    other.kill()
    other.join()
    assert is_alive


STUDY = """
import sys
from tree_sway.commands.cli import main
sys.exit(main(sys.argv[1:]))
"""


def test_ctrl_c_ends_at_once_and_frees_the_workers(apart: SeparateCluster, tmp_path: Path) -> None:
    import distributed

    study = tmp_path / 'study.yaml'
    study.write_text('trees: [benjamina]\nwinds: [{speed: 4, seeds: 40}]\nseconds: 10\n')
    words = ['study', str(study), '-o', str(tmp_path / 'o.csv'), '--scheduler', apart.address]
    command = [sys.executable, '-c', STUDY, *words]
    with (
        subprocess.Popen(command, start_new_session=True, stderr=subprocess.PIPE) as process,
        distributed.Client(apart.address, set_as_default=False) as watching,
    ):
        until(lambda: any(watching.processing().values()))
        began = time.monotonic()
        os.killpg(process.pid, signal.SIGINT)
        said = process.communicate(timeout=DEADLINE)[1]
        assert process.returncode == 130, said
        assert time.monotonic() - began < 15.0
        assert b'Traceback' not in said
        until(lambda: not any(watching.processing().values()))


def swallow_once(waited: threading.Event) -> None:
    """Drop the first interrupt, as a finalizer does, and wait for what never happens."""
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)
    waited.wait(DEADLINE)


def test_ctrl_c_that_a_finalizer_swallows_is_repeated(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, '_REPEAT', 0.1)
    handler = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt), cluster.repeated_interrupt():
        swallow_once(threading.Event())
    assert signal.getsignal(signal.SIGINT) is handler
    until(lambda: not any(isinstance(each, threading.Timer) for each in threading.enumerate()))


def until(is_so) -> None:
    """Wait for a condition, with a deadline."""
    end = time.monotonic() + DEADLINE
    while not is_so():
        assert time.monotonic() < end, 'it did not come to that'
        time.sleep(0.05)
