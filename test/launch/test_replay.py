# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Launched again, a record gives the same poses, from the first frame and at any speed."""

import hashlib
import struct

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from tree_sway_ros.process.topics import SEGMENT_POSES  # noqa: E402

BEGIN = 10**9
"""Of a record without a date, on the clock [ns]."""
FRAME = round(1e9 / 60.0)
TOLD = """\
player:
  ros__parameters:
    speed: {speed}
    loop: false
    wait_for: wind wind/filtered segment_poses /clock:2
solver:
  ros__parameters:
    qos_overrides./segment_poses.publisher.depth: 1000  # for readers below 600 frames per second
"""
_POSES = 28
"""Begin of the poses in a message: behind the header, their count and a gap that nobody fills."""


def replayed(launched, observer, folder, tree, speed, seconds):
    """Digest of each frame's poses by its stamp, from a launch to the end of its record."""
    record = folder / 'wind.csv'
    record.write_text(
        'time,u,v,w\n'
        + ''.join(f'{k / 20:.2f},{6 + k % 7},{0.1 * (k % 5):.1f},0\n' for k in range(20 * seconds))
    )
    told = folder / f'told_{speed:g}.yaml'
    told.write_text(TOLD.format(speed=speed))
    frames = observer.listen(SEGMENT_POSES, raw=True, depth=1000)
    run = launched(
        'sway.launch.py',
        tree=tree,
        source='player',
        file=record,
        use_sim_time='true',
        params_file=told,
    )
    last = BEGIN + seconds * 10**9 - FRAME
    observer.until(lambda: frames and stamp_of(frames[-1]) >= last, 'the last frame', 90.0)
    _, said = run.end()
    assert 'escalating' not in said
    assert 'not be exact' not in said, said
    found = {stamp_of(data): hashlib.sha1(data[_POSES:]).digest() for data in frames}
    # While the clock still stands the rest pose comes once, and nobody has to have heard it.
    return {stamp: digest for stamp, digest in found.items() if BEGIN <= stamp <= last}


def stamp_of(data):
    """Of a serialised pose array in [ns]."""
    second, nanosecond = struct.unpack_from('<iI', data, 4)
    return second * 10**9 + nanosecond


def assert_alike(runs):
    first = min(runs[0])
    assert first < BEGIN + 17_000_000
    differing = [
        (
            k,
            [
                stamp
                for stamp in sorted({*found, *runs[0]})
                if found.get(stamp) != runs[0].get(stamp)
            ][:3],
        )
        for k, found in enumerate(runs)
        if found != runs[0]
    ]
    assert differing == []
    assert len(set(runs[0].values())) > 0.9 * len(runs[0])  # it moves


def test_three_launches_give_the_same_poses(launched, observer, tree_file, tmp_path):
    given = (launched, observer, tmp_path, tree_file)
    assert_alike([replayed(*given, speed, seconds=3) for speed in (1.0, 10.0, 10.0)])


@pytest.mark.long
def test_twenty_launches_give_the_same_poses(launched, observer, tmp_path):
    given = (launched, observer, tmp_path, 'goldcrest')
    assert_alike([replayed(*given, speed, seconds=10) for speed in (1.0, 10.0) * 10])
