# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from dataclasses import replace
import json
from pathlib import Path

from jsonschema import Draft202012Validator
import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.core.leaves import flutter_angle
from tree_sway.core.leaves.foliage import leaf_clusters
from tree_sway.core.scene.placed_tree import joined, PlacedTree
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.tree_state import digest_of
from tree_sway.pictures.leaves_in_place import leaf_poses
from tree_sway_ros.wire.tree_description import describe, VERSION

TREE = tree_from_segments(
    [[0, 0, 0], [0, 0, 1], [0, 0, 1]], [[0, 0, 1], [0, 0, 2], [1, 0, 1]], [0.1, 0.08, 0.03]
)
ROOT = Path(__file__).parents[3]
SCHEMA = Draft202012Validator(
    json.loads((ROOT / 'doc/tree_description.schema.json').read_text(encoding='utf-8'))
)


def test_it_fits_its_schema():
    SCHEMA.validate(json.loads(describe(TREE, 'map')))
    assert 'leaves' not in json.loads(describe(TREE, 'map'))


def test_leaves_are_part_of_it():
    description = describe(
        TREE, 'map', leaves=leaf_clusters(TREE, np.random.default_rng(0), count=12)
    )
    SCHEMA.validate(json.loads(description))
    assert len(json.loads(description)['leaves']['segment']) == 12


def test_leaves_can_be_drawn_by_it_and_the_poses_alone():
    tree = tree_from_segments([[0, 0, 1.0]], [[0.3, 0.4, 1.2]], [0.004])
    leaves = leaf_clusters(tree, np.random.default_rng(3), count=20)
    listed = json.loads(describe(tree, 'map', leaves=leaves))['leaves']
    gain, largest = listed['flutter']['gain'], listed['flutter']['largest_angle']
    frequency, phase = np.array(listed['frequency']), np.array(listed['phase'])
    angle = largest * np.tanh(gain * 3.0**2 / (frequency * largest))
    angle *= np.sin(2.0 * np.pi * frequency * 0.7 + phase)
    np.testing.assert_allclose(angle, flutter_angle(leaves, 3.0, 0.7), atol=1e-3)
    rest = np.hstack([tree.start, tree.rest_frame[:, [1, 2, 3, 0]]])
    carrier = Rotation.from_quat(rest[listed['segment'], 3:])
    centre = tree.start[listed['segment']] + carrier.apply(listed['offset'])
    np.testing.assert_allclose(centre, leaf_poses(leaves, rest)[:, :3], atol=2e-4)


def test_every_tree_of_several_begins_with_a_segment_without_a_parent():
    trees = [PlacedTree('a', TREE), PlacedTree('b', TREE, x=3.0)]
    description = json.loads(describe(joined([each.placed() for each in trees]), 'map'))
    SCHEMA.validate(description)
    parents, names = description['segments']['parents'], description['segments']['names']
    roots = [name for name, parent in zip(names, parents, strict=True) if parent < 0]
    assert [name.split('/')[0] for name in roots] == ['a', 'b']
    assert len(set(names)) == 2 * TREE.n_segments


def test_it_says_what_the_tree_says():
    description = json.loads(describe(TREE, 'odom'))
    assert (description['version'], description['frame_id']) == (VERSION, 'odom')
    segments = description['segments']
    assert segments['names'] == list(TREE.segment_names)
    assert segments['parents'] == TREE.segment_parent.tolist()
    assert segments['branches'] == TREE.branch_of_segment.tolist()
    np.testing.assert_allclose(segments['lengths'], TREE.length)
    np.testing.assert_allclose(segments['base_radii'], TREE.base_diameter / 2)
    assert description['branches']['first_segments'] == TREE.branch_first[:-1].tolist()
    assert all(len(column) == TREE.n_segments for column in segments.values())


def test_another_tree_has_another_hash():
    assert digest_of(TREE) == json.loads(describe(TREE, 'map'))['hash']
    assert digest_of(replace(TREE, end=TREE.end * (1.0 + 1e-12))) != digest_of(TREE)
