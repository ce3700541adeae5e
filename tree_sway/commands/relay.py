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
from collections.abc import Iterator
import contextlib
from functools import partial
from importlib.metadata import entry_points
from pathlib import Path
import queue
import sys
import threading
import time
from typing import Any, TextIO

import numpy as np

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
from tree_sway.core.simulator.settings import Settings
from tree_sway.core.wind.intake import WindIntake
from tree_sway.errors import MissingDependencyError, StateError, TreeSwayError
from tree_sway.page.scene_state import SceneState
from tree_sway.page.server import PageServer
from tree_sway.relay.line import Line
from tree_sway.relay.tree_site import Site
from tree_sway.relay.wind_bytes import decode_wind, encode_wind

_WIND_RATE = 20
_LOOK = 0.05
_TRIES = 10
_MOST_WAITING = 1000
_OPEN = (
    'note: this line is not protected: whoever reaches it may send wind, and read wind and state; '
    '--zenoh-config names certificates or a password (doc/streaming.md, Security of the relay)'
)
_SECOND = 1_000_000_000
_EVERY = 2  # steps per frame


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
    add('--no-snapshot', action='store_true', help='receive from rest')
    add('--lose', type=float, default=0.0, metavar='SHARE', help='lose some wind, as a trial')
    add('-o', '--output', metavar='CSV', help='time and tip of every step')
    add('--seconds', type=float, metavar='N', help='end after this much of the wind')
    add('--page', action='store_true', help='serve the page of what is received')
    add_page_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Send or receive until the time is over or Ctrl-C."""
    for name, low, high in (('rate', 1, 1000), ('lose', 0.0, 1.0)):
        within(f'--{name}', getattr(arguments, name), low, high)
    endpoints = arguments.listen, arguments.connect, arguments.zenoh_config
    with contextlib.ExitStack() as stack:
        ending = stack.enter_context(Ending())
        line = stack.enter_context(Line(arguments.key, *endpoints))
        if not line.is_protected:
            print(_OPEN, file=sys.stderr, flush=True)
        relay = _Relay(arguments, line, stack)
        stack.callback(relay.report)
        relay.run(ending)
    return 0


class _Relay:
    """One site of the command."""

    def __init__(
        self, arguments: argparse.Namespace, line: Line, stack: contextlib.ExitStack
    ) -> None:
        self._arguments, self._line = arguments, line
        self._seconds = float('inf') if arguments.seconds is None else arguments.seconds
        self._first = self._last = 0
        self._refused, self._pause = Counter[str](), threading.Event()
        self._ros: Any = None
        self._scene: SceneState | None = None
        self._server: PageServer | None = None
        self._log: TextIO | None = None
        if arguments.output:
            self._log = stack.enter_context(Path(arguments.output).open('w', encoding='utf-8'))
            print('time,x,y,z', file=self._log)
        if arguments.ros:
            self._ros = stack.enter_context(_ros_wind(arguments.role == 'send'))
        if arguments.page:
            self._server = stack.enter_context(PageServer(page_settings(arguments)))
            print(f'page: {self._server.url}', flush=True)
        settings = Settings(model=arguments.model)
        simulator = make_simulator(opened_tree(arguments), settings=settings)
        self._site = Site(simulator, arguments.rate, self._stepped)
        if self._server is not None:
            self._scene = SceneState(simulator, is_running=False)
            self._server.describe(self._scene.description)
        simulator.reset()

    def run(self, ending: Ending) -> None:
        """Do what the role is until the end."""
        ending.look()
        if self._arguments.role == 'send':
            self._send(ending)
        else:
            self._receive(ending)

    def _send(self, ending: Ending) -> None:
        line, site = self._line, self._site
        line.answer('tree', site.identity)
        line.answer('snapshot', site.snapshot)
        print(f'sending the wind of {site.simulator.tree.name}', flush=True)
        if self._ros is not None:
            # It has passed the gate of the wind node.
            site.run.intake = WindIntake.of_velocities()
        for stamp, vector in self._winds(ending):
            good = site.add_wind(stamp, vector, time.time_ns())
            if good is not None:
                x, y, z = good.velocity.tolist()
                line.put('wind/filtered', encode_wind(good.time, (x, y, z)))
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

    def _receive(self, ending: Ending) -> None:
        line, site, heard = self._line, self._site, queue.Queue[bytes](_MOST_WAITING)
        line.hear('wind/filtered', partial(self._put, heard))
        if not self._agree(ending) or not self._join(ending):
            return
        print(f'receiving the wind of {site.simulator.tree.name}', flush=True)
        lost = np.random.default_rng(0)
        while not ending.is_asked and self._passed < self._seconds:
            with contextlib.suppress(queue.Empty), self._refusing('sample of the wind'):
                data = heard.get(timeout=_LOOK)
                if lost.random() < self._arguments.lose:
                    continue
                good = site.add_wind(*decode_wind(data), time.time_ns())
                if good is not None and self._ros is not None:
                    x, y, z = good.velocity.tolist()
                    self._ros.publish(encode_wind(good.time, (x, y, z)))
            site.hold_wind(time.time_ns())

    def _agree(self, ending: Ending) -> bool:
        """Wait for a sender; raises a `StateError` if it has another tree. False at the end."""
        while not ending.is_asked:
            identity = self._line.ask('tree', 1.0)
            if identity is None:
                continue
            different = None
            with self._refusing('identity of a sender'):
                different = self._site.differences(identity)
            if different:
                raise StateError(
                    f'the other site has {different}',
                    where=self._site.simulator.tree.name,
                    cure='open the same tree with the same settings and release at both sites',
                )
            if different is not None:
                return True
            self._pause.wait(_LOOK)
        return False

    def _join(self, ending: Ending) -> bool:
        """Set a snapshot, or go on from rest where none fits in some tries. False at the end."""
        for _ in range(0 if self._arguments.no_snapshot else _TRIES):
            if ending.is_asked:
                return False
            snapshot = self._line.ask('snapshot', 1.0)
            if snapshot:
                with self._refusing('snapshot'):
                    self._site.join(snapshot, time.time_ns())
                    return True
        if not self._arguments.no_snapshot:
            print('no snapshot that fits: going on from rest', file=sys.stderr, flush=True)
        return True

    def report(self) -> None:
        """Say what was refused."""
        if refused := self._site.run.counts.refused:
            self._refused['sample by the gate'] = refused
        for what, count in self._refused.items():
            print(f'refused: {count} x {what}', file=sys.stderr, flush=True)

    @contextlib.contextmanager
    def _refusing(self, what: str) -> Iterator[None]:
        """Count what comes over the line and cannot be read, and go on."""
        try:
            yield
        except TreeSwayError:
            self._refused[what] += 1

    def _put(self, heard: queue.Queue[bytes], data: bytes) -> None:
        try:
            heard.put_nowait(data)
        except queue.Full:
            self._refused['sample that came too fast'] += 1

    @property
    def _passed(self) -> float:
        """How much of the wind was solved [s]."""
        return (self._last - self._first) / _SECOND

    def _stepped(self, stamp: int, _wind: Floats) -> None:
        """Write down and publish what a step has led to."""
        self._first, self._last = self._first or stamp, stamp
        if self._log is not None:
            x, y, z = self._site.simulator.tip_displacement
            print(f'{stamp},{x:.6f},{y:.6f},{z:.6f}', file=self._log)
        if self._scene is None or (stamp // self._site.run.period) % _EVERY:
            return
        if self._server is not None:
            self._server.publish(self._scene.frame(stamp))


def _ros_wind(hears: bool) -> Any:
    """Return the wind of the ROS graph, as the package of the nodes gives it."""
    for point in entry_points(group='tree_sway.wind', name='ros'):
        return point.load()(hears)
    raise MissingDependencyError('--ros needs the nodes: pip install "tree_sway_ros[ros]"')
