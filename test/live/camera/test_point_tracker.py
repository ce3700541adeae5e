# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Points are followed to parts of a pixel, and what hides them is not followed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tree_sway.live import PointTracker

cv2: Any = pytest.importorskip('cv2', reason='needs OpenCV: pip install .[camera]')

RNG = np.random.default_rng(3)
SCENE = cv2.GaussianBlur(RNG.uniform(0.0, 255.0, (300, 400)).astype(np.float32), (0, 0), 2.5)
SCENE = 128.0 + 4.0 * (SCENE - SCENE.mean())
EVERYWHERE = np.full((300, 400), 255, dtype=np.uint8)


def picture(x: float, y: float) -> np.ndarray:
    """Return the scene, moved by parts of pixels, with noise."""
    moved = cv2.warpAffine(SCENE, np.array([[1.0, 0.0, x], [0.0, 1.0, y]]), (400, 300))
    noisy = moved + 2.0 * np.random.default_rng(1).normal(size=moved.shape)
    return np.clip(noisy, 0.0, 255.0).astype(np.uint8)


def moves(tracker: PointTracker, pictures: list[np.ndarray]) -> list[np.ndarray]:
    """Return how far points are from where they were found, in each picture, (k, p, 2)."""
    seen = [tracker.follow(k / 30.0, each) for k, each in enumerate(pictures)]
    assert {each.reference for each in seen} == {0}
    return [each.points - seen[0].points for each in seen]


def test_points_are_followed_to_a_tenth_of_a_pixel() -> None:
    places = [(0.0, 0.0), (1.3, -0.4), (3.7, 0.9), (0.2, 0.1), (0.0, 0.0)]
    found = moves(PointTracker(cv2, EVERYWHERE), [picture(*each) for each in places])
    for moved, wanted in zip(found, places, strict=True):
        inner = np.isfinite(moved[:, 0])
        assert inner.mean() > 0.7
        np.testing.assert_allclose(np.median(moved[inner], axis=0), wanted, atol=0.1)


def test_a_hidden_point_is_lost_and_found_again() -> None:
    hidden = picture(0.5, 0.0)
    hidden[60:200, 100:300] = 255
    tracker = PointTracker(cv2, EVERYWHERE)
    first = tracker.follow(0.0, picture(0.0, 0.0)).points
    behind = (np.abs(first - [200.0, 130.0]) < [85.0, 55.0]).all(axis=1)
    assert behind.sum() > 10
    lost = tracker.follow(0.1, hidden).points
    assert np.isfinite(lost[behind, 0]).mean() < 0.1
    again = tracker.follow(0.2, picture(1.0, 0.0)).points
    assert np.isfinite(again[behind, 0]).mean() > 0.7
    np.testing.assert_allclose(np.nanmedian(again - first, axis=0), [1.0, 0.0], atol=0.1)


def test_the_edge_of_a_shadow_and_a_cloud_behind_drag_no_point() -> None:
    column = np.arange(400.0)
    found = []
    tracker = PointTracker(cv2, EVERYWHERE)
    first = tracker.follow(0.0, picture(0.0, 0.0)).points
    for k in range(1, 8):
        light = 40.0 * np.tanh((column - 55.0 * k) / 8.0)
        shaded = (0.75 + 0.25 * np.tanh((column - 50.0 * k) / 10.0)) * picture(0.0, 0.0)
        seen = tracker.follow(k / 30.0, np.clip(shaded + light, 0.0, 255.0).astype(np.uint8))
        found.append(seen.points - first)
    missed = np.linalg.norm(found, axis=2)
    assert np.isfinite(missed).mean() > 0.7
    assert np.nanpercentile(missed, 90) < 0.25


def test_points_are_found_under_the_mask_and_some_far_beside_it() -> None:
    mask = np.zeros((300, 400), dtype=np.uint8)
    mask[100:180, 50:150] = 255
    tracker = PointTracker(cv2, mask)
    points = tracker.follow(0.0, picture(0.0, 0.0)).points
    is_inside = ((points >= [50, 100]) & (points < [150, 180])).all(axis=1)
    assert is_inside.sum() > 5
    behind = points[~is_inside]
    assert len(behind) > 5
    gap = np.maximum([50, 100] - behind, behind - [149, 179]).max(axis=1)
    assert gap.min() > 29.0
    moved = tracker.follow(0.1, picture(1.5, -0.7)).points[~is_inside] - behind
    np.testing.assert_allclose(np.nanmedian(moved, axis=0), [1.5, -0.7], atol=0.1)


def test_points_are_found_anew_when_most_are_lost_for_long() -> None:
    tracker = PointTracker(cv2, EVERYWHERE)
    tracker.follow(0.0, picture(0.0, 0.0))
    other = picture(0.0, 0.0)[::-1, ::-1].copy()
    seen = [tracker.follow(each, other).reference for each in (1.0, 5.0, 10.5, 11.0)]
    assert seen == [0, 0, 1, 1]


def test_a_picture_of_nothing_is_no_error() -> None:
    tracker = PointTracker(cv2, EVERYWHERE)
    grey = np.full((300, 400), 90, dtype=np.uint8)
    assert len(tracker.follow(0.0, grey).points) == 0
    assert len(tracker.follow(0.1, picture(0.0, 0.0)).points) > 10
