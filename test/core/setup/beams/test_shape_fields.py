# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The fields by which a branch moves: orthogonal, right-handed, the static first, converging."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

from tree_sway.core.model.records import MAX_COORDINATES, ROOMS
from tree_sway.core.setup.beams.beam import energies, RotationField
from tree_sway.core.setup.beams.branch_model import TreeBeams
from tree_sway.core.setup.beams.field_counts import (
    BRANCH_PAIRS_OF_SMALL,
    ENRICHED_PAIRS,
    SMALL_TREE,
    STEM_PAIRS_OF_SMALL,
)
from tree_sway.core.setup.beams.shape_fields import across
from tree_sway.core.setup.matrices import reduce_tree
from tree_sway.core.setup.modes import natural_modes
from tree_sway.core.tree.building import tree_from_segments


@given(st.integers(0, 10**6))
@settings(deadline=None)
def test_axes_across_a_chord_are_right_handed(seed):
    chord = np.random.default_rng(seed).normal(size=3)
    chord /= np.linalg.norm(chord)
    frame = np.stack([chord, *across(chord)])
    assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(frame) == pytest.approx(1.0)


def test_positive_coordinates_move_the_tip_along_e1_and_e2(fork):
    for model in TreeBeams(fork(), 900.0).models(subtrees=True):
        e1, e2 = across(model.beam.chord)
        for field, direction in zip(model.fields, (e1, e2), strict=True):
            assert field.nodes[-1] @ direction == pytest.approx(model.beam.chord_length)


def test_one_of_many_alike_twigs_may_have_a_chord_that_no_wind_turns():
    """A twig that returns to its base is one of a batch with others of as many segments."""
    stem = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    starts, ends = [stem[0]], [stem[1]]
    for way in ((0.3, 0.0, 0.0), (0.0, 0.3, 0.1), (-0.3, 0.0, 0.2)):
        middle = stem[1] + way
        starts += [stem[1], middle]
        ends += [middle, stem[1] + 2.0 * np.array(way)]
    ends[-1] = stem[1]
    parent, branch = [-1, 0, 1, 0, 3, 0, 5], [0, 1, 1, 2, 2, 3, 3]
    tree = tree_from_segments(starts, ends, np.full(7, 0.01), parent=parent, branch=branch)
    models = TreeBeams(tree, 900.0).models(subtrees=True)
    assert len(models) == 4
    for model in models:
        assert all(np.isfinite(field.nodes).all() for field in model.fields)


def stem_with_limbs(n_limbs):
    """Make a straight stem of 8 m whose limbs carry nothing."""
    start, end, thick, parent, branch = [], [], [], [], []

    def add(on, root, way, length, base, tip, cuts, number):
        nodes = root + np.linspace(0.0, length, cuts + 1)[:, None] * way
        first, width = len(start), np.linspace(base, tip, cuts + 1)
        start.extend(nodes[:-1]), end.extend(nodes[1:]), thick.extend(pairwise(width))
        parent.extend([on, *range(first, first + cuts - 1)])
        branch.extend([number] * cuts)

    add(-1, np.zeros(3), np.array([0.0, 0.0, 1.0]), 8.0, 0.14, 0.04, 16, 0)
    for k in range(n_limbs):
        node, turn = 4 + (k * 12) // n_limbs, 2.4 * k
        way = np.array([0.92 * np.cos(turn), 0.92 * np.sin(turn), 0.39])
        way /= np.linalg.norm(way)
        length = 2.2 * (1.1 - node / 20.0)
        root = np.array([0.0, 0.0, 0.5 * node])
        add(node - 1, root, way, length, length / 45.0, length / 110.0, 5, k + 1)
    return tree_from_segments(start, end, thick, parent=np.array(parent), branch=np.array(branch))


def test_an_enriched_branch_has_pairs_and_what_carries_turns(fork):
    models = TreeBeams(fork(), 900.0).models(subtrees=True, enriched=frozenset(range(4)))
    for model in models:
        most = ROOMS[1] if len(model.children) > 1 else 2 * ENRICHED_PAIRS + 1
        assert 2 * ENRICHED_PAIRS <= len(model.fields) <= most


