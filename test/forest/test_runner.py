# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Studies over processes: the same numbers in any number of them; what is killed loses nothing."""

from __future__ import annotations

import contextlib
import csv
from dataclasses import replace
import math
import os
from pathlib import Path
import signal
import subprocess
import sys
import threading
import time
from urllib.request import urlopen

import numpy as np
import pytest

from tree_sway.commands import cli
from tree_sway.core.settings import USUAL
from tree_sway.errors import FormatError, ParameterError, TreeSwayError
from tree_sway.files.wind.record import WindRecord
from tree_sway.forest import cluster, runner
from tree_sway.forest.cluster import delayed_interrupt
from tree_sway.forest.compute import compute
from tree_sway.forest.plan import Case, read_study
from tree_sway.forest.runner import (
    batches,
    compute_batch,
    estimated_time,
    is_outcome,
    missing_cases,
    result_path,
    run_study,
    store_row,
)
from tree_sway.forest.table import write_table

pytest.importorskip('distributed', reason='needs dask.distributed')
pytest.importorskip('cryptography', reason='needs cryptography')

SEEDLING = Path(__file__).parents[1] / 'files' / 'data' / 'seedling.yaml'


def compute_to_file(case, folder):
    store_row(case, compute(case), folder)


def cases(seeds=4, **changes):
    given = {'settings': {'model': 'branch'}, 'seconds': 1.0, **changes}
    tree = {'file': str(SEEDLING)}
    return [Case(tree, {'speed': 4.0, 'intensity': 0.2, 'seed': k}, **given) for k in range(seeds)]


@pytest.fixture(scope='module')
def alone(tmp_path_factory):
    """Rows computed in this process, one after the other."""
    folder = tmp_path_factory.mktemp('alone')
    for case in cases():
        compute_to_file(case, folder)
    return run_study(cases(), folder)


def test_a_case_whose_file_is_cut_off_is_computed_again(tmp_path):
    first, second, *_ = cases()
    for case in (first, second):
        compute_to_file(case, tmp_path)
    result_path(tmp_path, first).write_text('{"tip_rms [m]": 0.0')
    assert missing_cases([first, second], tmp_path) == [first]
    too_long = b'{"a": "' + b' ' * 2**20 + b'"}'
    for damaged in (b'', b'\xff\xfe', b'[' * 50_000, b'{}', b'[1]', too_long):
        result_path(tmp_path, first).write_bytes(damaged)
        assert missing_cases([first, second], tmp_path) == [first]


@pytest.fixture
def in_this_process(monkeypatch):
    """Compute here: other processes take long to start."""
    monkeypatch.setattr(runner, '_outcomes', lambda missing, *_: compute_batch(missing, {}))


def watched(after, do):
    """Return a bar that does something after a number of cases."""

    def bar(items, _):
        for done, item in enumerate(items):
            if done == after:
                do()
            yield item

    return bar


def test_two_processes_give_the_same_numbers_bit_for_bit(alone, tmp_path):
    rows = run_study(cases(), tmp_path, workers=2)
    assert rows == alone
    columns = {'frequency [Hz]', 'tip_largest [m]', 'base_moment_rms [N m]', 'strain_largest [-]'}
    assert columns <= set(rows[0])
    assert rows[0]['tip_largest [m]'] > 0.0
    for part in ('wood', 'roots'):
        share, low, high = (
            rows[0][f'{part}_strength_used{band} [-]'] for band in ('', '_low', '_high')
        )
        assert 0.0 < low < share < high


@pytest.mark.usefixtures('in_this_process')
def test_what_is_finished_is_not_computed_again(alone, tmp_path):
    for case in cases(2):
        compute_to_file(case, tmp_path)
    stamps = {case.name: result_path(tmp_path, case).stat().st_mtime_ns for case in cases(2)}
    assert run_study(cases(), tmp_path, workers=1) == alone
    assert all(
        result_path(tmp_path, case).stat().st_mtime_ns == stamps[case.name] for case in cases(2)
    )


def test_trees_of_any_size_are_on_one_model():
    rows = []
    for name in ('seedling.yaml', 'segments.csv', 'fork.swc'):
        tree = {'file': str(SEEDLING.with_name(name))}
        case = Case(tree, {'speed': 4.0, 'intensity': 0.2, 'seed': 0}, seconds=1.0)
        rows.append(compute(case))
    assert len({row['segments'] for row in rows}) == 3
    assert {row['model'] for row in rows} == {str(USUAL)}


