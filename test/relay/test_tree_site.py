# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Sites that have the same wind agree, whenever it comes and whenever they begin."""

from __future__ import annotations

import base64
import json
import math
from pathlib import Path
import time
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.scene.run import LONGEST_JUMP
from tree_sway.core.scene.scene import Scene
from tree_sway.errors import FormatError, StateError
from tree_sway.files.trees.source import open_scene
from tree_sway.relay.tree_site import PATIENCE, Site
from tree_sway.relay.wind_bytes import decode_wind, encode_wind

HOSTILE = pytest.mark.usefixtures('little_effort')
START = 1_700_000_000_123_456_789
SECOND = 1_000_000_000
SEEDLING = Path(__file__).parents[1] / 'files' / 'data' / 'seedling.yaml'
SCENE = open_scene(SEEDLING, length_unit=2.0)


def winds(seconds: float) -> list[tuple[int, Any]]:
    """Make a gusty wind at 20 Hz."""
    times = np.arange(0.0, seconds, 0.05)
    vectors = np.stack([6 + 2 * np.sin(2 * times), np.cos(3 * times), 0 * times], axis=1)
    return [(START + round(t * SECOND), tuple(v)) for t, v in zip(times, vectors, strict=True)]


def made(scene: Scene = SCENE, **options: Any) -> Site:
    return Site(scene.simulator(model=12), **options)  # type: ignore[arg-type]


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
            other.join(one.snapshot(), stamp)
    np.testing.assert_array_equal(poses(one), poses(other))
    assert np.unique(np.diff(ends)).tolist()[0] > 0


def test_who_joins_late_or_loses_wind_is_near_after_half_a_minute() -> None:
    one, late, lossy = made(), made(), made()
    lost, apart = np.random.default_rng(0), []
    for k, (stamp, vector) in enumerate(winds(50.0)):
        one.add_wind(stamp, vector)
        if k > 200:
            late.add_wind(stamp, vector)
        if lost.random() >= 0.05:
            lossy.add_wind(stamp, vector)
        tips = [site.simulator.tip_displacement for site in (one, late, lossy)]
        apart.append([np.linalg.norm(tip - tips[0]) for tip in tips])
    _, joined, losing = np.array(apart).T
    assert joined[201:220].max() > 1e-3  # it began from rest
    assert np.quantile(joined[800:], 0.95) < 5e-3
    assert 0.0 < np.quantile(losing[100:], 0.95) < 0.02


