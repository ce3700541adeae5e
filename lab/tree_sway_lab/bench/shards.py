# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Shards of a stand on two hosts, as two network namespaces joined by a cable.

The cable is cut and joined again, and a shard is killed. Needs Linux, root and ``ip`` of iproute2.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import contextlib
import json
import os
from pathlib import Path
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from typing import Any

import numpy as np

from tree_sway.commands import waiting
from tree_sway.core.arrays import Floats
from tree_sway.errors import TransportError
from tree_sway_lab.bench.measured import Measured
from tree_sway_lab.bench.stream import isolated

_HOSTS = ('treesway0', 'treesway1')
_START, _RUN_IN, _AFTER, _BACK = 120.0, 4.0, 4.0, 16.0
_SOLVER = 'from tree_sway_ros.nodes.executables import solver; raise SystemExit(solver())'
_SIDE = [sys.executable, '-m', 'tree_sway_lab.bench.shard_side']


def time_shards(n_trees: int = 40, cut: float = 5.0) -> list[Measured]:
    """
    Cut two hosts apart and kill a shard.

    Parameters
    ----------
    n_trees
        Number of trees of both.
    cut
        How long the cable is cut in [s].

    Returns
    -------
    list of Measured
        CPU time and traffic of the shards, and times in [s].

    Raises
    ------
    TransportError
        Where no network namespace can be made, or no frames of a shard arrive.

    """
    with (
        tempfile.TemporaryDirectory() as folder,
        _joined_hosts(),
        contextlib.ExitStack() as children,
    ):
        stand = Path(folder, 'stand.csv')
        rows = [
            f'{5.0 * i},0,{("pine", "oak")[i % 2]},{8.0 + 0.1 * i:.1f}' for i in range(n_trees)
        ]
        stand.write_text('\n'.join(['x,y,species,height', *rows]) + '\n', encoding='utf-8')
        with waiting('the whole stand on one host'), contextlib.ExitStack() as one_host:
            whole, side = _start(one_host, stand, 1)
            one = _Load(whole, side)
            heard_alone = _end(side)
        with waiting('two hosts with a shard each'):
            shards, sides = _start(children, stand, 2)
            both = _Load(shards, sides)
            cut_at = time.monotonic()
            _cable('down')
            _let_run(sides, cut)
            joined_at = time.monotonic()
            _cable('up')
            _let_run(sides, _AFTER)
            killed_at = time.monotonic()
            shards[1].kill()
            shards[1].wait()
            _let_run(sides, 0.1)  # what was on its way has come
            gone_at = time.monotonic()
            children.enter_context(_shard(1, 2, stand))
            _let_run(sides, _BACK)
            received = _end(sides)
    gaps = [_longest_gap(np.array(received[k][k]), cut_at, joined_at) for k in (0, 1)]
    rejoined = [_first_after(received[k][1 - k], joined_at) for k in (0, 1)]
    lost = [sum(cut_at + 0.5 < at < joined_at for at in received[k][1 - k]) for k in (0, 1)]
    back = _first_after(received[1][1], gone_at) + gone_at - killed_at
    own = [received[k][k] for k in (0, 1)]
    return [
        *one.reported('one shard', [heard_alone[0][0]]),
        *both.reported('each of two shards', own),
        Measured('frames of the other host while cut', float(sum(lost)), '-'),
        Measured('longest gap of the own shard while cut', max(gaps), 's'),
        Measured('whole again after the cut', max(rejoined), 's'),
        Measured('killed shard back', back, 's'),
    ]


class _Load:
    """What solvers take, and send, while they are let run."""

    def __init__(self, shards: list[Any], sides: list[Any]) -> None:
        _let_run(sides, 1.0)  # what the start took is over
        self._begin, cpu = time.monotonic(), sum(map(_cpu_time, shards))
        _let_run(sides, _RUN_IN)
        self._end = time.monotonic()
        seconds = (self._end - self._begin) * len(shards)
        self._share = (sum(map(_cpu_time, shards)) - cpu) / seconds

    def reported(self, whose: str, arrivals: list[list[float]]) -> list[Measured]:
        """Return means over the shards: CPU time per time, and frames on their own host."""
        frames = [sum(self._begin < at < self._end for at in each) for each in arrivals]
        rate = float(np.mean(frames)) / (self._end - self._begin)
        return [
            Measured(f'CPU of {whose}', self._share, '-'),
            Measured(f'frames of {whose}', rate, 'Hz'),
        ]


def _cpu_time(process: Any) -> float:
    """CPU time that a process has taken in [s]."""
    fields = (
        Path(f'/proc/{process.pid}/stat').read_text(encoding='ascii').rsplit(')', 1)[1].split()
    )
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def _start(
    children: contextlib.ExitStack, stand: Path, n_shards: int
) -> tuple[list[Any], list[Any]]:
    """Start shards, each on its host with a listener, until frames of all arrive."""
    hosts = range(n_shards)
    shards = [children.enter_context(_shard(k, n_shards, stand)) for k in hosts]
    sides = [
        children.enter_context(
            _child(k, [*_SIDE, str(int(k == 0)), str(n_shards)], stdin=-1, stdout=-1)
        )
        for k in hosts
    ]
    for k, side in enumerate(sides):
        _wait_until_ready(k, side, shards)
    return shards, sides


