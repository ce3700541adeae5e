# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A step of the wind apart from its anemometer, as its equations say."""

from __future__ import annotations

import math
import tracemalloc

import numpy as np
import pytest

from tree_sway.core.arrays import Floats
from tree_sway.core.wind.gusts.far_wind import FarWind, LENGTHS, SAMPLES

PLACES = np.array([[0.0, 0.0, -1.0], [0.0, 2.0, -3.0], [1.0, -2.0, -3.0]])
SHARE = np.array([0.5, 0.3, 0.2])
TURNED = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def far(bearing: float | None, *, is_sample: bool) -> FarWind:
    return FarWind(PLACES, np.full(3, 0.5), SHARE, 1.0, 12.0, bearing, 3, is_sample=is_sample)


def by_equations(wind: FarWind, measured: Floats, dts: Floats) -> tuple[Floats, Floats]:
    """Return winds of crown and parts: means over at most 600 s, and low-passes of the wind."""
    mean, variance, told, passed = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros((5, 3))
    run = span = 0.0
    wholes, aparts = [], []
    for air, dt in zip(measured, dts, strict=True):
        nearest = round(math.degrees(math.atan2(mean[1], mean[0])) / 10.0) % 36
        span = min(span + dt, 600.0)
        mean = mean + dt / span * (air - mean)
        variance = variance + dt / span * (np.square(air - mean) - variance)
        way = max(math.hypot(*mean[:2]), 0.5) * dt
        run += way
        keep = np.maximum(1.0 - np.exp(-way / LENGTHS), dt / span)[:, None]
        passed = passed + keep * (air - passed)
        weights = wind._weights[0]
        if len(wind._weights) > 1:
            sectors = np.degrees(math.atan2(mean[1], mean[0])) % 360.0 / 10.0
            low, share = int(sectors), sectors % 1.0
            weights = (1 - share) * wind._weights[low] + share * wind._weights[(low + 1) % 36]
        found = weights @ (passed - mean)
        told = told + dt / span * (np.square(SHARE @ found) - told)
        found = found + mean
        if wind._native.is_sample:
            assert wind._rest is not None
            row, share = int(run / 0.25), run / 0.25 % 1.0
            more = np.float32(wind._mixes[nearest if len(wind._weights) > 1 else 0])
            rows = [(row + k) % SAMPLES for k in (0, 1)]
            low, high = np.float64(wind._least[rows] + more * wind._more[rows])
            along = np.array([*mean[:2], 0.0]) / math.hypot(*mean[:2])
            axes = np.stack([along, TURNED @ along, [0.0, 0.0, 1.0]])
            deviations = np.sqrt(np.square(axes) @ variance)
            found = found + ((1 - share) * low + share * high) @ (deviations[:, None] * axes)
        else:
            more = np.maximum(variance - told, 0.0) @ [0.8, 0.8, 0.5]
            square = np.square(found).sum(axis=1)
            found = found * np.sqrt(1.0 + more / np.maximum(square, more + 1e-9))[:, None]
        wholes.append(SHARE @ found)
        aparts.append(found - SHARE @ found)
    return np.array(wholes), np.array(aparts)


@pytest.mark.parametrize('is_sample', [False, True])
@pytest.mark.parametrize('bearing', [None, 4.0])
def test_a_step_is_that_of_the_equations(bearing: float | None, is_sample: bool) -> None:
    rng = np.random.default_rng(1)
    # From calm to a wind that turns through north, to more than the run of a drawn field.
    turn = np.linspace(-1.0, 7.0, 900)
    measured = rng.normal(size=(900, 3))
    measured[:, :2] += 8.0 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    dts = np.where(rng.random(900) < 0.9, 1.0 / 60.0, 20.0)
    wind, apart = far(bearing, is_sample=is_sample), np.zeros((3, 3))
    wholes, aparts = by_equations(wind, measured, dts)
    for k, (air, dt) in enumerate(zip(measured.tolist(), dts.tolist(), strict=True)):
        np.testing.assert_allclose(wind.push(*air, dt, apart), wholes[k], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(apart, aparts[k], rtol=1e-9, atol=1e-8)


@pytest.mark.parametrize('shape', [(2, 3), (3, 2), (9,), (6, 3)])
def test_winds_of_parts_that_do_not_fit_are_refused(shape: tuple[int, ...]) -> None:
    wind = far(None, is_sample=False)
    apart = np.zeros(shape)
    with pytest.raises(ValueError, match='an array of shape'):
        wind.push(5.0, 0.0, 0.0, 0.1, apart if shape != (6, 3) else apart[::2])


def test_a_step_allocates_nothing() -> None:
    wind, apart = far(4.0, is_sample=True), np.zeros((3, 3))
    wind.push(5.0, 0.0, 0.0, 0.1, apart)
    tracemalloc.start()
    before = tracemalloc.take_snapshot()
    for _ in range(100):
        wind.push(5.0, 1.0, 0.0, 0.1, apart)
    grown = tracemalloc.take_snapshot().compare_to(before, 'filename')
    tracemalloc.stop()
    assert sum(each.size_diff for each in grown if 'far_wind' in str(each.traceback)) < 200
