# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Bags that are written and read without ROS: what goes in comes out, the rest is refused."""

from __future__ import annotations

from pathlib import Path
import signal
import subprocess
import sys

import numpy as np
import pytest

pytest.importorskip('rosbags', reason='rosbags is not installed')

from rosbags.typesys import get_typestore, Stores  # noqa: E402

from tree_sway.errors import FormatError, ParameterError  # noqa: E402
from tree_sway.files.recording.bag_reader import read_bag  # noqa: E402
from tree_sway.files.recording.bag_writer import BagWriter  # noqa: E402

pytestmark = pytest.mark.usefixtures('readers_in_this_process')

STATE_TYPE, DESCRIPTION_TYPE = 'std_msgs/msg/Float64MultiArray', 'std_msgs/msg/String'
TYPES = get_typestore(Stores.ROS2_JAZZY)
SECOND = 1_000_000_000


def state(stamp: int, value: float) -> bytes:
    types = TYPES.types
    dimension = types['std_msgs/msg/MultiArrayDimension'](label='coordinates', size=1, stride=1)
    layout = types['std_msgs/msg/MultiArrayLayout'](dim=[dimension], data_offset=2)
    message = types[STATE_TYPE](layout=layout, data=np.array([*divmod(stamp, SECOND), value]))
    return bytes(TYPES.serialize_cdr(message, STATE_TYPE))


def description(text: str = '{"state":{}}') -> bytes:
    message = TYPES.types[DESCRIPTION_TYPE](data=text)
    return bytes(TYPES.serialize_cdr(message, DESCRIPTION_TYPE))


def recorded(path: Path, storage: str, text: str = '{"state":{}}') -> Path:
    with BagWriter(path, storage) as bag:
        bag.add('/oak/tree_description', DESCRIPTION_TYPE, latched=True)
        bag.add('/oak/tree_state', STATE_TYPE, depth=10)
        bag.write('/oak/tree_description', 0, description(text))
        for at, k in enumerate((0, 1, 3, 2, 4)):  # one comes out of order
            bag.write('/oak/tree_state', at, state(10 * SECOND + k * 100_000_000, float(k)))
    return path


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_state_comes_back_as_it_was_sent(tmp_path: Path, storage: str) -> None:
    bag = read_bag(recorded(tmp_path / 'bag', storage), [STATE_TYPE])
    assert bag.types == {
        '/oak/tree_description': DESCRIPTION_TYPE,
        '/oak/tree_state': STATE_TYPE,
    }
    messages = bag.messages['/oak/tree_state']
    assert [stamp for stamp, _ in messages] == list(range(5))
    assert messages[2][1] == state(10 * SECOND + 300_000_000, 3.0)


def test_the_description_is_kept_for_who_comes_late(tmp_path: Path) -> None:
    metadata = (recorded(tmp_path / 'bag', 'mcap') / 'metadata.yaml').read_text(encoding='utf-8')
    assert 'durability: transient_local' in metadata


def test_what_cannot_be_read_or_written_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match='no such bag'):
        read_bag(tmp_path / 'none', [STATE_TYPE])
    (tmp_path / 'wrong.mcap').write_bytes(b'\x89MCAP0\r\n' + bytes(40))
    with pytest.raises(FormatError, match='not a bag that can be read'):
        read_bag(tmp_path / 'wrong.mcap', [STATE_TYPE])
    with pytest.raises(FormatError, match='there already'):
        BagWriter(tmp_path)
    with pytest.raises(ParameterError, match='use mcap or sqlite3'):
        BagWriter(tmp_path / 'new', 'csv')


WRITER = """
import os, resource, signal, sys
from pathlib import Path
from tree_sway.errors import FormatError
from tree_sway.files.recording import bag_writer
resource.setrlimit(resource.RLIMIT_FSIZE, 2 * (int(sys.argv[3]),))
bag_writer.COMMIT_EVERY = 0.0
try:
    with bag_writer.BagWriter(Path(sys.argv[1]), sys.argv[2]) as bag:
        bag.add('/state', 'std_msgs/msg/Float64MultiArray')
        for stamp in range(100):
            bag.write('/state', stamp, bytes(1000))
        os.kill(os.getpid(), signal.SIGKILL)
except FormatError as error:
    print(error)
"""


def written(path: Path, storage: str, largest: int) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, '-c', WRITER, str(path), storage, str(largest)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


def test_what_a_killed_recorder_wrote_is_in_the_bag(tmp_path: Path) -> None:
    ended = written(tmp_path / 'bag', 'sqlite3', 1 << 30)
    assert ended.returncode == -signal.SIGKILL
    assert len(read_bag(tmp_path / 'bag', [STATE_TYPE]).messages['/state']) == 100


def test_an_mcap_of_a_killed_recorder_can_be_recovered(tmp_path: Path) -> None:
    ended = written(tmp_path / 'bag', 'mcap', 1 << 30)
    assert ended.returncode == -signal.SIGKILL
    (file,) = (tmp_path / 'bag').glob('*.mcap')
    assert file.read_bytes().count(bytes(1000)) == 100
    with pytest.raises(FormatError, match="repair it with 'mcap recover'"):
        read_bag(tmp_path / 'bag', [STATE_TYPE])


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_full_disk_is_one_line_and_leaves_what_was_written(tmp_path: Path, storage: str) -> None:
    ended = written(tmp_path / 'bag', storage, 80_000)
    assert (ended.returncode, ended.stderr) == (0, '')
    assert 'cannot be written to' in ended.stdout
    (file,) = (each for each in (tmp_path / 'bag').iterdir() if each.suffix != '.yaml')
    assert file.read_bytes().count(bytes(1000)) > 20
    if storage == 'mcap':
        assert "'mcap recover' restores the written part" in ended.stdout
        with pytest.raises(FormatError, match="repair it with 'mcap recover'"):
            read_bag(tmp_path / 'bag', [STATE_TYPE])
    else:
        assert 'the written part can be read' in ended.stdout
        assert len(read_bag(tmp_path / 'bag', [STATE_TYPE]).messages['/state']) > 20
