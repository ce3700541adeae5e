# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pose arrays of other programs on the topic of a tree, and waits for what is not there."""

from __future__ import annotations

import argparse
import itertools
import math
from pathlib import Path
from queue import Queue
from typing import Any

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')

from geometry_msgs.msg import Pose, PoseArray  # noqa: E402, I100

from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.errors import TransportError  # noqa: E402
from tree_sway.growth.builtin import builtin_tree  # noqa: E402
from tree_sway_ros.commands.bag_recorder import record_bag, Recorder  # noqa: E402
from tree_sway_ros.commands.monitor import StreamMonitor  # noqa: E402
from tree_sway_ros.commands.text import status_line, summary  # noqa: E402
from tree_sway_ros.commands.watch import watch  # noqa: E402
from tree_sway_ros.process.topics import qos_profile, SEGMENT_POSES  # noqa: E402

pytestmark = pytest.mark.ros
DEADLINE = 20.0


@pytest.mark.parametrize('count', [0, 7, 100_000])
def test_poses_of_another_program_are_counted_apart(context: object, count: int) -> None:
    tree = builtin_tree('goldcrest')
    with StreamMonitor(context, tree) as monitor, StreamMonitor(context, None, 'other') as other:
        topic = f'/{SEGMENT_POSES.name}'
        publisher = other.node.create_publisher(PoseArray, topic, qos_profile(SEGMENT_POSES))
        monitor._receive_poses(bytes(20))  # not whole
        for _ in range(1000):
            publisher.publish(PoseArray(poses=[Pose()] * count))
            monitor.spin(0.02)
            if monitor.totals.foreign > 1:
                break
        assert monitor.totals.foreign > 1
        assert monitor.totals.poses.count == 0
        monitor.totals.add_poses(1.0, 1.0, tree.end[0])
        told = f'{monitor.totals.foreign} pose arrays of another program'
        assert told in summary(monitor.totals, 60.0)
        assert told in status_line(monitor.totals, 1.0)


@pytest.fixture
def reported(monkeypatch: pytest.MonkeyPatch) -> Queue[str]:
    """Collect what is said of a wait, at once."""
    said = Queue[str]()
    monkeypatch.setattr('tree_sway.commands.progress.PATIENCE', 0.0)
    monkeypatch.setattr('tree_sway.commands.progress._report', said.put)
    return said


def test_a_listener_says_that_it_waits_for_poses(context: object, reported: Queue[str]) -> None:
    with (
        StreamMonitor(context, None, 'nobody') as monitor,
        pytest.raises(TransportError, match='no poses within 0'),
    ):
        watch(monitor, 1.0, lambda: bool(reported.get(timeout=DEADLINE)), patience=0.0)


@pytest.mark.parametrize(('seconds', 'within'), [(0.5, 2), (4.0, 4), (math.inf, 30)])
def test_a_listener_without_a_solver_ends_with_its_time(
    context: object, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
    seconds: float, within: float,
) -> None:  # fmt: skip
    clock = itertools.count()
    with StreamMonitor(context, None, 'nobody') as monitor:
        monkeypatch.setattr(monitor, 'spin', lambda _: None)
        monkeypatch.setattr('tree_sway_ros.commands.listen.StreamMonitor', lambda *_: monitor)
        monkeypatch.setattr('tree_sway_ros.commands.watch.time.monotonic', lambda: next(clock))
        arguments = [] if seconds == math.inf else ['--seconds', str(seconds)]
        assert main(['listen', *arguments]) == 2
    assert f'no poses within {within} s' in capsys.readouterr().err
    assert next(clock) <= within + 3


def test_a_recorder_says_that_it_waits_for_a_tree_and_what_did_not_come(
    reported: Queue[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    class Waiting(Recorder):
        recorded = covered = 0.0
        missing = ('/tree_state', '/tree_description')  # type: ignore[assignment]
        said = ''

        def __init__(self, _context: object, *others: Any) -> None:
            """Leave the bag alone."""

        def spin(self, seconds: float) -> None:
            """Get what is said, and the first message after it."""
            Waiting.said = Waiting.said or reported.get(timeout=DEADLINE)
            Waiting.recorded += 1.0

        def close(self) -> None:
            """Leave all as it is."""

    monkeypatch.setattr('tree_sway_ros.commands.bag_recorder.Recorder', Waiting)
    given = argparse.Namespace(output=tmp_path / 'bag', format='mcap', poses=False, namespace='')
    assert record_bag(given, 2.0) == 0
    assert 'waiting for a running tree' in Waiting.said
    told = 'note: nobody published /tree_state, /tree_description\n'
    assert told in capsys.readouterr().err
