# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway soak``: the whole chain through every fault of a sensor, for hours; what it costs."""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tree_sway_ros.errors import ParameterError, TransportError
from tree_sway_ros.files.trees.source import open_scene
from tree_sway_ros.ros.process.composition import Composition
from tree_sway_ros.ros.process.ending import LONGEST, Ending
from tree_sway_ros.tools.stream.monitor import StreamMonitor
from tree_sway_ros.tools.stream.only_demo import only_demo
from tree_sway_ros.tools.stream.text import summary

_WARM = 0.2
"""Share of the time, at its beginning, whose growth is start and not leak."""
_HOUR = 3600.0
_LINES = 60


class Health(NamedTuple):
    """Of this process: time since the start [s], memory [MB], open handles, threads."""

    time: float
    memory: float
    handles: int
    threads: int


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("--hours", type=float, default=1.0, help="how long (%(default)s)")
    parser.add_argument("--tree", default="goldcrest", help="what sways (%(default)s)")
    parser.add_argument(
        "--every", type=float, default=20.0, help="seconds from fault to fault (%(default)s)"
    )
    parser.add_argument(
        "--speed",
        type=float,
        default=1.0,
        metavar="K",
        help="K times as many frames and faults, and samples up to 100 per second (%(default)s)",
    )
    parser.add_argument(
        "--slope",
        type=float,
        default=1.0,
        metavar="MB",
        help="largest growth of memory per hour [MB/h] (%(default)s)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the chain, then tell what it took; 1 if memory grew, or a callback failed."""
    if not arguments.hours > 0.0:
        raise ParameterError(f"{arguments.hours:g} h is no time to run", where="--hours")
    if not 0.1 <= arguments.speed <= 10.0:
        what = f"{arguments.speed:g} times as fast is none of 0.1 to 10"
        raise ParameterError(what, where="--speed")
    tree = open_scene(arguments.tree).tree
    seconds, rate = _HOUR * arguments.hours, 60.0 * arguments.speed
    anemometer = {
        "rate": min(100.0, 20.0 * arguments.speed),
        "fault": "all",
        "fault_every": arguments.every / arguments.speed,
        "fault_duration": 0.25 * arguments.every / arguments.speed,
    }
    seen: list[Health] = []
    failed = restarted = 0
    with (
        Ending() as ending,
        only_demo(),
        Composition({}) as nodes,
        StreamMonitor(nodes.context, tree) as monitor,
    ):
        monitor.expect_silence()
        nodes.add("anemometer", anemometer)
        nodes.add("wind", {})
        solver = nodes.add("solver", {"tree": arguments.tree, "rate": rate})
        nodes.add("viewer", {"port": 0})
        ending.look()
        ending.limit = LONGEST
        monitor.spin(1.0)
        monitor.count_anew()
        begin = time.monotonic()
        period = min(60.0, max(0.5, seconds / _LINES))
        while (since := time.monotonic() - begin) < seconds and not ending.is_asked:
            nodes.check()
            seen.append(health(since))
            print(_line(seen[-1], monitor.record.pose_rate), flush=True)
            monitor.spin(min(period, seconds - since))
        failed = sum(node.guard.count for node in nodes.nodes)
        restarted = solver.simulator.counts.restarted
        print(summary(monitor.totals, rate), flush=True)
        if not monitor.totals.arrivals.count:
            raise TransportError("no poses came")
    slope, error = growth(seen)
    told = f"{slope:+.2f} +- {error:.2f} MB/h" if np.isfinite(slope) else "too short to tell"
    print(f"memory   {told} after the first fifth, of all nodes in one process, page included")
    print(f"failed   {failed} callbacks; {restarted} restarts of the motion")
    return int(failed > 0 or restarted > 0 or slope > arguments.slope)


def health(since: float) -> Health:
    """Look at this process, a time after the start [s]."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    words = dict(line.split(":", 1) for line in status.splitlines())
    handles = len(os.listdir("/proc/self/fd"))
    return Health(since, int(words["VmRSS"].split()[0]) / 1024.0, handles, int(words["Threads"]))


def growth(seen: list[Health]) -> tuple[float, float]:
    """
    Slope of the memory after the warm-up, and its standard error, in [MB/h]; NaN from fewer than
    ten looks.

    """
    table = np.array([(each.time, each.memory) for each in seen])
    if len(table):
        table = table[table[:, 0] >= _WARM * table[-1, 0]]
    if len(table) < 10:
        return float("nan"), float("nan")
    line, covariance = np.polyfit(table[:, 0] / _HOUR, table[:, 1], 1, cov=True)
    return float(line[0]), float(np.sqrt(covariance[0, 0]))


def _line(now: Health, rate: float) -> str:
    return (
        f"{now.time:8.1f} s | memory {now.memory:7.1f} MB | handles {now.handles:4d} | "
        f"threads {now.threads:3d} | poses {rate:5.1f} Hz"
    )
