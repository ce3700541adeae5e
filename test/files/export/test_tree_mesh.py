# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tree_sway.core.leaves.foliage import leaf_clusters
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.look import Spray
from tree_sway.core.species.species import species_named
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.files.export.tree_mesh import BARK_HEIGHT, crown_mesh, leaf_mesh, SIDES, wood_mesh
from tree_sway.files.trees.tree_file import read_tree
from tree_sway.growth.builtin import builtin_tree

DATA = Path(__file__).parents[1] / 'data'


@pytest.fixture
def tree():
    return read_tree(DATA / 'fork.archi.csv').tree


@pytest.mark.parametrize('name', ['benjamina', 'goldcrest'])
def test_rest_poses_are_the_solvers(name):
    """Not only the direction of each segment: its roll too, or a driven mesh is twisted."""
    tree = builtin_tree(name, 0)
    simulator = make_simulator(tree, species_named(tree.species), model=12)
    np.testing.assert_allclose(tree.rest_poses, simulator.place(), atol=1e-12)


def test_upright_and_slanted_segments_alike():
    ends = [[0, 0, 1], [0, 0, -1], [-1, 0, 0], [1, 0, 0], [0, 1, 0]]
    tree = tree_from_segments([[0, 0, 0]] * 5, ends, [0.1] * 5, parent=[-1, 0, 0, 0, 0])
    poses = tree.rest_poses
    tips = Rotation.from_quat(poses[:, 3:]).apply([1.0, 0.0, 0.0])
    np.testing.assert_allclose(tips, tree.end - tree.start, atol=1e-12)


def test_cones_are_closed_and_face_outward(tree):
    mesh = wood_mesh(tree)
    places = np.unique(np.round(mesh.placed(tree.rest_poses), 9), axis=0, return_inverse=True)[1]
    triangles = places.ravel()[mesh.triangles]
    edges = np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    assert {tuple(edge) for edge in edges} == {tuple(edge[::-1]) for edge in edges}
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    volume = np.einsum('ij,ij->i', a, np.cross(b, c)).sum() / 6.0
    polygon = SIDES / (2.0 * np.pi) * np.sin(2.0 * np.pi / SIDES)
    assert volume == pytest.approx(polygon * tree.volume.sum(), rel=1e-12)


def test_normals_are_across_the_surface(tree):
    mesh = wood_mesh(tree)
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-12)
    sides = mesh.triangles.reshape(tree.n_segments, -1, 3)[:, : 2 * SIDES].reshape(-1, 3)
    a, b, c = (mesh.points[sides[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    across /= np.linalg.norm(across, axis=1)[:, None]
    agreement = np.einsum('ij,ikj->ik', across, mesh.normals[sides])
    assert agreement.min() > np.cos(np.pi / SIDES) - 1e-6


def test_leaves_lie_as_their_clusters(tree):
    leaves = leaf_clusters(tree, np.random.default_rng(0), count=20)
    spray = Spray(1.5, 0.5, (0.0, 1.2))
    mesh = leaf_mesh(leaves, spray)
    assert len(mesh.points) == 2 * 4 * len(leaves.size)
    assert (mesh.segment[::4] == np.tile(leaves.segment, 2)).all()
    corners = mesh.points.reshape(2, -1, 4, 3)
    # Each card begins where its cluster does, half of its size before its middle.
    turns = Rotation.from_quat(leaves.orientation[:, [1, 2, 3, 0]])
    root = leaves.offset - 0.5 * leaves.size[:, None] * turns.apply([1.0, 0.0, 0.0])
    for card in corners:
        np.testing.assert_allclose(0.5 * (card[:, 0] + card[:, 3]), root, atol=1e-12)
        wide = np.linalg.norm(card[:, 3] - card[:, 0], axis=1)
        np.testing.assert_allclose(wide, 1.5 * 0.5 * leaves.size, rtol=1e-12)
    across = [card[:, 3] - card[:, 0] for card in corners]
    angle = np.einsum('ij,ij->i', *across) / np.prod(
        [np.linalg.norm(each, axis=1) for each in across], axis=0
    )
    assert np.abs(angle).max() < 0.7  # they cross each other


def test_a_crown_of_smaller_shoots_is_above_the_ground_and_lit_from_outside(tree):
    leaves = leaf_clusters(tree, np.random.default_rng(0), count=200)
    spray = Spray(1.5, 0.5, (0.0, 1.2))
    whole, parted = leaf_mesh(leaves, spray), crown_mesh(tree, leaves, spray, 4)
    assert len(whole.points) < len(parted.points) <= 4 * len(whole.points)
    points = parted.placed(tree.rest_poses)
    assert points[:, 2].min() >= tree.start[0, 2]
    turns = Rotation.from_quat(tree.rest_poses[parted.segment, 3:])
    normals = turns.apply(parted.normals)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-12)
    away = points - points.mean(axis=0)
    away /= np.linalg.norm(away, axis=1)[:, None]
    assert np.einsum('ij,ij->i', normals, away).mean() > 0.6
    # The side that a viewer takes for the front is the one that is lit.
    corner, one, other = (points[parted.triangles[:, k]] for k in range(3))
    front = np.cross(one - corner, other - corner)
    assert np.mean(np.einsum('ij,ij->i', front, normals[parted.triangles[:, 0]]) > 0.0) > 0.9

    def area(mesh):
        a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
        return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()

    assert 0.7 < area(parted) / area(whole) <= 1.05


def test_light_and_shade_of_a_crown_meet_at_no_edge(tree):
    leaves = leaf_clusters(tree, np.random.default_rng(0), count=200)
    mesh = crown_mesh(tree, leaves, Spray(1.5, 0.5, (0.0, 1.2)), 4)
    upward = mesh.turned(tree.rest_poses)[:, 2]
    from_below = np.argsort(mesh.placed(tree.rest_poses)[:, 2])
    layers = np.array([layer.mean() for layer in np.array_split(upward[from_below], 10)])
    assert np.abs(np.diff(layers)).max() < 0.3
    assert layers.min() > -0.5  # the lowest leaves have light of the sky, too
    assert layers[-1] > 0.5


def test_a_texture_goes_on_along_each_branch(tree):
    mesh = wood_mesh(tree)
    along = mesh.texture[:, 1].reshape(tree.n_segments, 2, SIDES)
    high = min(BARK_HEIGHT, 0.12 * tree.height)
    for branch in range(tree.n_branches):
        here = along[tree.segments_of(branch)]
        assert (here[0, 0] == 0.0).all()
        np.testing.assert_allclose(here[-1, 1], tree.branch_length[branch] / high, rtol=1e-9)
        np.testing.assert_allclose(here[1:, 0], here[:-1, 1], rtol=1e-12)
    assert SIDES % 2 == 0
    around = mesh.texture[:SIDES, 0]  # there and back
    np.testing.assert_allclose(around[1:], around[:0:-1], atol=1e-12)
    assert (around[0], around[SIDES // 2]) == (0.0, 1.0)