def test_a_row_says_how_long_its_record_is_and_what_is_doubtful_about_it():
    wind = WindRecord(np.arange(3.0), np.full((3, 3), 1.0), 'three')
    record = {'file': 'three.csv', 'scale': 1.0}
    still = compute(Case({'name': 'goldcrest'}, record, {'model': 0}, seconds=60.0), wind=wind)
    assert still['length [s]'] == pytest.approx(2.0)
    assert 'the tree stands still' in still['notes']
    moved = compute(Case({'name': 'goldcrest'}, record, {'model': 4}, seconds=1.0), wind=wind)
    assert moved['length [s]'] == 1.0
    assert moved['notes'] == ''


def test_a_scale_whose_wind_would_be_dropped_is_refused():
    wind = WindRecord(np.arange(3.0), np.full((3, 3), 1.0), 'three')
    case = Case({'name': 'goldcrest'}, {'file': 'three.csv', 'scale': 200.0}, {'model': 0})
    with pytest.raises(ParameterError, match=r'scale: 200\.0 is out of range; use 0 to 86\.6'):
        compute(case, wind=wind)


def test_the_time_is_estimated_before_anything_is_computed(tmp_path, capsys, monkeypatch):
    assert estimated_time([], 2) == 0.0
    few, many = estimated_time(cases(8), 2), estimated_time(cases(8, seconds=600.0), 2)
    assert many - few == pytest.approx(8 * 599 * 60 * 2e-4 / 2)
    assert estimated_time(cases(80), 8) < estimated_time(cases(80), 2)
    study, table = tmp_path / 'study.yaml', tmp_path / 'study.csv'
    study.write_text(f'trees: [{SEEDLING}]\nwinds: [{{speed: 4, seeds: 3}}]\nseconds: 1\n')
    folder = table.with_suffix('.cases')
    folder.mkdir()
    compute_to_file(read_study(study)[0], folder)
    said = []

    def outcomes(missing, workers, scheduler, deadline):
        said.append(capsys.readouterr().err)
        assert workers == 2
        assert (scheduler, deadline) == (None, 14_400.0)
        return compute_batch(missing, {})  # in this process: others take long to start

    monkeypatch.setattr(runner, '_outcomes', outcomes)
    assert cli.main(['study', str(study), '-o', str(table), '--workers', '2']) == 0
    assert '2 of 3 cases to compute: some 7 s on 2 cores' in said[0]


def test_a_tree_is_set_up_once_for_many_winds():
    same, other = cases(8), cases(8, settings={'model': 'branch'})
    mixed = [case for pair in zip(same, other, strict=True) for case in pair]
    parts = batches(mixed, workers=1)
    assert sorted(map(len, parts)) == [4, 4, 4, 4]
    assert all(len({str(case.settings) for case in part}) == 1 for part in parts)
    assert sorted(str(case) for part in parts for case in part) == sorted(map(str, mixed))
    assert max(map(len, batches(same, workers=2))) == 1


def workers_of(parent: int) -> list[int]:
    """List processes that a process has spawned to compute."""
    found = []
    for path in Path('/proc').glob('[0-9]*/stat'):
        try:
            fields = path.read_text().rpartition(')')[2].split()
            command = (path.parent / 'cmdline').read_bytes()
        except OSError:
            continue
        if int(fields[1]) == parent and b'spawn_main' in command:
            found.append(int(path.parent.name))
    return found


@pytest.mark.skipif(not Path('/proc').is_dir(), reason='needs /proc to find a worker to kill')
def test_a_killed_worker_loses_nothing_and_is_reported(alone, tmp_path, monkeypatch, capsys):
    killed = []

    def kill_one():
        killed.append(workers_of(os.getpid())[0])
        os.kill(killed[0], signal.SIGKILL)

    monkeypatch.setattr(runner, 'bar', watched(1, kill_one))
    rows = run_study(cases(6), tmp_path, workers=2)
    assert killed
    assert len(rows) == 6
    assert rows[:4] == alone
    assert capsys.readouterr().err.count('a worker was ended') == 1


