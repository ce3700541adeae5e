"""
``tree-sway demo``: a tree sways in wind, all nodes in one process, over real DDS.

What it prints is what a subscriber receives, not what the solver believes to have sent.

"""

from __future__ import annotations

import argparse
import math
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from tree_sway_ros.core.settings import RUNGS
from tree_sway_ros.core.tree import Floats, Tree
from tree_sway_ros.errors import ParameterError, TransportError
from tree_sway_ros.importers.tree_source import open_tree
from tree_sway_ros.ros.composition import Composition
from tree_sway_ros.ros.parameters import Value
from tree_sway_ros.tools.stream_monitor import StreamMonitor, StreamRecord

_LONGEST_START, _SETTLING = 30.0, 0.5
_LIVE_PERIOD, _LOG_PERIOD = 0.2, 5.0
_WINDOW = 2.0
_COMPASS = ("E", "NE", "N", "NW", "W", "SW", "S", "SE")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "--tree",
        default="benjamina",
        help="benjamina, goldcrest, broadleaf, or a file (%(default)s)",
    )
    parser.add_argument("--wind", metavar="FILE", help="a wind record to play; simulated if left out")
    parser.add_argument(
        "--speed", type=float, default=6.0, metavar="U", help="mean of the simulated wind [m/s] (%(default)s)"
    )
    parser.add_argument("--seconds", type=float, metavar="N", help="end after so long; else by Ctrl-C")
    parser.add_argument("--rate", type=float, default=60.0, help="poses a second [Hz] (%(default)s)")
    parser.add_argument("--fidelity", choices=RUNGS, default="subtree", help="model of the sway (%(default)s)")


def run(arguments: argparse.Namespace) -> int:
    """Run the demo until its time is over, the record ends, or Ctrl-C."""
    begin = math.inf
    seconds = math.inf if arguments.seconds is None else arguments.seconds
    if not seconds > 0.0:
        raise ParameterError(f"{seconds:g} s is no time to run", where="--seconds", cure="give more than 0")
    tree = open_tree(arguments.tree).tree
    print(f"{tree.name}: {size_of(tree)}; starting (the first start compiles, up to a minute)", flush=True)
    try:
        with interrupted_once(), Composition(_nodes(arguments)) as nodes:
            monitor = StreamMonitor(nodes.context, tree)
            try:
                begin = _settled(nodes, monitor)
                _watch(nodes, monitor, begin, begin + seconds)
            except KeyboardInterrupt:
                print()
            finally:
                monitor.close()
    except KeyboardInterrupt:
        return 0
    print(summary(monitor.record.since(begin), arguments.rate))
    return 0


@contextmanager
def interrupted_once() -> Iterator[None]:
    """
    Turn the first Ctrl-C or SIGTERM into KeyboardInterrupt and be deaf to others.

    A second one, while threads and middleware close, would end the process halfway; so it stays
    deaf until the process ends.

    """
    numbers = (signal.SIGINT, signal.SIGTERM)

    def interrupt(_number: int, _frame: object) -> None:
        for number in numbers:
            signal.signal(number, signal.SIG_IGN)
        raise KeyboardInterrupt

    before = [signal.signal(number, interrupt) for number in numbers]
    yield
    for number, handler in zip(numbers, before, strict=True):
        if signal.getsignal(number) is interrupt:
            signal.signal(number, handler)


def size_of(tree: Tree) -> str:
    """Number of branches and segments, and height, for people."""
    return f"{tree.n_branches} branches, {tree.n_segments} segments, {tree.height:.2f} m"


def _nodes(arguments: argparse.Namespace) -> dict[str, dict[str, Value]]:
    solver = {"tree": arguments.tree, "rate": arguments.rate, "fidelity": arguments.fidelity}
    if arguments.wind is None:
        return {"anemometer": {"mean_speed": arguments.speed}, "wind": {}, "solver": solver}
    return {"player": {"file": arguments.wind}, "wind": {}, "solver": solver}


def _settled(nodes: Composition, monitor: StreamMonitor) -> float:
    """Wait until poses come and what had queued up at the start is through; return the time then."""
    deadline = time.monotonic() + _LONGEST_START
    while not monitor.record.arrival:
        monitor.wait(0.1)
        nodes.check()
        if time.monotonic() > deadline:
            raise TransportError(
                f"no poses within {_LONGEST_START:g} s",
                cure="check that multicast works on this machine, or set ROS_LOCALHOST_ONLY=1",
            )
    monitor.wait(_SETTLING)
    return time.time()


def _watch(nodes: Composition, monitor: StreamMonitor, begin: float, end: float) -> None:
    """Receive until a time, with a line that follows what comes."""
    is_live = sys.stdout.isatty()
    period = _LIVE_PERIOD if is_live else _LOG_PERIOD
    while not nodes.is_done and (left := end - time.time()) > 0.0:
        monitor.wait(min(period, left))
        nodes.check()
        now = time.time()
        line = status_line(monitor.record.since(now - _WINDOW), now - begin)
        print(f"\r\033[K{line}" if is_live else line, end="" if is_live else "\n", flush=True)
    if is_live:
        print()


def status_line(latest: StreamRecord, elapsed: float) -> str:
    """One line about the last two seconds of a stream."""
    wind = "wind none yet"
    if latest.wind:
        wind = f"wind {_speed(latest.wind[-1]):4.1f} m/s {_from(latest.wind[-1]):>7} at {latest.wind_rate:4.1f} Hz"
    tip = f"{1e3 * float(np.linalg.norm(latest.tip[-1])):6.1f} mm" if latest.tip else "  none"
    late = f"{1e3 * latest.latency(0.5):.2f} ms (p95 {1e3 * latest.latency(0.95):.2f})"
    return f"{elapsed:6.1f} s | {wind} | tip {tip} | poses {latest.pose_rate:5.1f} Hz, latency {late}"


def summary(record: StreamRecord, rate: float) -> str:
    """Several lines about a whole stream; `rate` is the one it was meant to have in [Hz]."""
    missing = record.missing(rate)
    late = [1e3 * record.latency(share) for share in (0.5, 0.95, 1.0)]
    lines = [
        f"poses    {len(record.arrival)} at {record.pose_rate:.2f} Hz (wanted {rate:g}), "
        f"{missing or 'none'} missing",
        f"latency  p50 {late[0]:.2f}, p95 {late[1]:.2f}, max {late[2]:.2f} ms",
    ]
    if record.wind:
        speed = [_speed(vector) for vector in record.wind]
        lines.append(
            f"wind     {len(speed)} at {record.wind_rate:.2f} Hz, mean {np.mean(speed):.2f}, "
            f"max {np.max(speed):.2f} m/s, {_from(np.mean(record.wind, axis=0))}"
        )
    if record.tip:
        tip = np.array(record.tip)
        way = 1e3 * np.linalg.norm(tip, axis=1)
        east, north, up = 1e3 * tip.mean(axis=0)
        lines.append(
            f"tip      {way.mean():.1f} mm from rest on average, {way.max():.1f} at most; "
            f"mean {east:+.1f} east, {north:+.1f} north, {up:+.1f} up"
        )
    return "\n".join(lines)


def _speed(vector: Floats) -> float:
    return float(np.linalg.norm(vector))


def _from(vector: Floats) -> str:
    """Where the wind comes from, as people say it."""
    if _speed(vector) < 0.05:
        return "calm"
    octant = round(math.atan2(-vector[1], -vector[0]) / (math.pi / 4.0)) % 8
    return f"from {_COMPASS[octant]}"
