# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")
pytestmark = pytest.mark.ros

from tree_sway_ros.core.growth.builtin import BUILTIN_TREES, builtin_tree  # noqa: E402
from tree_sway_ros.ros.parameters.node_parameters import WIND_TYPE_NAMES  # noqa: E402
from tree_sway_ros.ros.process.topics import FORCE_PLANE, SEGMENT_POSES, WIND, WIND_FILTERED  # noqa: E402
from tree_sway_ros.ros.reports.diagnostics import OK, STALE, WARN  # noqa: E402
from tree_sway_ros.ros.wire.wind_messages import (  # noqa: E402
    WindSample,
    stamp_to_ns,
    wind_class,
    wind_from_message,
    wind_to_message,
)

STAMPED = wind_class(WIND_TYPE_NAMES[0])
PERIOD = 50_000_000


class Mast:
    """An anemometer in the hand of the test: it says when and what."""

    def __init__(self, observer, type_name=WIND_TYPE_NAMES[0]):
        self._kind = wind_class(type_name)
        self._publisher = observer.publisher(WIND, self._kind)
        self._clock = observer.node.get_clock()

    def say(self, u, v=0.0, w=0.0, stamp=None):
        stamp = self._clock.now().nanoseconds if stamp is None else stamp
        sample = WindSample(stamp, "map", u, v, w)
        self._publisher.publish(wind_to_message(self._kind, sample))
        return stamp


def vector(message):
    return message.vector.x, message.vector.y, message.vector.z


@pytest.mark.parametrize("convention", ["to", "from"])
@pytest.mark.parametrize("type_name", WIND_TYPE_NAMES)
def test_a_westerly_bends_the_tree_to_the_east(compose, observer, tree_file, type_name, convention):
    """Through the nodes as they are launched: anemometer, wind, solver."""
    kind = {"direction_convention": convention}
    compose(
        solver={"tree": tree_file},
        wind={"input_type": type_name, **kind},
        anemometer={"output_type": type_name, "turbulence": "none", **kind},
    )
    frames = observer.listen(SEGMENT_POSES)
    said = observer.listen(WIND, wind_class(type_name))
    observer.until(lambda: said and frames, "wind and frames")
    sign = 1.0 if convention == "to" else -1.0
    assert wind_from_message(said[-1]).u == pytest.approx(sign * 6.0)
    observer.until(lambda: frames[-1].poses[2].position.x > 1e-3, "the tree to bend east")
    assert abs(frames[-1].poses[2].position.y) < 1e-4


@pytest.mark.parametrize("tree", BUILTIN_TREES)
def test_a_westerly_bends_every_tree_to_the_east(compose, observer, tree):
    compose(solver={"tree": tree}, wind={}, anemometer={"turbulence": "none"})
    frames = observer.listen(SEGMENT_POSES)
    start = builtin_tree(tree).start
    highest = int(np.argmax(start[:, 2]))
    rest = start[highest]

    def sway():
        position = frames[-1].poses[highest].position
        return position.x - rest[0], position.y - rest[1]

    observer.until(lambda: frames and sway()[0] > 1e-3, "the tree to bend east")
    assert abs(sway()[1]) < sway()[0]


def test_the_wind_goes_through_with_its_stamp(compose, observer):
    compose(wind={"speed_scale": 0.5, "yaw_offset": np.pi / 2})
    filtered, plane = observer.listen(WIND_FILTERED), observer.listen(FORCE_PLANE)
    mast = Mast(observer)
    observer.until(lambda: mast.say(4.0) and filtered and plane, "wind")
    stamp = mast.say(4.0)
    observer.until(lambda: abs(stamp_to_ns(filtered[-1].header.stamp) - stamp) < 1000, "the stamp")
    np.testing.assert_allclose(vector(filtered[-1]), (0.0, 2.0, 0.0), atol=1e-12)
    q = plane[-1].pose.orientation  # x along the wind, to the north
    np.testing.assert_allclose((q.w, q.x, q.y, q.z), np.sqrt((0.5, 0, 0, 0.5)), atol=1e-12)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 999.99, 1e300, 41.0])
