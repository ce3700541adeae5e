# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import sys
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from geometry_msgs.msg import TransformStamped, Vector3Stamped  # noqa: E402, I100
from rclpy.qos import QoSProfile, ReliabilityPolicy  # noqa: E402

from tree_sway.growth.builtin import builtin_tree  # noqa: E402
from tree_sway_ros.nodes import wind as wind_node  # noqa: E402
from tree_sway_ros.nodes.wind import WindNode  # noqa: E402
from tree_sway_ros.process.topics import (  # noqa: E402
    CLOCK,
    DIAGNOSTICS,
    qos_profile,
    SEGMENT_POSES,
    TF,
    TF_STATIC,
    WIND,
    WIND_FILTERED,
    WIND_FORCE_PLANE,
)
from tree_sway_ros.reports.diagnostics import ERROR, OK, WARN  # noqa: E402
from tree_sway_ros.wire import frames  # noqa: E402
from tree_sway_ros.wire.wind_messages import (  # noqa: E402
    clock_message,
    fill_stamp,
    stamp_to_ns,
    WIND_CLASSES,
    wind_from_message,
    wind_to_message,
    WindSample,
)

STAMPED = Vector3Stamped
PERIOD = 50_000_000


class Mast:
    """An anemometer in the hand of the test: it says when and what."""

    def __init__(self, observer, type_name='geometry_msgs/Vector3Stamped'):
        self._kind = WIND_CLASSES[type_name]
        self._publisher = observer.publisher(WIND, self._kind)
        self._clock = observer.node.get_clock()

    def say(self, u, v=0.0, w=0.0, stamp=None, frame_id='map'):
        stamp = self._clock.now().nanoseconds if stamp is None else stamp
        sample = WindSample(stamp, frame_id, u, v, w)
        self._publisher.publish(wind_to_message(self._kind, sample))
        return stamp


def vector(message):
    return message.vector.x, message.vector.y, message.vector.z


@pytest.mark.parametrize('convention', ['to', 'from'])
@pytest.mark.parametrize('type_name', WIND_CLASSES)
def test_a_westerly_bends_the_tree_to_the_east(
    compose, observer, tree_file, type_name, convention
):
    """Through the nodes as they are launched: anemometer, wind, solver."""
    kind = {'direction_convention': convention}
    compose(
        solver={'tree': tree_file},
        wind={'input_type': type_name, **kind},
        anemometer={'output_type': type_name, 'intensity': 0.0, **kind},
    )
    frames = observer.listen(SEGMENT_POSES)
    said = observer.listen(WIND, WIND_CLASSES[type_name])
    observer.until(lambda: said and frames, 'wind and frames')
    sign = 1.0 if convention == 'to' else -1.0
    assert wind_from_message(said[-1]).u == pytest.approx(sign * 6.0)
    observer.until(lambda: frames[-1].poses[2].position.x > 1e-3, 'the tree to bend east')
    assert abs(frames[-1].poses[2].position.y) < 1e-4


def test_a_westerly_bends_a_tree_of_the_package_to_the_east(compose, observer):
    tree = 'goldcrest'
    compose(solver={'tree': tree}, wind={}, anemometer={'intensity': 0.0})
    frames = observer.listen(SEGMENT_POSES)
    start = builtin_tree(tree).start
    highest = int(np.argmax(start[:, 2]))
    rest = start[highest]

    def sway():
        position = frames[-1].poses[highest].position
        return position.x - rest[0], position.y - rest[1]

    observer.until(lambda: frames and sway()[0] > 1e-3, 'the tree to bend east')
    assert abs(sway()[1]) < sway()[0]


