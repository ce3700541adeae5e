# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The beam frame against closed forms (V1, V2, V12, V13) and against an independent beam model."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tree_sway_lab.example_trees import forked_tree, tapered_stem
from tree_sway_lab.frame.frame import frame_model
from tree_sway_lab.segments.refinement import refined

from tree_sway.core.tree.building import tree_from_segments
from tree_sway.errors import TreeError

E, RHO, LENGTH, WIDTH = 9.0e9, 900.0, 5.0, 0.1
TREE_121 = Path(__file__).resolve().parents[3] / 'test' / 'files' / 'data' / 'tree121.csv'


def dimensionless(frequency):
    """Frequencies as w L^2 sqrt(rho A / EI), with the section at the base."""
    return 2.0 * np.pi * np.asarray(frequency) * LENGTH**2 * np.sqrt(16.0 * RHO / E) / WIDTH


def greenhill(width):
    """Length at which an upright uniform stem buckles: 7.8373 EI / (rho A g) cubed (Greenhill)."""
    return (7.8373 * E * width**2 / (16.0 * RHO * 9.81)) ** (1 / 3)


def test_uniform_cantilever_has_the_textbook_roots():
    frequency = frame_model(tapered_stem(LENGTH, np.full(21, WIDTH)), E, RHO).frequencies(6)
    assert dimensionless(frequency[::2]) == pytest.approx([3.5160, 22.0345, 61.6972], rel=1e-4)
    assert frequency[1::2] == pytest.approx(frequency[::2], rel=1e-6)


@pytest.mark.parametrize(
    ('profile', 'root'),
    [
        (lambda x: 1.0 - x, 8.719),
        (lambda x: (1.0 - x) ** (2 / 3), 7.16),
        (lambda x: 1.0 - 0.5 * x, 4.63),
    ],
    ids=['cone', 'two thirds power', 'half'],
)
def test_tapered_stems(profile, root):
    width = WIDTH * np.maximum(profile(np.linspace(0.0, 1.0, 41)), 1e-5)
    frequency = frame_model(tapered_stem(LENGTH, width), E, RHO).frequencies(1)
    assert dimensionless(frequency) == pytest.approx(root, rel=2e-3)


def test_stem_like_tree_sways_alike_both_ways():
    bent = tapered_stem(LENGTH, np.linspace(WIDTH, 0.3 * WIDTH, 13), direction=(0.28, 0.0, 0.96))
    model = frame_model(bent, E, RHO)
    frequency, shapes = model.modes(2)
    assert frequency[1] / frequency[0] < 1.05
    pushed = model.static(np.tile([0.0, 1.0, 0.0], (12, 1)))[-1]
    assert abs(pushed[0]) < 0.05 * abs(pushed[1])
    assert shapes.shape == (2, len(model.node), 3)


@pytest.mark.parametrize(('share', 'ratio'), [(0.5, 0.935), (0.9, 0.521)])
def test_weight_lowers_the_frequency_of_a_stem(share, ratio):
    stem = tapered_stem(share * greenhill(WIDTH), np.full(21, WIDTH))
    light, heavy = (frame_model(stem, E, RHO, gravity=g).frequencies(1)[0] for g in (0.0, 9.81))
    assert heavy / light == pytest.approx(ratio, rel=5e-3)


def test_stem_above_greenhill_length_is_refused_by_name():
    stem = tapered_stem(1.02 * greenhill(WIDTH), np.full(21, WIDTH))
    with pytest.raises(TreeError, match=r"branch 'stem'.*buckles under its own weight"):
        frame_model(stem, E, RHO, gravity=9.81).frequencies(1)


def test_weak_branch_is_named():
    tree = forked_tree(0.5, 0.6)
    weakened = 14
    thin = np.ones(tree.n_segments)
    thin[tree.segments_of(weakened)] = 0.1
    weak = replace(
        tree, base_diameter=tree.base_diameter * thin, tip_diameter=tree.tip_diameter * thin
    )
    with pytest.raises(TreeError, match=f"branch 'b{weakened}'"):
        frame_model(weak, 8.0e9, 900.0, gravity=9.81).frequencies(1)


def test_static_sway_is_the_cantilevers():
    stem = tapered_stem(LENGTH, np.full(3, WIDTH))
    stiffness = E * np.pi / 64.0 * WIDTH**4
    model = frame_model(stem, E, RHO, subdivisions=1)
    spread = model.static(np.tile([1.0, 0.0, 0.0], (2, 1)))[-1, 0]
    assert spread == pytest.approx(2.0 * LENGTH**3 / (8.0 * stiffness), rel=1e-9)
    at_tip = np.zeros((3, 3))
    at_tip[-1, 1] = 1.0
    assert model.static_nodal(at_tip)[-1, 1] == pytest.approx(
        LENGTH**3 / (3.0 * stiffness), rel=1e-9
    )


def test_branch_off_its_node_rides_on_a_rigid_offset():
    # A child that starts beside the stem's tip, and the same with a stiff, light bracket in
    # between.
    stem = ([0, 0, 0], [0, 0, 2.0])
    child = ([0.3, 0, 2.0], [0.3, 1.0, 2.5])
    bracket = ([0, 0, 2.0], [0.3, 0, 2.0])
    loose = tree_from_segments(
        [stem[0], child[0]], [stem[1], child[1]], [0.1, 0.05], parent=[-1, 0]
    )
    with_bracket = tree_from_segments(
        [stem[0], bracket[0], child[0]], [stem[1], bracket[1], child[1]], [0.1, 0.5, 0.05],
        parent=[-1, 0, 1],
    )  # fmt: skip
    push = np.array([[0.0, 0, 0], [0.0, 1.0, 0.3]])
    moved = frame_model(loose, E, RHO).static(push)[-1]
    same = frame_model(with_bracket, E, RHO).static(np.insert(push, 1, 0.0, axis=0))[-1]
    assert moved == pytest.approx(same, rel=2e-3, abs=1e-9)


def test_four_stepped_elements_a_segment_repeat_an_independent_beam_model():
    rows = np.genfromtxt(TREE_121, delimiter=',', names=True)
    tree = tree_from_segments(
        np.stack([rows[k] for k in ('x0', 'y0', 'z0')], axis=1),
        np.stack([rows[k] for k in ('x1', 'y1', 'z1')], axis=1),
        np.stack([rows['d0'], rows['d1']], axis=1),
        parent=rows['parent'].astype(int),
        branch=rows['branch'].astype(int),
    )
    expected = [0.7154, 0.7254, 1.4084, 1.7586, 1.9168, 2.1329, 2.2987, 2.3264]
    cut = refined(tree, 4)
    width = 0.5 * (cut.base_diameter + cut.tip_diameter)
    stepped = frame_model(
        replace(cut, base_diameter=width, tip_diameter=width), 8.0e9, 900.0, subdivisions=1
    )
    assert stepped.frequencies(8) == pytest.approx(expected, abs=6e-5)
    tapered = frame_model(tree, 8.0e9, 900.0).frequencies(8)
    assert tapered == pytest.approx(expected, rel=4e-3)
