# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway relay --page``: a page elsewhere, served on without ROS."""

from __future__ import annotations

import os
from pathlib import Path
import re
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')
pytest.importorskip('tree_sway_ros', reason='the command is not installed')

from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.stream.client import StreamClient  # noqa: E402
from tree_sway.stream.protocol import decode_description, encode_state, Frame  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
DESCRIPTION = (ROOT / 'test' / 'page' / 'vectors' / 'description.bin').read_bytes()
WITHOUT_ROS = (
    'import sys; sys.modules["rclpy"] = sys.modules["diagnostic_msgs"] = None; '
    'from importlib import util; found = util.find_spec; '
    'util.find_spec = lambda name, *more: None if name == "rclpy" else found(name, *more); '
    'from tree_sway.commands.cli import main; sys.exit(main(sys.argv[1:]))'
)


@pytest.mark.parametrize('words', [['--page'], []])
def test_poses_and_wind_come_through_a_page_of_another_site(
    words: list[str], tmp_path: Path
) -> None:
    token = tmp_path / 'token'
    token.write_text('a-token-of-the-farm\n')
    token.chmod(0o600)
    described = decode_description(DESCRIPTION)
    rng = np.random.default_rng(5)
    over = threading.Event()

    def publish() -> None:
        sequence = 0
        while not over.wait(1.0 / 60.0):
            wind = np.array([3.0, 0.5, 0.0])
            state = rng.uniform(-0.5, 0.5, len(described.scale)) * described.scale
            frame = encode_state(described, sequence, time.time_ns(), wind, state, 0)
            sent[sequence] = frame
            there.publish(frame)
            sequence += 1

    sent: dict[int, bytes] = {}
    settings = PageSettings(port=0, token_file=str(token))
    frames: list[Frame] = []
    winds: list[Frame] = []
    heard: list[bytes] = []
    with PageServer(settings) as there:
        there.describe(DESCRIPTION)
        publisher = threading.Thread(target=publish)
        publisher.start()
        line = ['relay', there.url, '--token-file', str(token), '--port', '0', *words]
        with subprocess.Popen(
            [sys.executable, '-c', WITHOUT_ROS, *line],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**os.environ, 'PYTHONUNBUFFERED': '1'},
        ) as relay:
            try:
                assert relay.stdout is not None
                first = relay.stdout.readline()
                found = re.search(r'to (http://\S+token=\S+)', first)
                assert found is not None, first
                url = found[1]
                with (
                    StreamClient(
                        url, rate=60.0, on_message=heard.append,
                        on_frame=lambda frame, _at: frames.append(frame),
                    ) as client,
                    StreamClient(
                        url, wind_only=True, on_frame=lambda frame, _at: winds.append(frame)
                    ) as vane,
                ):  # fmt: skip
                    client.wait(frames=20)
                    vane.wait(frames=5)
                    assert client.poses() is not None
                    client.set('mean_speed', 30.0)  # nothing is changed there
            finally:
                relay.terminate()
                over.set()
                publisher.join()
            assert relay.wait(10.0) == 0
            assert 'frames, 0 unreadable' in relay.stdout.read()
    assert heard[0] == DESCRIPTION
    assert set(heard[1:]) <= set(sent.values())
    assert all(frame.wind[0] == pytest.approx(3.0, abs=0.02) for frame in [*frames, *winds])
    assert len(winds[0].coordinates) == 0
