# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway relay``: the wind of a page elsewhere, on `wind` of this site."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
import math
from pathlib import Path
import socket
import subprocess
import sys
import threading
import time
from typing import Any

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')

from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.errors import TransportError  # noqa: E402
from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.stream.protocol import (  # noqa: E402
    decode_description,
    encode_state,
    PAUSED,
    WIND_LOST,
)
from tree_sway_ros.commands.relay import wait_for_frames  # noqa: E402
from tree_sway_ros.process.composition import Composition  # noqa: E402
from tree_sway_ros.process.listener import Listener  # noqa: E402
from tree_sway_ros.process.topics import (  # noqa: E402
    DIAGNOSTICS,
    message_class,
    qos_profile,
    WIND,
)
from tree_sway_ros.reports.diagnostics import OK, WARN  # noqa: E402

pytestmark = pytest.mark.ros

ROOT = Path(__file__).resolve().parents[3]
DESCRIPTION = (ROOT / 'test' / 'page' / 'vectors' / 'description.bin').read_bytes()
DEADLINE = 60.0


class Site:
    """A page whose tree rests in an east wind of 3 m/s, 60 times per second."""

    def __init__(self, server: PageServer) -> None:
        self._server, self._ended = server, threading.Event()
        self._thread = threading.Thread(target=self._publish)
        self.flags = 0

    def __enter__(self) -> Site:
        self._server.describe(DESCRIPTION)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()

    def _publish(self) -> None:
        described = decode_description(DESCRIPTION)
        wind, still = np.array([3.0, 0.0, 0.0]), np.zeros(len(described.scale))
        sequence = 0
        while not self._ended.wait(1.0 / 60.0):
            stamp = time.time_ns()
            frame = encode_state(described, sequence, stamp, wind, still, self.flags)
            self._server.publish(frame)
            sequence += 1


class Ear(Listener):
    """What the relay publishes: samples, and the newest status."""

    def __init__(self) -> None:
        super().__init__('ear')
        self.heard: list[Any] = []
        self.said: list[Any] = []
        for topic, store in ((WIND, self.heard), (DIAGNOSTICS, self.said)):
            quality = qos_profile(topic, is_input=True)
            kind = message_class(topic)
            self.node.create_subscription(kind, topic.name, store.append, quality)

    def until(self, holds: Callable[[], object]) -> None:
        """Listen until something is true; fail after the deadline."""
        end = time.monotonic() + DEADLINE
        while not holds():
            assert time.monotonic() < end
            self.spin(0.05)

    def status(self) -> tuple[int, str]:
        """Level and message of the newest status."""
        if not self.said:
            return -1, ''
        status = self.said[-1].status[0]
        return status.level[0], status.message


