# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is recorded of a running tree over real DDS, and what can be made of it again."""

import json
from pathlib import Path
import re
import time

import numpy as np
import pytest
import yaml

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytest.importorskip('rosbags', reason='rosbags is not installed')
pytestmark = pytest.mark.ros

from rosbags.highlevel import AnyReader  # noqa: E402, I100

from tree_sway.files.recording.bag_writer import BagWriter  # noqa: E402
from tree_sway.files.wind.wind_file import read_wind  # noqa: E402
from tree_sway.stream.placing import Placer  # noqa: E402
from tree_sway.stream.protocol import decode_description  # noqa: E402
from tree_sway_ros.commands.bag_recorder import _MORE, _USUAL, Recorder  # noqa: E402
from tree_sway_ros.process.topics import TREE_DESCRIPTION, TREE_STATE  # noqa: E402
from tree_sway_ros.wire.tree_state import read_state, read_state_entry  # noqa: E402

CONFIG = Path(__file__).resolve().parents[2] / 'config'
DEADLINE = 60.0


def recorded(observer, path, storage, topics):
    """Record a bag of a second of states and wind."""
    with BagWriter(path, storage) as bag:
        recorder = Recorder(observer.context, bag, topics)
        try:
            end = time.monotonic() + DEADLINE
            while min(bag.counts.get(name, 0) for name in ('/tree_state', '/wind')) < 30:
                assert time.monotonic() < end, bag.counts
                recorder.spin(0.1)
        finally:
            recorder.close()
    return bag.counts


@pytest.mark.parametrize(('storage', 'topics'), [('mcap', _USUAL + _MORE), ('sqlite3', _USUAL)])
def test_a_recorded_state_can_be_drawn_again(
    compose, observer, tree_file, tmp_path, storage, topics
):
    nodes = compose(anemometer={'rate': 40.0}, wind={}, solver={'tree': tree_file})
    counts = recorded(observer, tmp_path / 'bag', storage, topics)
    nodes.close()
    assert len(counts) == len(topics)
    assert len(read_wind(tmp_path / 'bag', topic='/wind').time) >= 28
    with AnyReader([tmp_path / 'bag']) as bag:
        found = {TREE_DESCRIPTION.name: [], TREE_STATE.name: []}
        for connection, _, data in bag.messages():
            if connection.topic.lstrip('/') in found:
                message = bag.deserialize(data, connection.msgtype)
                found[connection.topic.lstrip('/')].append(message)
    states = found[TREE_STATE.name]
    read = [read_state(each) for each in states]
    stamps = [1e-9 * each.stamp for each in read]
    assert len(states) >= 30
    assert (np.diff(stamps) > 0).all()
    entry = read_state_entry(json.loads(found[TREE_DESCRIPTION.name][-1].data))
    description = decode_description(entry)
    moved = [np.ptp(column) for column in np.array([each.coordinates for each in read]).T]
    assert max(moved) > 1e-6
    assert len(moved) == len(description.scale)
    assert Placer(description).n_segments == 7


def test_a_recorder_knows_what_nobody_publishes(compose, observer, tmp_path):
    compose(anemometer={'rate': 40.0})
    with BagWriter(tmp_path / 'bag', 'mcap') as bag:
        with Recorder(observer.context, bag, _USUAL) as recorder:
            end = time.monotonic() + DEADLINE
            while not bag.counts.get('/wind'):
                assert time.monotonic() < end, bag.counts
                recorder.spin(0.1)
            assert recorder.missing == ['/wind/filtered', '/tree_state', '/tree_description']


def test_the_layouts_show_what_a_bag_holds(compose, observer, tree_file, tmp_path):
    """Every topic that RViz and Foxglove are to show is there, of a type that they show."""
    compose(anemometer={'rate': 40.0}, wind={}, solver={'tree': tree_file})
    counts = recorded(observer, tmp_path / 'bag', 'mcap', _USUAL + _MORE)
    layout = json.loads((CONFIG / 'tree_sway.foxglove.json').read_text())['configById']
    rviz = yaml.safe_load((CONFIG / 'tree_sway.rviz').read_text())['Visualization Manager']
    shown = {f'/{d["Topic"]["Value"]}': d['Class'] for d in rviz['Displays'] if 'Topic' in d}
    in_space = {'MarkerArray', 'PoseArray', 'PoseStamped'}
    plotted = [p['value'] for panel in layout.values() for p in panel.get('paths', ())]
    with AnyReader([tmp_path / 'bag']) as bag:
        types = {c.topic: c.msgtype.rpartition('/')[2] for c in bag.connections}
        assert all(counts[topic] > 0 for topic in types)
        for topic, kind in shown.items():
            assert types[topic].startswith(kind.rpartition('/')[2])
        assert {types[topic] for topic in layout['3D!tree']['topics']} <= in_space
        assert types[layout['DiagnosticSummary!nodes']['topicToRender']] == 'DiagnosticArray'
        for path in plotted:
            topic, *fields = re.split(r'[.\[]', path.rstrip(']'))
            (connection,) = [c for c in bag.connections if c.topic == topic]
            *_, data = next(bag.messages([connection]))
            value = bag.deserialize(data, connection.msgtype)
            for field in fields:
                value = value[int(field)] if field.isdecimal() else getattr(value, field)
            assert np.isfinite(value)
    assert layout['3D!tree']['followTf'] == rviz['Global Options']['Fixed Frame'] == 'map'
