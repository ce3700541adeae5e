# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway lab fuzz``: damaged messages to every reader of a line, each in a process of its own.

Afterwards each is offered good messages alone: it must be there, take them, and be no larger.
Damaged files are tried by ``test/files/test_fuzz.py``.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager, suppress
import json
from pathlib import Path
import re
import socket
import subprocess
import sys
import tempfile
import time

from tree_sway.commands import Ending
from tree_sway.errors import ParameterError, TransportError
from tree_sway.stream import StreamClient
from tree_sway_lab.fuzz.doors import Door, doors, Offer, offering
from tree_sway_lab.soak.health import Health, health

_AFTERWARDS = 40.0
"""Longest time until a good message is taken, after those that are damaged [s]."""
_FRAMES = 5
_FAULT = re.compile(r'Traceback|(?<!Connection)(?<!Timeout)\b[A-Z]\w*(?:Error|Exception): .*')
"""What a process says where an exception of Python was not foreseen."""
_LARGEST_GROWTH = 30.0
"""Growth of a process after a fifth of the time that is no leak [MiB]."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add('--minutes', type=float, default=10.0, help='how long (%(default)s)')
    add('--seed', type=int, default=1, help='seed of the damage (%(default)s)')
    add('--only', metavar='NAME', help='one reader alone, as "Modbus TCP"')


def run(arguments: argparse.Namespace) -> int:
    """Offer, then report; 1 if a process ended, is deaf, says an exception or grew."""
    if not 0.0 < arguments.minutes <= 600.0:
        raise ParameterError(f'{arguments.minutes:g} min is no time to run', where='--minutes')
    seconds = 60.0 * arguments.minutes
    with tempfile.TemporaryDirectory() as folder, Ending() as ending:
        with _served(Path(folder)) as (page, port):
            description, frames = _messages(port)
            made = doors(description, frames, port)
            if arguments.only:
                if arguments.only not in made:
                    known = ', '.join(made)
                    raise ParameterError(f"no '{arguments.only}'", cure=f'one of {known}')
                made = {arguments.only: made[arguments.only]}
            tried = [_Tried(name, door, arguments.seed + k, page, Path(folder))
                     for k, (name, door) in enumerate(made.items())]  # fmt: skip
            begin = time.monotonic()
            while (passed := time.monotonic() - begin) < seconds and not ending.is_asked:
                time.sleep(min(1.0, seconds / 20.0))
                for each in tried:
                    each.look(passed, is_warm=passed >= 0.2 * seconds)
            faults = [each.end(passed) for each in tried]
    return int(any(faults))


class _Tried:
    """A reader that is tried: its process, what it is offered, and what it takes."""

    def __init__(
        self, name: str, door: Door, seed: int, page: subprocess.Popen[str], folder: Path
    ) -> None:
        self._name = name
        self._said = folder / f'{name}.txt'
        self._is_own = bool(door.kind)
        self._process = page
        if self._is_own:
            with self._said.open('w') as said:
                self._process = subprocess.Popen(
                    [sys.executable, '-m', 'tree_sway_lab.fuzz.listener', door.kind, door.address],
                    stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=said, text=True,
                )  # fmt: skip
        self._offer: Offer
        self._offer, self._thread = offering(door, seed)
        self._warm: Health | None = None
        self._newest: Health | None = None

    def look(self, since: float, *, is_warm: bool) -> None:
        """Look what the process takes."""
        with suppress(OSError, StopIteration):
            self._newest = health(since, self._process.pid)
            if is_warm and self._warm is None:
                self._warm = self._newest

    def end(self, passed: float) -> bool:
        """Offer what is good, end, and print the figures; whether something is wrong."""
        trials, counts = self._offer.trials, self._counts()
        self._offer.is_good = True
        is_heard = not self._is_own or self._takes_more(counts['accepted'])
        has_ended = self._process.poll() is not None
        self._offer.is_over = True
        self._thread.join(5.0)
        if self._is_own:
            with suppress(OSError, subprocess.TimeoutExpired):
                self._process.communicate(timeout=20.0)
            self._process.kill()
        said = self._said.read_text(errors='replace') if self._said.exists() else ''
        faults = sorted({found[0][:160] for found in _FAULT.finditer(said)})
        warm, newest = self._warm or self._newest, self._newest
        memory = 'no figure'
        has_grown = False
        if warm is not None and newest is not None:
            has_grown = newest.memory - warm.memory > _LARGEST_GROWTH
            memory = f'{warm.memory:.1f} to {newest.memory:.1f} MiB, handles {newest.handles}'
        figures = f'{self._name:16s} {trials:8d} messages in {passed:.0f} s'
        words = [figures, f'taken {counts}', memory]
        words += ['ended'] * has_ended + ['deaf afterwards'] * (not is_heard) + faults[:5]
        print('; '.join(words), flush=True)
        return has_ended or not is_heard or has_grown or bool(faults)

    def _takes_more(self, before: int) -> bool:
        deadline = time.monotonic() + _AFTERWARDS
        while self._process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.5)
            if self._counts()['accepted'] > before:
                return True
        return False

    def _counts(self) -> dict[str, int]:
        """Ask the process for its counts; zeros of one that has ended."""
        with suppress(OSError, ValueError):
            if self._is_own and self._process.stdin and self._process.stdout:
                self._process.stdin.write('\n')
                self._process.stdin.flush()
                return dict(json.loads(self._process.stdout.readline()))
        return {'accepted': 0, 'refused': 0}


@contextmanager
def _served(folder: Path) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """Serve a page, in a process that ends with the context."""
    with socket.create_server(('127.0.0.1', 0)) as trial:
        port = int(trial.getsockname()[1])
    command = [sys.executable, '-m', 'tree_sway', 'show', 'goldcrest', '-q']
    with (folder / 'page.txt').open('w') as said:
        page = subprocess.Popen([*command, '--port', f'{port}'], stderr=said, text=True)
    try:
        yield page, port
        if page.poll() is not None:
            raise TransportError(f'the page has ended with {page.returncode}')
    finally:
        page.terminate()
        with suppress(subprocess.TimeoutExpired):
            page.wait(20.0)
        page.kill()
        if text := (folder / 'page.txt').read_text(errors='replace').strip():
            print(f'the page said: {text[-2000:]}')


def _messages(port: int) -> tuple[bytes, list[bytes]]:
    """Return a description and some frames of the page."""
    seen = list[bytes]()
    with StreamClient(f'http://127.0.0.1:{port}/', on_message=seen.append) as client:
        client.wait(120.0, frames=_FRAMES)
    return seen[0], seen[1:][:_FRAMES]
