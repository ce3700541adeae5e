# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree cut again: same shape, same names, and same motion however finely it is cut."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from tree_sway_lab.resegment import MOST_SEGMENTS, resegment

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.wind.turbulence import Turbulence
from tree_sway.errors import ParameterError
from tree_sway.growth.builtin import builtin_tree

CUTS = (3, 6, 12, 24)
RATE = 60.0


@pytest.fixture(scope='module')
def gusty():
    """Ten seconds of a gusty day at 8 m/s."""
    turbulence = Turbulence(8.0).record(36_000, RATE, np.random.default_rng(1))
    return np.array([8.0, 0.0, 0.0]) + turbulence[: int(10.0 * RATE)]


def tip_motion(tree, model, winds):
    sim = make_simulator(tree, model=model)
    tips = np.empty((len(winds), 3))
    for i, wind in enumerate(winds):
        sim.step(wind, 1.0 / RATE)
        sim.place()
        tips[i] = sim.tip_displacement
    return tips


def limbs(sketch, cuts):
    """Stem, two limbs and a twig, straight and tapered; children sit in their parents' middles."""
    s = sketch()
    stem = s.add(None, 0, (0.05, 0.0, 1.0), 2.0, 0.030, 0.012, cuts)
    limb = s.add(stem, cuts // 2, (1.0, 0.3, 0.6), 0.9, 0.014, 0.006, cuts)
    s.add(stem, cuts, (-0.5, 0.8, 0.7), 0.8, 0.011, 0.005, cuts)
    s.add(limb, cuts // 2, (0.4, 1.0, 0.2), 0.4, 0.006, 0.003, cuts)
    return s.tree()


@pytest.mark.parametrize('model', ['branch', 20, 'full'])
@pytest.mark.parametrize('kind', ['one branch', 'four branches'])
def test_the_tip_moves_the_same_however_finely_a_tree_is_cut(stem, sketch, gusty, model, kind):
    # Cut in 4, so that a cut in 3 leaves the twig within a segment.
    tree = (
        stem(length=2.0, base=0.02, tip=0.006, cuts=4)
        if kind == 'one branch'
        else limbs(sketch, 4)
    )
    finest, *others = [tip_motion(resegment(tree, cut), model, gusty) for cut in CUTS[::-1]]
    size = np.sqrt(np.square(finest).sum(axis=1).mean())
    assert size > 0.005
    for tips in others:
        away = np.sqrt(np.square(tips - finest).sum(axis=1).mean())
        assert away <= 1e-3 * size


@pytest.mark.parametrize('model', ['branch', 20, 'full'])
def test_finer_cuts_change_no_frequency(fork, model):
    tree = fork()
    for cut in (4, 7, 24):
        sims = [make_simulator(each, model=model) for each in (tree, resegment(tree, cut))]
        coarse, fine = (sim.frequencies(6) for sim in sims)
        assert fine == pytest.approx(coarse, rel=1e-6)


@given(seed=st.integers(0, 10_000), cut=st.integers(1, 9))
@settings(max_examples=40, deadline=None)
def test_what_is_kept(random_tree, seed, cut):
    start, end, diameter, parent = random_tree(seed)
    tree = tree_from_segments(
        start, end, np.stack([diameter, 0.8 * diameter], axis=1), parent=parent
    )
    finer = resegment(tree, cut)
    assert (np.diff(finer.branch_first) == cut).all()
    assert sorted(finer.branch_names) == sorted(tree.branch_names)
    ours = [finer.branch_names.index(name) for name in tree.branch_names]
    assert finer.start[finer.branch_first[ours]] == pytest.approx(
        tree.start[tree.branch_first[:-1]]
    )
    assert finer.end[finer.branch_first[1:][ours] - 1] == pytest.approx(
        tree.end[tree.branch_first[1:] - 1]
    )
    for old, new in enumerate(ours):
        carriers = [each.branch_parent[b] for each, b in ((tree, old), (finer, new))]
        names = [
            each.branch_names[c] if c >= 0 else ''
            for each, c in zip((tree, finer), carriers, strict=True)
        ]
        assert names[0] == names[1]
        if cut >= tree.branch_first[old + 1] - tree.branch_first[old]:
            # Finer cuts keep every node, and so length and volume.
            here, there = tree.segments_of(old), finer.segments_of(new)
            assert finer.length[there].sum() == pytest.approx(tree.length[here].sum())
            assert finer.volume[there].sum() == pytest.approx(tree.volume[here].sum())
    touching = np.linalg.norm(finer.start[1:] - finer.end[finer.segment_parent[1:]], axis=1)
    if cut >= np.diff(tree.branch_first).max():
        assert touching.max() < 1e-12


def test_a_cut_of_the_same_number_gives_the_same_tree(stem):
    tree = stem(cuts=5, tip=0.004)
    same = resegment(tree, 5)
    for name in (
        'start',
        'end',
        'base_diameter',
        'tip_diameter',
        'segment_parent',
        'branch_first',
    ):
        assert (getattr(same, name) == getattr(tree, name)).all()


def test_the_longest_segments_are_split_first():
    nodes = np.array([[0.0, 0.0, z] for z in (0.0, 1.0, 3.0, 3.5)])
    tree = tree_from_segments(nodes[:-1], nodes[1:], [0.03, 0.02, 0.01])
    again = resegment(tree, 6)
    assert again.length == pytest.approx([0.5, 0.5, 2 / 3, 2 / 3, 2 / 3, 0.5])
    # Steps in thickness stay where they are.
    assert again.base_diameter == pytest.approx([0.03, 0.03, 0.02, 0.02, 0.02, 0.01])


def test_a_longest_length_is_kept_to(fork):
    tree = fork(2)
    again = resegment(tree, max_segment_length=0.1)
    assert again.length.max() <= 0.1 + 1e-9
    # A branch as long as two segments to rounding gets two.
    assert (
        resegment(
            tree_from_segments([[0, 0, 0]], [[0, 0, 0.6]], [0.1]), max_segment_length=0.3
        ).n_segments
        == 2
    )


def test_children_sit_on_the_segment_beside_them():
    tree = builtin_tree('broadleaf')
    for cut in (2, 5, 11):
        again = resegment(tree, cut)
        first = again.branch_first[1:-1]
        seat = again.segment_parent[first]
        # Their start lies within the seat's length, a stored node at either end of it included.
        along = np.einsum(
            'ij,ij->i', again.start[first] - again.start[seat], again.end[seat] - again.start[seat]
        )
        share = along / again.length[seat] ** 2
        assert share.min() > -0.35
        assert share.max() < 1.35
        if cut == 11:
            assert np.abs(share - np.clip(share, 0.0, 1.0)).max() < 1e-9


@pytest.mark.parametrize(
    'wish',
    [
        {},
        {'segments_per_branch': 3, 'max_segment_length': 0.1},
        {'segments_per_branch': 0},
        {'segments_per_branch': MOST_SEGMENTS + 1},
        {'max_segment_length': 0.0},
        {'max_segment_length': float('nan')},
        {'max_segment_length': 1e-9},
    ],
)
def test_a_cut_that_cannot_be_is_refused(stem, wish):
    with pytest.raises(ParameterError):
        resegment(stem(), **wish)
