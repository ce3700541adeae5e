# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What makes people recognise each plant, as numbers."""

from itertools import combinations

from drawn_trees import branch_order
import numpy as np
import pytest

from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.growth import forms
from tree_sway.growth.builtin import builtin_tree, BUILTIN_TREES
from tree_sway.growth.growing import grow

SEEDS = range(3)


def steepness(tree: Tree) -> np.ndarray:
    """Sine of each segment's angle above the horizon."""
    return (tree.end - tree.start)[:, 2] / tree.length


def width_by_height(tree: Tree, n_bands: int = 8) -> np.ndarray:
    """Distance from the axis that nine tenths of the nodes in each band keep within."""
    radius = np.hypot(*(tree.end - tree.start[0])[:, :2].T)
    band = np.minimum((tree.end[:, 2] / tree.height * n_bands).astype(int), n_bands - 1)
    return np.array(
        [
            np.percentile(radius[band == i], 90) if np.any(band == i) else 0.0
            for i in range(n_bands)
        ]
    )


def tips(tree: Tree, order: int) -> np.ndarray:
    return tree.branch_first[1:][branch_order(tree) == order] - 1


@pytest.mark.parametrize('seed', SEEDS)
def test_benjamina_has_several_stems_from_one_short_stock_and_weeps(seed: int) -> None:
    tree = builtin_tree('benjamina', seed)
    rise = steepness(tree)
    assert tree.height == pytest.approx(1.3)
    assert tree.branch_length[0] < 0.1 * tree.height
    assert np.count_nonzero(branch_order(tree) == 1) == 5
    assert np.all(rise[tree.branch_first[:-1][branch_order(tree) == 1]] > 0.9)
    branches = branch_order(tree) == 2
    first, last = tree.branch_first[:-1][branches], tips(tree, 2)
    assert np.mean(rise[first] > 0.0) > 0.9
    assert np.mean(rise[last] < -0.5) > 0.9
    assert np.mean(rise[tips(tree, 3)] < 0.0) > 0.75


@pytest.mark.parametrize('seed', SEEDS)
def test_goldcrest_is_a_narrow_cone_of_steep_branches(seed: int) -> None:
    tree = builtin_tree('goldcrest', seed)
    assert tree.height == pytest.approx(1.2)
    assert tree.branch_length[0] > 0.95 * tree.height
    width = width_by_height(tree)
    assert 0.2 < 2.0 * width.max() / tree.height < 0.42
    assert np.polyfit(np.arange(6), width[2:], 1)[0] < -0.01
    assert width[-1] < 0.35 * width.max()
    branch = branch_order(tree) == 1
    assert np.count_nonzero(branch) > 60
    assert np.median(steepness(tree)[tree.branch_first[:-1][branch]]) > 0.7
    assert np.median(steepness(tree)[tips(tree, 1)]) > 0.9


@pytest.mark.parametrize('seed', SEEDS)
def test_broadleaf_has_a_bare_trunk_and_a_rounded_crown(seed: int) -> None:
    tree = builtin_tree('broadleaf', seed)
    assert tree.height == pytest.approx(8.0)
    crown = tree.end[branch_order(tree)[tree.branch_of_segment] > 1]
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


def grown(species: str, height: float = 14.0, seed: int = 0) -> Tree:
    return grow(species, height, rng=np.random.default_rng(seed))


def rise_of(tree: Tree, order: int, *, at_tip: bool) -> np.ndarray:
    """Sine of the elevation of each branch of an order, of its first or last segment."""
    first = tree.branch_first[:-1][branch_order(tree) == order]
    return steepness(tree)[tips(tree, order) if at_tip else first]


def twigs_of(tree: Tree) -> np.ndarray:
    return tree.branch_first[:-1][np.diff(tree.branch_first) == 1]


def lowest_limb(tree: Tree) -> float:
    limbs = tree.branch_first[:-1][branch_order(tree) == 1]
    return float(tree.start[limbs][:, 2].min()) / tree.height


@pytest.mark.parametrize('species', ['spruce', 'sitka', 'douglas_fir'])
def test_crowns_of_conifers_come_to_a_point(species: str) -> None:
    width = width_by_height(grown(species), 6)
    widest = int(np.argmax(width))
    assert 1 <= widest <= 3
    assert np.all(np.diff(width[widest:]) < 0.0)
    assert width[-1] < 0.65 * width.max()


def test_each_species_keeps_its_habit() -> None:
    trees = {s: grown(s) for s in ('oak', 'birch', 'beech', 'ash', 'sycamore', 'walnut')}
    trees |= {s: grown(s) for s in ('spruce', 'sitka', 'pine')}
    width = {s: 2.0 * width_by_height(tree).max() / tree.height for s, tree in trees.items()}
    tip = {s: np.median(rise_of(tree, 1, at_tip=True)) for s, tree in trees.items()}
    twig = {s: np.median(steepness(tree)[twigs_of(tree)]) for s, tree in trees.items()}
    stem = {s: tree.end[tree.segments_of(0)][-1, 2] / tree.height for s, tree in trees.items()}
    # Birch: narrow, led by one stem, limbs start steeply and end low, twigs hang.
    assert width['birch'] < 0.55
    assert stem['birch'] > 0.9
    assert np.median(rise_of(trees['birch'], 1, at_tip=False)) > 0.6
    assert tip['birch'] < 0.5
    assert twig['birch'] < -0.7
    # Oak and walnut spread wide and lose their stem in the crown; oak is crooked.
    for key in ('oak', 'walnut'):
        assert width[key] > 0.65
        assert stem[key] < 0.75
    assert bend(trees['oak']) > 2.0 * bend(trees['beech'])
    # Ash has a long bole, and turns its twigs up.
    assert lowest_limb(trees['ash']) > 0.25
    assert twig['ash'] > 0.6
    # Twigs of a spruce hang, those of a Sitka spruce are level, on level branches.
    assert twig['spruce'] < -0.5
    assert abs(twig['sitka']) < 0.35
    assert np.median(rise_of(trees['spruce'], 1, at_tip=False)) < tip['spruce'] - 0.3
    assert lowest_limb(trees['pine']) > 0.45


