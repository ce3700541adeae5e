# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.ros

from hypothesis import given  # noqa: E402, I100
from hypothesis import strategies as st  # noqa: E402

from tree_sway_ros.wire.wind_messages import (  # noqa: E402
    clock_message,
    plane_message,
    stamp_to_ns,
    WIND_CLASSES,
    wind_from_message,
    wind_to_message,
    WindSample,
    WindWriter,
)

NUMBERS = st.floats(-100.0, 100.0)


@given(
    st.sampled_from(sorted(WIND_CLASSES)),
    st.integers(0, 2**31 * 10**9 - 1),
    NUMBERS,
    NUMBERS,
    NUMBERS,
)
def test_what_is_written_is_read_again(type_name, stamp, u, v, w):
    kind = WIND_CLASSES[type_name]
    sample = WindSample(stamp, 'mast', u, v, w)
    read = wind_from_message(wind_to_message(kind, sample))
    expected = sample if hasattr(kind(), 'header') else WindSample(0, '', u, v, w)
    assert read == expected


@pytest.mark.parametrize(('first', 'is_there'), [(0.0, True), (0.04, True), (-1.0, False)])
def test_a_covariance_of_minus_one_is_no_reading(first, is_there):
    kind = WIND_CLASSES['geometry_msgs/TwistWithCovarianceStamped']
    message = wind_to_message(kind, WindSample(1, 'map', 4.0, 0.0, 0.0))
    message.twist.covariance[0] = first
    assert np.isfinite(wind_from_message(message)[2:]).all() == is_there


def test_whole_numbers_are_no_trap():
    sample = WindSample(1, 'map', 1, 2, 3)
    message = wind_to_message(WIND_CLASSES['geometry_msgs/Vector3'], sample)
    assert (message.x, message.y, message.z) == (1.0, 2.0, 3.0)


@pytest.mark.parametrize('type_name', WIND_CLASSES)
@pytest.mark.parametrize(('convention', 'sign'), [('to', 1.0), ('from', -1.0)])
def test_the_writer_keeps_the_convention(type_name, convention, sign):
    message = WindWriter(type_name, convention, 'map').message(5, np.array([1.0, -2.0, 0.5]))
    sample = wind_from_message(message)
    assert sample[2:] == (sign * 1.0, sign * -2.0, sign * 0.5)


def test_the_plane_has_the_quaternion_in_message_order():
    message = plane_message(3_000_000_001, 'map', np.array([0.5, 0.1, 0.2, 0.3]))
    q = message.pose.orientation
    assert (q.w, q.x, q.y, q.z) == (0.5, 0.1, 0.2, 0.3)
    assert stamp_to_ns(message.header.stamp) == 3_000_000_001


def test_the_clock():
    assert stamp_to_ns(clock_message(7_000_000_003).clock) == 7_000_000_003