def test_the_wind_goes_through_with_its_stamp(compose, observer):
    compose(wind={'speed_scale': 0.5, 'yaw_offset': np.pi / 2})
    filtered, plane = observer.listen(WIND_FILTERED), observer.listen(WIND_FORCE_PLANE)
    mast = Mast(observer)
    observer.until(lambda: mast.say(4.0) and filtered and plane, 'wind')
    stamp = mast.say(4.0)
    observer.until(lambda: abs(stamp_to_ns(filtered[-1].header.stamp) - stamp) < 1000, 'the stamp')
    np.testing.assert_allclose(vector(filtered[-1]), (0.0, 2.0, 0.0), atol=1e-12)
    q = plane[-1].pose.orientation  # x along the wind, to the north
    np.testing.assert_allclose((q.w, q.x, q.y, q.z), np.sqrt((0.5, 0, 0, 0.5)), atol=1e-12)


def transform(frame, parent, yaw, stamp=0):
    made = TransformStamped(child_frame_id=frame)
    made.header.frame_id = parent
    fill_stamp(made.header.stamp, stamp)
    made.transform.rotation.z, made.transform.rotation.w = np.sin(yaw / 2), np.cos(yaw / 2)
    return made


@pytest.fixture
def tf(monkeypatch):
    """Give the callbacks of /tf and /tf_static."""
    callbacks, subscribe = {}, WindNode.subscription

    def listen(node, topic, callback, *more, **named):
        if topic not in (TF, TF_STATIC):
            return subscribe(node, topic, callback, *more, **named)
        callbacks[topic.name] = lambda *given: callback(SimpleNamespace(transforms=given))

    monkeypatch.setattr(WindNode, 'subscription', listen)
    return callbacks


def test_wind_in_another_frame_is_turned_by_tf(compose, observer, statuses, tf, capfd):
    """On a boat that lies to the north: what comes over its bow blows to the south."""
    nodes = compose(wind={})
    filtered = observer.listen(WIND_FILTERED)
    mast = Mast(observer)
    listens = lambda: mast.say(-4.0, frame_id='mast') and len(tf) == 2  # noqa: E731
    observer.until(listens, 'the node to listen to /tf')
    assert not filtered  # the transform may be on its way
    tf['/tf_static'](transform('mast', 'boat', 0.0))
    tf['/tf'](transform('boat', 'map', np.pi / 2, stamp=5))
    observer.until(lambda: mast.say(-4.0, frame_id='/mast') and filtered, 'wind')
    np.testing.assert_allclose(vector(filtered[-1]), (0.0, -4.0, 0.0), atol=1e-12)
    assert filtered[-1].header.frame_id == 'map'
    said = "turned into 'map' by /tf"
    observer.until(lambda: said in getattr(statuses('wind: frame'), 'message', ''), said)
    assert statuses('wind: frame').level[0] == OK
    mast.say(np.nan, frame_id='mast')
    observer.until(lambda: nodes['wind']._intake.counts.not_finite == 1, 'the refusal')


def test_wind_in_a_frame_that_nobody_knows_is_taken_as_it_is(
    compose, observer, statuses, tf, capfd, monkeypatch
):
    monkeypatch.setattr(frames, '_PATIENCE', 0.2)
    compose(wind={})
    filtered = observer.listen(WIND_FILTERED)
    mast = Mast(observer)
    observer.until(lambda: mast.say(4.0, frame_id='mast') and len(filtered) > 2, 'wind')
    assert vector(filtered[-1]) == (4.0, 0.0, 0.0)
    said = "wind is in frame 'mast', taken as 'map': no transform between the two on /tf"
    observer.until(lambda: getattr(statuses('wind: frame'), 'message', '') == said, said)
    assert statuses('wind: frame').level[0] == WARN
    assert capfd.readouterr().err.count(said) == 1


def test_without_tf2_one_line_says_so(compose, observer, capfd, monkeypatch):
    monkeypatch.setitem(sys.modules, 'tf2_msgs.msg', None)
    compose(wind={})
    filtered = observer.listen(WIND_FILTERED)
    mast = Mast(observer)
    observer.until(lambda: mast.say(4.0, frame_id='mast') and len(filtered) > 2, 'wind')
    said = "wind is in frame 'mast', taken as 'map': tf2_msgs is not installed"
    assert capfd.readouterr().err.count(said) == 1


