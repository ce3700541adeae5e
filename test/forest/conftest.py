# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Dask clusters that are started apart from the study."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
import json
from pathlib import Path
import subprocess
import sys
import time

import pytest

_PATIENCE = 120.0
"""Longest wait for a process of a cluster to start [s], on a busy machine."""


class SeparateCluster:
    """A scheduler and workers as processes of their own, each in a folder of its own."""

    def __init__(self, folder: Path) -> None:
        self._stack = ExitStack()
        self._folder = folder
        self.workers: list[subprocess.Popen[bytes]] = []
        file = folder / 'scheduler.json'
        words = ('--host', '127.0.0.1', '--port', '0', '--no-dashboard')
        started = self._start('scheduler', 'dask_scheduler', *words, '--scheduler-file', str(file))
        end = time.monotonic() + _PATIENCE
        while not (file.is_file() and file.read_text().endswith('}')):
            assert started.poll() is None, 'the scheduler ended'
            assert time.monotonic() < end, f'no scheduler within {_PATIENCE:g} s'
            time.sleep(0.05)
        self.address: str = json.loads(file.read_text())['address']

    def start_worker(self) -> subprocess.Popen[bytes]:
        number = len(self.workers)
        words = (self.address, '--nthreads', '1', '--no-nanny', '--no-dashboard')
        self.workers.append(self._start(f'worker{number}', 'dask_worker', *words))
        return self.workers[-1]

    def wait_for_workers(self) -> None:
        """Wait until the scheduler knows all workers that were started."""
        import distributed

        with distributed.Client(self.address, set_as_default=False, timeout=_PATIENCE) as client:
            client.wait_for_workers(len(self.workers), timeout=_PATIENCE)

    def _start(self, name: str, module: str, *words: str) -> subprocess.Popen[bytes]:
        place = self._folder / name
        place.mkdir()
        command = [sys.executable, '-m', f'distributed.cli.{module}', *words]
        quiet = subprocess.DEVNULL
        process = subprocess.Popen(command, cwd=place, stdout=quiet, stderr=quiet)
        self._stack.callback(process.wait, 20.0)
        self._stack.callback(process.kill)
        return process

    def close(self) -> None:
        self._stack.close()


StartCluster = Callable[[int], SeparateCluster]
"""Starts a cluster with a number of workers."""


@pytest.fixture(scope='module')
def start_cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[StartCluster]:
    with ExitStack() as stack:

        def start(n_workers: int) -> SeparateCluster:
            cluster = SeparateCluster(tmp_path_factory.mktemp('cluster'))
            stack.callback(cluster.close)
            for _ in range(n_workers):
                cluster.start_worker()
            return cluster

        yield start
