# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway relay`` beside ROS, and where the state is played; what it refuses."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import itertools
import json
import math
import os
from pathlib import Path
import socket
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

pytest.importorskip('zenoh', reason='eclipse-zenoh is not installed')

from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.relay.line import Line  # noqa: E402
from tree_sway.relay.wind_bytes import decode_wind, encode_wind  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
SEEDLING = str(ROOT / 'test' / 'files' / 'data' / 'seedling.yaml')
DEADLINE = 90.0
Process = subprocess.Popen[str]


def place() -> str:
    """Name an endpoint that nobody has."""
    with socket.socket() as trial:
        trial.bind(('127.0.0.1', 0))
        return f'tcp/127.0.0.1:{trial.getsockname()[1]}'


@contextmanager
def relay(
    *given: str, environment: dict[str, str] | None = None, stderr: int | None = None
) -> Iterator[subprocess.Popen[str]]:
    """Run a site in a process of its own, until it has said its first line."""
    command = [sys.executable, '-m', 'tree_sway.commands.cli', 'relay', *given]
    process = subprocess.Popen(
        command, cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=stderr,
        env=environment or dict(os.environ),
    )  # fmt: skip
    timer = threading.Timer(DEADLINE, process.kill)
    timer.start()
    try:
        yield process
    finally:
        timer.cancel()
        process.kill()
        process.wait()
        assert process.stdout is not None
        process.stdout.close()
        if process.stderr is not None:
            process.stderr.close()


def test_who_sends_without_an_endpoint_ends_in_time_and_says_that_the_line_is_open() -> None:
    with relay('send', SEEDLING, '--seconds', '0.5', stderr=subprocess.PIPE) as process:
        _, errors = process.communicate(timeout=DEADLINE)
        assert process.returncode == 0
        assert 'this line is not protected' in errors


def test_what_strangers_send_is_refused_and_counted_and_the_receiver_goes_on() -> None:
    at, stop = place(), threading.Event()
    odd = [
        *(b'', b'\x00\x01\x00', b'\xff' * 52, bytes(1000)),
        encode_wind(time.time_ns(), (math.nan, 0.0, 0.0)),
        encode_wind(2_147_483_647 * 10**9, (5.0, 0.0, 0.0)),
        encode_wind(time.time_ns() + 60 * 10**9, (5.0, 0.0, 0.0)),
        encode_wind(time.time_ns(), (1e300, 0.0, 0.0)),
    ]
    snapshots = itertools.cycle(['', '{}', '[]', '{"run": 1, "state": 2}', '[' * 200_000])
    with Line('tree_sway', listen=[at]) as line:
        line.answer('snapshot', lambda: next(snapshots))
        with relay('receive', SEEDLING, '--connect', at, '--seconds', '2',
                   stderr=subprocess.PIPE) as process:  # fmt: skip

            def send() -> None:
                for number in itertools.count():
                    if stop.wait(0.05):
                        return
                    line.put('wind/filtered', odd[number % len(odd)])
                    line.put('wind/filtered', encode_wind(time.time_ns(), (5.0, 0.0, 0.0)))

            sender = threading.Thread(target=send)
            sender.start()
            try:
                _, errors = process.communicate(timeout=DEADLINE)
            finally:
                stop.set()
                sender.join()
    assert process.returncode == 0, errors
    for refused in ('x snapshot', 'x sample of the wind', 'by the gate', 'going on from rest'):
        assert refused in errors
    assert 'Traceback' not in errors


def test_a_password_of_zenoh_keeps_strangers_off_the_line(tmp_path: Path) -> None:
    at, heard = place(), threading.Event()
    (tmp_path / 'users').write_text('vane:secret\n')
    auth = {'user': 'vane', 'password': 'secret', 'dictionary_file': str(tmp_path / 'users')}
    own = tmp_path / 'zenoh.json5'
    own.write_text(json.dumps({'transport': {'auth': {'usrpwd': auth}}}))
    with Line('tree_sway', listen=[at], configuration=str(own)) as here:
        assert here.is_protected
        here.hear('wind/filtered', lambda _data: heard.set())
        with Line('tree_sway', connect=[at]) as stranger:
            assert not stranger.is_protected
            for _ in range(20):
                stranger.put('wind/filtered', b'x')
            assert not heard.wait(1.0)
        with Line('tree_sway', connect=[at], configuration=str(own)) as friend:
            end = time.monotonic() + DEADLINE
            while not heard.wait(0.05) and time.monotonic() < end:
                friend.put('wind/filtered', b'x')
            assert heard.is_set()


@pytest.mark.ros
def test_the_wind_of_ros_goes_over_the_line_as_it_is(ros_environment: dict[str, str]) -> None:
    pytest.importorskip('rclpy', reason='ROS 2 is not installed')
    at, heard, more = place(), [], threading.Event()

    def hear(data: bytes) -> None:
        heard.append(data)
        if len(heard) > 10:
            more.set()

    blows = 'from tree_sway_ros.nodes.executables import {0} as f; raise SystemExit(f())'
    nodes = [
        subprocess.Popen([sys.executable, '-c', blows.format(name)], env=ros_environment, cwd=ROOT)
        for name in ('anemometer', 'wind')
    ]
    try:
        with relay('send', SEEDLING, '--ros', '--listen', at, environment=ros_environment) as here:
            assert here.stdout is not None
            assert 'sending' in here.stdout.readline()
            with Line('tree_sway', connect=[at]) as line:
                line.hear('wind/filtered', hear)
                assert more.wait(DEADLINE)
    finally:
        for node in nodes:
            node.kill()
            node.wait()
    samples = [decode_wind(data) for data in heard]
    assert np.all(np.diff([stamp for stamp, _ in samples]) > 0)
    assert decode_wind(encode_wind(*samples[0])) == samples[0]
    assert any(np.linalg.norm(vector) > 0.1 for _, vector in samples)


@pytest.mark.parametrize(
    ('given', 'told'),
    [
        (['send', SEEDLING, '--listen', 'nowhere'], 'cannot be opened'),
        (['send', SEEDLING, '--rate', '0'], '--rate'),
        (['send', SEEDLING, '--zenoh-config', 'nowhere.json5'], 'cannot be opened'),
    ],
)
def test_what_cannot_be_relayed_is_refused(
    given: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(['relay', *given]) == 2
    assert told in capsys.readouterr().err