def test_transforms_that_are_published_turn_the_wind(compose, observer):
    kind = pytest.importorskip('tf2_msgs.msg', reason='tf2_msgs is not installed').TFMessage
    compose(wind={})
    filtered = observer.listen(WIND_FILTERED)
    mast = Mast(observer)
    fixed = observer.node.create_publisher(kind, TF_STATIC.name, qos_profile(TF_STATIC))
    fixed.publish(kind(transforms=[transform('mast', 'map', np.pi / 2)]))
    observer.until(lambda: mast.say(4.0, frame_id='mast') and filtered, 'wind')
    np.testing.assert_allclose(vector(filtered[0]), (0.0, 4.0, 0.0), atol=1e-12)


@pytest.mark.parametrize('bad', [np.nan, np.inf, -np.inf, 999.99, 1e300, 41.0])
def test_bad_samples_are_refused_and_counted(compose, observer, bad):
    nodes = compose(wind={})
    filtered = observer.listen(WIND_FILTERED)
    mast = Mast(observer)
    observer.until(lambda: mast.say(3.0) and filtered, 'wind')
    counts = nodes['wind']._intake.counts
    for place in range(3):
        mast.say(*np.roll((bad, 0.0, 0.0), place))
    observer.until(lambda: counts.refused == 3, 'refusals')
    n = len(filtered)
    observer.until(lambda: mast.say(3.0) and len(filtered) > n, 'good wind again')
    assert {vector(message) for message in filtered} == {(3.0, 0.0, 0.0)}


def test_a_spike_is_refused_and_a_true_step_passes(compose, observer):
    nodes = compose(wind={'longest_refusal': 0.2})
    filtered = observer.listen(WIND_FILTERED)
    mast = Mast(observer)
    counts = nodes['wind']._intake.counts
    observer.until(lambda: mast.say(2.0) and filtered, 'wind')
    start, n = mast.say(2.0), counts.accepted
    mast.say(30.0, stamp=start + PERIOD)
    mast.say(2.0, stamp=start + 2 * PERIOD)
    observer.until(lambda: counts.accepted >= n + 1 and counts.spike == 1, 'a spike')
    observer.until(lambda: mast.say(30.0) and filtered[-1].vector.x == 30.0, 'the step')
    assert counts.forced == 1
    heard = list(filtered)
    speeds = np.array([message.vector.x for message in heard])
    seconds = 1e-9 * np.diff([stamp_to_ns(message.header.stamp) for message in heard])
    assert (np.diff(speeds) <= 20.0 * seconds + 1e-6).all()


def test_stamps_that_lie_are_counted_and_never_step_back(compose, observer):
    nodes = compose(wind={})
    filtered = observer.listen(WIND_FILTERED)
    mast = Mast(observer)
    observer.until(lambda: mast.say(2.9) and filtered, 'wind')
    now = mast.say(3.0)
    stamps = (0, now + 3600 * 10**9, now, now - PERIOD, now - 3600 * 10**9)
    for k, stamp in enumerate(stamps):
        mast.say(3.1 + 0.1 * k, stamp=stamp)
    observer.until(lambda: filtered[-1].vector.x == pytest.approx(3.5), 'every sample')
    counts = nodes['wind']._intake.counts
    assert (counts.zero_stamp, counts.future_stamp, counts.old_stamp) == (1, 1, 1)
    assert counts.out_of_order == 2
    assert (np.diff([stamp_to_ns(m.header.stamp) for m in filtered]) > 0).all()
    assert [round(m.vector.x, 1) for m in filtered[-6:]] == [3.0, 3.1, 3.2, 3.3, 3.4, 3.5]


def test_a_frozen_sensor_is_a_warning(compose, observer, statuses, level):
    compose(wind={'frozen_after': 1.0})
    mast = Mast(observer)
    observer.until(lambda: mast.say(3.2) and mast.say(3.1) and level('wind: wind') == OK, 'OK')
    observer.until(lambda: mast.say(3.0) and level('wind: wind') == WARN, 'a warning')
    assert 'frozen' in statuses('wind: wind').message
    observer.until(lambda: mast.say(3.2) and mast.say(3.1) and level('wind: wind') == OK, 'OK')


