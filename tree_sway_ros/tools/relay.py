# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway relay``: one tree at several sites, over Zenoh.

One site sends the wind, and a snapshot to whoever joins; the others solve the same tree in it, or
play the state. Where ROS runs, the wind comes from `wind/filtered` and goes to it.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
import contextlib
from pathlib import Path
import queue
import threading
import time
from typing import Any, TextIO

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.checks import within
from tree_sway_ros.core.simulator.settings import FIDELITIES, Settings
from tree_sway_ros.core.wind.intake import WindIntake
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.page.scene_state import SceneState
from tree_sway_ros.page.server import PageServer
from tree_sway_ros.relay.line import Line
from tree_sway_ros.relay.tree_site import Site
from tree_sway_ros.relay.wind_bytes import decode_wind, encode_wind
from tree_sway_ros.ros.process.ending import Ending
from tree_sway_ros.ros.process.listener import Listener
from tree_sway_ros.tools.arguments import (
    add_tree_arguments,
    add_wind_arguments,
    opened_tree,
    opened_wind,
)
from tree_sway_ros.tools.page_arguments import add_page_arguments, page_settings

_MODELS = tuple(name for name in FIDELITIES if name != 'auto')
_WIND_RATE = 20
_LOOK = 0.05
_SECOND = 1_000_000_000
_EVERY = 2  # steps per frame


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add('role', choices=('send', 'receive'), help='the wind')
    add_tree_arguments(parser, default='benjamina')
    add('--listen', action='append', default=[], metavar='tcp/HOST:PORT')
    add('--connect', action='append', default=[], metavar='tcp/HOST:PORT')
    add('--key', default='tree_sway', help="of this tree's line (%(default)s)")
    add('--model', choices=_MODELS, default=Settings().model, help='of the sway (%(default)s)')
    add('--rate', type=int, default=60, help='steps per second (%(default)s)')
    add('--ros', action='store_true', help='wind from, or to, `wind/filtered`')
    add_wind_arguments(parser, 'the record to send, over and over; simulated if left out')
    add('--state', action='store_true', help='send the state as well, to be played')
    add('--play', action='store_true', help='play the state, solve nothing')
    add('--no-snapshot', action='store_true', help='receive from rest')
    add(
        '--lose', type=float, default=0.0, metavar='SHARE', help='of the received wind, as a trial'
    )
    add('-o', '--output', metavar='CSV', help='time and tip of every step')
    add('--seconds', type=float, metavar='N', help='end after so much of the wind')
    add('--pace', type=float, default=1.0, help='send so many times as fast (%(default)s)')
    add('--page', action='store_true', help='serve the page of what is received')
    add_page_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Send or receive until the time is over or Ctrl-C."""
    for name, low, high in (('rate', 1, 1000), ('pace', 0.01, 1000.0), ('lose', 0.0, 1.0)):
        within(f'--{name}', getattr(arguments, name), low, high)
    with contextlib.ExitStack() as stack:
        ending = stack.enter_context(Ending())
        line = stack.enter_context(Line(arguments.key, arguments.listen, arguments.connect))
        _Relay(arguments, line, stack).run(ending)
    return 0


class _Relay:
    """One site of the command."""

    def __init__(
        self, arguments: argparse.Namespace, line: Line, stack: contextlib.ExitStack
    ) -> None:
        self._arguments, self._line = arguments, line
        self._seconds = float('inf') if arguments.seconds is None else arguments.seconds
        self._first = self._last = 0
        self._ros: _RosWind | None = None
        self._scene: SceneState | None = None
        self._server: PageServer | None = None
        self._log: TextIO | None = None
        if arguments.output:
            self._log = stack.enter_context(Path(arguments.output).open('w', encoding='utf-8'))
            print('time,x,y,z', file=self._log)
        if arguments.ros:
            self._ros = stack.enter_context(_RosWind(arguments.role == 'send'))
        if arguments.page:
            self._server = stack.enter_context(PageServer(page_settings(arguments)))
            print(f'page: {self._server.url}', flush=True)
        if arguments.play:
            return
        settings = Settings(model=arguments.model)
        simulator = opened_tree(arguments).simulator(settings, model=arguments.model)
        self._site = Site(simulator, arguments.rate, self._stepped)
        if arguments.page or (arguments.state and arguments.role == 'send'):
            self._scene = SceneState(simulator, is_running=False)
            if self._server is not None:
                self._server.describe(self._scene.description)
        simulator.reset()

    def run(self, ending: Ending) -> None:
        """Do what the role is until the end."""
        ending.look()
        if self._arguments.role == 'send':
            self._send(ending)
        elif self._arguments.play:
            self._play(ending)
        else:
            self._receive(ending)

    def _send(self, ending: Ending) -> None:
        line, site = self._line, self._site
        line.answer('tree', site.identity)
        line.answer('snapshot', site.snapshot)
        if self._scene is not None:
            description = self._scene.description
            line.answer('description', lambda: description)
        print(f'sending the wind of {site.simulator.tree.name}', flush=True)
        intake = WindIntake() if self._ros is None else WindIntake.of_velocities()
        for stamp, vector in self._winds():
            good = intake.offer(stamp, vector)
            if good is not None:
                x, y, z = good.velocity.tolist()
                line.put('wind/filtered', encode_wind(good.time, (x, y, z)))
                site.add_wind(good.time, good.velocity)
            if ending.is_asked or self._passed >= self._seconds:
                return

    def _winds(self) -> Iterator[tuple[int, Any]]:
        """Give samples when they are due: of ROS, a record or the simulation."""
        if self._ros is not None:
            while True:
                yield from map(decode_wind, self._ros.taken(_LOOK))
        arguments = self._arguments
        source = opened_wind(arguments)
        begin, wall, pause = time.monotonic(), time.time_ns(), threading.Event()
        for number in range(1 << 40):
            at = number / _WIND_RATE
            pause.wait(max(0.0, begin + at / arguments.pace - time.monotonic()))
            yield wall + round(at * _SECOND), source.mean(at, at)

    def _receive(self, ending: Ending) -> None:
        line, site, heard = self._line, self._site, queue.SimpleQueue[bytes]()
        line.hear('wind/filtered', heard.put)
        while (identity := line.ask('tree', 1.0)) is None:
            if ending.is_asked:
                return
        site.check(identity.decode())
        snapshot = None
        while not self._arguments.no_snapshot and not snapshot and not ending.is_asked:
            snapshot = line.ask('snapshot', 1.0)
        if snapshot:
            site.join(snapshot.decode())
        print(f'receiving the wind of {site.simulator.tree.name}', flush=True)
        lost = np.random.default_rng(0)
        while not ending.is_asked and self._passed < self._seconds:
            with contextlib.suppress(queue.Empty):
                data = heard.get(timeout=_LOOK)
                if lost.random() < self._arguments.lose:
                    continue
                site.add_wind(*decode_wind(data))
                if self._ros is not None:
                    self._ros.publish(data)
            if self._arguments.pace == 1.0:
                site.hold_wind(time.time_ns())

    def _play(self, ending: Ending) -> None:
        if self._server is None:
            raise ParameterError(
                '--play without --page', cure='say where it is to be seen: --page'
            )
        description = None
        while description is None and not ending.is_asked:
            description = self._line.ask('description', 1.0)
        if description is None:
            return
        self._server.describe(description)
        self._line.hear('frame', self._server.publish)
        end, pause = time.monotonic() + self._seconds, threading.Event()
        while not ending.is_asked and time.monotonic() < end:
            pause.wait(_LOOK)

    @property
    def _passed(self) -> float:
        """How much of the wind was solved [s]."""
        return (self._last - self._first) / _SECOND

    def _stepped(self, stamp: int, _wind: Floats) -> None:
        """Tell what a step has led to."""
        self._first, self._last = self._first or stamp, stamp
        if self._log is not None:
            x, y, z = self._site.simulator.tip_displacement
            print(f'{stamp},{x:.6f},{y:.6f},{z:.6f}', file=self._log)
        if self._scene is None or (stamp * self._site.rate // _SECOND) % _EVERY:
            return
        frame = self._scene.frame(stamp)
        if self._server is not None:
            self._server.publish(frame)
        if self._arguments.role == 'send':
            self._line.put('frame', frame)


class _RosWind(Listener):
    """`wind/filtered` of this site as bytes: heard where it sends, published where it receives."""

    def __init__(self, hears: bool) -> None:
        from tree_sway_ros.ros.process.topics import message_class, qos_profile, WIND_FILTERED

        super().__init__('tree_sway_relay')
        self._heard: list[bytes] = []
        kind, name = message_class(WIND_FILTERED), WIND_FILTERED.name
        quality = qos_profile(WIND_FILTERED)
        self.publish: Callable[[bytes], None] = lambda data: None
        if hears:
            self.node.create_subscription(kind, name, self._heard.append, quality, raw=True)
        else:
            self.publish = self.node.create_publisher(kind, name, quality).publish

    def taken(self, seconds: float) -> list[bytes]:
        """Take what has come, after waiting so long for more [s]."""
        self.spin_once(seconds)
        taken = self._heard.copy()
        self._heard.clear()
        return taken
