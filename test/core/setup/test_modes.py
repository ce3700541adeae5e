# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Natural modes: orthonormal, equal by both ways, softened by weight, refused if they buckle."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csc_matrix
from simulators import FULL

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup import modes as modes_module
from tree_sway.core.setup.beams.branch_model import TreeBeams
from tree_sway.core.setup.beams.greenhill import greenhill_length
from tree_sway.core.setup.matrices import Factors, reduce_tree
from tree_sway.core.setup.modes import buckling_factor, natural_modes, refuse_buckling
from tree_sway.core.species.species import Species, species_named
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.errors import ParameterError, TreeError


def reduced(tree, gravity=9.81, modulus=9e9, enriched=()):
    models = TreeBeams(tree, 900.0).models(subtrees=True, enriched=frozenset(enriched))
    return reduce_tree(tree, models, modulus, modulus / 2.6, gravity)


def test_modes_are_orthonormal_and_solve_the_eigenproblem(fork):
    tree = fork()
    matrices = reduced(tree, enriched=(0, 1))
    modes = natural_modes(tree, matrices)
    n = matrices.n_coordinates
    assert modes.shapes.shape == (n, n)
    assert modes.shapes.T @ matrices.mass @ modes.shapes == pytest.approx(np.eye(n), abs=1e-8)
    stiff = modes.shapes.T @ matrices.stiffness @ modes.shapes
    w2 = modes.circular**2
    assert stiff / np.sqrt(np.outer(w2, w2)) == pytest.approx(np.eye(n), abs=1e-8)
    assert (np.diff(modes.circular) >= 0.0).all()
    assert modes.frequencies == pytest.approx(modes.circular / (2 * np.pi))


def test_fewer_modes_are_the_first_ones(fork):
    tree = fork()
    matrices = reduced(tree)
    every, few = natural_modes(tree, matrices), natural_modes(tree, matrices, 3)
    assert few.circular == pytest.approx(every.circular[:3], rel=1e-9)


def crown(sketch, n=120):
    drawn = sketch()
    rng = np.random.default_rng(4)
    stem = drawn.add(None, 0, (0, 0, 1), 4.0, 0.08, 0.02, 30)
    for k in range(n):
        heading = rng.uniform(0, 2 * np.pi)
        way = (np.cos(heading), np.sin(heading), rng.uniform(0, 1))
        thick = rng.uniform(0.004, 0.012)
        drawn.add(stem, 1 + k % 30, way, rng.uniform(0.3, 1.0), thick, thick / 2, 2)
    return drawn.tree()


def test_lanczos_finds_what_the_dense_problem_has(sketch, monkeypatch):
    tree = crown(sketch)
    matrices = reduced(tree, enriched=(0,))
    monkeypatch.setattr(modes_module, '_DENSE_UP_TO', 10)
    sparse, factor = natural_modes(tree, matrices, 8), buckling_factor(matrices)
    monkeypatch.setattr(modes_module, '_DENSE_UP_TO', 10_000)
    dense, exact = natural_modes(tree, matrices, 8), buckling_factor(matrices)
    assert sparse.circular == pytest.approx(dense.circular, rel=1e-8)
    assert factor[0] == pytest.approx(exact[0], rel=1e-6)
    # Of a pair of near-equal modes only the plane they span is one and the same.
    overlap = dense.shapes.T @ matrices.mass @ sparse.shapes
    assert np.linalg.svd(overlap, compute_uv=False) == pytest.approx(np.ones(8), abs=1e-6)


@pytest.mark.parametrize(('share', 'ratio'), [(0.5, 0.935), (0.9, 0.521)])
def test_weight_slows_an_upright_stem(stem, share, ratio):
    """Greenhill (1881): at these shares of the length at which it buckles."""
    tree, wood = flagpole(stem, share)
    there = make_simulator(tree, wood, model=12).frequencies(1)[0]
    without = make_simulator(tree, wood, model=12, gravity=0.0).frequencies(1)[0]
    assert there / without == pytest.approx(ratio, rel=0.03)


@pytest.mark.parametrize('model', ['branch', 12, *FULL])
def test_a_stem_beyond_greenhills_length_is_refused_by_name(stem, model):
    tree, wood = flagpole(stem, 1.02)
    with pytest.raises(
        TreeError, match=r"branch 'stem': buckles under its own weight.*thick"
    ) as error:
        make_simulator(tree, wood, model=model)
    assert '9' in error.value.what
    assert make_simulator(tree, wood, model=model, gravity=0.0).frequencies(1)[0] > 0.0


def flagpole(stem, share):
    wood = Species('x', 'x', modulus=8e9, density=900.0)
    rigidity = 8e9 * np.pi / 64 * 0.01**4
    length = share * greenhill_length(rigidity, 900.0 * np.pi / 4 * 0.01**2 * 9.81)
    return stem(length=length, base=0.01, cuts=8), wood