def _end(sides: list[Any]) -> list[Any]:
    """Return when each host received each shard."""
    return [json.loads(side.communicate(b'\n', timeout=30.0)[0]) for side in sides]


def _ip(*words: str) -> None:
    done = subprocess.run(['ip', *words], capture_output=True, text=True, check=False)
    if done.returncode:
        raise TransportError(
            done.stderr.strip() or 'ip failed',
            where='ip ' + ' '.join(words),
            cure='run as root on Linux with iproute2',
        )


@contextlib.contextmanager
def _joined_hosts() -> Iterator[None]:
    """Two network namespaces joined by a cable."""
    if shutil.which('ip') is None:
        raise TransportError("there is no program 'ip'", cure='install iproute2, on Linux')
    try:
        for host in _HOSTS:
            _ip('netns', 'add', host)
        _ip('link', 'add', 'cable0', 'netns', _HOSTS[0], 'type', 'veth',
            'peer', 'name', 'cable1', 'netns', _HOSTS[1])  # fmt: skip
        for k, host in enumerate(_HOSTS):
            _ip('-n', host, 'address', 'add', f'10.77.0.{k + 1}/24', 'dev', f'cable{k}')
            for link in ('lo', f'cable{k}'):
                _ip('-n', host, 'link', 'set', link, 'up')
            _ip('-n', host, 'route', 'add', '224.0.0.0/4', 'dev', f'cable{k}')
        yield
    finally:
        for host in _HOSTS:
            with contextlib.suppress(TransportError):
                _ip('netns', 'delete', host)


def _cable(state: str) -> None:
    _ip('-n', _HOSTS[0], 'link', 'set', 'cable0', state)
    if state == 'up':
        _ip('-n', _HOSTS[0], 'route', 'replace', '224.0.0.0/4', 'dev', 'cable0')


@contextlib.contextmanager
def _child(host: int, command: list[str], **pipes: Any) -> Iterator[subprocess.Popen[bytes]]:
    """Run a process on a host, to be ended with the run."""
    environment = {**isolated(0), 'ROS_DOMAIN_ID': '77', 'ROS_AUTOMATIC_DISCOVERY_RANGE': 'SUBNET'}
    child = subprocess.Popen(
        ['ip', 'netns', 'exec', _HOSTS[host], *command],
        env=environment, stderr=subprocess.DEVNULL, **pipes,
    )  # fmt: skip
    try:
        yield child
    finally:
        if child.poll() is None:
            child.send_signal(signal.SIGINT)
            with contextlib.suppress(subprocess.TimeoutExpired):
                child.wait(5.0)
            child.kill()
        child.wait()


def _shard(number: int, shards: int, stand: Path) -> contextlib.AbstractContextManager[Any]:
    given = {'tree': stand, 'shard.index': number, 'shard.count': shards}
    values = [word for name, value in given.items() for word in ('-p', f'{name}:={value}')]
    places = ['-r', f'__ns:=/shard{number}', '-r', 'wind/filtered:=/wind/filtered']
    return _child(number, [sys.executable, '-c', _SOLVER, '--ros-args', *places, *values])


def _wait_until_ready(host: int, side: subprocess.Popen[bytes], shards: list[Any]) -> None:
    """Wait until a side receives both shards."""
    assert side.stdout is not None
    deadline = time.monotonic() + _START
    os.set_blocking(side.stdout.fileno(), False)
    while not side.stdout.readline():
        ended = [k for k, each in enumerate(shards) if each.poll() is not None]
        if ended or side.poll() is not None or time.monotonic() > deadline:
            raise TransportError(
                f'host {host} does not receive both shards'
                + (f'; shards that ended: {ended}' if ended else ''),
                cure='see that multicast is not cut off, and run a shard by itself',
            )
        select.select([side.stdout], [], [], 0.05)
    os.set_blocking(side.stdout.fileno(), True)


def _let_run(sides: Sequence[subprocess.Popen[bytes]], seconds: float) -> None:
    """Let the sides listen for a time [s]; one that ends before is an error."""
    deadline = time.monotonic() + seconds
    for host, side in enumerate(sides):
        with contextlib.suppress(subprocess.TimeoutExpired):
            side.wait(max(0.0, deadline - time.monotonic()))
            raise TransportError(f'host {host} stopped listening', cure='run the bench again')


def _longest_gap(at: Floats, begin: float, end: float) -> float:
    """Longest time between two arrivals within a time."""
    inside = at[(at > begin) & (at < end)]
    return float(np.diff([begin, *inside, end]).max())


def _first_after(at: list[float], begin: float) -> float:
    """Time to the first arrival after another; infinite if nothing arrives."""
    return min((each - begin for each in at if each > begin), default=float('inf'))
