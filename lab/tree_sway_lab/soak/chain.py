# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The nodes of ROS through every fault of a sensor, for hours; a page is followed."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
import contextlib
import socket
import subprocess
import sys
import time
from typing import Any

from tree_sway.commands import Ending
from tree_sway.errors import TransportError
from tree_sway.stream import StreamClient
from tree_sway_lab.soak.health import check, has_grown, Health, health, line_of, period_of
from tree_sway_ros.commands.monitor import StreamMonitor
from tree_sway_ros.commands.text import summary
from tree_sway_ros.process import DIAGNOSTICS, message_class, qos_profile

_PATIENCE = 180.0
"""Until poses come [s]: the first start compiles."""
_NODE = 'from tree_sway_ros.nodes.executables import {0}; raise SystemExit({0}())'


def soak_chain(arguments: argparse.Namespace, seconds: float, rate: float) -> int:
    """Run the chain, then report what it took; 1 if memory grew, or a callback failed."""
    every = arguments.every / arguments.rate
    port, code = _free_port(), 0
    with Ending() as ending, StreamMonitor(None, None) as monitor:
        monitor.expect_silence()
        reports = _Reports(monitor.node)
        with _running(_commands(arguments, rate, port)) as processes:
            ending.look()
            ending.limit = 2.0 * Ending.LONGEST
            _wait_for_poses(monitor, processes, ending)
            _set_faults(monitor, every)
            seen: dict[str, list[Health]] = {name: [] for name in processes}
            with StreamClient(f'http://127.0.0.1:{port}/') as page:
                page.wait(_PATIENCE)
                monitor.spin(1.0)  # what had queued up is through
                monitor.restart()
                reports.begin()
                begin, period = time.monotonic(), period_of(seconds)
                while (since := time.monotonic() - begin) < seconds and not ending.is_asked:
                    for name, process in processes.items():
                        check(name, process)
                        seen[name].append(health(since, process.pid))
                    print(line_of(seen, monitor.take_recent().poses.rate), flush=True)
                    monitor.spin(min(period, seconds - since))
        code = _told(monitor, reports, seen, rate, arguments.slope)
    return code


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
        command = [sys.executable, '-m', 'tree_sway', 'demo', arguments.tree]
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
                process.wait(2.0 * Ending.LONGEST)
            process.kill()


def _wait_for_poses(
    monitor: StreamMonitor, processes: Mapping[str, subprocess.Popen[bytes]], ending: Ending
) -> None:
    deadline = time.monotonic() + _PATIENCE
    while not (monitor.totals.poses.count and monitor.totals.wind.count) and not ending.is_asked:
        for name, process in processes.items():
            check(name, process)
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
    is_larger = has_grown(seen, limit)
    print(f'failed   {reports.failed} callbacks; {reports.restarted} restarts of the motion')
    return int(is_larger or reports.failed > 0 or reports.restarted > 0)


def _free_port() -> int:
    with socket.socket() as trial:
        trial.bind(('127.0.0.1', 0))
        return int(trial.getsockname()[1])
