# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A study of 400 cases on a Dask cluster that was started apart: time and traffic by its workers.

``pytest -m long -s test/forest/test_cluster_cost.py`` prints the table of ``doc/clusters.md``.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
import os
from pathlib import Path
import subprocess
import sys
import threading
import time
from urllib.parse import urlsplit

import pytest

from test.forest.conftest import StartCluster

pytest.importorskip('distributed', reason='needs dask.distributed')
pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(os.name != 'posix', reason='ends processes by signals'),
]

SEEDLING = Path(__file__).parents[1] / 'files' / 'data' / 'seedling.yaml'
N_CASES = 400
DEADLINE = 240.0
STUDY = f"""
trees: [{SEEDLING}]
winds: [{{speed: [4, 8], seeds: {N_CASES // 2}}}]
settings: {{model: branch}}
seconds: 20
"""
PROGRAM = 'from tree_sway.commands.cli import main; raise SystemExit(main())'


class CountingRelay:
    """Pass bytes on between a study and its scheduler, and count them."""

    def __init__(self, scheduler: str) -> None:
        there = urlsplit(scheduler)
        self._host, self._port = there.hostname, there.port
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        listening = asyncio.start_server(self._pass_on, '127.0.0.1', 0)
        server = asyncio.run_coroutine_threadsafe(listening, self._loop).result()
        self.address = f'tcp://127.0.0.1:{server.sockets[0].getsockname()[1]}'
        self.sent = 0
        self.received = 0

    async def _pass_on(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        there_reader, there_writer = await asyncio.open_connection(self._host, self._port)
        answers = asyncio.create_task(self._copy_back(there_reader, writer))
        while piece := await reader.read(65536):
            self.sent += len(piece)
            there_writer.write(piece)
        there_writer.close()
        await answers

    async def _copy_back(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        while piece := await reader.read(65536):
            self.received += len(piece)
            writer.write(piece)
        writer.close()

    def close(self) -> None:
        """Stop listening."""
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(20.0)


@contextmanager
def counted(scheduler: str) -> Iterator[CountingRelay]:
    relay = CountingRelay(scheduler)
    try:
        yield relay
    finally:
        relay.close()


def study(folder: Path, scheduler: str) -> subprocess.Popen[bytes]:
    """Start ``tree-sway study`` in a folder of its own."""
    folder.mkdir()
    (folder / 'study.yaml').write_text(STUDY)
    command = [sys.executable, '-c', PROGRAM, 'study', 'study.yaml', '-o', 'table.csv']
    command += ['--scheduler', scheduler]
    return subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)


def until_cases(folder: Path, n_cases: int, process: subprocess.Popen[bytes]) -> None:
    """Wait until a study has finished a number of cases."""
    end = time.monotonic() + DEADLINE
    while len(list(folder.glob('table.cases/*.json'))) < n_cases:
        assert process.poll() is None, 'the study ended too early'
        assert time.monotonic() < end, 'the study is too slow'
        time.sleep(0.02)


def test_any_number_of_workers_gives_the_same_table(
    start_cluster: StartCluster, tmp_path: Path
) -> None:
    cluster = start_cluster(0)
    tables = list[bytes]()
    print('\n| workers | killed | time [s] | sent [kB] | received [kB] | table |')
    print('|---|---|---|---|---|---|')
    for n_workers, n_killed in ((1, 0), (2, 0), (4, 0), (4, 1)):
        while len(cluster.workers) < n_workers:
            cluster.start_worker()
        cluster.wait_for_workers()
        folder = tmp_path / f'{n_workers} workers {n_killed} killed'
        with counted(cluster.address) as relay:
            began = time.monotonic()
            process = study(folder, relay.address)
            if n_killed:
                until_cases(folder, N_CASES // 2, process)
                cluster.workers[-1].kill()
            said = process.communicate(timeout=DEADLINE)[1]
            spent = time.monotonic() - began
        assert process.returncode == 0, said
        tables.append((folder / 'table.csv').read_bytes())
        is_same = 'same' if tables[-1] == tables[0] else 'differs'
        traffic = f'{relay.sent / 1000:.0f} | {relay.received / 1000:.0f}'
        print(f'| {n_workers} | {n_killed} | {spent:.1f} | {traffic} | {is_same} |')
    assert tables[0].count(b'\n') == N_CASES + 1
    assert all(table == tables[0] for table in tables)