def test_a_silent_sensor_goes_from_warn_to_error(compose, observer, statuses, level):
    compose(wind={'timeout': 0.3})
    observer.until(lambda: level('wind: wind') == WARN, 'a warning')
    assert 'no wind yet' in statuses('wind: wind').message
    mast = Mast(observer)
    observer.until(lambda: mast.say(3.0) and level('wind: wind') == OK, 'OK')
    observer.until(lambda: level('wind: wind') == ERROR, 'ERROR')


def test_a_sensor_of_another_type_is_named(compose, observer, statuses):
    compose(wind={'input_type': 'geometry_msgs/TwistStamped'})
    observer.node.create_publisher(STAMPED, WIND.name, 10)
    named = 'set input_type to read geometry_msgs/Vector3Stamped'
    observer.until(lambda: named in getattr(statuses('wind: wind'), 'message', ''), 'the type')


def test_a_message_without_a_stamp_takes_its_arrival(compose, observer):
    compose(wind={'input_type': 'geometry_msgs/Vector3'})
    filtered = observer.listen(WIND_FILTERED)
    mast = Mast(observer, 'geometry_msgs/Vector3')
    before = observer.node.get_clock().now().nanoseconds
    observer.until(lambda: mast.say(3.0) and len(filtered) > 2, 'wind')
    stamps = [stamp_to_ns(message.header.stamp) for message in filtered]
    assert stamps == sorted(stamps)
    assert 0 <= stamps[0] - before < 10 * 10**9


def test_a_foreign_sample_is_reported_for_a_while_and_cut(
    compose, observer, statuses, level, monkeypatch
):
    monkeypatch.setattr(frames, '_PATIENCE', 0.0)
    monkeypatch.setattr(wind_node, '_RECENT', 1.5)
    compose(wind={})
    mast = Mast(observer)
    name = 'm' * 100_000
    observer.until(
        lambda: mast.say(4.0, frame_id=name) and level('wind: frame') == WARN, 'a warning'
    )
    assert len(statuses('wind: frame').message) < 200
    observer.until(lambda: mast.say(4.0) and level('wind: frame') == OK, 'its end')


def test_each_report_has_the_same_statuses(compose, observer, tree_file):
    """A status that comes and goes is stale for an aggregator."""
    reports = observer.listen(DIAGNOSTICS)
    nodes = compose(wind={}, solver={'tree': tree_file})

    def names(node):
        arrays = [[each.name for each in report.status] for report in reports]
        return [each for each in arrays if each[0].startswith(node)]

    observer.until(lambda: len(names('wind')) > 1 and len(names('solver')) > 1, 'reports')
    for node in ('wind', 'solver'):
        nodes[node].guard.note(ValueError('seen'))
    nodes['solver'].refusals.note('push', 'no such segment')
    n, m = len(names('wind')), len(names('solver'))
    observer.until(lambda: len(names('wind')) > n and len(names('solver')) > m, 'further reports')
    assert {*map(tuple, names('wind'))} == {('wind: wind', 'wind: frame', 'wind: callbacks')}
    (of_solver,) = {*map(tuple, names('solver'))}
    assert {'solver: camera', 'solver: push', 'solver: pull', 'solver: callbacks'} < {*of_solver}
    for node in nodes.nodes:
        node.guard.count = 0  # seen; the fixture asks for none