def test_a_wind_that_ends_is_held_and_dies_down() -> None:
    ends: list[int] = []
    felt: list[float] = []

    def note(stamp: int, wind: Any) -> None:
        ends.append(stamp)
        felt.append(float(wind[0]))

    site = made(stepped=note)
    site.hold_wind(START)  # before any wind
    for k in range(20):
        site.add_wind(START + k * SECOND // 20, (5.0, 0.0, 0.0))
    for k in range(1, 400):
        site.hold_wind(START + k * SECOND // 20)
    assert len(ends) == pytest.approx(60 * (20.0 - PATIENCE), abs=4)
    assert felt[60 * 2] == pytest.approx(5.0)
    assert 0.0 < felt[-1] < 0.1
    site.add_wind(START + SECOND // 2, (9.0, 0.0, 0.0), START + 20 * SECOND)
    assert len(ends) <= 60 * 20


@HOSTILE
def test_a_sample_far_ahead_takes_few_steps_and_holds_nothing() -> None:
    ends: list[int] = []
    site = made(stepped=lambda stamp, _: ends.append(stamp))
    now = START
    for ahead in (0, 60, 0, 10**9, 0, -(10**9), 0, 0):
        before = len(ends)
        now += SECOND // 20
        site.add_wind(now + ahead * SECOND, (5.0, 0.0, 0.0), now)
        assert len(ends) - before <= 4
    site.add_wind(now + 3600 * SECOND, (5.0, 0.0, 0.0))  # without a clock of one's own
    assert len(ends) - before <= 4 + LONGEST_JUMP // site.run.period


def test_another_tree_is_named_and_its_state_refused() -> None:
    one, other = made(), made(open_scene(SEEDLING.with_name('segments.csv')))
    one.add_wind(START, (5.0, 0.0, 0.0))
    other.add_wind(START, (5.0, 0.0, 0.0))
    assert 'tree' in one.differences(other.snapshot())
    assert 'rate' in made(rate=50).differences(one.snapshot())
    assert made().differences(one.snapshot()) == ''
    with pytest.raises(StateError, match='state of tree'):
        one.join(other.snapshot(), START)
    with pytest.raises(StateError, match='another time'):
        one.join(other.snapshot(), START + 3600 * SECOND)


ODD = [
    *('', '[]', '{}', '1', 'null', '"x"', '{', '[' * 200_000, 'NaN', '\x00'),
    *(json.dumps({'run': each, 'state': ''}) for each in (None, [], 1, [1, 2, [], []], 'wind')),
]


@HOSTILE
@pytest.mark.parametrize('odd', ODD, ids=range(len(ODD)))
def test_what_is_no_snapshot_and_no_identity_is_refused(odd: str) -> None:
    site = FUZZED
    before = site.snapshot()
    for refused in (odd, odd.encode(), b'\xff' + odd.encode()):
        with pytest.raises(StateError):
            site.join(refused, START)
        with pytest.raises(StateError):
            site.differences(refused)
    assert site.snapshot() == before


@HOSTILE
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_damaged_snapshots_are_refused_or_go_on_finite(data: Any) -> None:
    site, begin = FUZZED, time.monotonic()
    content = json.loads(SNAPSHOT)
    field = data.draw(st.sampled_from(['time', 'origin', 'wind', 'samples', 'state']))
    odd = data.draw(st.one_of(
        st.integers(-(2**70), 2**70), st.floats(), st.none(), st.text(max_size=5),
        st.lists(st.one_of(st.floats(), st.integers()), max_size=14),
    ))  # fmt: skip
    if field == 'state':
        raw = bytearray(base64.b64decode(content['state']))
        raw[data.draw(st.integers(0, len(raw) - 1))] ^= data.draw(st.integers(1, 255))
        content['state'] = base64.b64encode(raw).decode()
    else:
        content['run'][['time', 'origin', 'wind', 'samples'].index(field)] = odd
    try:
        site.join(json.dumps(content), START + SECOND)
    except StateError:
        pass
    site.add_wind(START + 2 * SECOND, (5.0, 0.0, 0.0), START + 2 * SECOND)
    assert np.isfinite(site.simulator.place()).all()
    assert time.monotonic() - begin < 5.0
    site.simulator.reset()


@HOSTILE
@settings(max_examples=150, deadline=None)
@given(data=st.binary(max_size=80), flip=st.integers(0, 51), by=st.integers(0, 255))
def test_any_bytes_are_a_sample_or_are_refused(data: bytes, flip: int, by: int) -> None:
    site, begin = FUZZED, time.monotonic()
    whole = bytearray(encode_wind(START + SECOND, (3.0, 1.0, 0.0)))
    whole[flip % len(whole)] ^= by
    for each in (data, bytes(whole), b'\x00\x01\x00', bytes(whole)[:-1]):
        try:
            stamp, vector = decode_wind(each)
        except FormatError:
            continue
        site.add_wind(stamp, vector, START + SECOND)
    assert np.isfinite(site.simulator.place()).all()
    assert time.monotonic() - begin < 5.0


FUZZED = made()
FUZZED.add_wind(START, (5.0, 0.0, 0.0))
FUZZED.add_wind(START + SECOND // 20, (5.0, 0.0, 0.0))
SNAPSHOT = FUZZED.snapshot()


@HOSTILE
@pytest.mark.parametrize('vector', [(math.nan, 0.0, 0.0), (math.inf, 0.0, 0.0), (1e300, 0, 0)])
def test_a_wind_that_cannot_be_is_refused_and_counted(vector: Any) -> None:
    before = FUZZED.run.counts.refused
    assert FUZZED.add_wind(*decode_wind(encode_wind(START + 9 * SECOND, vector))) is None
    assert FUZZED.run.counts.refused == before + 1


@pytest.mark.parametrize('frame_id', ['', 'map', 'a longer frame'])
def test_the_wind_is_a_message_of_ros(frame_id: str) -> None:
    data = encode_wind(START, (1.5, -2.0, 0.25), frame_id)
    assert decode_wind(data) == (START, (1.5, -2.0, 0.25))
    with pytest.raises(FormatError):
        decode_wind(data[:-1])
    typesys = pytest.importorskip('rosbags.typesys')
    types = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
    message = types.deserialize_cdr(data, 'geometry_msgs/msg/Vector3Stamped')
    assert (message.header.frame_id, message.vector.y) == (frame_id, -2.0)
    assert message.header.stamp.sec * SECOND + message.header.stamp.nanosec == START
    assert bytes(types.serialize_cdr(message, 'geometry_msgs/msg/Vector3Stamped')) == data
