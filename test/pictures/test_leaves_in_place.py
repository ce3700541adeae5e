# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.core.leaves import leaf_clusters, LeafClusters
from tree_sway.core.tree import Tree, tree_from_segments
from tree_sway.pictures.leaves_in_place import leaf_poses


def twig() -> Tree:
    return tree_from_segments([[0, 0, 1.0]], [[0.3, 0.4, 1.2]], [0.004])


def poses_at_rest(tree: Tree) -> np.ndarray:
    rest = tree.rest_frame
    return np.hstack([tree.start, rest[:, [1, 2, 3, 0]]])


def leaves_of(tree: Tree) -> LeafClusters:
    return leaf_clusters(tree, np.random.default_rng(3), count=20)


def test_leaves_at_rest_are_where_they_were_put() -> None:
    tree = twig()
    leaves = leaves_of(tree)
    block = leaf_poses(leaves, poses_at_rest(tree))
    along = (block[:, :3] - tree.start[0]) @ (tree.end - tree.start)[0] / tree.length[0]
    np.testing.assert_allclose(along, leaves.offset[:, 0], atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(block[:, 3:], axis=1), 1.0)


def test_leaves_ride_on_the_segment_as_a_rigid_body() -> None:
    tree = twig()
    leaves, rest = leaves_of(tree), poses_at_rest(tree)
    turn, shift = Rotation.from_rotvec([0.3, -0.8, 0.5]), np.array([1.0, -2.0, 0.5])
    moved = np.hstack(
        [turn.apply(rest[:, :3]) + shift, (turn * Rotation.from_quat(rest[:, 3:])).as_quat()]
    )
    before, after = leaf_poses(leaves, rest), leaf_poses(leaves, moved)
    np.testing.assert_allclose(after[:, :3], turn.apply(before[:, :3]) + shift, atol=1e-12)
    expected = (turn * Rotation.from_quat(before[:, 3:])).as_matrix()
    np.testing.assert_allclose(Rotation.from_quat(after[:, 3:]).as_matrix(), expected, atol=1e-12)


def test_flutter_turns_a_leaf_about_its_stalk_alone() -> None:
    tree = twig()
    leaves, rest = leaves_of(tree), poses_at_rest(tree)
    still, turned = leaf_poses(leaves, rest), leaf_poses(leaves, rest, 0.4)
    np.testing.assert_array_equal(still[:, :3], turned[:, :3])
    before, after = (Rotation.from_quat(block[:, 3:]) for block in (still, turned))
    np.testing.assert_allclose(before.apply([1, 0, 0]), after.apply([1, 0, 0]), atol=1e-12)
    np.testing.assert_allclose((before.inv() * after).magnitude(), 0.4, rtol=1e-9)
