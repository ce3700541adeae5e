# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Whatever is sent as wind: no error, no pose that is not finite, unit quaternions."""

from dataclasses import asdict
import math
import random

import numpy as np
import pytest

from tree_sway.files.wind.instruments import read_instrument
from tree_sway.files.wind.nmea import parse_nmea
from tree_sway.files.wind.reading import WindReading

ODD = (math.nan, math.inf, -math.inf, 0.0, -0.0, 5e-324, 1e300, -1e300, 999.99, 327.68, 40.0, 1e6)
FRAME_IDS = ('map', '', 'mast', '\u2014' * 300)
LAST = (2**31 - 1, 2**32 - 1)
"""The largest that the two fields of a stamp hold."""
BLOCK, PER_FRAME = 1000, 10
"""Messages of one manner, and messages from one frame to the next."""
PERIOD = 16_666_667
JUMPS = (-10_000_000_000, -900_000_000, 30_000_000_000)
"""Of the clock [ns]."""
LINES = (
    '$WIMWV,084.0,T,10.4,N,A*04',
    '$WIMWD,270.0,T,268.0,M,12.4,N,6.4,M*5C',
    '$IIMWV,075,R,1.0,N,A*20',
    'Q,229,002.74,M,00,16',
    'S 00.65 S2 00.65 D 245 U 00.58 V 00.27 W 00.09 T 22.6',
)


class Clock:
    """In place of a node's clock."""

    ros_time_is_active = False
    nanoseconds = 10**18

    def now(self):
        return self

    def to_msg(self):
        from builtin_interfaces.msg import Time

        return Time()


class Outlet:
    """In place of a publisher."""

    def __init__(self, publish):
        self.publish = publish


def velocities(rng):
    """Of a block, (n, 3): steady, frozen, gusty or mad, with odd components."""
    size = rng.choice((0.0, 0.3, 3.0, 8.0, 100.0))
    values = rng.normal(0.0, 5.0, 3) + rng.normal(0.0, size, (BLOCK, 3))
    is_odd = rng.random((BLOCK, 3)) < rng.choice((0.0, 0.0, 0.02, 0.3, 1.0))
    return np.where(is_odd, rng.choice(ODD, (BLOCK, 3)), values)


def stamps(rng, times):
    """Seconds and nanoseconds of a block, (n, 2), and those that are said twice."""
    is_wrong = rng.random(BLOCK) < rng.choice((0.0, 0.0, 0.05, 0.4, 1.0))
    kind = np.where(is_wrong, rng.integers(1, 6, BLOCK), 0)
    stamps = times - 1_000_000
    for number, most in ((1, 50_000_000), (2, 600_000_000), (3, 10**11)):
        there = kind == number
        stamps[there] += rng.integers(-most, most, there.sum())
    fields = np.stack(np.divmod(stamps, 10**9), axis=1)
    wild = kind == 4
    fields[wild] = rng.integers((-(2**31), 0), LAST, (wild.sum(), 2), endpoint=True)
    fields[wild & (rng.random(BLOCK) < 0.5)] = ((0, 0), (0, 1), (-(2**31), 0), LAST)[
        rng.integers(4)
    ]
    again = np.flatnonzero(kind == 5)
    fields[again] = fields[again - 1]
    return fields, again


class Sender:
    """Messages of all types that wind comes in, each one object that is written repeatedly."""

    def __init__(self):
        from geometry_msgs import msg

        plain, twist, vector = msg.Vector3Stamped(), msg.TwistStamped(), msg.Vector3()
        covariant = msg.TwistWithCovarianceStamped()
        self._kinds = (
            (plain, plain.header, plain.vector),
            (twist, twist.header, twist.twist.linear),
            (covariant, covariant.header, covariant.twist.twist.linear),
            (vector, None, vector),
        )

    def block(self, rng, times):
        """Messages that arrive at times in [ns], (n,)."""
        wind = velocities(rng)
        fields, again = stamps(rng, times)
        wind[again] = wind[again - 1]
        for _, header, _ in self._kinds[:3]:
            header.frame_id = FRAME_IDS[rng.integers(len(FRAME_IDS))]
        kinds = np.where(rng.random(BLOCK) < 0.9, 0, rng.integers(4, size=BLOCK)).tolist()
        for kind, (x, y, z), stamp in zip(kinds, wind.tolist(), fields.tolist(), strict=True):
            message, header, vector = self._kinds[kind]
            vector.x, vector.y, vector.z = x, y, z
            if header is not None:
                header.stamp.sec, header.stamp.nanosec = stamp
            yield message


