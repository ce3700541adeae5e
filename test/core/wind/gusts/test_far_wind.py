# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wind apart from the anemometer: late and smooth where expected, turbulence where drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tree_sway.core.arrays import Floats
from tree_sway.core.wind.gusts.far_wind import FarWind
from tree_sway.core.wind.turbulence import simulate_turbulence

DT = 1.0 / 20.0
PLACES = np.array([[0.0, 0.0, -1.0], [0.0, 2.0, -3.0], [1.0, -2.0, -3.0]])
SHARE = np.array([0.5, 0.3, 0.2])
UPWIND = 1.5 * math.pi
"""Bearing of the anemometer: west of the tree, in a westerly."""

WIND = simulate_turbulence(7.0, rate=20.0, duration=1200.0, rng=3, intensity=0.3)


def winds(far: FarWind, measured: Floats) -> tuple[Floats, Floats]:
    """Wind of the crown (n, 3), and of each part, (n, g, 3)."""
    whole, parts = np.empty_like(measured), np.empty((len(measured), len(SHARE), 3))
    apart = np.zeros((len(SHARE), 3))
    for k, wind in enumerate(measured):
        whole[k] = far.push(*wind.tolist(), DT, apart)
        parts[k] = whole[k] + apart
    return whole, parts


def far(distance: float, seed: int | None = None, *, bearing: float | None = UPWIND) -> FarWind:
    """Return a wind of three parts, which is a sample with a seed."""
    is_sample = seed is not None
    return FarWind(PLACES, np.zeros(3), SHARE, 1.0, distance, bearing, seed, is_sample=is_sample)


def test_a_steady_wind_is_the_same_at_any_distance() -> None:
    steady = np.tile([5.0, 1.0, 0.2], (400, 1))
    for distance in (0.5, 30.0):
        whole, parts = winds(far(distance), steady)
        np.testing.assert_allclose(whole, steady, atol=1e-9)
        np.testing.assert_allclose(parts, steady[:, None].repeat(3, axis=1), atol=1e-9)


def test_less_of_the_gusts_is_expected_the_farther_the_anemometer_is() -> None:
    measured = WIND[8000:].std(axis=0)
    told = [winds(far(distance), WIND)[0][8000:].std(axis=0) for distance in (3.0, 12.0, 40.0)]
    assert (np.diff(told, axis=0) < 0.0).all()
    assert (told[0] < measured).all()


def test_the_expected_wind_is_late_by_the_way_along_the_wind() -> None:
    whole = winds(far(30.0), WIND)[0][:, 0]
    lags = np.arange(200)
    n = len(WIND) - 4200
    first = WIND[4000 : 4000 + n, 0]
    alike = [np.corrcoef(first, whole[4000 + k : 4000 + k + n])[0, 1] for k in lags]
    assert DT * lags[int(np.argmax(alike))] == pytest.approx(30.0 / 7.0, abs=1.2)


def test_what_is_not_expected_still_loads_the_tree() -> None:
    whole = winds(far(30.0), WIND)[0]
    drag = [np.linalg.norm(each, axis=1) * each[:, 0] for each in (WIND, whole)]
    measured, expected = (each[4000:].mean() for each in drag)
    mean = WIND[4000:, 0].mean() ** 2
    assert measured > 1.08 * mean
    assert expected == pytest.approx(measured, rel=0.03)


def test_a_sample_has_the_spectrum_of_turbulence_and_is_the_same_for_a_seed() -> None:
    one, parts = winds(far(12.0, 1), WIND)
    again, _ = winds(far(12.0, 1), WIND)
    other, _ = winds(far(12.0, 2), WIND)
    np.testing.assert_array_equal(one, again)
    assert np.abs(one - other).max() > 1.0
    np.testing.assert_allclose(parts[4000:, 0].std(axis=0), WIND[4000:].std(axis=0), rtol=0.15)
    fast = [np.diff(each[4000:, 0]).std() for each in (parts[:, 0], WIND)]
    assert fast[0] == pytest.approx(fast[1], rel=0.2)


def test_a_crown_in_a_sample_is_as_lively_wherever_the_anemometer_stands() -> None:
    untold = winds(far(1000.0, 1), WIND)[0][4000:, 0]
    beside = winds(far(0.1, 1), WIND)[0][4000:, 0]
    half_seconds = [np.diff(each.reshape(-1, 10).mean(axis=1)).std() for each in (beside, untold)]
    assert half_seconds[0] == pytest.approx(half_seconds[1], rel=0.05)
    # Upwind it tells more than across the wind, and less is drawn.
    upwind, aside = (
        winds(far(12.0, 1, bearing=each), WIND)[0][4000:, 0] for each in (UPWIND, 0.0)
    )
    assert upwind.std() == pytest.approx(aside.std(), rel=0.06)


def test_parts_share_slow_gusts_and_not_fast_ones() -> None:
    _, parts = winds(far(12.0, 1), WIND)
    along = parts[4000:, :2, 0]
    slow = along[: len(along) // 100 * 100].reshape(-1, 100, 2).mean(axis=1)
    assert np.corrcoef(slow.T)[0, 1] > 0.8
    assert np.corrcoef(np.diff(along, axis=0).T)[0, 1] < 0.3


def test_an_anemometer_of_unknown_bearing_tells_less() -> None:
    known, unknown = (
        winds(far(12.0, bearing=bearing), WIND)[0][4000:, 0].std() for bearing in (UPWIND, None)
    )
    assert unknown < known


def test_the_delay_that_the_expected_wind_lacks_is_known() -> None:
    wind, distance = far(30.0), 30.0
    whole = winds(wind, WIND)[0]
    n = 8192  # of 1200 s, where the mean is known
    lines = [np.fft.rfft(each[-n:, 0] * np.hanning(n)) for each in (WIND, whole)]
    hertz = np.fft.rfftfreq(n, DT)
    slow = (hertz > 0.01) & (hertz < 0.1)
    delayed = lines[1][slow] * wind.later(hertz[slow], wind.mean)
    travel = lines[0][slow] * np.exp(-2j * np.pi * hertz[slow] * distance / wind.mean[0])
    assert np.abs(np.angle((delayed * travel.conj()).sum())) < 0.1
    # As it is, the expected wind has not this delay.
    of_line = np.abs(np.angle(lines[1][slow] * travel.conj()))
    assert of_line.max() > 3.0 * np.abs(np.angle(delayed * travel.conj())).max() > 0.0


def test_gusts_are_shared_along_the_wind_more_than_across_it() -> None:
    hertz, mean = np.array([0.01, 0.05, 0.1]), (7.0, 0.0)
    along, across, unknown = (
        np.abs(far(12.0, bearing=bearing).later(hertz, mean)) for bearing in (UPWIND, 0.0, None)
    )
    assert (np.log(across) < 2.0 * np.log(along)).all()
    assert (unknown <= across + 1e-9).all()
    assert unknown == pytest.approx(across, rel=0.2)
