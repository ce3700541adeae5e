# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tree_sway.core.leaves.foliage import foliage_of
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.scene.scene_simulator import SceneSimulator
from tree_sway.core.species.species import species_named
from tree_sway.errors import ParameterError
from tree_sway.files.trees.source import open_scene, open_tree, scene_of_files

FILE = open_tree(Path(__file__).parents[1] / 'data' / 'seedling.yaml')


def forest_of(*leaf_on):
    trees = tuple(
        PlacedTree(f'tree{i}', FILE.tree, x=3.0 * i, species=FILE.species, leaf_on=each)
        for i, each in enumerate(leaf_on)
    )
    return Scene(trees, 'row', 'row.yaml')


def test_it_is_drawn_and_described_as_one_record():
    tree = forest_of(None, None).tree
    assert (tree.name, tree.n_segments) == ('row', 2 * FILE.tree.n_segments)
    assert tree.segment_names[FILE.tree.n_segments] == 'tree1/stem/0'


def test_it_sways_as_a_forest():
    file = replace(forest_of(None, True), anemometer=(-9.0, 0.0, 0.0), convection_ratio=2.0)
    forest = file.simulator(model='branch', damping_ratio=0.2)
    assert isinstance(forest, SceneSimulator)
    assert forest.model == 'branch'
    assert [each.settings.in_leaf for each in forest.simulators] == [False, True]
    forest.step((6.0, 0.0, 0.0), 1.0 / 60.0)
    assert forest.gusts.delay == pytest.approx([0.75, 1.0])


def test_of_one_wood_its_leaves_are_too():
    birches = forest_of(None, None).of_species(species_named('birch'))
    assert (
        {each.species.key for each in birches.trees}
        == {each.tree.species for each in birches.trees}
        == {'birch'}
    )
    birch = FILE.of_species(species_named('birch'))
    assert (birch.species.key, birch.tree.species) == ('birch', 'birch')


def test_leaves_stand_on_their_own_trees():
    leaves = forest_of(False, True, None).leaves(True, 40)
    n = FILE.tree.n_segments
    assert np.bincount(leaves.segment // n, minlength=3).tolist() == [0, 20, 20]
    assert leaves.size.shape == (40,)
    assert forest_of(False, None).leaves(False, 40) is None
    assert forest_of(True).leaves(False, 40) is not None
    assert forest_of(True).leaves(True, 0) is None


def test_a_scene_of_one_tree_is_as_the_tree():
    scene = scene_of_files([FILE])
    sim = scene.simulator(model='full', in_leaf=True)
    assert sim.model == 'full'
    assert sim.settings.leaf_area == pytest.approx(foliage_of(FILE.tree).drag_area)
    assert (scene.name, scene.tree.segment_names) == (FILE.tree.name, FILE.tree.segment_names)
    np.testing.assert_array_equal(scene.tree.end, FILE.tree.end)
    assert scene.leaves(False, 40) is None
    assert scene.leaves(True, 40).segment.shape == (40,)


def test_trees_of_one_file_stand_where_they_do_in_it():
    path = Path(__file__).parents[1] / 'data' / 'forest.treefile.txt'
    forest = open_scene(path)
    assert [(each.name, each.x, each.y, each.z) for each in forest.trees] == [
        ('forest.treefile1', 0.0, 0.0, 0.0),
        ('forest.treefile2', 10.0, 0.0, 0.0),
    ]
    assert forest.tree.start[:, 0].max() >= 10.0
    second = open_scene(path, tree=2)
    assert second.tree.name == 'forest.treefile2'
    with pytest.raises(ParameterError, match='tree 3 of 2; give 1 to 2'):
        open_scene(path, tree=3)
    with pytest.raises(ParameterError, match=r'tree 1\.5 of 2; give 1 to 2'):
        open_scene(path, tree=1.5)
    # Not moved, they are at their places in the file.
    placed = open_scene(path, to_origin=False).tree
    assert placed.start[0].tolist() == [100.0, 200.0, 50.0]
    assert placed.start[forest.trees[0].tree.n_segments].tolist() == [110.0, 200.0, 50.0]
