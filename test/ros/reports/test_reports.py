# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import math
import sys

import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.ros

from builtin_interfaces.msg import Time  # noqa: E402, I100

from tree_sway.core.wind.gate import GateCounts, SECOND, WindGate  # noqa: E402
from tree_sway_ros.reports import wind_report  # noqa: E402
from tree_sway_ros.reports.diagnostics import (  # noqa: E402
    ERROR,
    OK,
    Status,
    status_array,
    WARN,
)
from tree_sway_ros.reports.one_publisher import OnePublisher  # noqa: E402
from tree_sway_ros.reports.sequence_gaps import SequenceGaps  # noqa: E402
from tree_sway_ros.reports.sway_report import _wind, SwayReport  # noqa: E402
from tree_sway_ros.reports.wind_report import LOST_AFTER, WindReport  # noqa: E402
from tree_sway_ros.timing.pacer import Timing  # noqa: E402

TIMEOUT = 2.0


class Clock:
    """A clock in the hand of the test."""

    def __init__(self):
        self.now = 100.0

    def monotonic(self):
        return self.now


@pytest.fixture
def clock(monkeypatch):
    made = Clock()
    monkeypatch.setattr(wind_report, 'time', made)
    return made


def test_a_status_becomes_a_message():
    status = Status('wind', WARN, 'late', {'age [s]': 1.23456789, 'count': 3, 'kind': 'a'})
    message = status_array([status], prefix='oak/solver', hardware='oak', stamp=Time(sec=5))
    (item,) = message.status
    assert (item.level, item.name, item.message) == (b'\x01', 'oak/solver: wind', 'late')
    assert item.hardware_id == 'oak'
    assert {pair.key: pair.value for pair in item.values} == {
        'age [s]': '1.23457',
        'count': '3',
        'kind': 'a',
    }
    assert message.header.stamp.sec == 5


def test_wind_goes_from_none_to_live_to_lost_to_stale(clock):
    report, gate = WindReport(), WindGate()
    assert report.status(TIMEOUT, gate).level == WARN
    assert report.age == math.inf
    for _ in range(21):
        clock.now += 0.05
        report.add()
    status = report.status(TIMEOUT, gate)
    assert status.level == OK
    assert report.rate == pytest.approx(20.0)
    clock.now += 1.1 * TIMEOUT
    assert report.status(TIMEOUT, gate).level == WARN
    assert report.rate == 0.0
    clock.now += LOST_AFTER * TIMEOUT
    assert report.status(TIMEOUT, gate).level == ERROR
    report.add()
    assert report.status(TIMEOUT, gate).level == OK


def test_wind_across_the_force_plane_is_said(clock):
    report, gate = WindReport(), WindGate()
    for k in range(400):
        clock.now += 0.05
        report.add(0.6 if k % 2 else -0.6)
    assert report.left_out == pytest.approx(0.6, rel=0.01)
    assert '0.6 m/s across the force plane are left out' in report.status(TIMEOUT, gate).message
    for _ in range(400):
        clock.now += 0.05
        report.add(0.0)
    assert 'left out' not in report.status(TIMEOUT, gate).message


def test_a_slow_sensor_is_late_by_its_own_periods(clock):
    report, gate, timeout = WindReport(), WindGate(), 0.5
    for _ in range(30):
        clock.now += 0.999
        report.add()
    clock.now += 0.99
    assert report.status(timeout, gate).level == OK
    clock.now += 2.1
    assert report.status(timeout, gate).level == WARN
    clock.now += 3.0 * LOST_AFTER
    assert report.status(timeout, gate).level == ERROR


def test_dropouts_make_no_slow_sensor(clock):
    report, gate = WindReport(), WindGate()
    for number in range(100):
        clock.now += 10.0 if number in (0, 90, 95) else 0.01
        report.add()
    clock.now += 1.1 * TIMEOUT
    assert report.status(TIMEOUT, gate).level == WARN


def test_refused_samples_are_no_wind(clock):
    report, gate = WindReport(), WindGate()
    gate.offer(SECOND, (float('nan'), 0.0, 0.0))
    status = report.status(TIMEOUT, gate)
    assert status.level == WARN
    assert '1 samples refused' in status.message
    assert status.values['not_finite'] == 1