def test_of_two_anemometers_on_one_topic_one_is_used(compose, observer, statuses):
    """They measure opposite winds: the samples of the second are refused, and both are named."""
    winds = observer.listen(WIND_FILTERED)
    compose(wind={})
    for name, bearing in (('west', 0.5), ('east', 1.5)):
        calm = {'intensity': 0.0, 'mean_speed': 15.0, 'bearing_to': bearing * np.pi}
        mast = compose(namespace=name, anemometer=calm)[f'{name}/anemometer']
        mast._publisher = mast.create_publisher(STAMPED, f'/{WIND.name}', qos_profile(WIND))
        observer.until(lambda: len(winds) > 5, 'the first')

    def said():
        return getattr(statuses('wind: wind'), 'message', '')

    named = '2 publishers: /east/anemometer, /west/anemometer; one is followed'
    observer.until(lambda: named in said(), 'both names')
    assert 'samples of others were refused' in said()
    assert statuses('wind: wind').level[0] == WARN
    n = len(winds)
    observer.until(lambda: len(winds) > n + 20, 'wind')
    assert {np.sign(vector(each)[0]) for each in winds} == {1.0}


def test_the_first_samples_of_a_replay_wait_for_a_subscriber(compose, observer, monkeypatch):
    """Processes may take longer to find each other than a player waits."""
    monkeypatch.setattr(wind_node, '_LONGEST_HOLD', 1e3)
    node = compose(wind={'use_sim_time': True})['wind']
    clock, mast = observer.publisher(CLOCK), Mast(observer)
    observer.until(
        lambda: clock.publish(clock_message(10**9)) or node.get_clock().now().nanoseconds,
        'the clock to begin',
    )
    stamps = iter(range(10**9, 10**10, PERIOD))
    told = [mast.say(5.0, stamp=next(stamps)) for _ in range(4)]
    observer.until(lambda: node._intake.counts.accepted == 4, 'the samples')
    heard = observer.listen(WIND_FILTERED)

    def tell():
        clock.publish(clock_message(told[-1]))
        told.append(mast.say(5.0, stamp=next(stamps)))

    observer.until(lambda: tell() or heard, 'the wind', poll=0.05)
    observer.until(lambda: len(heard) >= 4, 'all of it')
    assert [stamp_to_ns(each.header.stamp) for each in heard[:4]] == told[:4]


@pytest.mark.parametrize('node', ['wind', 'solver'])
def test_in_a_replay_a_driver_of_best_effort_is_heard(compose, observer, tree_file, node):
    """Alone, and beside a reliable one: the subscription is made again."""
    topic = WIND if node == 'wind' else WIND_FILTERED
    parameters = {'use_sim_time': True, **({'tree': tree_file} if node == 'solver' else {})}
    nodes = compose(**{node: parameters})
    counts = nodes[node]._intake.counts if node == 'wind' else nodes[node]._run.counts
    clock = observer.publisher(CLOCK)
    reliable = observer.publisher(topic)
    best_effort = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    driver = observer.node.create_publisher(STAMPED, topic.name, best_effort)
    now = iter(range(10**9, 10**12, 10_000_000))

    def accepted_of(publisher):
        before = counts.accepted
        observer.until(lambda: say(publisher) or counts.accepted > before, 'its wind')

    def say(publisher):
        stamp = next(now)
        clock.publish(clock_message(stamp))
        publisher.publish(wind_to_message(STAMPED, WindSample(stamp, 'map', 3.0, 0.0, 0.0)))

    accepted_of(driver)
    accepted_of(reliable)
    (subscription,) = [
        each for each in nodes[node].subscriptions if each.topic_name == f'/{topic.name}'
    ]
    assert subscription.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT


def test_a_publisher_whose_node_is_not_found_yet_says_so(compose, monkeypatch):
    """The name that rmw gives it is nothing a person could look for."""
    node = compose(wind={})['wind']
    kind = 'geometry_msgs/msg/Vector3Stamped'
    names = (('/east', 'mast'), ('_NODE_NAMESPACE_UNKNOWN_', '_NODE_NAME_UNKNOWN_'))
    found = [
        SimpleNamespace(node_namespace=space, node_name=name, topic_type=kind)
        for space, name in names
    ]
    monkeypatch.setattr(node, 'get_publishers_info_by_topic', lambda _topic: found)
    said = node.publishers_of('wind', 'geometry_msgs/Vector3Stamped')
    assert said == ['/east/mast', 'a node not found yet']