@pytest.fixture
def own_domain(ros_environment: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in ros_environment.items():
        monkeypatch.setenv(name, value)


@contextmanager
def relaying(url: str, *arguments: str) -> Iterator[subprocess.Popen[str]]:
    """Run the command, which ends without an error."""
    command = [sys.executable, '-m', 'tree_sway', 'relay', url, *arguments]
    pipe = subprocess.PIPE
    relay = subprocess.Popen(command, cwd=ROOT, text=True, stderr=pipe, stdout=pipe)
    try:
        yield relay
        relay.terminate()
        _, errors = relay.communicate(timeout=DEADLINE)
        assert (relay.returncode, errors) == (0, '')
    finally:
        relay.kill()
        relay.wait()


@pytest.mark.usefixtures('own_domain')
@pytest.mark.parametrize('token', ['long enough', 'a+b/c&d=e%f#g?h'])
def test_the_wind_of_a_page_is_published_as_a_driver_would(tmp_path: Path, token: str) -> None:
    file = tmp_path / 'token'
    file.write_text(f'{token}\n')
    file.chmod(0o600)
    settings = PageSettings(port=0, token_file=str(file))
    with PageServer(settings) as server, Site(server), Ear() as ear:
        with relaying(server.url, '--token-file', str(file)) as relay:
            ear.until(lambda: len(ear.heard) >= 10 or relay.poll() is not None)
    assert len(ear.heard) >= 10
    stamps = [each.header.stamp.sec + 1e-9 * each.header.stamp.nanosec for each in ear.heard]
    assert (np.diff(stamps) > 0.0).all()
    assert abs(stamps[-1] - time.time()) < DEADLINE
    assert {(each.vector.x, each.vector.y) for each in ear.heard} == {(3.0, 0.0)}


@pytest.mark.usefixtures('own_domain')
def test_an_address_where_nobody_listens_is_said_while_it_waits() -> None:
    with socket.create_server(('localhost', 0)) as closed:
        port = closed.getsockname()[1]
    command = [
        sys.executable,
        '-m',
        'tree_sway',
        'relay',
        f'https://localhost:{port}',
    ]
    with subprocess.Popen(command, cwd=ROOT, text=True, stdout=subprocess.PIPE) as relay:
        assert relay.stdout is not None
        assert f'waiting for wss://localhost:{port}/stream (' in relay.stdout.readline()
        relay.terminate()
        assert relay.wait(DEADLINE) == 0


class Waiting:
    """A client whose server has other problems as it is waited for, and then sends a frame."""

    url, problem = 'ws://there:8765/stream', ''

    def __init__(self, *problems: str) -> None:
        self.problems, self.waited = list(problems), 0.0

    def has_frames(self, seconds: float) -> bool:
        self.waited += seconds
        if not self.problems:
            return True
        self.problem = self.problems.pop(0)
        return False


def test_a_server_that_is_not_there_yet_is_waited_for(capsys: pytest.CaptureFixture[str]) -> None:
    client = Waiting('no route', *['refused'] * 100)
    wait_for_frames(client, math.inf)  # type: ignore[arg-type]
    assert client.waited == 102 * 3.0
    first, second = capsys.readouterr().out.splitlines()
    assert 'waiting for ws://there:8765/stream (no route) until it is there' in first
    assert '(refused)' in second


def test_a_server_that_is_not_reached_in_the_time_given_is_given_up() -> None:
    client = Waiting(*['refused'] * 100)
    with pytest.raises(TransportError, match=r'no frame in time [(]refused[)]; check the address'):
        wait_for_frames(client, 8.0)  # type: ignore[arg-type]
    assert client.waited == 8.0


@pytest.mark.usefixtures('own_domain')
def test_a_site_that_starts_after_the_relay_is_relayed() -> None:
    with socket.create_server(('127.0.0.1', 0)) as closed:
        port = closed.getsockname()[1]
    with relaying(f'http://127.0.0.1:{port}') as relay, Ear() as ear:
        assert relay.stdout is not None
        assert 'waiting for' in relay.stdout.readline()
        with PageServer(PageSettings(port=port)) as server, Site(server):
            ear.until(lambda: ear.heard)


@pytest.mark.usefixtures('own_domain')
@pytest.mark.parametrize(
    ('flag', 'reason'), [(WIND_LOST, 'no measured wind'), (PAUSED, 'tree is paused')]
)
def test_a_wind_that_nobody_measures_is_not_published(flag: int, reason: str) -> None:
    with PageServer(PageSettings(port=0)) as server, Site(server) as site, Ear() as ear:
        with relaying(server.url):
            ear.until(lambda: len(ear.heard) > 3 and ear.status()[0] == OK)
            site.flags = flag
            ear.until(lambda: ear.status()[0] == WARN)
            assert reason in ear.status()[1]
            n_heard, n_said = len(ear.heard), len(ear.said)
            ear.until(lambda: len(ear.said) > n_said + 1)
            assert len(ear.heard) == n_heard
            site.flags = 0
            ear.until(lambda: len(ear.heard) > n_heard + 3 and ear.status()[0] == OK)


@pytest.mark.usefixtures('own_domain')
def test_the_wind_of_a_dead_anemometer_is_not_published() -> None:
    """Over the nodes of the remote site, whose anemometer is killed."""
    with Composition({}) as nodes:
        tree = {'tree': 'goldcrest', 'model': '20'}
        nodes.add('solver', tree, namespace='remote')
        nodes.add('wind', {}, namespace='remote')
        viewer = nodes.add('viewer', {'port': 0}, namespace='remote')
        mast = nodes.add('anemometer', {}, namespace='remote')
        with Ear() as ear, relaying(viewer.server.url):
            ear.until(lambda: len(ear.heard) > 10)
            mast.stop()
            ear.until(lambda: ear.status()[0] == WARN and 'no measured wind' in ear.status()[1])
            n_heard, n_said = len(ear.heard), len(ear.said)
            ear.until(lambda: len(ear.said) > n_said + 1)
            assert len(ear.heard) == n_heard
        nodes.check()


@pytest.mark.parametrize(
    ('url', 'reason'), [('http://[', 'not an address'), ('there:8765', 'http:// or https://')]
)
def test_what_is_no_address_is_refused(
    capsys: pytest.CaptureFixture[str], url: str, reason: str
) -> None:
    assert main(['relay', url, '--seconds', '1']) == 2
    assert reason in capsys.readouterr().err
