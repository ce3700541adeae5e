# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.wind import gate as gate_module
from tree_sway.core.wind.gate import LARGEST_LEAD, SECOND, WindGate
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.errors import ParameterError

PERIOD = 0.05


def ns(seconds):
    return round(seconds * SECOND)


def offer(gate, stamp, wind, arrival=None, **how):
    """Offer a sample to the gate, times in seconds."""
    return gate.offer(ns(stamp), wind, None if arrival is None else ns(arrival), **how)


def offer_all(gate, winds, period=PERIOD):
    return np.array([offer(gate, (i + 1) * period, wind).accepted for i, wind in enumerate(winds)])


def warmed_up(wind=(3.0, 0.0, 0.0), **options):
    """Return a gate that has seen a second of steady wind, up to t = 1."""
    gate = WindGate(**options)
    assert offer_all(gate, [wind] * 20).all()
    return gate


def record_with_spikes_and_gusts(seed, mean_speed):
    rng = np.random.default_rng(seed)
    wind = simulate_turbulence(mean_speed, rate=20.0, duration=1800.0, rng=rng)
    n = len(wind)
    time = np.arange(n) / 20.0
    for start in 10.0 + 45.0 * np.arange(40):
        duration, amplitude = rng.uniform(1.5, 6.0), rng.uniform(4.0, 12.0)
        share = np.clip((time - start) / duration, 0.0, 1.0)
        wind[:, 0] += 0.5 * amplitude * (1.0 - np.cos(2.0 * np.pi * share))  # IEC 61400-1, 6.3.2
    at = 20 * rng.choice(n // 20, 180, replace=False) + rng.integers(0, 10, 180)
    direction = rng.normal(size=(180, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    wind[at] += rng.uniform(5.0, 30.0, (180, 1)) * direction
    is_spike = np.zeros(n, dtype=bool)
    is_spike[at] = True
    return wind, is_spike


@pytest.mark.parametrize('mean_speed', [2.0, 5.0, 8.0])
def test_half_an_hour_all_spikes_caught_and_no_gust_refused(mean_speed):
    wind, is_spike = record_with_spikes_and_gusts(1, mean_speed)
    gate = WindGate()
    accepted = offer_all(gate, wind)
    np.testing.assert_array_equal(accepted, ~is_spike)
    assert gate.counts.refused == 180
    assert gate.counts.forced == 0


def test_a_rate_alone_refuses_good_samples_of_a_fast_sensor_in_a_strong_wind(monkeypatch):
    rng = np.random.default_rng(1)
    wind = simulate_turbulence(12.0, rate=20.0, duration=300.0, rng=rng)
    assert offer_all(WindGate(), wind).all()
    for allowance in ('JUMP_FLOOR', 'JUMP_FRACTION'):
        monkeypatch.setattr(gate_module, allowance, 0.0)
    rate_only = offer_all(WindGate(), wind)
    assert 1.0 - rate_only.mean() > 0.2  # the failure that the allowance for eddies is there for


@pytest.mark.parametrize('rate', [1.0, 4.0, 20.0, 100.0])
@pytest.mark.parametrize('mean_speed', [3.0, 20.0])
def test_plain_turbulence_is_never_refused(rate, mean_speed):
    rng = np.random.default_rng(2)
    wind = simulate_turbulence(mean_speed, rate=rate, duration=60.0, rng=rng)
    assert offer_all(WindGate(), wind, 1.0 / rate).all()


@pytest.mark.parametrize(
    ('bad', 'reason'),
    [
        ((math.nan, 0.0, 0.0), 'not_finite'),
        ((0.0, math.inf, 0.0), 'not_finite'),
        ((0.0, 0.0, -math.inf), 'not_finite'),
        ((1e300, 1e300, 0.0), 'too_fast'),
        ((1e6, 0.0, 0.0), 'too_fast'),
        ((40.1, 0.0, 0.0), 'too_fast'),
        ((999.99, 0.0, 0.0), 'sentinel'),
        ((3.0, 0.0, 999.99), 'sentinel'),
        ((-9999.0, -9999.0, 0.0), 'sentinel'),
        ((-32768.0, 0.0, 0.0), 'sentinel'),
        ((-327.68, -327.68, -327.68), 'sentinel'),
        ((20.0, 0.0, 0.0), 'spike'),
        ((-3.0, 0.0, 0.0), 'spike'),
    ],
)
def test_a_fault_is_refused_counted_and_leaves_no_trace(bad, reason):
    gate, untouched = warmed_up(), warmed_up()
    verdict = offer(gate, 1.05, bad)
    assert (verdict.accepted, verdict.reason) == (False, reason)
    assert getattr(gate.counts, reason) == gate.counts.refused == 1
    for i in range(2, 20):
        wind = (3.0 + 0.3 * i, 0.1 * i, 0.0)
        assert offer(gate, 1.0 + i * PERIOD, wind) == offer(untouched, 1.0 + i * PERIOD, wind)


@pytest.mark.parametrize('change', [8.0, 12.0, 30.0])
def test_a_true_step_passes_after_half_a_second_at_most(change):
    gate = warmed_up()
    accepted = offer_all_from(gate, 1.0, [(3.0 + change, 0.0, 0.0)] * 30)
    first = int(np.argmax(accepted))
    assert 0 < first <= 10  # refused at once, in after 0.5 s
    assert accepted[first:].all()
    assert gate.counts.spike == first


def offer_all_from(gate, start, winds):
    verdicts = [offer(gate, start + (i + 1) * PERIOD, wind) for i, wind in enumerate(winds)]
    return np.array([verdict.accepted for verdict in verdicts])


@pytest.mark.parametrize('lasts', [0.6, 1.0, 3.0])
def test_after_a_refused_run_the_wind_moves_no_faster_than_a_gust(lasts):
    gate, given = warmed_up(), [(3.0, 0.0, 0.0)]
    spike = round(lasts / PERIOD)
    for i, wind in enumerate([(3.0, 25.0, 0.0)] * spike + [(3.0, 0.0, 0.0)] * 60):
        verdict = offer(gate, 1.0 + (i + 1) * PERIOD, wind)
        given.append(verdict.wind if verdict.accepted else given[-1])
    moves = np.linalg.norm(np.diff(given, axis=0), axis=1)
    assert moves.max() == pytest.approx(20.0 * PERIOD)
    assert given[-1] == (3.0, 0.0, 0.0)
    highest = np.max(given, axis=0)[1]
    assert highest == pytest.approx(min(25.0, 20.0 * (lasts - 0.45)), abs=1.1)


def test_a_step_above_the_rate_is_let_in_by_patience():
    gate = warmed_up(max_rate=5.0)
    accepted = offer_all_from(gate, 1.0, [(23.0, 0.0, 0.0)] * 30)
    assert int(np.argmax(accepted)) == 10
    assert gate.counts.forced == 1


def test_too_fast_never_gets_in_however_long_it_lasts():
    gate = warmed_up()
    assert not offer_all_from(gate, 1.0, [(41.0, 0.0, 0.0)] * 200).any()
    assert offer(gate, 20.0, (3.0, 0.0, 0.0)).accepted


def test_a_frozen_sensor_is_flagged_after_ten_seconds_and_recovers():
    gate = WindGate()
    for i in range(400):
        assert offer(gate, 1.0 + i * PERIOD, (3.0, 1.0, 0.2)).accepted
        assert gate.is_frozen == (i * PERIOD >= 10.0 - 1e-9)
    assert gate.counts.frozen == 1
    offer(gate, 21.0, (3.01, 1.0, 0.2))
    assert not gate.is_frozen


def test_a_calm_of_zeros_is_not_frozen():
    gate = WindGate()
    offer_all(gate, [(0.0, 0.0, 0.0)] * 600)
    assert not gate.is_frozen
    assert gate.is_still
    assert gate.counts.accepted == 600
    offer(gate, 60.0, (0.0, 0.1, 0.0))
    assert not gate.is_still


class TestStamps:
    """Stamps that are missing, repeated, out of order or ahead."""

    def test_zero_stamp_takes_the_arrival(self):
        gate = WindGate()
        verdict = offer(gate, 0.0, (1, 0, 0), 100.0)
        assert verdict[:3] == (True, 'accepted', ns(100.0))
        assert gate.counts.zero_stamp == 1

    def test_a_stamp_before_all_time_takes_the_arrival(self):
        gate = WindGate()
        assert offer(gate, -5.0, (1, 0, 0), 100.0).time == ns(100.0)
        assert gate.counts.zero_stamp == 1
        assert offer(WindGate(), 0.0, (1, 0, 0)).accepted  # simulated time starts at zero

    def test_future_and_old_stamps_take_the_arrival(self):
        gate = WindGate()
        assert offer(gate, 160.0, (1, 0, 0), 100.0).time == ns(100.0)
        assert offer(gate, 40.0, (1, 0, 0), 100.1).time == ns(100.1)
        assert offer(gate, 100.15, (1, 0, 0), 100.2).time == ns(100.15)
        assert (gate.counts.future_stamp, gate.counts.old_stamp) == (1, 1)

    def test_a_message_sent_twice_is_dropped(self):
        gate = WindGate()
        offer(gate, 100.0, (1, 0, 0), 100.01)
        verdict = offer(gate, 100.0, (1, 0, 0), 100.02)
        assert (verdict.accepted, verdict.reason) == (False, 'repeated')
        assert gate.counts.out_of_order == gate.counts.repeated == 1

    def test_equal_readings_without_stamps_are_no_repeats(self):
        gate = WindGate()
        for i in range(20):
            assert offer(gate, 0.0, (3.0, 0.0, 0.0), 100.0 + i * PERIOD).accepted
        assert gate.counts.zero_stamp == 20

    def test_stamps_of_whole_seconds_are_spread_by_arrival(self):
        gate = WindGate()
        times = []
        for i in range(60):
            arrival = 100.0 + i * PERIOD
            verdict = offer(gate, math.floor(arrival + 1e-6), (1.0 + 0.01 * i, 0, 0), arrival)
            assert verdict.accepted
            times.append(verdict.time)
        assert set(np.diff(times)) == {ns(PERIOD)}

    def test_out_of_order_is_taken_in_the_order_of_arrival(self):
        gate = WindGate()
        times = [
            offer(gate, stamp, (1.0, 0.1 * i, 0.0), 100.1 + i * PERIOD).time
            for i, stamp in enumerate((100.0, 100.1, 100.05, 100.15, 100.2))
        ]
        assert gate.counts.out_of_order == 3  # the late one, and two not after the time it got
        assert gate.counts.accepted == 5
        assert (np.diff(times) > 0.0).all()

    def test_without_arrivals_out_of_order_is_refused(self):
        gate = WindGate()
        offer(gate, 100.0, (1, 0, 0))
        assert offer(gate, 99.9, (1.1, 0, 0)).reason == 'no_time'
        assert offer(gate, 100.0, (1.2, 0, 0)).reason == 'no_time'

    def test_a_clock_set_back_starts_again(self):
        gate = warmed_up()
        offer(gate, 900.0, (3.0, 0.0, 0.0))
        verdict = offer(gate, 0.05, (20.0, 0.0, 0.0))
        assert verdict[:3] == (True, 'accepted', ns(0.05))
        assert gate.counts.clock_back == 1

    @given(
        st.lists(
            st.tuples(
                st.integers(-(2**63), 2**63 - 1) | st.integers(97 * SECOND, 110 * SECOND),
                st.floats(allow_nan=True, allow_infinity=True),
                st.integers(0, SECOND),
            ),
            max_size=40,
        ),
        st.sampled_from([0, SECOND // 10]),
    )
    def test_never_a_negative_step_and_every_sample_counted(self, samples, lead):
        gate = WindGate()
        arrival, last = 100 * SECOND, -1
        for stamp, speed, wait in samples:
            arrival += wait
            verdict = gate.offer(stamp, (speed, 0.0, 0.0), arrival, lead=lead)
            if verdict.accepted:
                assert last < verdict.time <= arrival + LARGEST_LEAD + len(samples)
                last = verdict.time
        assert gate.counts.accepted + gate.counts.refused == len(samples)

    @pytest.mark.parametrize('lead', [0.001, 0.08, 0.2, 0.45, 0.5, 30.0])
    @pytest.mark.parametrize('latency', [0.0, 0.003, 0.12])
    def test_a_stamp_ahead_blocks_no_good_one_after_it(self, lead, latency):
        """Every eighth stamp is ahead; the others keep their own times."""
        gate = WindGate()
        for i in range(200):
            arrival = 100.0 + i * PERIOD
            is_ahead = i % 8 == 7
            stamp = arrival + lead if is_ahead else arrival - latency
            verdict = offer(gate, stamp, (3.0 + 0.01 * i, 0.0, 0.0), arrival)
            assert verdict.accepted
            assert lead < 0.06 or verdict.time == ns(arrival - latency)
        assert gate.counts.future_stamp == (0 if lead < 0.06 else 25)

    def test_a_clock_that_is_ahead_is_believed_as_it_goes(self):
        gate = WindGate()
        for i in range(100):
            arrival = 100.0 + i * PERIOD + 0.002 * (i % 3)
            stamp = 100.0 + i * PERIOD + min(0.4, 0.05 * i)
            assert offer(gate, stamp, (3.0 + 0.01 * i, 0.0, 0.0), arrival).time == ns(stamp)
        assert gate.counts.future_stamp == 0

    @pytest.mark.parametrize('lead', [0.03, 0.055, 0.1])
    def test_two_senders_at_one_rate_block_each_other_never(self, lead):
        gate = WindGate()
        for i in range(400):
            arrival = 100.0 + i * PERIOD / 4
            stamp = arrival + lead if i % 2 else arrival - 0.02
            assert offer(gate, stamp, (3.0 + 0.001 * i, 0.0, 0.0), arrival).accepted

    def test_a_second_sender_whose_clock_is_ahead_blocks_nobody(self):
        gate = WindGate()
        for i in range(400):
            arrival = 100.0 + i * PERIOD / 2
            stamp = arrival + 0.45 if i % 2 else arrival - 0.002
            assert offer(gate, stamp, (3.0 + 0.001 * i, 0.0, 0.0), arrival).accepted
        assert gate.counts.future_stamp == 200

    def test_on_a_simulated_clock_stamps_ahead_of_its_tick_are_believed(self):
        gate = WindGate()
        for i in range(100):
            stamp = 100 * SECOND + i * SECOND // 20
            tick = stamp - stamp % (SECOND // 10)  # two samples for each tick of the clock
            verdict = gate.offer(stamp, (3.0 + 0.01 * i, 0.0, 0.0), tick, lead=LARGEST_LEAD)
            assert verdict[:3] == (True, 'accepted', stamp)

    def test_in_a_fast_replay_a_late_sample_keeps_its_stamp(self):
        """At 5x, 3 s of the clock are 0.6 s of the machine; without the lag it is a fault."""
        for lag, expected in ((8 * SECOND, 97), (0, 100)):
            gate = WindGate()
            verdict = gate.offer(97 * SECOND, (3.0, 0.0, 0.0), 100 * SECOND, lag=lag)
            assert verdict.time == expected * SECOND

    def test_in_a_fast_replay_samples_may_come_before_a_tick_that_is_late(self):
        gate = WindGate()
        for i in range(100):
            stamp = 100 * SECOND + i * SECOND // 20
            verdict = gate.offer(stamp, (3.0, 0.01 * i, 0.0), 100 * SECOND, lead=10 * SECOND)
            assert verdict[:3] == (True, 'accepted', stamp)

    def test_why_a_stamp_was_not_believed_is_counted(self):
        gate = WindGate()
        for stamp, arrival in (
            (0.0, 100.0),
            (100.3, 100.1),
            (160.0, 100.2),
            (40.0, 100.3),
            (100.35, 100.4),
            (100.35, 100.5),
            (100.3, 100.6),
            (100.5, 100.7),
        ):
            assert offer(gate, stamp, (arrival - 97.0, 0.0, 0.0), arrival).accepted
        counts = gate.counts
        causes = counts.zero_stamp, counts.future_stamp, counts.old_stamp, counts.out_of_order
        assert causes == (1, 2, 1, 3)


@given(st.floats(-math.pi, math.pi), st.integers(0, 5))
def test_the_axes_do_not_matter(angle, seed):
    rng = np.random.default_rng(seed)
    wind = np.cumsum(rng.normal(0.0, 1.2, (60, 3)), axis=0)
    c, s = math.cos(angle), math.sin(angle)
    turned = wind @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T
    np.testing.assert_array_equal(offer_all(WindGate(), wind), offer_all(WindGate(), turned))


def test_reset_forgets_samples_and_keeps_counts():
    gate = warmed_up()
    gate.reset()
    assert gate.counts.accepted == 20
    assert offer(gate, 0.5, (20.0, 0.0, 0.0)).accepted


@pytest.mark.parametrize(
    'options',
    [
        {'max_speed': 0.0},
        {'max_speed': math.nan},
        {'max_rate': -1.0},
        {'longest_refusal': -0.1},
        {'frozen_after': 0.0},
    ],
)
def test_parameters_out_of_range_are_refused(options):
    with pytest.raises(ParameterError, match=f'{next(iter(options))}: .* is out of range'):
        WindGate(**options)


def test_what_is_no_vector_is_refused_by_an_error():
    with pytest.raises(ParameterError, match='not three numbers'):
        offer(WindGate(), 1.0, (1.0, 2.0))
