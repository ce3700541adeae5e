# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Sites that have the same wind agree, whenever it comes and whenever they begin."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from tree_sway_ros.errors import FormatError, StateError
from tree_sway_ros.files.trees.source import open_tree
from tree_sway_ros.relay.tree_site import PATIENCE, Site
from tree_sway_ros.relay.wind_bytes import decode_wind, encode_wind

START = 1_700_000_000_123_456_789
SECOND = 1_000_000_000


def winds(seconds: float) -> list[tuple[int, Any]]:
    """Make a gusty wind at 20 Hz."""
    times = np.arange(0.0, seconds, 0.05)
    vectors = np.stack([6 + 2 * np.sin(2 * times), np.cos(3 * times), 0 * times], axis=1)
    return [(START + round(t * SECOND), v) for t, v in zip(times, vectors, strict=True)]


def made(name: str = 'goldcrest', **options: Any) -> Site:
    return Site(open_tree(name).simulator(model='modes'), **options)


def poses(site: Site) -> Any:
    return site.simulator.place().copy()


def test_steps_do_not_depend_on_when_the_wind_comes() -> None:
    one, other = made(), made()
    samples = winds(3.0)
    for stamp, vector in samples:
        one.add_wind(stamp, vector)
    for k in range(0, len(samples), 7):
        for stamp, vector in samples[k : k + 7]:
            other.add_wind(stamp, vector)
            other.add_wind(stamp, vector)  # twice
    np.testing.assert_array_equal(poses(one), poses(other))
    assert np.linalg.norm(one.simulator.tip_displacement) > 1e-3


def test_who_joins_by_a_snapshot_goes_on_bit_for_bit() -> None:
    ends: list[int] = []
    one, other = made(), made(stepped=lambda stamp, _: ends.append(stamp))
    samples = winds(4.0)
    assert one.snapshot() == ''
    for k, (stamp, vector) in enumerate(samples):
        one.add_wind(stamp, vector)
        if k > 38:
            other.add_wind(stamp, vector)  # it hears the wind before it asks for the snapshot
        if k == 40:
            other.join(one.snapshot())
    np.testing.assert_array_equal(poses(one), poses(other))
    assert np.unique(np.diff(ends)).tolist()[0] > 0
    assert other.n_joined == 1


def test_a_wind_that_ends_is_held() -> None:
    ends: list[int] = []
    site = made(stepped=lambda stamp, _: ends.append(stamp))
    site.hold_wind(START)  # before any wind
    site.add_wind(START, (5.0, 0.0, 0.0))
    site.hold_wind(START + 3 * SECOND)
    assert len(ends) == pytest.approx(60 * (3.0 - PATIENCE), abs=1)
    site.add_wind(START + SECOND // 2, (9.0, 0.0, 0.0))  # too late to be felt from its time on
    assert len(ends) == pytest.approx(60 * (3.0 - PATIENCE), abs=1)


def test_another_tree_or_nonsense_is_refused() -> None:
    one, other = made(), made('benjamina')
    with pytest.raises(StateError, match='the other site has tree'):
        one.check(other.identity())
    one.check(made().identity())
    other.add_wind(START, (5.0, 0.0, 0.0))
    with pytest.raises(StateError, match='state of tree'):
        one.join(other.snapshot())
    for broken in ('', '[]', '{}', json.dumps({'step': 1, 'wind': [[1]], 'state': ''})):
        with pytest.raises(StateError):
            one.join(broken)


@pytest.mark.parametrize('frame_id', ['', 'map', 'a longer frame'])
def test_the_wind_is_a_message_of_ros(frame_id: str) -> None:
    data = encode_wind(START, (1.5, -2.0, 0.25), frame_id)
    assert decode_wind(data) == (START, (1.5, -2.0, 0.25))
    with pytest.raises(FormatError):
        decode_wind(data[:-1])
    with pytest.raises(FormatError, match='not finite'):
        decode_wind(encode_wind(START, (float('nan'), 0.0, 0.0), frame_id))
    typesys = pytest.importorskip('rosbags.typesys')
    types = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
    message = types.deserialize_cdr(data, 'geometry_msgs/msg/Vector3Stamped')
    assert (message.header.frame_id, message.vector.y) == (frame_id, -2.0)
    assert message.header.stamp.sec * SECOND + message.header.stamp.nanosec == START
    assert bytes(types.serialize_cdr(message, 'geometry_msgs/msg/Vector3Stamped')) == data
