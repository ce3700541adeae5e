# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Leaves: how much of them there is, where they are, and what carries them."""

from dataclasses import replace
from functools import cache

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves.foliage import (
    foliage_of,
    joined_clusters,
    leaf_clusters,
    leafy_length,
    MAX_LEAF_AREA_INDEX,
)
from tree_sway.core.species.foliage_traits import LeafTraits
from tree_sway.core.species.look import Look
from tree_sway.core.species.species import leaf_traits, look_of, species_keys
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.growth import builtin
from tree_sway.growth.growing import grow

every_tree = pytest.mark.parametrize('name', builtin.BUILTIN_TREES)
builtin_tree = cache(builtin.builtin_tree)


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def ground_covered(tree: Tree) -> float:
    points = np.vstack([tree.start, tree.end])
    return float(0.25 * np.pi * np.ptp(points[:, 0]) * np.ptp(points[:, 1]))


@every_tree
def test_leaves_stand_on_outer_wood_and_not_on_the_stem(name: str) -> None:
    tree = builtin_tree(name)
    leafy = leafy_length(tree)
    assert np.all((leafy == 0.0) | (leafy == tree.length))
    twigs = np.diff(tree.branch_first) == 1
    assert np.all(leafy[tree.branch_first[:-1][twigs]] > 0.0)
    assert leafy[0] == 0.0
    assert 0.4 < leafy.sum() / tree.length.sum() < 0.9


@every_tree
def test_area_is_what_the_stem_supplies_up_to_a_closed_crown(name: str) -> None:
    tree = builtin_tree(name)
    leaf, foliage = leaf_traits(tree.species), foliage_of(tree)
    supplied = leaf.area_per_section * np.pi / 4.0 * tree.base_diameter[0] ** 2
    assert foliage.area.sum() == pytest.approx(
        min(supplied, MAX_LEAF_AREA_INDEX * ground_covered(tree))
    )
    np.testing.assert_allclose(foliage.mass, leaf.fresh_mass * foliage.area)


@every_tree
def test_the_wind_meets_less_than_half_of_them(name: str) -> None:
    foliage = foliage_of(builtin_tree(name))
    assert 0.1 < foliage.drag_area.sum() / foliage.area.sum() < 0.5


def test_few_leaves_hide_nothing_and_many_hide_each_other() -> None:
    tree = builtin_tree('broadleaf')
    sparse, dense = (
        foliage_of(tree, traits=LeafTraits(0.07, ratio, 0.2, 4.0)) for ratio in (1.0, 1e6)
    )
    assert sparse.drag_area.sum() == pytest.approx(0.5 * sparse.area.sum(), rel=1e-3)
    # All of the outline of a closed crown, and no more.
    crown = np.ptp(tree.end[leafy_length(tree) > 0.0, 2])
    points = np.vstack([tree.start, tree.end])
    outline = 0.25 * np.pi * np.sqrt(np.ptp(points[:, 0]) * np.ptp(points[:, 1])) * crown
    assert 0.85 < dense.drag_area.sum() / outline <= 1.0


def test_a_pole_has_leaves_too() -> None:
    tree = tree_from_segments([[0, 0, 0], [0, 0, 1.0]], [[0, 0, 1.0], [0, 0, 2.0]], [0.02, 0.01])
    foliage = foliage_of(tree)
    assert 0.0 < foliage.drag_area[0] < foliage.area[0]


@pytest.mark.parametrize('species', [*species_keys(), 'of no table'])
def test_every_species_has_leaves(species: str) -> None:
    leaf = leaf_traits(species)
    assert 0.01 < leaf.size < 0.35
    assert 0.1 < leaf.fresh_mass < 1.0
    assert 1.0 < leaf.flutter_frequency < 15.0


@every_tree
@given(seed=st.integers(0, 10_000), count=st.integers(1, 1500))
@settings(max_examples=8, deadline=None)
def test_clusters_sit_on_their_segments(name: str, seed: int, count: int) -> None:
    tree = builtin_tree(name)
    clusters = leaf_clusters(tree, rng(seed), count=count)
    assert len(clusters.segment) == count
    assert np.all(leafy_length(tree)[clusters.segment] > 0.0)
    reach = 0.5 * clusters.size
    assert np.all(np.linalg.norm(clusters.offset[:, 1:], axis=1) <= reach + 1e-12)
    assert np.all(clusters.offset[:, 0] >= -reach)
    assert np.all(clusters.offset[:, 0] <= tree.length[clusters.segment] + reach)
    np.testing.assert_allclose(np.linalg.norm(clusters.orientation, axis=1), 1.0)