def offered(report, gate, clock, samples, every=SECOND // 20):
    """Offer samples at 20 Hz, and return the last of the reports of each second."""
    for k, sample in enumerate(samples):
        clock.now += 1e-9 * every
        if gate.offer(SECOND + k * every, sample).accepted:
            report.add()
        if k % 20 == 19:
            status = report.status(TIMEOUT, gate)
    return status


def test_every_second_sample_without_a_reading_is_a_warning(clock):
    """And one such sample in a minute is not."""
    good, bad = (3.0, 0.0, 0.0), (999.99, 0.0, 0.0)
    samples = [(3.0 + 0.1 * (k % 2), 0.0, 0.0) for k in range(1200)]
    assert offered(WindReport(), WindGate(), clock, [*samples[:600], bad, *samples]).level == OK
    status = offered(WindReport(), WindGate(), clock, [good, bad] * 100)
    assert status.level == WARN
    assert "60 of 120 samples refused: 60 a sensor's code for no reading" in status.message


def test_a_refused_storm_says_that_it_is_too_fast(clock):
    report, gate = WindReport(), WindGate()
    status = offered(report, gate, clock, [(45.0, 0.0, 0.0)] * 40)
    assert status.level == WARN
    assert 'no wind yet' in status.message
    assert '40 of 40 samples refused: 40 faster than max_speed (40 m/s)' in status.message
    report, gate = WindReport(), WindGate()
    calm = [(3.0 + 0.1 * (k % 2), 0.0, 0.0) for k in range(100)]
    status = offered(report, gate, clock, calm + [(45.0, 0.0, 0.0)] * 100)
    assert 'no wind for 5' in status.message
    assert '100 faster than max_speed (40 m/s)' in status.message


def test_samples_of_zero_are_a_warning(clock):
    report, gate = WindReport(), WindGate(frozen_after=10.0)
    assert offered(report, gate, clock, [(0.0, 0.0, 0.0)] * 100).level == OK
    status = offered(report, gate, clock, [(0.0, 0.0, 0.0)] * 300)
    assert (status.level, gate.counts.frozen) == (WARN, 0)
    assert 'exactly 0 m/s' in status.message


def test_several_publishers_are_named(clock):
    report, gate = WindReport(), WindGate()
    report.add()
    one = report.status(TIMEOUT, gate, publishers=('/mast',))
    assert (one.level, one.values['publishers']) == (OK, 1)
    two = report.status(TIMEOUT, gate, publishers=('/roof', '/mast'))
    assert two.level == WARN
    assert '2 publishers: /mast, /roof; one is followed, 0 samples of others' in two.message


def is_admitted(one: OnePublisher, number: int, now: float, publishers: int = 2) -> bool:
    return one.admits({'publication_sequence_number': number}, lambda: publishers, now)


@pytest.mark.parametrize('ahead', [-1000, 0, 3, 1000])
def test_one_of_two_publishers_is_followed_by_its_numbers(ahead):
    one = OnePublisher()
    assert is_admitted(one, 2000, 0.0, 1)
    for k in range(1, 200):
        assert is_admitted(one, 2000 + k, 0.05 * k)
        assert not is_admitted(one, 2000 + ahead + k, 0.05 * k + 0.01)
    assert one.refused == 199
    assert not is_admitted(one, 2000 + ahead + 205, 10.5)
    assert is_admitted(one, 2000 + ahead + 230, 11.5), 'the first was silent'
    assert is_admitted(one, 2000 + ahead + 231, 11.55)
    assert not is_admitted(one, 2200, 11.56)


def test_losses_and_restarts_of_one_publisher_are_no_second():
    one = OnePublisher()
    for now, number in enumerate([5, 6, 9, 20, 1, 2, 3]):
        assert is_admitted(one, number, 0.05 * now, 1)
    assert one.admits({}, lambda: 2, 0.0), 'middleware without numbers'
    assert one.refused == 0


def test_a_replay_is_no_live_wind(clock):
    report, gate = WindReport(), WindGate()
    report.add()
    assert 'replay at 5x' in report.status(TIMEOUT, gate, replay=5.002).message


def numbered(gaps, numbers):
    for number in numbers:
        gaps.note({'publication_sequence_number': number})


def test_lost_samples_are_counted_by_their_numbers(clock):
    report, gate = WindReport(), WindGate()
    report.add()
    numbered(report.gaps, (7, 8, 11, 12))
    status = report.status(TIMEOUT, gate)
    assert (status.level, status.values['lost']) == (WARN, 2)
    assert '2 samples lost on the way' in status.message
    assert report.status(TIMEOUT, gate).level == OK
    numbered(report.gaps, (1, 2, 3))  # the publisher was started again
    assert report.status(TIMEOUT, gate).values['lost'] == 2


@pytest.mark.parametrize('info', [{}, {'publication_sequence_number': None}])
def test_middleware_without_numbers_counts_nothing(info):
    gaps = SequenceGaps()
    gaps.note(info)
    assert gaps.report(1) == 0


def test_numbers_of_two_publishers_are_no_gaps():
    gaps = SequenceGaps()
    numbered(gaps, (1, 900, 2, 901))
    assert gaps.report(2) == 0
    numbered(gaps, (903, 904))  # one of them has ended in this second
    assert gaps.report(1) == 0
    numbered(gaps, (905, 907))
    assert gaps.report(1) == 1


def test_late_samples_of_a_replay_are_a_warning():
    report, run = WindOfSolver(), LateRun()
    quiet = report.told(run, 1.0)
    assert (quiet.level, quiet.message) == (OK, 'replay at 1x: live')
    run.late = 3
    late = report.told(run, 1.0)
    assert late.level == WARN
    assert '3 samples came after their time' in late.message
    assert report.told(run, 1.0).level == OK
    run.late = 9
    assert report.told(run, None).level == OK  # a live wind is late by its transport


def test_a_frozen_sensor_is_named(clock):
    report, gate = WindReport(), WindGate(frozen_after=1.0)
    for k in range(30):
        gate.offer(SECOND + k * SECOND // 20, (3.0, 0.0, 0.0))
        report.add()
    status = report.status(TIMEOUT, gate)
    assert (status.level, status.message[:6]) == (WARN, 'frozen')


class LateRun:
    """The counts of a run."""

    wind_state, counts, late = 'live', GateCounts(), 0


class WindOfSolver(SwayReport):
    """The status of the wind alone."""

    def told(self, run, replay):
        return self._of_replay(_wind(run.wind_state, run.counts), run, replay, 0)


def timing_of(skipped, silence=0.0):
    return Timing(60.0, 1e-4, 2e-3, 5e-3, 1e-3, 600, skipped, 0, 0, silence)


def test_frames_that_are_skipped_are_a_warning_until_it_keeps_up():
    report = SwayReport()
    assert report._output(timing_of(0), 60.0, 60, False).level == OK
    late = report._output(timing_of(30), 60.0, 90, False)
    assert late.level == WARN
    assert '30 frames skipped, 2.0 ms late' in late.message
    assert report._output(timing_of(30), 60.0, 150, False).level == OK


def test_a_stream_that_stops_is_a_warning_unless_simulated_time_does():
    report = SwayReport()
    standing = report._output(timing_of(0, silence=5.0), 60.0, 60, False)
    assert (standing.level, standing.message) == (WARN, 'no frame for 5.0 s')
    assert report._output(timing_of(0, silence=5.0), 60.0, 60, True).level == OK


@pytest.mark.parametrize(
    ('state', 'level'),
    [('none', WARN), ('live', OK), ('holding', OK), ('decaying', WARN), ('stale', ERROR)],
)
def test_every_state_of_the_wind_has_a_level(state, level):
    status = _wind(state, GateCounts(accepted=7, spike=2, no_time=1))
    assert status.level == level
    assert (status.values['refused'], status.values['spike']) == (3, 2)


def test_a_report_each_second_takes_no_memory():
    """Tuples of `dataclasses.asdict` would fill a list of the interpreter for half an hour."""
    report, gate = WindReport(), WindGate()
    report.status(TIMEOUT, gate)
    before = sys.getallocatedblocks()
    for _ in range(500):
        report.status(TIMEOUT, gate)
    assert sys.getallocatedblocks() - before < 100


def test_a_tree_that_lost_coordinates_is_a_warning(fork):
    from tree_sway.core.scene.make import make_simulator
    from tree_sway_ros.reports import sway_report

    sim = make_simulator(fork(), model=4)

    def report():
        return sway_report._with_reductions(sway_report._model(sim), sim)

    assert (report().level, report().message) == (OK, '4')
    sim.counts.reduced = 2
    assert report().level == WARN
    assert 'left out 2 times' in report().message
    assert report().values['reduced'] == 2


def test_a_limp_tree_reports_how_many_coordinates_it_solves():
    from tree_sway_lab.kinds.kinds import kind_called
    from tree_sway_lab.validation.truth import SETTINGS, WOOD

    from tree_sway.core.scene.make import make_simulator
    from tree_sway_ros.reports import sway_report

    sim = make_simulator(kind_called('whips'), WOOD, SETTINGS, model=200)
    status = sway_report._model(sim)
    assert status.message == f'{len(sim.models[0].stiffness)}/200'
    assert status.values['model'] == status.message
