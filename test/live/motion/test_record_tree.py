# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway record --motion``: wind and motion as one record, with dates of one clock."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
import socket
import sys
import threading
import time
from typing import Any

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway_lab.twin.read_record import read_tree_record  # noqa: E402

from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.files.motion.motion_file import read_motion  # noqa: E402
from tree_sway.files.trees.source import open_tree  # noqa: E402
from tree_sway.files.wind.wind_file import read_wind  # noqa: E402

ACCELERATION = {'accelerometer': ('accX', 'accY', 'accZ', 'acc_time')}
GYROSCOPE = {'gyroscope': ('gyrX', 'gyrY', 'gyrZ', 'gyr_time')}


@pytest.fixture
def port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(('127.0.0.1', 0))
        return int(probe.getsockname()[1])


@pytest.fixture
def wind(port: int) -> Iterator[str]:
    """Send lines of an anemometer twenty times a second; its address."""
    over = threading.Event()

    def send() -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            while not over.wait(0.05):
                sender.sendto(b'$WIMWV,270.0,R,6.4,M,A\r\n', ('127.0.0.1', port))

    thread = threading.Thread(target=send, daemon=True)
    thread.start()
    yield f'udp://127.0.0.1:{port}'
    over.set()
    thread.join()


@pytest.fixture
def no_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ('rclpy', 'rosbags'):
        monkeypatch.setitem(sys.modules, module, None)


def test_a_record_has_tree_wind_and_motion(
    phone: Any, wind: str, tmp_path: Path, no_ros: None, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / 'today'
    began = time.time()
    line = ['record', '--wind', wind, '--tree', 'goldcrest', '-o', str(folder)]
    both, alone = phone(ACCELERATION | GYROSCOPE), phone(ACCELERATION)
    line += ['--motion', both.url, '--at', '0.2', '--motion', f'{alone.url}?name=limb']
    line += ['--at', '0.1', '--seconds', '5']
    assert main(line) == 0
    assert 'samples of phyphox at 0.2' in capsys.readouterr().out
    record = read_tree_record(folder)
    assert [each.at for each in record.motion] == ['0.2', '0.1']
    assert open_tree(record.path(record.tree)).tree.n_segments > 3
    blown = read_wind(record.path(record.wind))
    assert blown.velocity[:, 0] == pytest.approx(6.4)
    for each, has_rate in zip(record.motion, (True, False), strict=True):
        motion = read_motion(record.path(each.file))
        assert (motion.rate is not None) is has_rate
        assert motion.acceleration is not None
        assert motion.acceleration[:, 2] == pytest.approx(9.81)
        assert motion.epoch is not None
        assert np.diff(motion.time).min() > 0.0
        # Dates of this machine: wind and motion are of the same seconds.
        assert began - 1.0 < motion.epoch + motion.time[0] < time.time()
        assert motion.times_after(blown.epoch)[-1] == pytest.approx(blown.time[-1], abs=1.5)
    assert main(line) == 2
    assert 'no new folder' in capsys.readouterr().err


def test_a_sensor_that_sends_nothing_is_left_out_and_told(
    phone: Any, wind: str, tmp_path: Path, no_ros: None, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / 'today'
    line = ['record', '--wind', wind, '--tree', 'goldcrest', '-o', str(folder), '--seconds', '4']
    paused = phone(ACCELERATION)
    paused.measuring = False
    line += ['--motion', phone(ACCELERATION).url, '--at', '0.2', '--motion', paused.url]
    assert main([*line, '--at', '0.1']) == 0
    assert 'press play in phyphox' in capsys.readouterr().err
    assert [each.at for each in read_tree_record(folder).motion] == ['0.2']


@pytest.mark.parametrize(
    ('extra', 'words'),
    [
        ([], 'motion without wind'),
        (['--wind', 'udp://:5005'], 'without the tree'),
        (['--wind', 'udp://:5005', '--tree', 'goldcrest'], '1 --motion and 0 --at'),
        (['--wind', 'udp://:5005', '--tree', 'goldcrest', '--at', '99'], 'the stem has no height'),
    ],
)
def test_mistakes_are_told_with_the_cure(
    tmp_path: Path, no_ros: None, capsys: pytest.CaptureFixture[str], extra: list[str], words: str
) -> None:
    line = ['record', '-o', str(tmp_path / 'x'), '--motion', 'udp:5006', '--seconds', '1']
    assert main([*line, *extra]) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / 'x').exists()
