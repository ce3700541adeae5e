# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import pytest

pytest.importorskip('rclpy')

from rclpy.qos import ReliabilityPolicy  # noqa: E402, I100

from tree_sway_ros.process import topics  # noqa: E402
from tree_sway_ros.process.topics import (
    CLOCK,
    DIAGNOSTICS,
    MARKERS,
    message_class,
    qos_profile,
    SEGMENT_POSES,
    TF,
    TF_STATIC,
    TOPICS,
    TREE_DESCRIPTION,
    WIND,
    WIND_FILTERED,
)


@pytest.mark.parametrize('topic', TOPICS, ids=lambda topic: topic.name)
def test_each_has_the_constant_of_its_name(topic):
    name = topic.name.removeprefix('~').lstrip('/').replace('/', '_').upper()
    assert getattr(topics, name) is topic


def test_names_are_relative_but_those_that_ros_fixes():
    absolute = {topic.name for topic in TOPICS if topic.name.startswith('/')}
    assert absolute == {DIAGNOSTICS.name, CLOCK.name, TF.name, TF_STATIC.name}


def test_what_rviz_and_unity_show_is_reliable_and_short():
    for topic in (SEGMENT_POSES, MARKERS):
        assert topic.reliable
        assert topic.depth <= 5


def test_any_driver_matches_the_wind():
    assert qos_profile(WIND).reliability == ReliabilityPolicy.RELIABLE
    assert qos_profile(WIND, is_input=True).reliability == ReliabilityPolicy.BEST_EFFORT
    assert not WIND.latched


@pytest.mark.parametrize('topic', [WIND, WIND_FILTERED], ids=lambda topic: topic.name)
def test_a_replay_loses_no_wind(topic):
    """Both ends are reliable, and hold ten seconds of a sonic at 100 Hz and more."""
    for is_input in (False, True):
        quality = qos_profile(topic, is_input=is_input, is_replay=True)
        assert quality.reliability == ReliabilityPolicy.RELIABLE
        assert quality.depth >= 1000


def test_the_description_waits_for_late_joiners():
    assert TREE_DESCRIPTION.latched
    assert TREE_DESCRIPTION.reliable


@pytest.mark.ros
@pytest.mark.parametrize(
    'topic', [t for t in TOPICS if 'tf2' not in t.type_name], ids=lambda t: t.name
)
def test_types_and_qos_exist(topic):
    pytest.importorskip('rclpy')
    assert message_class(topic).__name__ == topic.type_name.rsplit('/', 1)[-1]
    assert qos_profile(topic).depth == topic.depth


def test_a_name_of_no_topic_is_refused():
    with pytest.raises(AttributeError, match=r'no topic SOIL in topics\.yaml'):
        topics.__getattr__('SOIL')