def test_the_buckling_factor_counts_weight(stem):
    tree, wood = flagpole(stem, 0.5)
    one, coordinate = buckling_factor(reduced(tree, modulus=wood.modulus))
    three, _ = buckling_factor(reduced(tree, modulus=wood.modulus, enriched=(0,)))
    # The cube of the length; Rayleigh's quotient is above the truth, less with more shapes.
    assert three == pytest.approx(8.0, rel=1e-3)
    assert three < one < 1.03 * three
    assert coordinate in (0, 1)
    assert buckling_factor(reduced(tree, gravity=0.0))[0] == float('inf')


def test_a_thin_branch_that_buckles_is_the_one_that_is_named(sketch):
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 2.0, 0.2, 0.1, 4)
    drawn.add(0, 2, (1, 0, 1), 0.5, 0.02, 0.01, 2)
    drawn.add(0, 4, (0, 0.01, 1), 3.0, 0.004, 0.004, 3)
    with pytest.raises(TreeError, match="branch 'b2': buckles"):
        make_simulator(drawn.tree(), model=12)


def test_the_cure_in_the_refusal_cures(stem):
    tree, wood = flagpole(stem, 1.3)
    matrices = reduced(tree, modulus=wood.modulus)
    with pytest.raises(TreeError, match='modulus') as error:
        refuse_buckling(tree, matrices)
    times = float(error.value.cure.split('modulus ')[1].split(' times')[0])
    refuse_buckling(tree, reduced(tree, modulus=times * wood.modulus))
    thicker = float(error.value.cure.split('diameters ')[1].split(' times')[0])
    stout = stem(length=tree.branch_length[0], base=0.01 * thicker, cuts=8)
    refuse_buckling(stout, reduced(stout, modulus=wood.modulus))


def test_a_branch_without_mass_is_refused_by_name(stem):
    weightless = Species('air', 'air', modulus=1e9, density=0.0)
    with pytest.raises(TreeError, match="branch 'stem': massless"):
        make_simulator(stem(), weightless, model=12)


@pytest.mark.parametrize('count', [0, -1, 3])
def test_a_count_of_modes_that_is_not_there_is_refused(stem, count):
    tree = stem()
    with pytest.raises(ParameterError, match=r'of a tree that has 2; ask for 1 to 2'):
        natural_modes(tree, reduced(tree), count)


@pytest.mark.parametrize('direction', [(0, 0, 1), (1, 0, 0), (1, 2, 0.3)])
def test_frequencies_do_not_depend_on_where_a_stem_points(stem, direction):
    sim = make_simulator(stem(direction=direction), model=12, gravity=0.0)
    upright = make_simulator(stem(), model=12, gravity=0.0)
    assert sim.frequencies() == pytest.approx(upright.frequencies(), rel=1e-9)


def test_a_mass_at_the_tip_slows_a_stem_as_the_books_say(sketch):
    """A light cantilever with a heavy short tip piece: w^2 = 3 E I / m L^3 (Blevins, 1979)."""
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 1.0, 0.01, 0.01, 10)
    drawn.add(0, 10, (1, 0, 0), 0.02, 0.1, 0.1, 1)
    drawn.add(0, 10, (-1, 0, 0), 0.02, 0.1, 0.1, 1)
    sim = make_simulator(drawn.tree(), model=12, gravity=0.0, enrich='all')
    wood = species_named('broadleaf')
    tip = 2 * wood.density * np.pi / 4 * 0.1**2 * 0.02
    own = wood.density * np.pi / 4 * 0.01**2
    w = np.sqrt(3.0 * wood.modulus * np.pi / 64 * 0.01**4 / (tip + 33.0 / 140.0 * own))
    assert sim.frequencies(1)[0] == pytest.approx(w / (2 * np.pi), rel=0.01)


def test_factors_are_no_fuller_than_the_matrix(random_tree):
    tree = tree_from_segments(*random_tree(4, 120)[:3])
    matrices = reduced(tree)
    stiffness, factors = matrices.stiffness, matrices.factors
    filled = factors._factors.L.nnz + factors._factors.U.nnz
    assert filled <= stiffness.nnz + stiffness.shape[0]
    load = np.random.default_rng(0).normal(0.0, 1.0, stiffness.shape[0])
    assert stiffness @ factors.solve(load) == pytest.approx(load, abs=1e-9)


@pytest.mark.parametrize('shift', [-1e-3, 1e-3])
def test_factors_know_whether_a_matrix_is_positive(random_tree, shift):
    mass = reduced(tree_from_segments(*random_tree(4, 120)[:3])).mass.toarray()
    least = np.linalg.eigvalsh(mass)[0]
    matrix = csc_matrix(mass - (1.0 + shift) * least * np.eye(len(mass)))
    assert Factors(matrix).is_positive == (shift < 0.0)