@pytest.fixture
def ctrl_c():
    """Have Ctrl-C reach commands, also where tests run in the background of a shell."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.skipif(not hasattr(signal, 'sigpending'), reason='needs signals that can be blocked')
@pytest.mark.usefixtures('ctrl_c')
def test_ctrl_c_waits_until_what_is_begun_is_whole():
    over = threading.Event()
    # Not blocked there: it may receive the signal, and hand it on a little later.
    threading.Thread(target=over.wait, daemon=True).start()
    before = signal.getsignal(signal.SIGINT)
    with delayed_interrupt() as delayed:
        os.kill(os.getpid(), signal.SIGINT)
        until(lambda: signal.SIGINT in signal.sigpending(), 10.0)
        with pytest.raises(KeyboardInterrupt):
            until(delayed.close, 10.0)
    over.set()
    assert signal.getsignal(signal.SIGINT) is before
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, [])


#: The command, whose cluster writes a line to its log as the last thing it does.
TALKATIVE = """
import logging, sys
from distributed.deploy.cluster import Cluster
from tree_sway.commands.cli import main

close = Cluster._close

async def say_and_close(self):
    logging.getLogger('distributed.batched').info('Batched Comm Closed')
    await close(self)

Cluster._close = say_and_close
sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.skipif(not Path('/proc').is_dir(), reason='needs /proc to find the workers')
@pytest.mark.usefixtures('ctrl_c')
@pytest.mark.parametrize(
    'number',
    [signal.SIGINT, signal.SIGKILL, pytest.param(signal.SIGTERM, marks=pytest.mark.long)],
)
def test_whatever_ends_a_study_ends_its_workers(tmp_path, number):
    study = tmp_path / 'study.yaml'
    study.write_text('trees: [benjamina]\nwinds: [{speed: 4, seeds: 9}]\nseconds: 3600\n')
    words = ['study', str(study), '-o', str(tmp_path / 'o.csv'), '--workers', '2']
    command = [sys.executable, '-c', TALKATIVE, *words]
    with subprocess.Popen(command, start_new_session=True, stderr=subprocess.PIPE) as process:
        workers = until(lambda: [w for w in workers_of(process.pid) if is_busy(w)], 60.0)
        began = time.monotonic()
        os.killpg(process.pid, number)
        process.wait(10.0)
        until(lambda: not any(Path('/proc', str(each)).exists() for each in workers), 10.0)
        assert time.monotonic() - began < 10.0
        said = process.stderr.read().decode()
    assert 'Traceback' not in said
    if number == signal.SIGINT:
        assert set(said.splitlines()[1:]) <= {'cases ...'}
    assert process.returncode == (130 if number == signal.SIGINT else -number)


@pytest.mark.skipif(not Path('/proc').is_dir(), reason='needs /proc to find the workers')
@pytest.mark.usefixtures('ctrl_c')
def test_ctrl_c_does_not_wait_for_workers_that_start(tmp_path):
    study, slow = tmp_path / 'study.yaml', tmp_path / 'slow.py'
    study.write_text('trees: [benjamina]\nwinds: [{speed: 4}]\nseconds: 60\n')
    slow.write_text('import time\ntime.sleep(60.0)\n')
    words = ['study', str(study), '-o', str(tmp_path / 'o.csv'), '--workers', '2']
    command = [sys.executable, '-m', 'tree_sway', *words]
    environment = {**os.environ, 'DASK_DISTRIBUTED__WORKER__PRELOAD': f'["{slow}"]'}
    with subprocess.Popen(command, start_new_session=True, env=environment) as process:
        workers = until(lambda: workers_of(process.pid), 60.0)
        began = time.monotonic()
        os.killpg(process.pid, signal.SIGINT)
        assert process.wait(40.0) == 130
        assert time.monotonic() - began < 20.0
        until(lambda: not any(Path('/proc', str(each)).exists() for each in workers), 10.0)


#: A process that is ended while it has a semaphore that others may use, as those of workers.
WITH_A_SEMAPHORE = """
import multiprocessing, os, signal
from tree_sway.forest.cluster import delayed_interrupt

with delayed_interrupt():
    lock = multiprocessing.get_context('spawn').Lock()
    os.kill(os.getpid(), signal.SIGTERM)
"""


@pytest.mark.skipif(not hasattr(signal, 'pthread_sigmask'), reason='SIGTERM is another there')
def test_semaphores_of_an_ended_study_are_removed_without_a_warning():
    command = [sys.executable, '-c', WITH_A_SEMAPHORE]
    ended = subprocess.run(command, stderr=subprocess.PIPE, timeout=60.0)
    assert ended.returncode == -signal.SIGTERM
    assert ended.stderr.decode() == ''


