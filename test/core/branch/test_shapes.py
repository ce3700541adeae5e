# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The fields by which a branch moves: orthogonal, right-handed, the static first, converging."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway_ros.core.branch.beam import energies, RotationField
from tree_sway_ros.core.branch.model import branch_models
from tree_sway_ros.core.branch.shapes import across, FEWER_TURNS, N_PAIRS, N_TURNS
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
        for field, direction in zip(model.fields, (e1, e2), strict=True):
            assert field.nodes[-1] @ direction == pytest.approx(model.beam.chord_length)


def test_an_enriched_branch_has_pairs_and_what_carries_turns(fork):
    models = branch_models(fork(), 900.0, carries=True, enriched=frozenset(range(4)))
    for branch, model in enumerate(models):
        turns = 0 if len(model.children) == 0 else FEWER_TURNS if branch else N_TURNS
        assert 2 * N_PAIRS <= len(model.fields) <= 2 * N_PAIRS + turns


def test_further_fields_are_orthogonal_in_energy(fork):
    for model in branch_models(fork(), 900.0, carries=True, enriched=frozenset(range(4))):
        energy = energies(model.fields, 1.0, 1.0 / 14.0)
        scale = 1.0 / np.sqrt(np.diag(energy))
        energy *= np.outer(scale, scale)
        energy[0, 1] = energy[1, 0] = 0.0
        assert energy == pytest.approx(np.eye(len(energy)), abs=1e-6)


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
    model = branch_models(drawn.tree(), 900.0, carries=True)[0]
    u = model.beam.place
    assert model.shape.slope == pytest.approx(1.5 * (2 * u - u**2), abs=0.01)
    alone = branch_models(drawn.tree(), 900.0, carries=False)[0]
    assert alone.shape.slope == pytest.approx(4 / 3 * (3 * u - 3 * u**2 + u**3), abs=1e-9)
