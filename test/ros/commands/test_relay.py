# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway relay``: the wind of a page elsewhere, on `wind` of this site."""

from __future__ import annotations

from pathlib import Path
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')

from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.page.protocol import decode_description, encode_state  # noqa: E402
from tree_sway.page.server import PageServer, PageSettings  # noqa: E402
from tree_sway_ros.process.listener import Listener  # noqa: E402
from tree_sway_ros.process.topics import message_class, qos_profile, WIND  # noqa: E402

pytestmark = pytest.mark.ros

ROOT = Path(__file__).resolve().parents[3]
DESCRIPTION = (ROOT / 'test' / 'page' / 'vectors' / 'description.bin').read_bytes()
DEADLINE = 60.0


def publish_until(server: PageServer, ended: threading.Event) -> None:
    """Publish states at rest in an east wind of 3 m/s, 60 times per second."""
    described = decode_description(DESCRIPTION)
    wind, still = np.array([3.0, 0.0, 0.0]), np.zeros(len(described.scale))
    sequence = 0
    while not ended.wait(1.0 / 60.0):
        server.publish(encode_state(described, sequence, time.time_ns(), wind, still))
        sequence += 1


def test_the_wind_of_a_page_is_published_as_a_driver_would(
    ros_environment: dict[str, str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for name, value in ros_environment.items():
        monkeypatch.setenv(name, value)
    token = tmp_path / 'token'
    token.write_text('long enough\n')
    token.chmod(0o600)
    ended, heard = threading.Event(), []
    with PageServer(PageSettings(port=0, token_file=str(token))) as server, Listener('ear') as ear:
        server.describe(DESCRIPTION)
        sender = threading.Thread(target=publish_until, args=(server, ended))
        sender.start()
        quality = qos_profile(WIND, is_input=True)
        ear.node.create_subscription(message_class(WIND), WIND.name, heard.append, quality)
        command = [sys.executable, '-m', 'tree_sway.commands.cli', 'relay', server.url]
        relay = subprocess.Popen(
            [*command, '--token-file', str(token)], cwd=ROOT, text=True, stderr=subprocess.PIPE,
        )  # fmt: skip
        try:
            end = time.monotonic() + DEADLINE
            while len(heard) < 10 and relay.poll() is None and time.monotonic() < end:
                ear.spin(0.1)
            relay.terminate()
            _, errors = relay.communicate(timeout=DEADLINE)
        finally:
            ended.set()
            relay.kill()
            sender.join()
    assert len(heard) >= 10, errors
    assert relay.returncode == 0
    stamps = [each.header.stamp.sec + 1e-9 * each.header.stamp.nanosec for each in heard]
    assert (np.diff(stamps) > 0.0).all()
    assert abs(stamps[-1] - time.time()) < DEADLINE
    assert {(each.vector.x, each.vector.y) for each in heard} == {(3.0, 0.0)}


def test_what_is_no_address_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(['relay', 'http://[', '--seconds', '1']) == 2
    assert 'not an address' in capsys.readouterr().err