def until(found, seconds):
    """Return what is found as soon as there is something."""
    end = time.monotonic() + seconds
    while not (there := found()):
        assert time.monotonic() < end, 'it did not come to that'
        time.sleep(0.02)
    return there


def is_busy(process: int) -> bool:
    """Whether a worker has loaded what it computes with."""
    return b'/scipy/' in Path('/proc', str(process), 'maps').read_bytes()


def test_tables_are_csv_or_parquet(alone, tmp_path):
    write_table(alone, tmp_path / 'rows.csv')
    with (tmp_path / 'rows.csv').open() as file:
        read = list(csv.DictReader(file))
    assert [float(row['tip_rms [m]']) for row in read] == [row['tip_rms [m]'] for row in alone]
    parquet = pytest.importorskip('pyarrow.parquet', reason='needs pyarrow')
    write_table(alone, tmp_path / 'rows.parquet')
    assert parquet.read_table(tmp_path / 'rows.parquet').to_pylist() == alone
    with pytest.raises(FormatError, match=r'end it with one of: \.csv, \.parquet'):
        write_table(alone, tmp_path / 'rows.xlsx')


@pytest.mark.usefixtures('in_this_process')
def test_the_command_resumes_its_own_table_and_writes_over_no_other(tmp_path, capsys):
    study, table = tmp_path / 'study.yaml', tmp_path / 'study.csv'
    study.write_text(
        f'trees: [{SEEDLING}]\nwinds: [{{speed: 4}}]\nsettings: {{model: branch}}\nseconds: 1\n'
    )
    words = ['study', str(study), '-o', str(table), '--workers', '1']
    table.write_text('of another kind')
    assert cli.main(words) == 2
    assert 'exists; give a different file, or write over it' in capsys.readouterr().err
    assert table.read_text() == 'of another kind'
    assert cli.main([*words, '--force']) == 0
    assert cli.main(words) == 0
    assert len(table.read_text().splitlines()) == 2


def test_no_page_of_the_cluster_answers_other_users() -> None:
    psutil = pytest.importorskip('psutil', reason='needs psutil')
    answered = {}
    with cluster._processes_here(1) as (_, client):
        client.wait_for_workers(1, timeout=60.0)
        me = psutil.Process()
        sockets = (each for one in [me, *me.children(recursive=True)] for each in
                   one.net_connections(kind='tcp'))  # fmt: skip
        listening = {each.laddr for each in sockets if each.status == psutil.CONN_LISTEN}
        for ip, port in listening:
            assert ip == '127.0.0.1'
            for page in ('', 'health', 'metrics', 'info/main/workers.html', 'sitemap.json'):
                url = f'http://{ip}:{port}/{page}'
                with contextlib.suppress(OSError), urlopen(url, timeout=10.0) as response:
                    answered[page] = response.read()
    assert len(listening) >= 4
    assert answered in ({}, {'sitemap.json': b'{"paths": ["/sitemap.json"]}'})


@pytest.mark.parametrize('settings', [{}, {'model': 12.0, 'crown_coherence': 0.5}])
def test_only_the_rows_of_the_cases_are_an_outcome(settings):
    asked = [replace(each, settings=each.settings | settings) for each in cases(2)]
    row = compute(asked[0])
    good = [(asked[0], row), (asked[1], TreeSwayError('no wind'))]
    assert is_outcome(good, asked, {})
    # Of a worker that lies: nothing, another case, not a number, a list, no results.
    other = {name: value for name, value in row.items() if name.startswith(('tree', 'wind'))}
    for lie in ({}, {'a': 1.0}, row | {'frequency [Hz]': math.nan}, row | {'wind_seed': -1},
                row | {'tip_largest [m]': [0.1]}, other):  # fmt: skip
        assert not is_outcome([(asked[0], lie), good[1]], asked, {})
    large = row | {'notes': 'x' * (1 << 18)}
    for bad in (None, 'ab', good[:1], good[::-1], [*good, good[0]], [(asked[0], 3), good[1]],
                [(asked[0], {'a': object()}), good[1]], [(asked[0], large), good[1]]):  # fmt: skip
        assert not is_outcome(bad, asked, {})
