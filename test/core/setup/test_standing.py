# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Limbs that cannot carry themselves: thickened until they do, with the least wood, no others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tree_sway.core.settings import Settings
from tree_sway.core.setup import standing
from tree_sway.core.setup.beams.greenhill import greenhill_length
from tree_sway.core.setup.modes import buckling_factor, buckling_modes
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.setup.standing import MARGIN, standing_tree
from tree_sway.core.species.foliage_traits import LeafTraits
from tree_sway.core.species.species import Species
from tree_sway.core.tree.building import tree_from_segments

WOOD = Species('w', 'wood', modulus=9e9, density=900.0, leaves=LeafTraits(area_per_section=0.0))
THICK = 0.02


def pole(length, cuts=24, thick=THICK):
    nodes = np.linspace(0.0, length, cuts + 1)[:, None] * [0.0, 0.0, 1.0]
    return tree_from_segments(nodes[:-1], nodes[1:], np.full(cuts, thick))


def carried(tree, wood=WOOD, *, in_leaf=True):
    settings = Settings(in_leaf=in_leaf)
    return buckling_factor(TreeReductions(tree, wood, settings).with_subtrees.reduction)[0]


def critical_length():
    area, second_moment = np.pi / 4 * THICK**2, np.pi / 64 * THICK**4
    return greenhill_length(WOOD.modulus * second_moment, WOOD.density * 9.81 * area)


@pytest.mark.parametrize('times', [1.01, 1.3, 2.0])
def test_a_pole_beyond_greenhills_length_stands_with_less_wood_than_a_uniform_one(times):
    tree = pole(times * critical_length())
    found, change = standing_tree(tree, WOOD, in_leaf=True, cache=None)
    assert change.carried == pytest.approx(times**-3, rel=0.02)
    assert MARGIN <= carried(found) < 1.1 * MARGIN
    # A uniform pole that carries the margin has this much more section: length^3 ~ d^2.
    assert 0.0 < change.added < MARGIN * times**3 - 1.0
    assert (found.base_diameter >= THICK).all()


def test_a_tree_that_stands_is_left():
    tree = pole(0.99 * critical_length())
    found, change = standing_tree(tree, WOOD, in_leaf=True, cache=None)
    assert found is tree
    assert change is None


def with_a_whip(thick):
    """Make a stout pole that carries an upright whip of 3 m and a thicker limb beside it."""
    nodes = np.array([[0.0, 0.0, z] for z in range(5)])
    whip = np.array([[1.0, 0.0, 3.0 + 0.5 * i] for i in range(7)])
    limb = np.array([[0.0, 1.0, 3.0 + 0.5 * i] for i in range(7)])
    start = np.vstack([nodes[:-1], whip[:-1], limb[:-1]])
    end = np.vstack([nodes[1:], whip[1:], limb[1:]])
    parent = np.array([-1, 0, 1, 2, 2, *range(4, 9), 2, *range(10, 15)])
    diameter = np.concatenate([np.full(4, 0.1), np.full(6, thick), np.full(6, 0.03)])
    return tree_from_segments(start, end, diameter, parent=parent)


def test_only_the_limb_that_buckles_is_thickened_and_named():
    tree = with_a_whip(0.004)
    found, change = standing_tree(tree, WOOD, in_leaf=True, cache=None)
    (branch,) = change.branch
    thin = tree.branch_of_segment == branch
    assert tree.base_diameter[thin] == pytest.approx(0.004)
    assert (found.base_diameter[~thin] == tree.base_diameter[~thin]).all()
    assert carried(found) > 1.0
    assert (found.base_diameter > tree.base_diameter).sum() <= change.segments <= thin.sum()
    assert f"1 limb thickened, most '{tree.branch_names[branch]}', from 4 to" in change.sentence(
        tree
    )


def test_it_is_found_to_stand_with_all_shapes_of_its_limbs(monkeypatch):
    sizes = []

    def noted(reduction, *limits):
        sizes.append(reduction.n_coordinates)
        return buckling_modes(reduction, *limits)

    monkeypatch.setattr(standing, 'buckling_modes', noted)
    found, _ = standing_tree(with_a_whip(0.004), WOOD, in_leaf=True, cache=None)
    settings = Settings(in_leaf=True, enrich='all')
    reduction = TreeReductions(found, WOOD, settings).with_subtrees.reduction
    assert sizes[0] < sizes[-1] == reduction.n_coordinates
    assert buckling_factor(reduction)[0] >= MARGIN


def test_it_stands_in_the_season_that_is_asked_for():
    tree = pole(0.9 * critical_length())
    leafy = replace(WOOD, leaves=LeafTraits(size=0.5, area_per_section=3000.0, fresh_mass=1.0))
    assert carried(tree, leafy, in_leaf=False) > 1.0 > carried(tree, leafy)
    found, _ = standing_tree(tree, leafy, in_leaf=True, cache=None)
    assert carried(found, leafy) > 1.0
    assert standing_tree(tree, leafy, in_leaf=False, cache=None) == (tree, None)


def test_the_changes_are_found_again(tmp_path):
    from tree_sway.cache.model_cache import ModelFiles

    tree, files = pole(1.2 * critical_length()), ModelFiles(tmp_path)
    first, second = (standing_tree(tree, WOOD, in_leaf=True, cache=files) for _ in range(2))
    assert len(list(tmp_path.iterdir())) == 1
    assert (first[0].base_diameter == second[0].base_diameter).all()
    assert first[1].sentence(tree) == second[1].sentence(tree)
