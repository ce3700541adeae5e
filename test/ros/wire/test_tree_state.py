# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The state as a message: nothing is lost on the way, and other layouts are refused."""

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from rclpy.serialization import deserialize_message  # noqa: E402, I100
from std_msgs.msg import Float64MultiArray, MultiArrayDimension  # noqa: E402

from tree_sway.errors import FormatError  # noqa: E402
from tree_sway.stream.protocol import PAUSED, WIND_LOST  # noqa: E402
from tree_sway_ros.wire.tree_state import HEAD, ModalState, read_state, StateWriter  # noqa: E402

STATE = ModalState(
    stamp=1_764_098_127_123_456_789,
    wind=np.array([3.0, -4.0, 0.5]),
    flags=PAUSED,
    coordinates=np.array([0.25, -1e-9, 7.0]),
)


def sent(state: ModalState = STATE) -> Float64MultiArray:
    return deserialize_message(StateWriter(3).to_bytes(state), Float64MultiArray)


def assert_equal(read: ModalState, state: ModalState) -> None:
    assert (read.stamp, read.flags) == (state.stamp, state.flags)
    np.testing.assert_array_equal(read.wind, state.wind)
    np.testing.assert_array_equal(read.coordinates, state.coordinates)


@pytest.mark.parametrize('stamp', [0, 999_999_999, STATE.stamp, 2**31 * 10**9 - 1])
def test_a_state_arrives_as_it_was_sent(stamp: int) -> None:
    state = STATE._replace(stamp=stamp)
    assert_equal(read_state(sent(state)), state)


def test_a_writer_writes_one_state_after_another() -> None:
    writer = StateWriter(3)
    later = ModalState(STATE.stamp + 1, np.zeros(3), WIND_LOST, np.arange(3.0))
    for state in (STATE, later):
        read = read_state(deserialize_message(writer.to_bytes(state), Float64MultiArray))
        assert_equal(read, state)


def test_who_goes_by_the_layout_finds_the_coordinates() -> None:
    """As the comments of std_msgs/MultiArrayLayout say: an offset, then the dimensions."""
    layout, data = sent().layout, np.array(sent().data)
    (dimension,) = layout.dim
    array = data[layout.data_offset :].reshape(dimension.size)
    assert (dimension.label, dimension.stride) == ('coordinates', 3)
    np.testing.assert_array_equal(array, STATE.coordinates)


def test_a_reader_without_ros_reads_it_to_the_last_byte() -> None:
    typesys = pytest.importorskip('rosbags.typesys', reason='rosbags is not installed')
    types = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
    message = types.deserialize_cdr(
        StateWriter(3).to_bytes(STATE), 'std_msgs/msg/Float64MultiArray'
    )
    assert_equal(read_state(message), STATE)


@pytest.mark.parametrize(
    ('change', 'why'),
    [
        (lambda m: m.layout.dim.clear(), r'dimensions \[\] from number 6 on'),
        (lambda m: m.layout.dim.append(MultiArrayDimension(label='b')), 'dimensions'),
        (lambda m: setattr(m.layout.dim[0], 'label', 'joints'), 'joints'),
        (lambda m: setattr(m.layout, 'data_offset', 0), 'from number 0 on'),
        (lambda m: m.data.pop(), '8 numbers for 3 coordinates'),
        (lambda m: m.data.append(0.0), '10 numbers for 3 coordinates'),
        (lambda m: setattr(m, 'data', []), '0 numbers for 3 coordinates'),
        (lambda m: m.data.__setitem__(6, float('nan')), 'not finite'),
        (lambda m: m.data.__setitem__(5, float('inf')), 'not finite'),
        (lambda m: m.data.__setitem__(0, 1e300), 'the time 1e[+]300 s'),
        (lambda m: m.data.__setitem__(0, -1.0), 'the time -1 s'),
        (lambda m: m.data.__setitem__(1, 1e9), 'the time'),
    ],
)
def test_a_different_layout_is_refused(change, why) -> None:
    message = sent()
    change(message)
    with pytest.raises(FormatError, match=why):
        read_state(message)


def test_unknown_flags_are_dropped() -> None:
    message = sent()
    message.data[len(HEAD) - 1] = 1e18
    assert read_state(message).flags in (0, PAUSED, WIND_LOST, PAUSED | WIND_LOST)
