# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The measured rate of simulated time, on readings of a clock in the hand of the test."""

from __future__ import annotations

import pytest

from tree_sway_ros.timing.clock_rate import ClockRate

BEGIN = 1_700_000_000.0


class Player:
    """Ticks of /clock at 250 Hz, of a playback at a rate."""

    def __init__(self) -> None:
        self.measured = ClockRate()
        self.now, self.shown = 50.0, BEGIN

    def play(self, rate: float, seconds: float, period: float = 0.004) -> None:
        for _ in range(round(seconds / period)):
            self.now += period
            self.shown += rate * period
            self.note()

    def note(self) -> None:
        self.measured.note(self.now, round(1e9 * self.shown))


@pytest.fixture
def player() -> Player:
    return Player()


@pytest.mark.parametrize('rate', [0.1, 1.0, 5.0, 900.0])
def test_the_rate_is_known_after_a_fifth_of_a_second(player: Player, rate: float) -> None:
    player.play(rate, 0.2)
    assert player.measured.rate == pytest.approx(rate, rel=1e-3)
    assert player.measured.factor == pytest.approx(max(1.0, rate), rel=1e-3)


def test_a_clock_that_nobody_sets_is_the_machine_s(player: Player) -> None:
    assert player.measured.rate == 1.0


@pytest.mark.parametrize('step', [3600.0, -3600.0])
def test_a_clock_that_is_set_keeps_its_rate(player: Player, step: float) -> None:
    player.play(2.0, 1.0)
    player.now += 0.004
    player.shown += step
    player.note()
    assert player.measured.rate == pytest.approx(2.0, rel=1e-3)
    player.play(2.0, 1.0)
    assert player.measured.rate == pytest.approx(2.0, rel=1e-3)


def test_a_pause_is_no_slow_playback(player: Player) -> None:
    player.play(5.0, 2.0)
    player.now += 60.0
    player.note()
    assert player.measured.rate == pytest.approx(5.0, rel=1e-3)
    player.play(5.0, 0.02)
    assert player.measured.rate == pytest.approx(5.0, rel=1e-3)


def test_a_clock_that_stands_before_it_begins_is_no_slow_playback(player: Player) -> None:
    player.note()
    player.now += 0.4
    player.play(2.0, 0.2)
    assert player.measured.rate == pytest.approx(2.0, rel=1e-3)


def test_a_busy_moment_changes_little(player: Player) -> None:
    """No tick for 0.3 s, and then all at once."""
    player.play(5.0, 2.0)
    player.now, player.shown = player.now + 0.3, player.shown + 1.5
    player.note()
    assert player.measured.rate == pytest.approx(5.0, rel=1e-3)


def test_a_clock_of_which_half_the_intervals_go_back_has_the_rate_of_the_others(
    player: Player,
) -> None:
    player.note()
    for _ in range(3):
        for step in (-0.05, 0.5):
            player.now += 0.1
            player.shown += step
            player.note()
    assert player.measured.rate == pytest.approx(5.0)
