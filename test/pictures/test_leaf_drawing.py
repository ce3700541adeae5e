# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Blades of leaves: their area, their place and their colour."""

import numpy as np
import pytest

from tree_sway.pictures.leaf_drawing import leaf_blades, leaf_colors

LEVEL = np.array([[1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]])


def polygon_area(corners: np.ndarray) -> float:
    """Area of a flat polygon in space (k, 3)."""
    spokes = corners[1:] - corners[0]
    return float(0.5 * np.linalg.norm(np.cross(spokes[:-1], spokes[1:]).sum(axis=0)))


@pytest.mark.parametrize('species', ['oak', 'spruce'])
def test_blades_show_the_area_of_their_cluster(species: str) -> None:
    corners, normal = leaf_blades(species, LEVEL, np.array([0.2]))
    shown = sum(polygon_area(blade) for blade in corners)
    assert shown == pytest.approx(0.25 * np.pi * 0.2**2, rel=0.2)
    assert np.abs(np.linalg.norm(normal, axis=1) - 1.0).max() < 1e-12
    for blade, across in zip(corners, normal, strict=True):
        assert np.abs((blade - blade[0]) @ across).max() < 1e-12


def test_blades_stay_by_their_cluster() -> None:
    corners, _ = leaf_blades('oak', LEVEL, np.array([0.2]))
    assert np.linalg.norm(corners - LEVEL[0, :3], axis=2).max() < 0.25


def test_a_leaf_that_faces_the_light_is_brighter_and_a_far_one_paler() -> None:
    sun = np.array([-0.35, -0.5, 0.8]) / np.linalg.norm([-0.35, -0.5, 0.8])
    normal = np.stack([sun, np.array([sun[2], 0.0, -sun[0]]), sun])
    lit, dark, far = leaf_colors('oak', normal, np.array([0.0, 0.0, 1.0]))
    assert lit.sum() > dark.sum()
    assert far.min() > lit.min()
    assert np.all((far >= 0.0) & (far <= 1.0))


def test_goldcrest_is_golden() -> None:
    gold, green = (
        leaf_colors(species, np.array([[0.0, 0.0, 1.0]]), np.zeros(1))[0]
        for species in ('goldcrest', 'benjamina')
    )
    assert gold[0] > 2.0 * gold[2]
    assert green[1] > 1.5 * green[0]