def test_bad_samples_are_refused_and_counted(compose, observer, bad):
    nodes = compose(wind={})
    filtered = observer.listen(WIND_FILTERED)
    mast = Mast(observer)
    observer.until(lambda: mast.say(3.0) and filtered, "wind")
    counts = nodes["wind"]._intake.counts
    for place in range(3):
        mast.say(*np.roll((bad, 0.0, 0.0), place))
    observer.until(lambda: counts.refused == 3, "refusals")
    n = len(filtered)
    observer.until(lambda: mast.say(3.0) and len(filtered) > n, "good wind again")
    assert {vector(message) for message in filtered} == {(3.0, 0.0, 0.0)}


def test_a_spike_is_refused_and_a_true_step_passes(compose, observer):
    nodes = compose(wind={"longest_refusal": 0.2})
    filtered = observer.listen(WIND_FILTERED)
    mast = Mast(observer)
    counts = nodes["wind"]._intake.counts
    observer.until(lambda: mast.say(2.0) and filtered, "wind")
    start, n = mast.say(2.0), counts.accepted
    mast.say(30.0, stamp=start + PERIOD)
    mast.say(2.0, stamp=start + 2 * PERIOD)
    observer.until(lambda: counts.accepted >= n + 1 and counts.spike == 1, "a spike")
    for k in range(3, 9):
        mast.say(30.0, stamp=start + k * PERIOD)
    observer.until(lambda: filtered[-1].vector.x == 30.0, "the step")
    assert counts.forced == 1


def test_stamps_that_lie_are_counted_and_never_step_back(compose, observer):
    nodes = compose(wind={})
    filtered = observer.listen(WIND_FILTERED)
    mast = Mast(observer)
    observer.until(lambda: mast.say(2.9) and filtered, "wind")
    now = mast.say(3.0)
    stamps = (0, now + 3600 * 10**9, now, now - PERIOD, now - 3600 * 10**9)
    for k, stamp in enumerate(stamps):
        mast.say(3.1 + 0.1 * k, stamp=stamp)
    observer.until(lambda: filtered[-1].vector.x == pytest.approx(3.5), "every sample")
    counts = nodes["wind"]._intake.counts
    assert (counts.zero_stamp, counts.future_stamp, counts.old_stamp) == (1, 1, 1)
    assert counts.out_of_order + counts.duplicate_stamp == 2
    assert (np.diff([stamp_to_ns(m.header.stamp) for m in filtered]) > 0).all()
    assert [round(m.vector.x, 1) for m in filtered[-6:]] == [3.0, 3.1, 3.2, 3.3, 3.4, 3.5]


def test_a_frozen_sensor_is_a_warning(compose, observer, statuses, level):
    compose(wind={"frozen_after": 1.0})
    mast = Mast(observer)
    observer.until(lambda: mast.say(3.2) and mast.say(3.1) and level("wind: wind") == OK, "OK")
    observer.until(lambda: mast.say(3.0) and level("wind: wind") == WARN, "a warning")
    assert "frozen" in statuses("wind: wind").message
    observer.until(lambda: mast.say(3.2) and mast.say(3.1) and level("wind: wind") == OK, "OK")


def test_a_silent_sensor_goes_from_warn_to_stale(compose, observer, statuses, level):
    compose(wind={"timeout": 0.3})
    observer.until(lambda: level("wind: wind") == WARN, "a warning")
    assert "no wind yet" in statuses("wind: wind").message
    mast = Mast(observer)
    observer.until(lambda: mast.say(3.0) and level("wind: wind") == OK, "OK")
    observer.until(lambda: level("wind: wind") == STALE, "STALE")


def test_a_sensor_of_another_type_is_named(compose, observer, statuses):
    compose(wind={"input_type": "geometry_msgs/TwistStamped"})
    observer.node.create_publisher(STAMPED, WIND.name, 10)
    named = "set input_type to read geometry_msgs/Vector3Stamped"
    observer.until(lambda: named in getattr(statuses("wind: wind"), "message", ""), "the type")


def test_a_message_without_a_stamp_takes_its_arrival(compose, observer):
    compose(wind={"input_type": "geometry_msgs/Vector3"})
    filtered = observer.listen(WIND_FILTERED)
    mast = Mast(observer, "geometry_msgs/Vector3")
    before = observer.node.get_clock().now().nanoseconds
    observer.until(lambda: mast.say(3.0) and len(filtered) > 2, "wind")
    stamps = [stamp_to_ns(message.header.stamp) for message in filtered]
    assert stamps == sorted(stamps)
    assert 0 <= stamps[0] - before < 10 * 10**9
