# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from functools import partial
import json
import math

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from geometry_msgs.msg import PoseArray, Vector3Stamped  # noqa: E402, I100
from rcl_interfaces.srv import SetParameters  # noqa: E402
import rclpy  # noqa: E402
from rclpy.parameter import Parameter  # noqa: E402
from rclpy.serialization import deserialize_message  # noqa: E402
from std_srvs.srv import SetBool, Trigger  # noqa: E402

from tree_sway.core.scene.make import make_simulator  # noqa: E402
from tree_sway.core.wind.averaging import WindAverage  # noqa: E402
from tree_sway.errors import ParameterError, TreeSwayError  # noqa: E402, E501
from tree_sway.files.trees.source import open_tree  # noqa: E402
from tree_sway_ros.nodes import solver as solver_node  # noqa: E402
from tree_sway_ros.process.topics import (  # noqa: E402
    MARKERS,
    qos_profile,
    SEGMENT_POSES,
    TREE_DESCRIPTION,
    WIND_FILTERED,
)
from tree_sway_ros.reports.diagnostics import ERROR, OK, WARN  # noqa: E402
from tree_sway_ros.wire.wind_messages import wind_to_message, WindSample  # noqa: E402


def block(message):
    rows = []
    for pose in message.poses:
        p, q = pose.position, pose.orientation
        rows.append((p.x, p.y, p.z, q.x, q.y, q.z, q.w))
    return np.array(rows)


