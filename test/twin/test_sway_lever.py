# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A sensor whose place turns about another point than its place on the model is told."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from tree_sway.core.arrays import Floats
from tree_sway.twin.alignment import GRAVITY
from tree_sway.twin.motion_sensor import MotionSensor
from tree_sway.twin.sensor_place import SensorPlace
from tree_sway.twin.sensor_track import SensorTrack
from tree_sway.twin.sway_lever import other_lever

DT, NOISE = 1.0 / 60.0, 0.004


def sway(lever: float, frequency: float, seed: int, pull: float = GRAVITY) -> Floats:
    """Motion of a place that turns about a point at a lever [m] below it, (n, 9)."""
    rng = np.random.default_rng(seed)
    pole = np.exp(DT * 2.0 * np.pi * frequency * (-0.05 + 1j))
    pushes = rng.normal(size=(round(120.0 / DT), 2))
    lean = lfilter([1.0], np.poly([pole, pole.conjugate()]).real, pushes, axis=0)
    lean *= 0.02 / lean.std()
    moved = np.full((len(lean), 9), np.nan)
    rate = np.gradient(lean, DT, axis=0)
    moved[:, :2] = lever * np.gradient(rate, DT, axis=0) - pull * lean
    moved[:, 2] = moved[:, 5] = 0.0
    moved[:, 3], moved[:, 4] = -rate[:, 1], rate[:, 0]
    moved[:, :3] += 0.03 * rng.normal(size=(len(lean), 3))
    moved[:, 3:6] += NOISE * rng.normal(size=(len(lean), 3))
    return moved


def said(moved: Floats, frequency: float = 1.0, *, has_gravity: bool = True) -> str:
    pull = GRAVITY * has_gravity
    model = sway(3.0, 1.0, 1, pull)
    return other_lever(moved, model, frequency, DT, pull)


@pytest.mark.parametrize('has_gravity', [True, False])
def test_another_height_is_told_and_other_wood_is_not(has_gravity: bool) -> None:
    pull = GRAVITY * has_gravity
    assert 'about a point 1.5 m below it' in said(sway(1.5, 1.0, 2, pull), has_gravity=has_gravity)
    for frequency in (0.7, 1.0, 1.3):
        assert not said(sway(3.0, frequency, 2, pull), has_gravity=has_gravity)


def test_too_little_or_half_of_a_sensor_tells_nothing() -> None:
    moved = sway(1.5, 1.0, 2)
    assert said(moved)
    assert not other_lever(moved[:2000], sway(3.0, 1.0, 1)[:2000], 1.0, DT, GRAVITY)
    moved[:, 3:6] = np.nan
    assert not said(moved)


def test_a_limb_that_turns_about_other_points_at_other_frequencies_is_not_told() -> None:
    moved, model = sway(1.5, 1.0, 2), sway(3.0, 1.0, 1)
    assert other_lever(moved, model, 1.0, DT, GRAVITY)
    model += sway(1.0, 1.5, 3)
    moved += sway(0.6, 1.5, 4)
    assert not other_lever(moved, model, 1.0, DT, GRAVITY)


@pytest.mark.parametrize('lever', [1.5, 3.0])
def test_it_is_noted_when_a_mounting_is_found(lever: float) -> None:
    track = SensorTrack(MotionSensor('phone', SensorPlace(0, 0.5)), 1.0, DT)
    track._quantities = ('acceleration', 'rate')
    sensed, model, free = sway(lever, 1.0, 1), sway(3.0, 1.0, 1), sway(3.0, 1.0, 1, 0.0)
    n = track.native.count = len(model)
    track._sensed[:n, :6], track._sensed[:n, 6:] = sensed[:, :6], np.nan
    track._sensed[:n, 2] += GRAVITY
    track._computed[:n, :3], track._computed[:n, 3:6] = free[:, :3], (model - free)[:, :3]
    track._computed[:n, 6:9] = model[:, 3:6]
    track.take(track.search()())
    assert track.in_use
    assert track.alignment is not None
    notes = [note for note in track.alignment.notes if 'turns about a point' in note]
    assert len(notes) == (lever == 1.5)
