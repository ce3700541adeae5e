# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Laws that every grown tree obeys, whatever the seed."""

from collections.abc import Callable
from functools import cache

from drawn_trees import branch_order
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.setup.beams.greenhill import greenhill_length
from tree_sway.core.species.species import species_named
from tree_sway.core.tree.tree import Tree
from tree_sway.growth.benjamina import grow_benjamina
from tree_sway.growth.broadleaf import grow_broadleaf
from tree_sway.growth.conifer import grow_conifer
from tree_sway.growth.goldcrest import grow_goldcrest

Generator = Callable[[np.random.Generator], Tree]
GENERATORS: list[Generator] = [grow_benjamina, grow_goldcrest, grow_broadleaf, grow_conifer]
ANY_SEED = st.integers(0, 2**32 - 1)
every_habit = pytest.mark.parametrize('generate', GENERATORS)


@cache
def grown(generate: Generator, seed: int) -> Tree:
    return generate(np.random.default_rng(seed))


def first_segments(tree: Tree) -> np.ndarray:
    return tree.branch_first[1:-1]


@every_habit
@given(seed=ANY_SEED)
@settings(max_examples=4, deadline=None)
def test_any_seed_grows_a_tree_that_hangs_together(generate: Generator, seed: int) -> None:
    tree = grown(generate, seed)
    parent = tree.segment_parent
    assert np.count_nonzero(parent < 0) == 1
    np.testing.assert_array_equal(tree.start[1:], tree.end[parent[1:]])
    assert tree.end[:, 2].min() > 0.0
    assert np.all(np.diff(np.concatenate([tree.base_diameter[:1], tree.tip_diameter[:1]])) <= 0.0)


@every_habit
@given(seed=ANY_SEED)
@settings(max_examples=4, deadline=None)
def test_diameters_fall_without_steps_and_children_are_thinner(
    generate: Generator, seed: int
) -> None:
    tree = grown(generate, seed)
    assert np.all(tree.tip_diameter <= tree.base_diameter)
    along = np.setdiff1d(np.arange(1, tree.n_segments), first_segments(tree))
    np.testing.assert_array_equal(
        tree.base_diameter[along], tree.tip_diameter[tree.segment_parent[along]]
    )
    base = first_segments(tree)
    ratio = tree.base_diameter[base] / tree.tip_diameter[tree.segment_parent[base]]
    assert ratio.max() <= 0.76 * (1.0 + 1e-12)


@every_habit
@given(seed=ANY_SEED)
@settings(max_examples=2, deadline=None)
def test_same_seed_same_tree_another_seed_another(generate: Generator, seed: int) -> None:
    one, again, other = (generate(np.random.default_rng(s)) for s in (seed, seed, seed + 1))
    np.testing.assert_array_equal(one.end, again.end)
    np.testing.assert_array_equal(one.base_diameter, again.base_diameter)
    assert one.end.shape != other.end.shape or not np.array_equal(one.end, other.end)


@every_habit
@pytest.mark.parametrize('seed', range(2))
def test_about_six_segments_a_branch_and_many_twigs_of_one(generate: Generator, seed: int) -> None:
    tree = grown(generate, seed)
    count = np.diff(tree.branch_first)
    assert 5.0 <= count[count > 1].mean() <= 7.0
    assert np.mean(count == 1) > 0.6
    assert tree.n_segments <= 2200


@every_habit
@pytest.mark.parametrize('seed', range(2))
def test_twigs_of_a_branch_are_alike_in_groups(generate: Generator, seed: int) -> None:
    tree = grown(generate, seed)
    twigs = tree.branch_first[:-1][np.diff(tree.branch_first) == 1]
    offset = np.round((tree.end - tree.start)[twigs], 9)
    diameter = np.round(tree.base_diameter[twigs], 9)
    owner = tree.branch_of_segment[tree.segment_parent[twigs]]
    kinds = np.unique(np.column_stack([owner, diameter, offset]), axis=0)
    assert len(kinds) < 0.6 * len(twigs)


@every_habit
@pytest.mark.parametrize('seed', range(2))
def test_slenderness_is_that_of_trees(generate: Generator, seed: int) -> None:
    tree = grown(generate, seed)
    slenderness = tree.branch_length / tree.base_diameter[tree.branch_first[:-1]]
    orders = branch_order(tree)
    assert orders.max() >= 1
    for order in range(1, int(orders.max()) + 1):
        assert 24.0 <= np.median(slenderness[orders == order]) <= 90.0


@every_habit
@pytest.mark.parametrize('seed', range(2))
def test_stands_under_its_own_weight(generate: Generator, seed: int) -> None:
    """Even if a branch were as thin throughout as at its middle and carried all its children."""
    tree = grown(generate, seed)
    wood = species_named(tree.species)
    volume = np.add.reduceat(tree.volume, tree.branch_first[:-1])
    for branch in range(tree.n_branches):
        own = tree.segments_of(branch)
        middle = float(tree.base_diameter[own][len(tree.base_diameter[own]) // 2])
        carried = volume[branch : tree.subtree_end[branch]].sum()
        length = float(tree.branch_length[branch])
        # The carried wood as if it were spread along the branch makes it that much denser.
        stiffness = wood.modulus * np.pi * middle**4 / 64.0
        assert length < 0.8 * greenhill_length(stiffness, wood.density * 9.81 * carried / length)
