# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway relay``: one tree at several sites, over Zenoh.

One site sends the wind, and a snapshot to whoever joins; the others solve the same tree in it.
Where ROS runs, the wind comes from `wind/filtered` and goes to it.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, ExitStack
from functools import partial
from importlib.metadata import entry_points
from pathlib import Path
import sys
import threading
import time
from typing import Any, TextIO

from tree_sway.commands.arguments import (
    add_model_argument,
    add_tree_arguments,
    add_wind_arguments,
    opened_tree,
    opened_wind,
)
from tree_sway.commands.ending import Ending
from tree_sway.commands.page_arguments import add_page_arguments, page_settings
from tree_sway.core.arrays import Floats
from tree_sway.core.checks import within
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.scene_simulator import Simulator
from tree_sway.core.simulator.settings import Settings
from tree_sway.core.wind.intake import GoodWind, WindIntake
from tree_sway.errors import MissingDependencyError, StateError, TreeSwayError
from tree_sway.page.scene_state import SceneState
from tree_sway.page.server import PageServer
from tree_sway.relay.line import Line
from tree_sway.relay.tree_site import Site
from tree_sway.relay.wind_bytes import decode_wind, encode_wind

_WIND_RATE = 20
_LOOK = 0.05
_TRIES = 10
_OPEN = (
    'note: this line is not protected: whoever reaches it may send wind, and read wind and state; '
    '--zenoh-config names certificates or a password (doc/streaming.md, Security of the relay)'
)
_SECOND = 1_000_000_000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add('role', choices=('send', 'receive'), help='the wind')
    add_tree_arguments(parser, default='benjamina')
    add('--listen', action='append', default=[], metavar='tcp/HOST:PORT')
    add('--connect', action='append', default=[], metavar='tcp/HOST:PORT')
    add('--zenoh-config', metavar='FILE', help='JSON5 of Zenoh: TLS, user and password, and more')
    add('--key', default='tree_sway', help="prefix of this tree's keys (%(default)s)")
    add_model_argument(parser)
    add('--rate', type=int, default=60, help='steps per second (%(default)s)')
    add('--ros', action='store_true', help='wind from, or to, `wind/filtered`')
    add_wind_arguments(parser, 'the record to send, over and over; simulated if left out')
    add('-o', '--output', metavar='CSV', help='time and tip of every step')
    add('--seconds', type=float, metavar='N', help='end after this much of the wind')
    add('--page', action='store_true', help='serve the page of what is received')
    add_page_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Send or receive until the time is over or Ctrl-C."""
    within('--rate', arguments.rate, 1, 1000)
    endpoints = arguments.listen, arguments.connect, arguments.zenoh_config
    with Ending() as ending, ExitStack() as stack, Line(arguments.key, *endpoints) as line:
        if not line.is_protected:
            print(_OPEN, file=sys.stderr, flush=True)
        relay = _Relay(arguments, line, stack)
        stack.callback(relay.report)
        ending.look()
        if arguments.role == 'send':
            relay.send(ending)
        else:
            relay.receive(ending)
    return 0


class _Relay:
    """One site of the command."""

    def __init__(self, arguments: argparse.Namespace, line: Line, stack: ExitStack) -> None:
        self._arguments, self._line = arguments, line
        self._seconds = float('inf') if arguments.seconds is None else arguments.seconds
        self._first = self._last = 0
        self._refused, self._pause = Counter[str](), threading.Event()
        self._outputs: list[Callable[[int], object]] = []
        self._ros: Any = None
        if arguments.ros:
            self._ros = stack.enter_context(_ros_wind(arguments.role == 'send'))
        settings = Settings(model=arguments.model)
        simulator = make_simulator(opened_tree(arguments), settings=settings)
        self._site = Site(simulator, arguments.rate, self._stepped)
        if arguments.output:
            log = stack.enter_context(Path(arguments.output).open('w', encoding='utf-8'))
            print('time,x,y,z', file=log)
            self._outputs.append(partial(_log_tip, log, simulator))
        if arguments.page:
            server = stack.enter_context(PageServer(page_settings(arguments)))
            print(f'page: {server.url}', flush=True)
            scene = SceneState(simulator, is_running=False)
            server.describe(scene.description)
            self._outputs.append(lambda stamp: server.publish(scene.frame(stamp)))
        simulator.reset()

    def send(self, ending: Ending) -> None:
        """Send the wind, and answer those who join."""
        line, site = self._line, self._site
        line.answer('snapshot', site.snapshot)
        print(f'sending the wind of {site.simulator.tree.name}', flush=True)
        if self._ros is not None:
            # It has passed the gate of the wind node.
            site.run.intake = WindIntake.of_velocities()
        for stamp, vector in self._winds(ending):
            good = site.add_wind(stamp, vector, time.time_ns())
            if good is not None:
                line.put('wind/filtered', _encoded(good))
            if self._passed >= self._seconds:
                return

    def _winds(self, ending: Ending) -> Iterator[tuple[int, tuple[float, float, float]]]:
        """Give samples when they are due: of ROS, a record or the simulation."""
        source = None if self._ros is not None else opened_wind(self._arguments)
        begin, wall, passed = time.monotonic(), time.time_ns(), -1.0
        while not ending.is_asked:
            if source is None:
                for data in self._ros.taken(_LOOK):
                    with self._refusing('sample of the wind'):
                        yield decode_wind(data)
                self._site.hold_wind(time.time_ns())
                continue
            now = time.monotonic() - begin
            for at, velocity in source.between(passed, now):
                yield wall + round(at * _SECOND), velocity
            self._site.hold_wind(time.time_ns())
            passed = now
            self._pause.wait(1.0 / _WIND_RATE)

    def receive(self, ending: Ending) -> None:
        """Take the wind from where the sender is, or from rest."""
        self._join(ending)
        print(f'receiving the wind of {self._site.simulator.tree.name}', flush=True)
        while not ending.is_asked and self._passed < self._seconds:
            self._site.hold_wind(time.time_ns())
            self._pause.wait(_LOOK)

    def _take(self, data: bytes) -> None:
        """Take a sample that the line passes on, in a thread of its own."""
        with self._refusing('sample of the wind'):
            good = self._site.add_wind(*decode_wind(data), time.time_ns())
            if good is not None and self._ros is not None:
                self._ros.publish(_encoded(good))

    def _join(self, ending: Ending) -> None:
        """
        Wait for a sender and go on from its snapshot, or from rest where none fits in some tries.

        Raises a `StateError` if it has another tree.
        """
        tries = 0
        while tries < _TRIES and not ending.is_asked:
            snapshot, different = self._line.ask('snapshot', 1.0), ''
            if snapshot is None:
                continue
            tries += 1
            if tries == 1:  # no sample between a snapshot and the next may be lost
                self._line.hear('wind/filtered', self._take)
                continue
            with self._refusing('snapshot'):
                different = self._site.differences(snapshot)
                if not different:
                    return self._site.join(snapshot, time.time_ns())
            if different:
                raise StateError(
                    f'the other site has {different}',
                    where=self._site.simulator.tree.name,
                    cure='open the same tree with the same settings and release at both sites',
                )
            self._pause.wait(_LOOK)
        print('no snapshot that fits: going on from rest', file=sys.stderr, flush=True)

    def report(self) -> None:
        """Say what was refused."""
        if refused := self._site.run.counts.refused:
            self._refused['sample by the gate'] = refused
        for what, count in self._refused.items():
            print(f'refused: {count} x {what}', file=sys.stderr, flush=True)

    @contextmanager
    def _refusing(self, what: str) -> Iterator[None]:
        """Count what comes over the line and cannot be read, and go on."""
        try:
            yield
        except TreeSwayError:
            self._refused[what] += 1

    @property
    def _passed(self) -> float:
        """How much of the wind was solved [s]."""
        return (self._last - self._first) / _SECOND

    def _stepped(self, stamp: int, _wind: Floats) -> None:
        """Write down and publish what a step has led to."""
        self._first, self._last = self._first or stamp, stamp
        for output in self._outputs:
            output(stamp)


def _log_tip(log: TextIO, simulator: Simulator, stamp: int) -> None:
    x, y, z = simulator.tip_displacement
    print(f'{stamp},{x:.6f},{y:.6f},{z:.6f}', file=log)


def _encoded(good: GoodWind) -> bytes:
    x, y, z = good.velocity.tolist()
    return encode_wind(good.time, (x, y, z))


def _ros_wind(hears: bool) -> Any:
    """Return the wind of the ROS graph, as the package of the nodes gives it."""
    for point in entry_points(group='tree_sway.wind', name='ros'):
        return point.load()(hears)
    raise MissingDependencyError('--ros needs the nodes: pip install "tree_sway_ros[ros]"')
