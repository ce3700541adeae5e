# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wood beyond the ends of a scan: its length, section and area, and what was cut."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.tree.tree import Tree
from tree_sway.growth.beyond_scan import grown_beyond, is_cut
from tree_sway.growth.growing import grow

TWIG, TRUSTED = 0.003, 0.05


def _fork(diameter: float) -> Tree:
    """Return a stem of 2 m with two limbs of 1 m, too small for the allometry of crowns."""
    start = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 2.0], [0.0, 0.0, 2.0]])
    end = np.array([[0.0, 0.0, 2.0], [0.8, 0.0, 2.6], [-0.8, 0.0, 2.6]])
    width = np.full((3, 2), diameter)
    return tree_from_segments(
        start, end, width, parent=np.array([-1, 0, 0]), branch=np.array([0, 1, 2]),
        branch_names=['stem', 'a', 'b'], name='fork', species='broadleaf',
    )  # fmt: skip


def _area(tree: Tree) -> float:
    return float((0.5 * (tree.base_diameter + tree.tip_diameter) * tree.length).sum())


def _cut(tree: Tree, least: float) -> Tree:
    """Return a tree without the segments thinner than ``least`` and what grows on them."""
    is_kept = np.zeros(tree.n_segments, dtype=bool)
    for segment, above in enumerate(tree.segment_parent.tolist()):
        mean = 0.5 * (tree.base_diameter[segment] + tree.tip_diameter[segment])
        is_kept[segment] = (above < 0 or is_kept[above]) and mean >= least
    kept, number = np.flatnonzero(is_kept), np.cumsum(is_kept) - 1
    above, branch = tree.segment_parent[kept], tree.branch_of_segment[kept]
    width = np.stack([tree.base_diameter, tree.tip_diameter], axis=1)[kept]
    return tree_from_segments(
        tree.start[kept], tree.end[kept], width, parent=np.where(above < 0, -1, number[above]),
        branch=branch, branch_names=[tree.branch_names[each] for each in np.unique(branch)],
        name='cut', species=tree.species,
    )  # fmt: skip


def test_each_end_carries_the_volume_and_area_of_its_pipes():
    tree, d = _fork(0.03), 0.03
    grown, beyond = grown_beyond(tree, TWIG, TRUSTED)
    length = 21.0 * (d**0.92 - TWIG**0.92)
    volume = 0.25 * np.pi * d**2 * length
    # Integral of 4 / (pi D) dV along the pipes: each diameter D has a total length d^2 / D^2.
    width = np.linspace(TWIG, d, 20001)
    each = 21.0 * 0.92 * width**-0.08 * (d / width) ** 2 * width
    area = float(((each[1:] + each[:-1]) * np.diff(width)).sum() / 2.0)
    n_ends = 2
    assert grown.volume.sum() - tree.volume.sum() == pytest.approx(n_ends * volume, rel=0.02)
    assert _area(grown) - _area(tree) == pytest.approx(n_ends * area, rel=0.02)
    assert 'the scan ends at 30 mm' in beyond.sentence()
    kept = {tuple(row) for row in np.hstack([grown.start, grown.end]).tolist()}
    assert {tuple(row) for row in np.hstack([tree.start, tree.end]).tolist()} <= kept


def test_thin_ends_and_twigs_of_no_thickness_get_nothing():
    tree = _fork(0.005)
    assert grown_beyond(tree, TWIG, TRUSTED) == (tree, None)
    assert grown_beyond(_fork(0.03), 0.0, TRUSTED)[1] is None


@pytest.mark.parametrize(('species', 'height'), [('oak', 18.0), ('birch', 16.0), ('ash', 20.0)])
def test_a_tree_cut_at_2_cm_has_its_area_and_mass_again(species, height):
    whole = replace(grow(species, height, rng=np.random.default_rng(3)), species=species)
    cut = _cut(whole, 0.02)
    assert is_cut(cut)
    assert _area(cut) < 0.85 * _area(whole)
    grown, _ = grown_beyond(cut, TWIG, TRUSTED)
    assert _area(grown) == pytest.approx(_area(whole), rel=0.2)
    assert grown.volume.sum() == pytest.approx(whole.volume.sum(), rel=0.1)


def test_a_bound_of_the_fit_is_no_cut():
    tree = grow('oak', 12.0, rng=np.random.default_rng(1))
    bounded = replace(
        tree,
        base_diameter=np.maximum(tree.base_diameter, 0.02),
        tip_diameter=np.maximum(tree.tip_diameter, 0.02),
    )
    assert not is_cut(bounded)
    assert not is_cut(tree)


def test_a_scan_with_far_too_much_thin_wood_is_thinned():
    tree = grow('birch', 16.0, rng=np.random.default_rng(3))
    factor = np.where(np.arange(tree.n_segments) >= tree.branch_first[1], 3.0, 1.0)
    fat = replace(
        tree,
        base_diameter=factor * tree.base_diameter,
        tip_diameter=factor * tree.tip_diameter,
    )
    less, beyond = grown_beyond(fat, TWIG, 0.2)
    assert _area(less) < _area(fat)
    assert beyond.drawn < 1.0
    stem = tree.segments_of(0)
    assert np.array_equal(less.base_diameter[stem], tree.base_diameter[stem])
