# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway relay`` beside ROS, and where the state is played; what it refuses."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import os
from pathlib import Path
import re
import socket
import subprocess
import sys
import threading

import numpy as np
import pytest

pytest.importorskip('zenoh', reason='eclipse-zenoh is not installed')

from tree_sway_ros.page.client import StreamClient  # noqa: E402
from tree_sway_ros.relay.line import Line  # noqa: E402
from tree_sway_ros.relay.wind_bytes import decode_wind, encode_wind  # noqa: E402
from tree_sway_ros.tools.cli import main  # noqa: E402

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
    *given: str, environment: dict[str, str] | None = None
) -> Iterator[subprocess.Popen[str]]:
    """Run a site in a process of its own, until it has said its first line."""
    command = [sys.executable, '-m', 'tree_sway_ros.tools.cli', 'relay', *given]
    process = subprocess.Popen(
        command, cwd=ROOT, text=True, stdout=subprocess.PIPE, env=environment or dict(os.environ)
    )
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


def test_the_state_is_played_where_nothing_is_solved() -> None:
    at = place()
    with relay('send', SEEDLING, '--listen', at, '--state', '--speed', '9'):
        with relay(
            'receive', SEEDLING, '--connect', at, '--play', '--page', '--port', '0'
        ) as there:
            assert there.stdout is not None
            told = there.stdout.readline()
            found = re.search(r'page: (\S+)', told)
            assert found, told
            with StreamClient(found[1]) as client:
                client.wait(DEADLINE, frames=20)
                first = client.poses()
                client.wait(DEADLINE, frames=60)
                later = client.poses()
                assert first is not None and later is not None  # noqa: PT018
                assert client.description is not None
                assert client.description.header['name'] == 'seedling'
                assert np.linalg.norm(later[:, :3] - first[:, :3], axis=1).max() > 1e-6


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
        (['receive', SEEDLING, '--lose', '2'], '--lose'),
        (['receive', SEEDLING, '--play', '--listen', 'tcp/127.0.0.1:0'], 'without --page'),
    ],
)
def test_what_cannot_be_relayed_is_refused(
    given: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(['relay', *given]) == 2
    assert told in capsys.readouterr().err
