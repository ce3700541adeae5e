# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Another launch file includes ours twice, and sets values for every node."""

import json
from pathlib import Path

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from tree_sway_ros.process.topics import (  # noqa: E402
    SEGMENT_POSES,
    TREE_DESCRIPTION,
    WIND_FILTERED,
)

PARENT = Path(__file__).with_name('two_trees.launch.py')
SHARED = """\
/**:
  ros__parameters: {frame_id: site, shutter: 3, rate: 50.0}
"""


def test_two_trees_stand_side_by_side_in_one_wind(launched, observer, tree_file, tmp_path):
    parameters = tmp_path / 'shared.yaml'
    parameters.write_text(SHARED)
    poses, winds, trees = (
        {name: observer.listen(topic, name=f'/{name}/{topic.name}') for name in ('elm', 'oak')}
        for topic in (SEGMENT_POSES, WIND_FILTERED, TREE_DESCRIPTION)
    )
    run = launched(PARENT, tree=tree_file, parameters=parameters)
    observer.until(
        lambda: (
            run.process.poll() is not None
            or all(len(poses[name]) > 60 and winds[name] and trees[name] for name in poses)
        ),
        'two trees',
        deadline=60.0,
    )
    assert run.process.poll() is None, run.text
    at = {name: poses[name][-1].poses[0].position for name in poses}
    assert (at['elm'].x, at['elm'].y) == (0.0, 0.0)
    assert (at['oak'].x, at['oak'].y) == (5.0, 0.0)
    assert poses['elm'][-1].header.frame_id == winds['oak'][-1].header.frame_id == 'site'
    described = {name: json.loads(trees[name][-1].data) for name in trees}
    assert described['elm']['hash'] != described['oak']['hash']  # each knows its place

    def felt(name):
        stamped = [(m.header.stamp.sec, m.header.stamp.nanosec, m.vector.x) for m in winds[name]]
        return set(stamped[2:])

    observer.until(lambda: len(felt('elm') & felt('oak')) > 10, 'one wind')
    moved = {
        name: max(abs(frame.poses[2].orientation.w - 1.0) for frame in poses[name])
        for name in poses
    }
    _, said = run.end()
    assert min(moved.values()) > 0.0, said
    assert "unknown parameter 'shutter'" in said
    assert "unknown parameter 'exposure'" in said
    assert said.count('process has finished cleanly') == 5, said
