# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The ways a branch moves: orthogonal, right-handed, the static one first, and closer to the truth the
more there are.

"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tree_sway_ros.core.branch.model import branch_models
from tree_sway_ros.core.branch.shapes import FEWER, N_SHAPES, N_TWISTS, across
from tree_sway_ros.core.reduction.matrices import reduce_tree
from tree_sway_ros.core.reduction.modes import natural_modes


@given(st.integers(0, 10**6))
@settings(deadline=None)
def test_axes_across_a_chord_are_right_handed(seed):
    chord = np.random.default_rng(seed).normal(size=3)
    chord /= np.linalg.norm(chord)
    frame = np.stack([chord, *across(chord)])
    assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(frame) == pytest.approx(1.0)


def test_positive_coordinates_move_the_tip_along_e1_and_e2(fork):
    for model in branch_models(fork(), 900.0, carries=True):
        e1, e2 = across(model.beam.chord)
        for way, direction in zip(model.coordinates, (e1, e2), strict=True):
            tip = way.shape.displacement(way.axis)[1][-1]
            assert tip @ direction == pytest.approx(model.beam.chord_length)


def test_an_enriched_branch_has_pairs_and_what_carries_twists(fork):
    models = branch_models(fork(), 900.0, carries=True, enriched=frozenset(range(4)))
    for branch, model in enumerate(models):
        twists = [way for way in model.coordinates if way.is_twist]
        assert len(model.coordinates) - len(twists) == 2 * (FEWER if branch else N_SHAPES)
        assert (0 if len(model.children) == 0 else 1) <= len(twists) <= N_TWISTS
        for way in twists:
            assert way.axis == pytest.approx(model.beam.chord)


def test_shapes_are_orthogonal_in_bending_energy(fork):
    for model in branch_models(fork(), 900.0, carries=True, enriched=frozenset(range(4))):
        for kind in (False, True):
            shapes = list(
                {id(w.shape): w.shape for w in model.coordinates if w.is_twist == kind}.values()
            )
            energy = np.array([[a.stiffness(b, 1.0) for b in shapes] for a in shapes])
            if len(shapes):
                scale = 1.0 / np.sqrt(np.diag(energy))
                assert energy * np.outer(scale, scale) == pytest.approx(
                    np.eye(len(shapes)), abs=1e-6
                )


def test_a_uniform_stem_converges_to_the_beams_roots(stem):
    tree = stem(length=1.0, base=0.02, cuts=12)
    roots = np.array([3.5160, 22.034, 61.697])
    found = {}
    for enriched in (frozenset(), frozenset([0])):
        models = branch_models(tree, 1.0, carries=True, enriched=enriched)
        matrices = reduce_tree(tree, models, 16.0 / 0.02**2, 1.0, 0.0)
        found[len(enriched)] = natural_modes(tree, matrices).circular[::2]
    assert found[0][0] == pytest.approx(3.5160, rel=5e-3)
    # Rayleigh and Ritz stand above the truth.
    assert (found[1] > roots * (1 - 1e-4)).all()
    assert found[1][:2] == pytest.approx(roots[:2], rel=1e-2)
    assert found[1][2] == pytest.approx(roots[2], rel=0.15)
    assert found[1][0] <= found[0][0]


def test_stiffness_of_bending_and_of_twist(stem, sketch):
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 2.0, 0.02, 0.02, 4)
    drawn.add(0, 4, (1, 0, 0), 0.5, 0.01, 0.01, 1)
    stem_model = branch_models(drawn.tree(), 900.0, carries=True, enriched=frozenset([0]))[0]
    (twist,) = (way for way in stem_model.coordinates if way.is_twist)
    # A shaft turned at its end: G J / L.
    polar = np.pi / 32.0 * 0.02**4
    assert twist.field.stiffness(twist.field, 9e9, 3.5e9) == pytest.approx(3.5e9 * polar / 2.0)


def test_a_carried_crown_bends_the_branch_as_a_tip_load(sketch):
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 1.0, 0.002, 0.002, 20)
    for way in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)):
        drawn.add(0, 20, way, 2.0, 0.1, 0.1, 1)
    model = branch_models(drawn.tree(), 900.0, carries=True)[0]
    u = model.beam.place
    assert model.coordinates[0].shape.slope == pytest.approx(1.5 * (2 * u - u**2), abs=0.01)
    alone = branch_models(drawn.tree(), 900.0, carries=False)[0]
    assert alone.coordinates[0].shape.slope == pytest.approx(
        4 / 3 * (3 * u - 3 * u**2 + u**3), abs=1e-9
    )