def outline(species: str) -> tuple[np.ndarray, float]:
    """Half-width over height in twelve levels, and the mean rise of twigs, of three trees."""
    widths, rises = [], []
    for seed in range(3):
        tree = grown(species, seed=seed)
        nodes = np.vstack([tree.start, tree.end])
        level = np.minimum((12 * nodes[:, 2] / tree.height).astype(int), 11)
        reach = np.hypot(*(nodes[:, :2] - nodes[0, :2]).T) / tree.height
        widths.append([np.percentile([0.0, *reach[level == k]], 95) for k in range(12)])
        rises.append(steepness(tree)[-tree.n_segments // 2 :].mean())
    return np.mean(widths, axis=0), float(np.mean(rises))


@pytest.mark.long
def test_silhouettes_differ() -> None:
    """By the outline, a tenth of the width at least, or by twigs that hang or rise."""
    # Species without a form of their own grow as their group.
    own = [key for key in (*forms._CONIFERS, *forms._BROADLEAVES) if key != 'any']
    assert len(own) == 22
    outlines = {key: outline(key) for key in own}
    for one, other in combinations(own, 2):
        (wide, rise), (width, lift) = outlines[one], outlines[other]
        apart = np.sqrt(np.mean((wide - width) ** 2)) / (0.5 * (wide.max() + width.max()))
        assert np.hypot(apart, 0.5 * (rise - lift)) > 0.1, (one, other)
    # A spruce is a cone and no spindle: it has most of its width low, and less at each level up.
    spruce = outlines['spruce'][0]
    assert spruce.argmax() <= 4
    assert np.all(np.diff(spruce[spruce.argmax() :]) < 0.0)
    assert outlines['willow'][1] == min(rise for _, rise in outlines.values()) < -0.5


def bend(tree: Tree) -> float:
    """Mean angle between successive segments of the limbs in [rad]."""
    angles = []
    for branch in np.flatnonzero(branch_order(tree) == 1):
        way = (tree.end - tree.start)[tree.segments_of(int(branch))]
        way /= np.linalg.norm(way, axis=1)[:, None]
        angles.append(np.arccos(np.clip((way[1:] * way[:-1]).sum(axis=1), -1.0, 1.0)).mean())
    return float(np.mean(angles))


@pytest.mark.parametrize('species', ['ash', 'sycamore'])
def test_limbs_stand_in_pairs(species: str) -> None:
    tree = grown(species)
    limbs = tree.branch_first[:-1][branch_order(tree) == 1]
    _, together = np.unique(tree.segment_parent[limbs], return_counts=True)
    assert np.all(together % 2 == 0)


@pytest.mark.parametrize('height', [10.0, 20.0, 30.0])
@pytest.mark.parametrize('species', ['spruce', 'sitka', 'pine', 'douglas_fir'])
def test_stems_of_conifers_have_the_form_factor_of_yield_tables(
    species: str, height: float
) -> None:
    tree = grown(species, height)
    stem = tree.segments_of(0)
    diameter = np.interp(1.3, tree.start[stem][:, 2], tree.base_diameter[stem])
    cylinder = 0.25 * np.pi * diameter**2 * height
    assert 0.42 <= tree.volume[stem].sum() / cylinder <= 0.52


@pytest.mark.parametrize('height', [6.0, 12.0, 24.0])
@pytest.mark.parametrize(
    'species', ['broadleaf', 'oak', 'birch', 'beech', 'ash', 'sycamore', 'walnut']
)
def test_wood_of_broadleaves_weighs_what_allometry_says(species: str, height: float) -> None:
    """Chave et al. (2014, eq. 4): dry mass 0.0673 (rho D^2 H)^0.976 in kg, g/cm^3, cm and m."""
    tree, basic = grown(species, height), 0.55
    stem = tree.segments_of(0)
    diameter = 100.0 * np.interp(1.3, tree.start[stem][:, 2], tree.base_diameter[stem])
    dry = 0.0673 * (basic * diameter**2 * height) ** 0.976
    assert tree.volume.sum() * 1000.0 * basic == pytest.approx(dry, rel=0.12)


def test_every_built_in_name_gives_that_tree() -> None:
    assert BUILTIN_TREES == ('benjamina', 'goldcrest', 'broadleaf')
    assert [builtin_tree(name).name for name in BUILTIN_TREES] == list(BUILTIN_TREES)


def test_an_unknown_name_is_met_with_the_nearest_and_all() -> None:
    with pytest.raises(
        ParameterError, match=r"did you mean 'benjamina'\? use one of: .*goldcrest"
    ):
        builtin_tree('Benjamin')
    with pytest.raises(ParameterError, match="'xyz'; use one of"):
        builtin_tree('xyz')


def test_a_negative_seed_is_refused() -> None:
    with pytest.raises(ParameterError, match='seed: -1'):
        builtin_tree('benjamina', seed=-1)
