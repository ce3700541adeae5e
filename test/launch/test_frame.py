# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""One launch argument names the frame of all that is published."""

import json

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from tree_sway_ros.process.topics import (  # noqa: E402
    MARKERS,
    SEGMENT_POSES,
    TREE_DESCRIPTION,
    WIND,
    WIND_FILTERED,
    WIND_FORCE_PLANE,
)


def frames_of(message):
    parts = getattr(message, 'markers', [message])
    return {part.header.frame_id for part in parts}


def test_one_frame_is_named_everywhere(launched, observer, tree_file):
    topics = (WIND, WIND_FILTERED, WIND_FORCE_PLANE, SEGMENT_POSES, MARKERS)
    heard = {topic.name: observer.listen(topic) for topic in topics}
    described = observer.listen(TREE_DESCRIPTION)
    run = launched('sway.launch.py', tree=tree_file, frame_id='site')
    observer.until(
        lambda: run.process.poll() is not None or (described and all(heard.values())),
        'every topic',
        deadline=60.0,
    )
    assert run.process.poll() is None, run.text
    named = {name: set().union(*map(frames_of, list(seen))) for name, seen in heard.items()}
    assert named == {name: {'site'} for name in heard}
    assert json.loads(described[0].data)['frame_id'] == 'site'
    assert run.end()[0] == 0
