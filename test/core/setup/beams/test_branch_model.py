# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a branch knows: where its children sit, its mass, its load and its leaves."""

from __future__ import annotations

from itertools import pairwise

from drawn_trees import crown
import numpy as np
import pytest

from tree_sway.core.settings import Settings
from tree_sway.core.setup.beams.branch_model import TreeBeams
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.species.species import species_named
from tree_sway.core.tree.building import tree_from_segments


def test_models_stand_in_the_order_of_branches(fork):
    tree = fork()
    models = TreeBeams(tree, 900.0).models(subtrees=True)
    assert [len(m.beam.length) for m in models] == np.diff(tree.branch_first).tolist()
    assert [m.children.tolist() for m in models] == [[1, 3], [2], [], []]
    for b, model in enumerate(models):
        assert model.beam.point[0, 0] == pytest.approx(
            tree.start[tree.segments_of(b)][0], abs=0.05
        )


def test_a_child_sits_at_the_foot_of_its_perpendicular():
    start = [[0, 0, 0], [0.1, 0, 0.3], [0.1, 0, 1.2], [-0.1, 0, -0.4]]
    end = [[0, 0, 1], [1, 0, 0.3], [1, 0, 1.2], [-1, 0, -0.4]]
    tree = tree_from_segments(
        start, end, [0.1, 0.02, 0.02, 0.02], parent=[-1, 0, 0, 0], branch=range(4)
    )
    stem = TreeBeams(tree, 900.0).models(subtrees=True)[0]
    place = dict(zip(tree.source_index[1:], stem.beam.child_place, strict=True))
    assert place == {1: pytest.approx(0.3), 2: pytest.approx(1.0), 3: pytest.approx(0.0)}


def test_mass_and_drag_area_are_the_woods_and_the_leaves(fork):
    tree = fork()
    leaf_mass, leaf_area = np.array([0.0, 0.1, 0.2, 0.3]), np.array([0.0, 1.0, 2.0, 3.0])
    models = TreeBeams(tree, 800.0, leaf_mass=leaf_mass, leaf_area=leaf_area).models(subtrees=True)
    frontal = 0.5 * (tree.base_diameter + tree.tip_diameter) * tree.length
    for b, model in enumerate(models):
        own = tree.segments_of(b)
        wood = 800.0 * tree.volume[own].sum()
        assert model.beam.integral(model.mass) == pytest.approx(wood + leaf_mass[b])
        area = frontal[own].sum() + leaf_area[b]
        assert model.beam.integral(model.drag_area) == pytest.approx(area)


def test_the_profile_weighs_area_by_the_square_of_speed(fork):
    tree = fork()
    speed = np.linspace(0.5, 1.5, tree.n_segments)
    frontal = 0.5 * (tree.base_diameter + tree.tip_diameter) * tree.length
    models = TreeBeams(tree, 800.0, speed_profile=speed).models(subtrees=True)
    for b, model in enumerate(models):
        own = tree.segments_of(b)
        weighted = (frontal * speed**2)[own].sum()
        assert model.beam.integral(model.drag_area) == pytest.approx(weighted)


def test_the_model_does_not_depend_on_the_place_of_the_tree(fork):
    tree = fork()
    away = np.array([100.0, -50.0, 7.0])
    moved = tree_from_segments(
        tree.start + away,
        tree.end + away,
        np.stack([tree.base_diameter, tree.tip_diameter], axis=1),
        parent=tree.segment_parent,
        branch=tree.branch_of_segment,
    )
    for one, other in zip(
        TreeBeams(tree, 900.0).models(subtrees=True),
        TreeBeams(moved, 900.0).models(subtrees=True),
        strict=True,
    ):
        assert one.beam.point == pytest.approx(other.beam.point, abs=1e-11)
        slope = one.shape.slope
        assert slope == pytest.approx(other.shape.slope, rel=1e-9)


def test_what_is_enriched():
    tree = crown((3, 3, 3))
    beams = TreeBeams(tree, 900.0)
    carriers = {0, *tree.branch_parent[1:].tolist()}
    needed = beams.enriched('needed')
    assert beams.enriched('none') == set()
    assert beams.enriched('stem') == {0} < needed
    assert beams.enriched('carriers') == carriers
    assert beams.enriched('all') == set(range(tree.n_branches))
    limbs = np.flatnonzero(tree.branch_parent == 0)
    assert set(limbs.tolist()) < needed
    assert len(needed) <= 13


def test_a_long_limb_needs_shapes_though_what_it_carries_is_bare():
    """Limbs of twigs alone swayed 3 to 5 % too often as long as their order decided."""
    tree, wood = _limbs_of_twigs(), species_named('broadleaf')
    found = {
        choice: TreeReductions(tree, wood, Settings(enrich=choice)).natural_frequencies(6)
        for choice in ('stem', 'needed', 'all')
    }
    gap = {choice: np.abs(found[choice] / found['all'] - 1.0).max() for choice in found}
    assert gap['needed'] < 0.003
    assert gap['stem'] > 0.03


def _limbs_of_twigs():
    """Return a stem with three long limbs that taper to 1 cm, and four twigs along each."""
    start, end, diameter, parent, branch = [], [], [], [], []

    def add(nodes, widths, carrier):
        first = len(parent)
        start.extend(nodes[:-1])
        end.extend(nodes[1:])
        diameter.extend(pairwise(widths))
        branch.extend([branch[-1] + 1 if branch else 0] * (len(nodes) - 1))
        parent.extend([carrier, *range(first, first + len(nodes) - 2)])
        return first

    up = np.outer(np.linspace(0.0, 5.0, 6), [0.0, 0.0, 1.0])
    add(up, np.linspace(0.12, 0.03, 6), -1)
    for number, bearing in enumerate((0.0, 2.2, 4.1)):
        out = np.array([np.cos(bearing), np.sin(bearing), 0.3])
        nodes = up[2 + number] + np.outer(np.linspace(0.0, 3.0, 9), out)
        first = add(nodes, np.linspace(0.05, 0.01, 9), 1 + number)
        for at in (3, 4, 6, 7):
            side = nodes[at] + np.outer(np.linspace(0.0, 1.0, 4), [-out[1], out[0], 0.1])
            add(side, np.linspace(0.012, 0.006, 4), first + at - 1)
    return tree_from_segments(start, end, diameter, parent=parent, branch=branch)


def test_a_branch_that_two_ways_do_not_distinguish_is_modelled_once(fork):
    beams = TreeBeams(fork(), 900.0)
    carried, alone = beams.models(subtrees=True), beams.models(subtrees=False)
    rich = beams.models(subtrees=True, enriched=frozenset([0]))
    bears = [len(model.children) > 0 for model in carried]
    assert [one is not other for one, other in zip(carried, alone, strict=True)] == bears
    assert [b for b in range(len(rich)) if rich[b] is not carried[b]] == [0]
    assert all(one.beam is other.beam for one, other in zip(carried, alone, strict=True))
