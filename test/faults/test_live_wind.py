# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a live stream must survive of its sensor: one test per fault, all on one running chain."""

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

FASTEST = 8.0
"""No tip of the test tree moves so fast in that wind [m/s]: what does has jumped."""


def test_dropout_of_a_moment_is_held_without_a_visible_step(chain, faulty):
    first = faulty('dropout', fault_duration=0.2)
    chain.until(lambda: len(chain.frames) > first + 120, 'two seconds with dropouts')
    assert chain.largest_jump(first) < FASTEST


def test_dropout_beyond_the_time_out_decays_and_the_first_sample_resumes(chain, faulty):
    states = set()
    run = chain.nodes['solver']._run
    first = faulty('dropout', fault_every=3.0, fault_duration=2.5)

    def gone_and_back():
        states.add(run.wind_state)
        return states >= {'decaying', 'stale'} and run.wind_state == 'live'

    chain.until(gone_and_back, 'a long dropout, and wind again')
    chain.until(lambda: len(chain.frames) > first + 30, 'frames')
    assert chain.largest_jump(first) < FASTEST


@pytest.mark.parametrize(
    ('kind', 'cause'),
    [
        ('nan', 'not_finite'),
        ('no_reading', 'sentinel'),
        ('spike', 'spike'),
        ('duplicate', 'repeated'),
    ],
)
def test_what_is_no_wind_is_refused_and_counted_by_cause(chain, faulty, kind, cause):
    before, refused = getattr(chain.counts, cause), chain.counts.refused
    first = faulty(kind)
    chain.until(lambda: getattr(chain.counts, cause) > before + 5, f'{cause} to be counted')
    assert chain.counts.refused - refused >= getattr(chain.counts, cause) - before
    assert chain.largest_jump(first) < FASTEST
    fastest = max(abs(m.vector.x) + abs(m.vector.y) for m in list(chain.filtered))
    assert fastest < 40.0


@pytest.mark.parametrize(
    ('kind', 'causes'),
    [
        ('zero_stamp', ('zero_stamp',)),
        ('future_stamp', ('future_stamp',)),
        ('reorder', ('out_of_order',)),
        ('delay', ('accepted',)),
    ],
)
def test_stamps_that_lie_are_counted_and_never_step_back(chain, faulty, kind, causes):
    def counted():
        return sum(getattr(chain.counts, cause) for cause in causes)

    before, first, n = counted(), faulty(kind), len(chain.filtered)
    chain.until(lambda: counted() > before + 5, f'{kind} to be counted')
    chain.until(lambda: len(chain.filtered) > n + 60, 'wind')
    stamps = [(m.header.stamp.sec, m.header.stamp.nanosec) for m in list(chain.filtered)[n:]]
    assert stamps == sorted(set(stamps))
    assert chain.largest_jump(first) < FASTEST


def test_frozen_sensor_is_a_warning_and_the_stream_goes_on(chain, faulty):
    gate = chain.nodes['wind']._intake.gate
    first = faulty('freeze', fault_every=3.0, fault_duration=2.5)
    chain.until(lambda: gate.is_frozen, 'the gate to call it frozen')
    (status,) = [s for s in chain.nodes['wind']._statuses() if s.name == 'wind']
    assert (status.level, status.message[:6]) == (1, 'frozen')
    chain.check_stream(first)


def test_sensor_that_starts_again_is_taken_up(chain, faulty):
    first, n = faulty('restart'), len(chain.filtered)
    chain.until(lambda: len(chain.filtered) > n + 60, 'wind between restarts')
    assert chain.largest_jump(first) < FASTEST


def test_all_faults_one_after_another_leave_the_stream_whole(chain, faulty):
    first = faulty('all', fault_every=0.3, fault_duration=0.15)
    chain.until(lambda: len(chain.frames) > first + 240, 'four seconds of every fault')
    assert chain.largest_jump(first) < FASTEST
    timing = chain.nodes['solver'].pacer.timing()
    assert timing.clamped == timing.restarts == 0