def test_clusters_spread_evenly_along_the_wood() -> None:
    tree = builtin_tree('broadleaf')
    leafy, clusters = leafy_length(tree), leaf_clusters(tree, rng(), count=20_000)
    # One leaf in each of 20,000 equal stretches: each end of a segment may gain or lose one.
    found = np.bincount(clusters.segment, minlength=tree.n_segments) / 20_000
    np.testing.assert_allclose(found, leafy / leafy.sum(), atol=2.0 / 20_000)


def test_clusters_together_show_the_leaf_area() -> None:
    tree = builtin_tree('broadleaf')
    shown = 0.25 * np.pi * leaf_clusters(tree, rng(), count=1000).size ** 2
    assert shown.sum() == pytest.approx(foliage_of(tree).area.sum(), rel=0.05)


def test_leaves_look_up() -> None:
    tree = builtin_tree('broadleaf')
    clusters = leaf_clusters(tree, rng())
    rest = tree.rest_frame[clusters.segment]
    turn = Rotation.from_quat(rest[:, [1, 2, 3, 0]]) * Rotation.from_quat(
        clusters.orientation[:, [1, 2, 3, 0]]
    )
    across = turn.apply([0.0, 0.0, 1.0])
    assert across[:, 2].min() > -1e-9
    assert np.median(across[:, 2]) > 0.7


def shoots(tree: Tree, look: Look | None = None) -> tuple[Floats, Floats]:
    """Directions of the shoots, and of the segments that carry them."""
    clusters = leaf_clusters(tree, rng(), look=look)
    rest = tree.rest_frame[clusters.segment]
    twig = Rotation.from_quat(rest[:, [1, 2, 3, 0]])
    own = twig * Rotation.from_quat(clusters.orientation[:, [1, 2, 3, 0]])
    return own.apply([1.0, 0.0, 0.0]), twig.apply([1.0, 0.0, 0.0])


def test_shoots_stand_and_hang_as_their_species() -> None:
    tree = builtin_tree('broadleaf')
    (away, along), (hanging, _) = (
        shoots(tree, Look(droop=d, shoot_angle=0.5)) for d in (0.0, 2.0)
    )
    angle = np.arccos(np.einsum('ij,ij->i', away, along))
    assert angle.mean() == pytest.approx(0.5, abs=0.03)
    assert hanging[:, 2].mean() < -0.8 < away[:, 2].mean()
    fine, coarse = (shoots(tree, Look(droop=0.0, shoot_angle=a))[0] for a in (1e-3, 1.4))
    assert np.einsum('ij,ij->i', fine, along).min() > 0.999
    assert np.einsum('ij,ij->i', coarse, along).mean() < 0.35


def test_shoots_of_a_conifer_are_left_and_right_of_its_twigs() -> None:
    tree = grow('fir', 8.0, rng=rng())
    away, along = shoots(tree, replace(look_of('fir'), droop=0.0))
    is_level = np.abs(along[:, 2]) < 0.5
    # A shoot leaves its twig to the side: neither up nor down from the slope of the twig itself.
    up = np.array([0.0, 0.0, 1.0]) - along[:, 2:] * along
    rise = np.einsum('ij,ij->i', away, up / np.linalg.norm(up, axis=1)[:, None])
    assert np.abs(rise[is_level]).max() < 1e-6
    left = np.cross(along, [0.0, 0.0, 1.0])
    assert 0.4 < np.mean(np.einsum('ij,ij->i', away, left)[is_level] > 0.0) < 0.6


def test_same_seed_same_leaves() -> None:
    tree = builtin_tree('goldcrest')
    one, again, other = (leaf_clusters(tree, rng(seed)) for seed in (5, 5, 6))
    np.testing.assert_array_equal(one.offset, again.offset)
    np.testing.assert_array_equal(one.phase, again.phase)
    assert not np.array_equal(one.phase, other.phase)


def test_less_than_no_clusters_are_refused() -> None:
    assert len(leaf_clusters(builtin_tree('goldcrest'), rng(), count=0).size) == 0
    with pytest.raises(ParameterError, match='count: -1 is out of range'):
        leaf_clusters(builtin_tree('goldcrest'), rng(), count=-1)


def test_joined_clusters_ride_on_the_segments_of_their_own_trees(fork):
    tree = fork()
    own = leaf_clusters(tree, np.random.default_rng(0), count=12)
    both = joined_clusters([own, leaf_clusters(tree, rng(), count=0), own], [tree.n_segments] * 3)
    assert both.segment.tolist() == [*own.segment, *(own.segment + 2 * tree.n_segments)]
    for name in ('offset', 'orientation', 'size', 'frequency', 'phase'):
        part = getattr(own, name)
        assert (getattr(both, name) == np.concatenate([part, part])).all()
