# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Hours of weather: gusts that join without a seam, live samples, and streamed scores."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.twin.hours_command import LiveSensor, Misfit, Sayings
from tree_sway_lab.twin.simulated_sensor import SimulatedSensor
from tree_sway_lab.twin.true_tree import DT
from tree_sway_lab.twin.weather import Weather

from tree_sway.commands.cli import main

PLACES = np.array([[0.0, 0.0, 10.0], [0.0, 30.0, 10.0]])


def test_gusts_have_the_mean_and_the_deviation_of_their_hour_also_where_they_meet() -> None:
    weather = Weather(6000.0, intensity=0.2)
    wind = np.array(list(weather.gusts(PLACES, 4.0, np.random.default_rng(1))))
    times = np.arange(len(wind)) / 4.0
    assert len(wind) == 24_000
    speed = np.array([weather.speed_at(each) for each in times])
    turn = np.array([weather.turn_at(each) for each in times])
    mean = speed[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    gusts = (wind[..., :2] - mean[:, None]) / speed[:, None, None]
    assert np.abs(gusts.mean(axis=(0, 1))).max() < 0.02
    along = gusts[..., 0] * np.cos(turn)[:, None] + gusts[..., 1] * np.sin(turn)[:, None]
    meets = (times % 600.0 < 60.0) & (times > 60.0)
    for rows in (meets, ~meets):
        assert along[rows].std() == pytest.approx(0.2, rel=0.15)
    steps = np.abs(np.diff(along, axis=0)).max(axis=1)
    assert steps[2399::2400].max() < 1.5 * np.quantile(steps, 0.99)


def test_leaves_get_wet_and_dry_and_a_battery_fades_and_is_charged() -> None:
    weather = Weather(100.0, rain=0.4)
    assert [weather.water_at(each) for each in (10.0, 40.0)] == [0.0, 0.4]
    assert weather.water_at(57.0) == pytest.approx(0.4 / np.e)
    assert [weather.rate_at(each) for each in (0.0, 45.0, 49.0, 60.0)] == [60.0, 25.0, 0.0, 60.0]


def test_samples_of_chunks_are_those_of_the_whole_motion() -> None:
    rng = np.random.default_rng(2)
    time = DT * np.arange(1, 1201)
    poses = np.zeros((1200, 7))
    poses[:, 0], poses[:, 6] = np.sin(3.0 * time), 1.0
    live = LiveSensor(3)
    parts = [live.measured(each, 50.0) for each in np.split(poses, 4)]
    whole = SimulatedSensor(noise=0.0, rate=50.0).measured(poses, DT, rng)
    found = np.concatenate([each.time for each in parts])
    np.testing.assert_allclose(np.diff(found), 0.02, atol=0.011)
    assert found[-1] > whole.time[-1] - 0.05
    felt = np.concatenate([each.acceleration for each in parts])
    moved = live._mount.apply(felt)[:, 0]
    np.testing.assert_allclose(moved, -9.0 * np.sin(3.0 * found), atol=0.2)


def test_errors_are_about_the_means_of_stretches_and_leans_of_the_means() -> None:
    time = np.linspace(0.0, 2.0 * np.pi, 1001)[:-1]
    true = np.zeros((1000, 1, 3))
    true[:, 0, 0] = 4.0 + np.sin(time)
    misfit = Misfit(np.zeros((1, 3)))
    wrong = 0.5 * np.sin(time)[:, None, None] * [1.0, 0.0, 0.0]
    misfit.add(true + wrong + [1.0, 0.0, 0.0], true)
    misfit.add(true + wrong - [1.0, 0.0, 0.0], true)
    assert misfit.take() == pytest.approx((0.5, 0.25))


def test_what_is_said_again_with_other_numbers_is_the_same_saying() -> None:
    said = Sayings()
    for time in (1, 2, 7200):
        said.note([f'silent for {time} s'])
    assert said.take() == ['said,3 s,silent for 1 s']
    assert said.take() == []


@pytest.mark.long
def test_a_tree_follows_its_sensor_for_minutes(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*'lab hours --hours 0.1 --seed 7002 --'.split(), 'limbs2 7002']) == 0
    rows = [each.split(',') for each in capsys.readouterr().out.splitlines()]
    hours = [each for each in rows if each[0][:1].isdigit()]
    assert len(hours) == 12
    assert min(float(each[9]) for each in hours[3:]) < 1.0, 'its battery was empty twice'
    assert any(each[0] == 'said' and 'silent' in each[2] for each in rows)
