# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from tree_sway.core.species import species_named
from tree_sway.core.tree import tree_from_segments
from tree_sway.files.trees import sway_oddity


def test_a_sway_of_no_tree_of_its_size_is_reported() -> None:
    tree = tree_from_segments([[0, 0, 0]], [[0, 0, 12]], [0.3])
    usual = 0.0766 + 3.1219 * 100.0 * tree.base_diameter[0] / tree.height**2
    spruce, oak = species_named('spruce'), species_named('oak')
    for frequency in (3.0 * usual, usual / 3.0):
        assert sway_oddity(tree, spruce, frequency) == ''
    for frequency in (10.0 * usual, 0.1 * usual):
        said = sway_oddity(tree, spruce, frequency)
        assert f'{frequency:.3g} Hz, while conifers of its size' in said
        assert sway_oddity(tree, oak, frequency) == ''
