# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import time
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from tree_sway_ros.process.topics import CLOCK, SEGMENT_POSES, WIND_FILTERED  # noqa: E402
from tree_sway_ros.solver import sample_wait  # noqa: E402
from tree_sway_ros.wire.wind_messages import (  # noqa: E402
    clock_message,
    stamp_to_ns,
    WIND_CLASSES,
    wind_to_message,
    WindSample,
)

VECTOR = WIND_CLASSES['geometry_msgs/Vector3Stamped']
START = 1_000 * 10**9
STEP = 4_000_000  # of /clock


class World:
    """A solver on simulated time, and a hand on the clock and the wind."""

    def __init__(self, compose, observer, tree_file):
        self.nodes = compose(solver={'tree': tree_file, 'use_sim_time': True})
        self.frames = observer.listen(SEGMENT_POSES)
        self._observer = observer
        self._clock = observer.publisher(CLOCK)
        self.now = START

    def begin_wind(self):
        self._wind = self._observer.publisher(WIND_FILTERED)

    def run(self, seconds, wind=None):
        """Let time pass, as fast as the solver takes it."""
        for _ in range(round(seconds * 1e9 / STEP)):
            self.now += STEP
            if wind is not None and self.now % 48_000_000 == 0:
                self.say(self.now, wind)
            self.set(self.now)

    def say(self, stamp, wind):
        self._wind.publish(wind_to_message(VECTOR, WindSample(stamp, 'map', *wind)))

    def set(self, now):  # noqa: A003
        self.now = now
        self._clock.publish(clock_message(now))
        solver = self.nodes['solver'].get_clock()
        self._observer.until(lambda: self._heard(solver), 'the clock to be heard', poll=0.0005)

    def _heard(self, clock):
        if clock.now().nanoseconds != self.now:
            self._clock.publish(clock_message(self.now))
        return clock.now().nanoseconds == self.now

    @property
    def stamps(self):
        return [stamp_to_ns(frame.header.stamp) for frame in self.frames]

    def sway(self):
        return self.frames[-1].poses[2].position.x


@pytest.fixture
def world(compose, observer, tree_file):
    made = World(compose, observer, tree_file)
    made.begin_wind()
    observer.until(lambda: made.run(0.05) or made.frames, 'a frame')
    return made


def test_wind_whose_publisher_is_yet_to_be_found_is_waited_for(
    compose, observer, tree_file, monkeypatch
):
    """However long that takes: for its first sample the solver waits from then on."""
    passed, steady = [0.0], sample_wait.time.monotonic
    later = {'monotonic': lambda: steady() + passed[0]}
    monkeypatch.setattr(sample_wait, 'time', SimpleNamespace(**{**vars(time), **later}))
    monkeypatch.setattr(sample_wait, '_PATIENCE', 1e3)
    world = World(compose, observer, tree_file)
    # A frame may be made before it is heard; a clock that is set back makes another.
    observer.until(lambda: world.set(world.now - 200_000_000) or world.frames, 'the first frame')
    begin = world.now
    world.run(0.3)
    found, node = [], world.nodes['solver']
    count = node.count_publishers
    monkeypatch.setattr(
        node, 'count_publishers', lambda topic: found.append(count(topic)) or found[-1]
    )
    passed[0] += 100.0
    world.begin_wind()
    observer.until(lambda: sum(found) > 2, 'the solver, which knows the publisher and waits')
    for after in range(0, 600_000_000, 50_000_000):
        world.say(begin + after, (6.0, 0.0, 0.0))
    run = world.nodes['solver']._run
    observer.until(lambda: run.counts.accepted == 12, 'the samples')
    observer.until(lambda: world.stamps[-1] > world.now - 2 * 16_666_667, 'the newest frame')
    assert run.late == 0


def test_poses_follow_the_clock_and_stop_with_it(world, observer):
    world.run(0.5, wind=(6.0, 0.0, 0.0))
    period = world.nodes['solver'].pacer.period
    newest = world.now // period * period
    observer.until(lambda: world.stamps[-1] == newest, 'the newest frame')
    n = len(world.frames)
    for _ in range(20):  # paused: the same time again and again
        world.set(world.now)
    assert len(world.frames) == n
    assert all(stamp <= world.now for stamp in world.stamps)
    assert (np.diff(world.stamps) > 0).all()


def test_a_clock_set_back_resets_and_goes_on_within_two_periods(world, observer):
    world.run(2.0, wind=(8.0, 0.0, 0.0))
    observer.until(lambda: world.sway() > 1e-3, 'the tree to bend')
    world.set(START - 500 * 10**9)
    world.run(2 / 60)
    observer.until(lambda: world.stamps[-1] < START, 'a frame of the new time')
    assert world.stamps[-1] <= START - 500 * 10**9 + 2 * 16_666_667
    assert abs(world.sway()) < 1e-9
    world.run(1.0, wind=(8.0, 0.0, 0.0))
    observer.until(lambda: world.sway() > 1e-3, 'the tree to bend again')


def test_a_clock_set_back_ends_the_wait_for_samples_of_before(world, observer, monkeypatch):
    """As at the end of a record that ``ros2 bag play --loop --clock`` plays."""
    monkeypatch.setattr(sample_wait, '_PATIENCE', 1e3)
    world.run(1.0, wind=(8.0, 0.0, 0.0))
    world.run(0.5)
    world.set(START - 500 * 10**9)
    world.run(0.1)
    observer.until(lambda: world.stamps[-1] < START, 'a frame of the new time', deadline=20.0)


def test_a_clock_set_forward_is_no_explosion(world, observer):
    world.run(2.0, wind=(8.0, 0.0, 0.0))
    observer.until(lambda: world.stamps[-1] > world.now - 2 * 16_666_667, 'the newest frame')
    before = world.sway()
    world.set(world.now + 3600 * 10**9)
    world.run(0.1)
    observer.until(lambda: world.stamps[-1] > START + 3600 * 10**9, 'a frame of the new time')
    assert 0.0 < world.sway() < 2.0 * before
    assert world.nodes['solver'].pacer.timing().clamped == 1