def test_a_small_tree_of_many_segments_has_more_of_them():
    tree = stem_with_limbs(4)
    stem, *limbs = TreeBeams(tree, 900.0).models(subtrees=True, enriched=frozenset(range(5)))
    assert 2 * STEM_PAIRS_OF_SMALL < len(stem.fields) <= MAX_COORDINATES
    assert [len(limb.fields) for limb in limbs] == [2 * BRANCH_PAIRS_OF_SMALL] * 4
    larger = TreeBeams(stem_with_limbs(SMALL_TREE), 900.0).models(
        subtrees=True, enriched=frozenset(range(SMALL_TREE + 1))
    )
    assert all(2 * ENRICHED_PAIRS <= len(model.fields) <= ROOMS[1] for model in larger)


def test_further_fields_are_orthogonal_in_energy(fork):
    for model in TreeBeams(fork(), 900.0).models(subtrees=True, enriched=frozenset(range(4))):
        energy = energies(model.fields, 1.0, 1.0 / 14.0)
        scale = 1.0 / np.sqrt(np.diag(energy))
        energy *= np.outer(scale, scale)
        energy[0, 1] = energy[1, 0] = 0.0
        assert energy == pytest.approx(np.eye(len(energy)), abs=1e-6)


def test_a_uniform_stem_converges_to_the_beams_roots(stem):
    tree = stem(length=1.0, base=0.002, cuts=12)  # so thin that its sections rotate freely
    roots = np.array([3.5160, 22.034, 61.697])
    found = {}
    for enriched in (frozenset(), frozenset([0])):
        models = TreeBeams(tree, 1.0).models(subtrees=True, enriched=enriched)
        matrices = reduce_tree(tree, models, 16.0 / 0.002**2, 1.0, 0.0)
        found[len(enriched)] = natural_modes(tree, matrices).circular[::2]
    assert found[0][0] == pytest.approx(3.5160, rel=5e-3)
    # Rayleigh and Ritz give more than the truth.
    assert (found[1] > roots * (1 - 1e-4)).all()
    assert found[1][:2] == pytest.approx(roots[:2], rel=1e-2)
    assert found[1][2] == pytest.approx(roots[2], rel=0.15)
    assert found[1][0] <= found[0][0]


def test_thick_sections_are_hard_to_rotate(stem):
    """A thick beam has the roots of a beam with rotatory inertia (Rayleigh, 1877), by shooting."""
    tree, r = stem(length=1.0, base=0.2, cuts=12), 0.05
    models = TreeBeams(tree, 1.0).models(subtrees=True, enriched=frozenset([0]))
    matrices = reduce_tree(tree, models, 16.0 / 0.2**2, 1.0, 0.0)
    found = natural_modes(tree, matrices).circular[:4:2]

    def remaining(w):
        """Return the determinant of moment and force at the tip of a clamped beam."""
        along = np.eye(4, k=1)  # of deflection, slope, and their next two derivatives
        along[3, [0, 2]] = w**2, -((w * r) ** 2)
        tip = expm(along)
        return np.linalg.det([tip[2, 2:], tip[3, 2:] + (w * r) ** 2 * tip[1, 2:]])

    thin = (3.5160, 22.034)
    roots = [brentq(remaining, 0.8 * each, 1.02 * each) for each in thin]
    assert roots[1] < 0.985 * thin[1]
    assert found == pytest.approx(roots, rel=5e-3)


def test_stiffness_of_bending_and_of_twist(stem, sketch):
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 2.0, 0.02, 0.02, 4)
    drawn.add(0, 4, (1, 0, 0), 0.5, 0.01, 0.01, 1)
    stem_model = TreeBeams(drawn.tree(), 900.0).models(subtrees=True, enriched=frozenset([0]))[0]
    beam = stem_model.beam
    twist = RotationField(beam, np.broadcast_to([0.0, 0.0, 0.5], (*beam.place.shape, 3)))
    # A shaft turned at its end: G J / L.
    polar = np.pi / 32.0 * 0.02**4
    assert energies([twist], 9e9, 3.5e9)[0, 0] == pytest.approx(3.5e9 * polar / 2.0)


def test_a_carried_crown_bends_the_branch_as_a_tip_load(sketch):
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 1.0, 0.002, 0.002, 20)
    for way in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)):
        drawn.add(0, 20, way, 2.0, 0.1, 0.1, 1)
    model = TreeBeams(drawn.tree(), 900.0).models(subtrees=True)[0]
    u = model.beam.place
    assert model.shape.slope == pytest.approx(1.5 * (2 * u - u**2), abs=0.01)
    alone = TreeBeams(drawn.tree(), 900.0).models(subtrees=False)[0]
    assert alone.shape.slope == pytest.approx(4 / 3 * (3 * u - 3 * u**2 + u**3), abs=1e-9)
