# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The azimuth of a sensor by the ellipse of its sway and by its lean in slow gusts."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.arrays import Floats
from tree_sway.twin.sway_azimuth import Sway, sway_azimuth

DT, F1, TURN = 1.0 / 20.0, 1.0, 2.0
SURE = np.radians(20.0)


def leans(
    seed: int, seconds: float, loss: float, bend: Floats, longer: float = 2.0
) -> tuple[Floats, Floats]:
    """Return leans of a tree, turned back by TURN, and of its model, by gusts to the north."""
    rng = np.random.default_rng(seed)
    n = round(seconds / DT)
    hertz = np.fft.rfftfreq(n, DT)[:, None]
    size = 1.0 / (0.05 + hertz) / np.abs(1.0 - np.square(hertz / F1) + 0.1j * hertz)
    gusts = rng.normal(size=(4, len(hertz), 2)) @ [1.0, 1.0j]
    common = np.exp(-loss * hertz)
    met = common * gusts[:2].T + np.sqrt(1.0 - common**2) * gusts[2:].T
    c, s = np.cos(TURN), np.sin(TURN)
    found = []
    for each in (met, common * gusts[:2].T):
        load = np.fft.irfft(size * each * [1.0, longer], n, axis=0)
        found.append((load / 30.0 + [0.0, 1.0]) @ bend.T)
    return found[0] @ np.array([[c, -s], [s, c]]), found[1]


def errors_of(
    seconds: float, loss: float, bend: Floats, longer: float = 2.0
) -> tuple[Floats, ...]:
    """Return errors of angles and those that are stated, of 60 trees, [rad]."""
    sway = Sway(bend, F1, DT)
    found = [
        sway_azimuth(*leans(seed, seconds, loss, bend, longer), 1e-3, sway) for seed in range(60)
    ]
    angle, stated = np.array(found).T
    return np.angle(np.exp(1j * (angle - TURN))), stated


@pytest.mark.parametrize('bend', [np.eye(2), np.array([[-1.0, 0.2], [0.0, -2.0]])])
def test_the_ellipse_and_slow_gusts_tell_an_azimuth_as_surely_as_is_stated(bend: Floats) -> None:
    wrong, stated = errors_of(40.0, 11.0, bend)
    is_sure = stated < SURE
    assert is_sure.mean() > 0.5
    assert np.mean(np.abs(wrong[is_sure]) < SURE) > 0.9
    assert np.sqrt(np.mean(np.square(wrong / stated)[is_sure])) < 1.2


def test_a_round_sway_tells_less() -> None:
    _, of_ellipse = errors_of(40.0, 11.0, np.eye(2))
    wrong, of_round = errors_of(40.0, 11.0, np.eye(2), 1.0)
    assert np.median(of_round) > 1.5 * np.median(of_ellipse)
    assert not np.any(np.abs(wrong[of_round < SURE]) > 3.0 * SURE)


def test_which_end_of_the_axis_is_which_is_not_told_by_a_motion_of_other_gusts() -> None:
    wrong, stated = errors_of(40.0, 1e9, np.eye(2))
    assert np.median(np.abs(np.sin(wrong))) < 0.4
    assert np.mean(stated > SURE) > 0.9


def test_leans_that_are_skewed_downwind_tell_which_end_of_the_axis_is_which() -> None:
    north, sway = np.array([np.sin(TURN), np.cos(TURN)]), Sway(np.eye(2), F1, DT)
    angles = []
    for seed in range(20):
        moved, model = leans(seed, 40.0, 1e9, np.eye(2))
        along = (moved - moved.mean(axis=0)) @ north
        moved += 0.3 * np.outer(np.square(along) / along.std(), north)
        angles.append(sway_azimuth(moved, model, 1e-3, sway)[0])
    assert np.mean(np.cos(np.array(angles) - TURN) > 0.0) > 0.9