def fuzz(wind, solver, n, seed):
    """
    Send n messages through the callbacks of both nodes; all frames are looked at.

    What a callback raises is raised here: no guard is around it.

    """
    from tree_sway_ros.timing.pacer import Tick

    rng, clock, sender, planes = np.random.default_rng(seed), Clock(), Sender(), []
    wind._clock = solver._clock = clock
    wind._filtered = Outlet(lambda each: solver._receive(each, {}))
    wind._plane = Outlet(planes.append)
    solver._tick(Tick(clock.nanoseconds // PERIOD * PERIOD, 1, True))
    poses = np.empty((BLOCK // PER_FRAME, *solver.simulator.place().shape))
    for block in range(n // BLOCK):
        jump = JUMPS[block // 10 % len(JUMPS)] if block % 10 == 9 else 0
        clock.nanoseconds += jump
        restarted, before = jump < 0, clock.nanoseconds // PERIOD - (jump < 0)
        times = clock.nanoseconds + np.arange(1, BLOCK + 1) * PERIOD // PER_FRAME
        for k, (message, time) in enumerate(
            zip(sender.block(rng, times), times.tolist(), strict=True), start=1
        ):
            clock.nanoseconds = time
            wind._receive(message, {})
            if k % PER_FRAME == 0:
                index = time // PERIOD
                solver._tick(Tick(index * PERIOD, min(index - before, 30), restarted))
                restarted, before = False, index
                solver.simulator.place(poses[k // PER_FRAME - 1])
        assert np.isfinite(poses).all()
        assert np.abs(np.linalg.norm(poses[..., 3:], axis=-1) - 1.0).max() < 1e-6
        attitude = [(p.x, p.y, p.z, p.w) for p in (each.pose.orientation for each in planes)]
        off = np.linalg.norm(np.reshape(attitude, (-1, 4)), axis=1) - 1.0
        assert np.abs(off).max(initial=0.0) < 1e-6
        planes.clear()
    counts = asdict(wind._intake.counts)
    return counts


@pytest.fixture
def nodes(compose, tree_file, request):
    """Make the wind node and the solver, configured; time is the test's."""
    pytest.importorskip('rclpy', reason='ROS 2 is not installed')
    tree = 'benjamina' if request.node.get_closest_marker('long') else tree_file
    own = {'wind': {'frozen_after': 1.0}, 'solver': {'tree': tree}}
    made = compose(**{name: {**values, 'autostart': False} for name, values in own.items()})
    for node in made.nodes:
        node.configure()
    made['wind'].is_active = True
    return made['wind'], made['solver']


def fuzz_lines(n, seed):
    """Read n damaged lines; return how many of them said a wind."""
    rng, good = random.Random(seed), 0
    for _ in range(n):
        line = list(rng.choice(LINES))
        for _ in range(rng.randrange(4)):
            place = rng.randrange(len(line)) if line else 0
            line[place : place + rng.randrange(3)] = chr(rng.choice((rng.randrange(128), 0x20AC)))
        text = ''.join(line)
        said = parse_nmea(text) or read_instrument(text)
        if isinstance(said, WindReading):
            good += 1
            assert all(math.isfinite(each) for each in said.velocity(0.0))
    return good


@pytest.mark.ros
def test_any_messages(nodes):
    counts = fuzz(*nodes, 30_000, 1)
    assert all(counts.values()), counts


def test_any_lines():
    assert fuzz_lines(20_000, 2) > 1000


@pytest.mark.long
@pytest.mark.ros
@pytest.mark.parametrize('seed', range(4))
def test_ten_million_messages(nodes, seed):
    counts = fuzz(*nodes, 2_500_000, seed)
    print(*(f'{cause} {count}' for cause, count in counts.items()))
    assert all(counts.values()), counts


@pytest.mark.long
def test_a_million_lines():
    assert fuzz_lines(1_000_000, 4) > 50_000
