# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway lab soak``: the whole chain through every fault of a sensor, for hours; what it costs.

Every node is a process of its own, or all are in one, as the demo has them. A page is followed, so
that the viewer has something to do. ``--page`` runs a page without ROS instead, with instruments.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
import contextlib
import os
from pathlib import Path
import socket
import subprocess
import sys
import time
from typing import Any, NamedTuple

import numpy as np

from tree_sway.commands import Ending, LONGEST
from tree_sway.errors import ParameterError, TransportError
from tree_sway.files.trees import open_scene
from tree_sway.stream import StreamClient
from tree_sway_lab.soak.page_soak import PageSoak
from tree_sway_ros.commands.monitor import StreamMonitor
from tree_sway_ros.commands.text import summary
from tree_sway_ros.process import DIAGNOSTICS, message_class, qos_profile

_WARM, _WARM_SHARE = 600.0, 0.2
"""Time at the beginning whose growth is start and not leak [s]; its largest share of a run."""
_HOUR = 3600.0
_LINES = 60
_PATIENCE = 180.0
"""Until poses come [s]: the first start compiles."""
_NODE = 'from tree_sway_ros.nodes.executables import {0}; raise SystemExit({0}())'


class Health(NamedTuple):
    """Health of a process: time since the start [s], memory [MiB], open handles, threads."""

    time: float
    memory: float
    handles: int
    threads: int


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add('--hours', type=float, default=1.0, help='how long (%(default)s)')
    add('--tree', default='goldcrest', help='what sways (%(default)s)')
    add('--demo', action='store_true', help='all in one process, as the demo; else one per node')
    add(
        '--page', action='store_true',
        help='without ROS: a page with four clients, an anemometer and two motion sensors',
    )
    add('--every', type=float, default=20.0, help='seconds from fault to fault (%(default)s)')
    add(
        '--rate',
        type=float,
        default=1.0,
        metavar='K',
        help='K times as many frames and faults (%(default)s)',
    )
    add(
        '--slope',
        type=float,
        default=0.1,
        metavar='MIB',
        help='largest growth of the memory of a process after ten minutes [MiB/h] (%(default)s)',
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the chain, then report what it took; 1 if memory grew, or a callback failed."""
    if not arguments.hours > 0.0:
        raise ParameterError(f'{arguments.hours:g} h is no time to run', where='--hours')
    if not 0.1 <= arguments.rate <= 10.0:
        what = f'{arguments.rate:g} is no rate within 0.1 to 10'
        raise ParameterError(what, where='--rate')
    open_scene(arguments.tree)  # refuses what is no tree
    seconds, rate, every = (
        _HOUR * arguments.hours,
        60.0 * arguments.rate,
        arguments.every / arguments.rate,
    )
    if arguments.page:
        return _soak_page(arguments, seconds, rate)
    port, code = _free_port(), 0
    with Ending() as ending, StreamMonitor(None, None) as monitor:
        monitor.expect_silence()
        reports = _Reports(monitor.node)
        with _running(_commands(arguments, rate, port)) as processes:
            ending.look()
            ending.limit = 2.0 * LONGEST
            _wait_for_poses(monitor, processes, ending)
            _set_faults(monitor, every)
            seen: dict[str, list[Health]] = {name: [] for name in processes}
            with StreamClient(f'http://127.0.0.1:{port}/') as page:
                page.wait(_PATIENCE)
                monitor.spin(1.0)  # what had queued up is through
                monitor.restart()
                reports.begin()
                begin, period = time.monotonic(), min(60.0, max(0.5, seconds / _LINES))
                while (since := time.monotonic() - begin) < seconds and not ending.is_asked:
                    for name, process in processes.items():
                        _check(name, process)
                        seen[name].append(health(since, process.pid))
                    print(_line(seen, monitor.take_recent().poses.rate), flush=True)
                    monitor.spin(min(period, seconds - since))
        code = _told(monitor, reports, seen, rate, arguments.slope)
    return code


def health(since: float, process: int | str = 'self') -> Health:
    """Look at a process, this one if none is named, a time after the start [s]."""
    where = Path(f'/proc/{process}')
    # Counted page by page; the figure of `status` is some 100 kB off.
    pages = (where / 'smaps_rollup').read_text(encoding='ascii').splitlines()
    memory = next(int(line.split()[1]) for line in pages if line.startswith('Rss:'))
    handles, threads = (len(os.listdir(where / of)) for of in ('fd', 'task'))
    return Health(since, memory / 1024.0, handles, threads)


def growth(seen: list[Health]) -> tuple[float, float]:
    """Slope of the memory after warm-up and its standard error [MiB/h]; NaN below ten looks."""
    table = np.array([(each.time, each.memory) for each in seen])
    if len(table):
        table = table[table[:, 0] >= min(_WARM, _WARM_SHARE * table[-1, 0])]
    if len(table) < 10:
        return float('nan'), float('nan')
    line, covariance = np.polyfit(table[:, 0] / _HOUR, table[:, 1], 1, cov=True)
    return float(line[0]), float(np.sqrt(covariance[0, 0]))


def _soak_page(arguments: argparse.Namespace, seconds: float, rate: float) -> int:
    """Run a page with its instruments and clients, then report what it took."""
    with Ending() as ending, PageSoak(arguments.tree, rate) as page:
        page.wait(ending)
        seen, slowest = list[Health](), list[float]()
        begin, period = time.monotonic(), min(60.0, max(0.5, seconds / _LINES))
        while (since := time.monotonic() - begin) < seconds and not ending.is_asked:
            _check('page', page.process)
            seen.append(health(since, page.process.pid))
            time.sleep(min(period, seconds - since))
            slowest.append(min(page.rates()))
            print(_line({'page': seen}, slowest[-1]), flush=True)
        _check('page', page.process)
        told = ', '.join(f'{least:.1f}' for least in np.percentile(slowest, (0, 5, 50)))
        print(f'slowest  client of four: {told} Hz (least, 5 %, median) of {rate:g} wanted')
        print(f'sent     {page.sent} samples; {page.unreadable} unreadable messages')
        print(f'status   {page.status}')
        has_grown = _has_grown({'page': seen}, arguments.slope)
    return int(has_grown or page.unreadable > 0)


class _Reports:
    """What the nodes report of themselves on `/diagnostics`, the newest of each."""

    def __init__(self, node: Any) -> None:
        self._newest: dict[str, dict[str, str]] = {}
        self._before = 0, 0
        node.create_subscription(
            message_class(DIAGNOSTICS), DIAGNOSTICS.name, self._take, qos_profile(DIAGNOSTICS)
        )

    def _take(self, message: Any) -> None:
        for status in message.status:
            self._newest[status.name] = {each.key: each.value for each in status.values}

    def _sum(self, status: str, value: str) -> int:
        found = (said for name, said in self._newest.items() if name.endswith(f': {status}'))
        return sum(int(said.get(value, 0)) for said in found)

    def begin(self) -> None:
        """Count frames from here on."""
        self._before = self._solver('frames'), self._solver('skipped')

    def _solver(self, value: str) -> int:
        return int(self._newest.get('solver: output', {}).get(value, 0))

    @property
    def skipped(self) -> float:
        """Share of the solver's frames that were skipped since the beginning."""
        frames, skipped = (
            self._solver(value) - before
            for value, before in zip(('frames', 'skipped'), self._before, strict=True)
        )
        return skipped / max(1, frames + skipped)

    @property
    def failed(self) -> int:
        """Callbacks that failed, in all nodes."""
        return self._sum('callbacks', 'failed')

    @property
    def restarted(self) -> int:
        """Restarts of the motion."""
        return self._sum('model', 'restarted')


def _commands(arguments: argparse.Namespace, rate: float, port: int) -> dict[str, list[str]]:
    """Return what to run, by the name of the process."""
    if arguments.demo:
        command = [sys.executable, '-m', 'tree_sway.commands.cli', 'demo', arguments.tree]
        return {'demo': [*command, '--rate', f'{rate}', '--port', f'{port}']}
    figures = {
        'anemometer': [f'rate:={min(100.0, 20.0 * arguments.rate)}'],
        'wind': [],
        'solver': [f'tree:={arguments.tree}', f'rate:={rate}'],
        'viewer': [f'port:={port}'],
    }
    return {
        name: [sys.executable, '-c', _NODE.format(name), '--ros-args']
        + [word for value in values for word in ('-p', value)]
        for name, values in figures.items()
    }


@contextlib.contextmanager
def _running(commands: Mapping[str, list[str]]) -> Iterator[dict[str, subprocess.Popen[bytes]]]:
    processes: dict[str, subprocess.Popen[bytes]] = {}
    try:
        for name, command in commands.items():
            processes[name] = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        yield processes
    finally:
        for process in processes.values():
            process.terminate()
        for process in processes.values():
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(2.0 * LONGEST)
            process.kill()


def _check(name: str, process: subprocess.Popen[bytes]) -> None:
    if process.poll() is not None:
        raise TransportError(f'{name} has ended with {process.returncode}')


def _wait_for_poses(
    monitor: StreamMonitor, processes: Mapping[str, subprocess.Popen[bytes]], ending: Ending
) -> None:
    deadline = time.monotonic() + _PATIENCE
    while not (monitor.totals.poses.count and monitor.totals.wind.count) and not ending.is_asked:
        for name, process in processes.items():
            _check(name, process)
        if time.monotonic() > deadline:
            raise TransportError(f'no poses within {_PATIENCE:g} s')
        monitor.spin(0.1)


def _set_faults(monitor: StreamMonitor, every: float) -> None:
    """Have the anemometer go through all faults, one after a time [s]."""
    from rcl_interfaces.srv import SetParametersAtomically
    from rclpy.parameter import Parameter

    values = {'fault': 'all', 'fault_every': every, 'fault_duration': 0.25 * every}
    wanted = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
    service = 'anemometer/set_parameters_atomically'
    client = monitor.node.create_client(SetParametersAtomically, service)
    deadline = time.monotonic() + _PATIENCE
    while not client.service_is_ready() and time.monotonic() < deadline:
        monitor.spin(0.1)
    answer = client.call_async(SetParametersAtomically.Request(parameters=wanted))
    while not answer.done() and time.monotonic() < deadline:
        monitor.spin(0.1)
    if not (answer.done() and answer.result().result.successful):
        raise TransportError('the anemometer takes no faults', where=service)


def _told(
    monitor: StreamMonitor,
    reports: _Reports,
    seen: Mapping[str, list[Health]],
    rate: float,
    limit: float,
) -> int:
    """Print what it took; 1 if something is wrong."""
    print(summary(monitor.totals, rate))
    print(f"skipped  {100.0 * reports.skipped:.4f} % of the solver's frames")
    has_grown = _has_grown(seen, limit)
    print(f'failed   {reports.failed} callbacks; {reports.restarted} restarts of the motion')
    return int(has_grown or reports.failed > 0 or reports.restarted > 0)


def _has_grown(seen: Mapping[str, list[Health]], limit: float) -> bool:
    """Print what processes took; whether the memory of one grew by more than a limit [MiB/h]."""
    has_grown = False
    for name, looks in seen.items():
        slope, error = growth(looks)
        has_grown |= slope > limit
        rise = 'too short for a figure'
        if np.isfinite(slope):
            rise = f'{slope:+.3f} +- {error:.3f} MiB/h'
        last = looks[-1]
        print(
            f'memory   {name} {rise} after warm-up, {last.memory:.2f} MiB at the end; '
            f'handles {looks[0].handles} to {last.handles}, threads {last.threads}'
        )
    return has_grown


def _line(seen: Mapping[str, list[Health]], rate: float) -> str:
    memories = ', '.join(f'{name} {looks[-1].memory:.2f}' for name, looks in seen.items())
    now = next(iter(seen.values()))[-1].time
    return f'{now:8.1f} s | memory [MiB] {memories} | poses {rate:5.1f} Hz'


def _free_port() -> int:
    with socket.socket() as trial:
        trial.bind(('127.0.0.1', 0))
        return int(trial.getsockname()[1])
