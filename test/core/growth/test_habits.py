# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What makes people recognise each plant, as numbers."""

import numpy as np
import pytest

from tree_sway_ros.core.growth.builtin import BUILTIN_TREES, builtin_tree
from tree_sway_ros.core.growth.conifer import grow_conifer
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import ParameterError

SEEDS = range(3)


def steepness(tree: Tree) -> np.ndarray:
    """Sine of each segment's angle above the horizon."""
    return (tree.end - tree.start)[:, 2] / tree.length


def width_by_height(tree: Tree, n_bands: int = 8) -> np.ndarray:
    """Distance from the axis that nine tenths of the nodes in each band keep within."""
    radius = np.hypot(*(tree.end - tree.start[0])[:, :2].T)
    band = np.minimum((tree.end[:, 2] / tree.height * n_bands).astype(int), n_bands - 1)
    return np.array(
        [np.percentile(radius[band == i], 90) if np.any(band == i) else 0.0 for i in range(n_bands)]
    )


def tips(tree: Tree, order: int) -> np.ndarray:
    return tree.branch_first[1:][tree.branch_order == order] - 1


@pytest.mark.parametrize("seed", SEEDS)
def test_benjamina_has_several_stems_from_one_short_stock_and_weeps(seed: int) -> None:
    tree = builtin_tree("benjamina", seed)
    rise = steepness(tree)
    assert tree.height == pytest.approx(1.3)
    assert tree.branch_length[0] < 0.1 * tree.height
    assert np.count_nonzero(tree.branch_order == 1) == 5
    assert np.all(rise[tree.branch_first[:-1][tree.branch_order == 1]] > 0.9)
    branches = tree.branch_order == 2
    first, last = tree.branch_first[:-1][branches], tips(tree, 2)
    assert np.mean(rise[first] > 0.0) > 0.9
    assert np.mean(rise[last] < -0.5) > 0.9
    assert np.mean(rise[tips(tree, 3)] < 0.0) > 0.75


@pytest.mark.parametrize("seed", SEEDS)
def test_goldcrest_is_a_narrow_cone_of_steep_branches(seed: int) -> None:
    tree = builtin_tree("goldcrest", seed)
    assert tree.height == pytest.approx(1.2)
    assert tree.branch_length[0] > 0.95 * tree.height
    width = width_by_height(tree)
    assert 0.2 < 2.0 * width.max() / tree.height < 0.42
    assert np.polyfit(np.arange(6), width[2:], 1)[0] < -0.01
    assert width[-1] < 0.35 * width.max()
    branch = tree.branch_order == 1
    assert np.count_nonzero(branch) > 60
    assert np.median(steepness(tree)[tree.branch_first[:-1][branch]]) > 0.7
    assert np.median(steepness(tree)[tips(tree, 1)]) > 0.9


@pytest.mark.parametrize("seed", SEEDS)
def test_broadleaf_has_a_bare_trunk_and_a_rounded_crown(seed: int) -> None:
    tree = builtin_tree("broadleaf", seed)
    assert tree.height == pytest.approx(8.0)
    crown = tree.end[tree.branch_order[tree.branch_of_segment] > 1]
    assert np.percentile(crown[:, 2], 2) > 0.12 * tree.height
    width = width_by_height(tree)
    widest = int(np.argmax(width))
    assert 2 <= widest <= 6
    assert width[-1] < 0.85 * width[widest]
    assert 0.5 < 2.0 * width.max() / tree.height < 1.0
    # Round from above as well: no side is without limbs.
    heading = np.arctan2(crown[:, 1], crown[:, 0])
    share = np.histogram(heading, bins=6, range=(-np.pi, np.pi))[0] / len(crown)
    assert share.min() > 0.05


@pytest.mark.parametrize("seed", SEEDS)
def test_conifer_tapers_to_a_point(seed: int) -> None:
    tree = grow_conifer(np.random.default_rng(seed))
    width = width_by_height(tree, 6)
    assert np.all(np.diff(width[1:]) < 0.0)
    assert width[-1] < 0.3 * width.max()


def test_every_built_in_name_gives_that_tree() -> None:
    assert BUILTIN_TREES == ("benjamina", "goldcrest", "broadleaf")
    assert [builtin_tree(name).name for name in BUILTIN_TREES] == list(BUILTIN_TREES)


def test_an_unknown_name_is_met_with_the_nearest_and_all() -> None:
    with pytest.raises(ParameterError, match=r"did you mean 'benjamina'\? use one of: .*goldcrest"):
        builtin_tree("Benjamin")
    with pytest.raises(ParameterError, match="'xyz'; use one of"):
        builtin_tree("xyz")


def test_a_negative_seed_is_refused() -> None:
    with pytest.raises(ParameterError, match="seed -1"):
        builtin_tree("benjamina", seed=-1)