def stamp(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


class Breeze:
    """Publishes `wind/filtered` from a timer of the observer."""

    def __init__(self, observer, vector, name=None, rate=20.0):
        self.vector = vector
        self._publisher = observer.publisher(WIND_FILTERED, name=name)
        self._clock = observer.node.get_clock()
        self._timer = observer.node.create_timer(1.0 / rate, self.blow)

    def blow(self):
        if self.vector is not None:
            sample = WindSample(self._clock.now().nanoseconds, 'map', *self.vector)
            self._publisher.publish(wind_to_message(Vector3Stamped, sample))


def test_without_wind_the_rest_pose_comes_at_the_full_rate(compose, observer, statuses, tree_file):
    compose(solver={'tree': tree_file})
    frames = observer.listen(SEGMENT_POSES)
    observer.until(lambda: len(frames) > 60, 'a second of frames')
    rest = make_simulator(open_tree(tree_file).tree).place()
    assert frames[0].header.frame_id == 'map'
    np.testing.assert_array_equal(block(frames[0]), rest)
    np.testing.assert_array_equal(block(frames[60]), rest)
    stamps = np.array([stamp(frame) for frame in frames])
    assert np.median(np.diff(stamps)) == pytest.approx(1e9 / 60, rel=1e-6)
    observer.until(lambda: statuses('solver: wind') is not None, 'diagnostics')
    assert statuses('solver: wind').level[0] == WARN
    assert 'no wind yet' in statuses('solver: wind').message
    assert statuses('solver: model').level[0] == OK


def test_a_late_joiner_gets_the_structure_and_the_next_pose(compose, observer, tree_file):
    compose(solver={'tree': tree_file})
    described = observer.listen(TREE_DESCRIPTION)
    observer.until(lambda: described, 'the description')
    description = json.loads(described[0].data)
    frames = observer.listen(SEGMENT_POSES)
    markers = observer.listen(MARKERS)
    observer.until(lambda: frames and markers, 'a frame')
    assert len(frames[0].poses) == len(description['segments']['names']) == 7
    lines = sum(len(marker.points) for marker in markers[0].markers)
    assert lines == 2 * 7


def test_a_subscriber_that_takes_nothing_slows_nobody(compose, observer, tree_file):
    """It asks for all messages and takes none; when it does, it gets the latest, no backlog."""
    nodes = compose(solver={'tree': tree_file})
    idle = rclpy.create_node(
        'idle', context=observer.context
    )  # in no executor: nobody takes for it
    late = idle.create_subscription(PoseArray, 'segment_poses', print, qos_profile(SEGMENT_POSES))
    solver = nodes['solver']
    frames = observer.listen(SEGMENT_POSES)
    observer.until(lambda: frames, 'a frame')
    ticks, published = solver.pacer.timing().ticks, solver.stream.frames
    observer.until(lambda: solver.pacer.timing().ticks > ticks + 90, 'some more ticks')
    # As the solver sees it: what the observer loses itself on a busy machine is not the solver's.
    assert solver.stream.frames - published >= solver.pacer.timing().ticks - ticks - 1
    waited = solver.pacer.timing()
    assert waited.work_mean < 0.5 / 60.0
    begin = stamp(frames[-1])
    observer.until(lambda: stamp(frames[-1]) > begin, 'the newest frame')
    queued = []
    with late.handle:
        while (taken := late.handle.take_message(PoseArray, False)) is not None:
            queued.append(taken[0])
            assert len(queued) <= SEGMENT_POSES.depth
    assert stamp(queued[0]) >= begin - 2 * solver.pacer.period * SEGMENT_POSES.depth
    idle.destroy_node()


def test_a_dropout_decays_to_rest_while_poses_go_on(
    compose, observer, level, tree_file, monkeypatch
):
    brief = partial(WindAverage, timeout=0.4, decay=0.2)
    monkeypatch.setattr(solver_node, 'WindAverage', brief)
    nodes = compose(solver={'tree': tree_file, 'damping_ratio': 0.5})
    frames = observer.listen(SEGMENT_POSES)
    observer.until(lambda: frames, 'a frame')
    rest = block(frames[0])
    breeze = Breeze(observer, (8.0, 0.0, 0.0))
    observer.until(lambda: block(frames[-1])[2, 0] > 1e-3, 'the tree to bend east')
    observer.until(lambda: level('solver: wind') == OK, 'OK')
    breeze.vector = None
    levels = []

    def at_rest():
        levels.append(level('solver: wind'))
        return levels[-1] == ERROR and np.abs(block(frames[-1]) - rest).max() < 1e-4

    observer.until(at_rest, 'rest')
    breeze.vector = (8.0, 0.0, 0.0)
    observer.until(lambda: block(frames[-1])[2, 0] > 1e-3, 'the tree to bend again')
    heard = list(frames)
    x = np.array([block(frame)[2, 0] for frame in heard])
    seconds = np.diff([stamp(frame) for frame in heard]) * 1e-9
    fastest_swing = 2.0 * np.pi * nodes['solver'].simulator.frequencies()[0] * np.ptp(x)
    assert (np.abs(np.diff(x)) / seconds).max() < fastest_swing


@pytest.mark.parametrize('bad', [np.nan, np.inf, 1e300])
def test_bad_wind_leaves_the_state_alone(compose, observer, tree_file, bad):
    nodes = compose(solver={'tree': tree_file})
    frames = observer.listen(SEGMENT_POSES)
    breeze = Breeze(observer, (bad, 0.0, 0.0))
    counts = nodes['solver']._run.counts
    observer.until(lambda: counts.refused > 3 and len(frames) > 5, 'refusals')
    np.testing.assert_array_equal(block(frames[-1]), block(frames[0]))
    breeze.vector = (5.0, 0.0, 0.0)
    observer.until(lambda: block(frames[-1])[2, 0] > 1e-4, 'the tree to bend')


def test_a_change_out_of_range_is_refused_with_the_reason(compose, observer, tree_file):
    nodes = compose(solver={'tree': tree_file})

    def change(name, value):
        request = SetParameters.Request(
            parameters=[Parameter(name, value=value).to_parameter_msg()]
        )
        return observer.call(SetParameters, 'solver/set_parameters', request).results[0]

    assert not change('publish_every', 0).successful
    assert '0 .. 2' in change('wind_delay', 'x').reason
    assert 'read-only' in change('rate', 30.0).reason
    assert nodes['solver'].values['rate'] == 60.0
    frames = observer.listen(SEGMENT_POSES)
    assert change('publish_every', 4).successful
    period = nodes['solver'].pacer.period
    changed = nodes['solver'].get_clock().now().nanoseconds // period + 4
    later = lambda: [tick for tick in (stamp(f) // period for f in frames) if tick > changed]  # noqa: E731
    observer.until(lambda: len(later()) > 6, 'frames')
    groups = [tick // 4 for tick in later()]
    assert len({*groups}) == len(groups)  # none of four has two, however late


def test_a_late_joiner_gets_the_whole_description_once(compose, observer, tree_file):
    compose(solver={'tree': tree_file})
    early = observer.listen(TREE_DESCRIPTION)
    is_whole = lambda: any('state' in json.loads(each.data) for each in early)  # noqa: E731
    observer.until(is_whole, 'the state in the description')
    late, frames = observer.listen(TREE_DESCRIPTION), observer.listen(SEGMENT_POSES)
    observer.until(lambda: len(frames) > 60, 'a second of frames')
    assert len(early) <= 2
    assert [each.data for each in late] == [early[-1].data]


def test_the_tree_is_tuned_while_it_sways(compose, observer, tree_file):
    nodes = compose(solver={'tree': tree_file, 'model': 'branch', 'gravity': 0.0})
    solver = nodes['solver']

    def change(name, value):
        request = SetParameters.Request(
            parameters=[Parameter(name, value=value).to_parameter_msg()]
        )
        return observer.call(SetParameters, 'solver/set_parameters', request).results[0]

    frames = observer.listen(SEGMENT_POSES)
    Breeze(observer, (8.0, 0.0, 0.0))
    observer.until(lambda: frames and block(frames[-1])[2, 0] > 1e-3, 'the tree to bend')
    assert change('damping_ratio', 0.9).successful
    observer.until(lambda: solver.simulator.check_tuning().damping_ratio == 0.9, 'the damping')
    n = len(frames)
    still = lambda: np.ptp([block(frame)[2, 0] for frame in frames[-30:]]) < 1e-5  # noqa: E731
    observer.until(lambda: len(frames) > n + 60 and still(), 'a steady bend')
    lean = block(frames[-1])[2, 0]
    assert change('stiffness_factor', 8.0).successful
    observer.until(lambda: block(frames[-1])[2, 0] < 0.5 * lean, 'less bend')
    assert 'out of range' in change('stiffness_factor', 11.0).reason
    assert 'without weight' in change('gravity', 9.81).reason
    assert not change('volume_rule.stiffness', 1.0e5).successful
    assert 'for the start' in change('damping_ratio', 0.0).reason
    assert solver.values['gravity'] == 0.0
    assert solver.simulator.check_tuning().stiffness_factor == 8.0


POLE = """\
segment,parent,branch,x0,y0,z0,x1,y1,z1,d0,d1
0,-1,0,0,0,0,0,0,3,.012,.012
"""


def test_changes_that_buckle_the_tree_together_are_refused_before_the_first_is_applied(
    compose, tmp_path, monkeypatch
):
    pole = tmp_path / 'pole.csv'
    pole.write_text(POLE)
    solver = compose(solver={'tree': str(pole), 'model': 2})['solver']
    waiting = []
    monkeypatch.setattr(solver._run, 'request', lambda action, refused: waiting.append(action))
    softer, heavier = (
        solver.set_parameters([Parameter(name, value=value)])[0]
        for name, value in (('stiffness_factor', 0.5), ('gravity', 19.6))
    )
    assert softer.successful
    assert not heavier.successful
    assert 'buckles' in heavier.reason
    assert len(waiting) == 1
    for action in waiting:
        action()
    assert solver.simulator.check_tuning().gravity == pytest.approx(9.81, abs=0.01)


def test_pause_holds_the_pose_and_reset_goes_to_rest(compose, observer, tree_file):
    compose(solver={'tree': tree_file})
    frames = observer.listen(SEGMENT_POSES)
    observer.until(lambda: frames, 'a frame')
    rest = block(frames[0])
    breeze = Breeze(observer, (8.0, 3.0, 0.0))
    observer.until(lambda: block(frames[-1])[2, 0] > 1e-3, 'the tree to bend')
    assert observer.call(SetBool, 'solver/pause', SetBool.Request(data=True)).success
    # Frames from before the pause may be heard after its response.
    stands_still = lambda: (block(frames[-1]) == block(frames[-2])).all()  # noqa: E731
    observer.until(stands_still, 'the tree to stand still')
    n = len(frames)
    observer.until(lambda: len(frames) > n + 10, 'frames while paused')
    assert all((block(frame) == block(frames[n - 1])).all() for frame in frames[n:])
    assert observer.call(Trigger, 'solver/reset', Trigger.Request()).success
    observer.until(lambda: (block(frames[-1]) == rest).all(), 'rest')
    breeze.vector = None
    assert observer.call(SetBool, 'solver/pause', SetBool.Request(data=False)).message == 'running'


def test_two_trees_side_by_side(compose, observer, tree_file):
    compose(namespace='oak', solver={'tree': tree_file})
    compose(namespace='elm', solver={'tree': tree_file})
    oak = observer.listen(SEGMENT_POSES, name='oak/segment_poses')
    elm = observer.listen(SEGMENT_POSES, name='elm/segment_poses')
    Breeze(observer, (8.0, 0.0, 0.0), name='oak/wind/filtered')
    observer.until(lambda: oak and block(oak[-1])[2, 0] > 1e-3, 'the oak to bend')
    n = len(elm)  # none, where it is found later than the oak
    observer.until(lambda: len(elm) > n + 10, 'the elm beside it')
    np.testing.assert_array_equal(block(elm[-1]), block(elm[0]))
    topics = dict(observer.node.get_topic_names_and_types())
    assert not {'/segment_poses', '/markers', '/tree_description'} & set(topics)


def test_bytes_on_the_wire_are_a_pose_array(compose, observer, tree_file):
    compose(solver={'tree': tree_file})
    raw = observer.listen(SEGMENT_POSES, raw=True)
    observer.until(lambda: raw, 'a frame')
    assert len(deserialize_message(raw[0], PoseArray).poses) == 7


@pytest.mark.parametrize(
    ('parameters', 'message'),
    [
        ({'tree': 'oka.yaml'}, "no tree 'oka.yaml'"),
        ({'species': 'oka'}, "unknown species 'oka'"),
        ({'model': 'brnch'}, "did you mean 'branch'"),
    ],
)
def test_what_cannot_start_says_why(compose, parameters, message):
    with pytest.raises(TreeSwayError, match=message):
        compose(solver=parameters)


def test_a_parameter_of_another_kind_names_itself(compose):
    with pytest.raises(ParameterError, match="parameter 'rate': 'fast' is not a number"):
        compose(solver={'rate': 'fast'})


def test_two_trees_stand_in_one_frame_each_in_its_place(compose, observer, tree_file):
    compose(namespace='oak', solver={'tree': tree_file, 'pose': (3.0, 0.0, 0.0, 0.0)})
    compose(namespace='elm', solver={'tree': tree_file, 'pose': (0.0, -2.0, 0.0, 1.5708)})
    oak = observer.listen(SEGMENT_POSES, name='oak/segment_poses')
    elm = observer.listen(SEGMENT_POSES, name='elm/segment_poses')
    described = observer.listen(TREE_DESCRIPTION, name='oak/tree_description')
    observer.until(lambda: oak and elm and described, 'frames')
    np.testing.assert_allclose(block(oak[0])[0, :3], (3.0, 0.0, 0.0), atol=1e-12)
    np.testing.assert_allclose(block(elm[0])[0, :3], (0.0, -2.0, 0.0), atol=1e-12)
    assert elm[0].header.frame_id == 'map'
    assert json.loads(described[0].data)['frame_id'] == 'map'


def test_it_answers_what_the_wind_at_a_place_is(compose, observer, statuses, tree_file):
    from geometry_msgs.msg import PointStamped

    from tree_sway_ros.process.topics import WIND_AT, WIND_THERE

    nodes = compose(
        solver={'tree': tree_file, 'model': '4', 'profile': 'log'},
        anemometer={'mean_speed': 8.0, 'intensity': 0.0},
        wind={},
    )
    answers = observer.listen(WIND_THERE, name='solver/wind_there')
    ask = observer.publisher(WIND_AT, name='solver/wind_at')
    frames = observer.listen(WIND_FILTERED)
    observer.until(lambda: len(frames) > 20, 'wind')
    question = PointStamped()
    question.header.stamp.sec = 7

    def is_answered(height):
        question.point.z, question.header.stamp.nanosec = float(height), height
        ask.publish(question)
        return any(each.header.stamp.nanosec == height for each in answers)

    for height in (10, 2):
        observer.until(partial(is_answered, height), 'an answer', poll=0.1)
    speeds = {each.header.stamp.nanosec: each.vector for each in answers}
    assert {each.header.stamp.sec for each in answers} == {7}
    ratio = math.log(2.0 / 0.03) / math.log(10.0 / 0.03)
    high = math.hypot(speeds[10].x, speeds[10].y)
    assert high == pytest.approx(8.0, rel=0.2)
    assert math.hypot(speeds[2].x, speeds[2].y) / high == pytest.approx(ratio, rel=0.1)
    question.header.frame_id = 'moon'
    observer.until(
        lambda: ask.publish(question)
        or ((status := statuses('solver: wind_at')) and status.level[0] == WARN),
        'a warning', poll=0.1,
    )  # fmt: skip
    assert nodes['solver'].is_active


def test_a_scan_that_was_changed_is_said_on_diagnostics(compose, observer, statuses, tmp_path):
    head = 'ID,parentID,startX,startY,startZ,endX,endY,endZ,radius,branchOrder,growthLength'
    rows = [f'{i},{i - 1},0,0,{2 * i},0,0,{2 * i + 2},0.03,0,{20 - 2 * i}' for i in range(10)]
    scan = tmp_path / 'pole.csv'
    scan.write_text('\n'.join([head, *rows]))
    compose(solver={'tree': str(scan), 'model': 2})
    observer.until(lambda: statuses('solver: tree') is not None, 'diagnostics')
    status = statuses('solver: tree')
    assert status.level == bytes([WARN])
    assert 'of 10 segments of 1 limb thickened' in status.message
