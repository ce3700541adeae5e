# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree as glTF 2.0, ready to sway: one mesh, by a skin or by morph targets.

With a skin, each segment is a node named as in `Tree.segment_names`, flat below the node of the
tree: a node's translation and rotation are the segment's pose, at rest and in every frame of
``segment_poses``. With morph targets, each is what one coordinate of the tree's state does to the
vertices, so that some twenty weights play the tree; the targets are linear. glTF has y up by its
specification, which the node of the tree turns: all inside it keeps our frame.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves.foliage import LeafClusters
from tree_sway.core.simulator.find_basis import state_basis
from tree_sway.core.simulator.simulator import SwaySimulator
from tree_sway.core.state.state_basis import MARGIN, StateBasis
from tree_sway.core.tree.species import bark_color, leaf_traits
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import FormatError
from tree_sway.files.export.breeze import in_breeze, RATE
from tree_sway.files.export.gltf_document import (
    ARRAY_BUFFER,
    ELEMENT_ARRAY_BUFFER,
    GltfDocument,
)
from tree_sway.files.export.tree_mesh import leaf_mesh, TreeMesh, wood_mesh

_GENERATOR = 'tree_sway'
_Y_UP = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]
_MAX_JOINTS = 65536
_SWING = 0.5
"""Part of a coordinate's unit at which a target has the slope: between a breeze and a storm."""
_SECONDS = 20.0


def skinned_tree(tree: Tree, leaves: LeafClusters | None = None) -> GltfDocument:
    """
    Return a tree, or a forest joined to one, as a mesh with a skin of a joint per segment.

    Raises a `FormatError` for more segments than a skin can have joints.
    """
    if tree.n_segments > _MAX_JOINTS:
        raise FormatError(
            f'{tree.n_segments} segments, more than the {_MAX_JOINTS} joints of a skin',
            where=tree.name,
            cure='convert its trees one by one',
        )
    document, poses = GltfDocument(_GENERATOR), tree.rest_poses
    joints = list(range(1, tree.n_segments + 1))
    root = document.add('nodes', name=tree.name, rotation=_Y_UP, children=joints)
    for name, pose in zip(tree.segment_names, poses.tolist(), strict=True):
        document.add('nodes', name=name, translation=pose[:3], rotation=pose[3:])
    inverse = document.add_array(_inverse_matrices(poses))
    skin = document.add('skins', joints=joints, skeleton=root, inverseBindMatrices=inverse)
    primitives = []
    for material, mesh in _meshes(tree, leaves):
        primitive = _primitive(document, material, tree.species, mesh, poses)
        joint = np.zeros((len(mesh.points), 4), dtype=np.uint16)
        weight = np.zeros((len(mesh.points), 4), dtype=np.uint8)
        joint[:, 0], weight[:, 0] = mesh.segment, 255
        primitive['attributes'] |= {
            'JOINTS_0': document.add_array(joint, target=ARRAY_BUFFER),
            'WEIGHTS_0': document.add_array(weight, target=ARRAY_BUFFER),
        }
        primitives.append(primitive)
    body = document.add('meshes', name=tree.name, primitives=primitives)
    # A viewer ignores where the node of a skinned mesh is: it is next to the joints.
    shown = document.add('nodes', name=f'{tree.name} mesh', mesh=body, skin=skin)
    document.add('scenes', nodes=[root, shown])
    document.set(scene=0)
    return document


def morphing_tree(simulator: SwaySimulator, leaves: LeafClusters | None = None) -> GltfDocument:
    """
    Return a tree on any model of a simulator as a mesh with a morph target per coordinate.

    A weight is the coordinate over its ``unit``, which the mesh's extras list with the digest of
    the basis; 1 is as far as it goes in a storm. An animation plays a breeze.
    """
    tree, basis = simulator.tree, state_basis(simulator)
    unit = basis.scale / MARGIN
    document, rest = GltfDocument(_GENERATOR), tree.rest_poses
    steps = [_swung(simulator, basis, k, unit[k]) for k in range(basis.n_coordinates)]
    names = tuple(f'sway {k + 1}' for k in range(basis.n_coordinates))
    primitives = []
    for material, mesh in _meshes(tree, leaves):
        primitive = _primitive(document, material, tree.species, mesh, rest)
        primitive['targets'] = [
            {'POSITION': document.add_array(change, target=ARRAY_BUFFER, bounds=True)}
            for change in (_change(mesh, step).astype(np.float32) for step in steps)
        ]
        primitives.append(primitive)
    body = document.add(
        'meshes',
        name=tree.name,
        primitives=primitives,
        weights=[0.0] * len(names),
        extras={'targetNames': list(names), 'unit': unit.tolist(), 'basis': basis.digest},
    )
    shown = document.add('nodes', name=tree.name, mesh=body, rotation=_Y_UP)
    document.add('scenes', nodes=[shown])
    document.set(scene=0)
    weights = in_breeze(
        simulator, _SECONDS, lambda: basis.coordinates(simulator.rotations()) / unit
    )
    _add_animation(document, shown, np.array(weights))
    return document


def _meshes(tree: Tree, leaves: LeafClusters | None) -> list[tuple[str, TreeMesh]]:
    wood = ('bark', wood_mesh(tree))
    return [wood] if leaves is None else [wood, ('leaves', leaf_mesh(leaves))]


def _primitive(
    document: GltfDocument, material: str, species: str, mesh: TreeMesh, poses: Floats
) -> dict[str, Any]:
    """Part of a mesh at rest, in the frame of the tree."""
    is_bark = material == 'bark'
    color = bark_color(species) if is_bark else leaf_traits(species).green
    normals = Rotation.from_quat(poses[mesh.segment, 3:]).apply(mesh.normals)
    points = mesh.placed(poses).astype(np.float32)
    return {
        'attributes': {
            'POSITION': document.add_array(points, target=ARRAY_BUFFER, bounds=True),
            'NORMAL': document.add_array(normals.astype(np.float32), target=ARRAY_BUFFER),
        },
        'indices': document.add_array(
            mesh.triangles.ravel().astype(np.uint32), target=ELEMENT_ARRAY_BUFFER
        ),
        'material': document.add(
            'materials',
            name=material,
            doubleSided=None if is_bark else True,
            pbrMetallicRoughness={
                'baseColorFactor': [*(round(c**2.2, 3) for c in color), 1.0],
                'metallicFactor': 0.0,
                'roughnessFactor': 1.0,
            },
        ),
    }


def _inverse_matrices(poses: Floats) -> Any:
    """Inverse of each pose as a matrix by columns, (n, 4, 4)."""
    rotation = Rotation.from_quat(poses[:, 3:]).as_matrix()
    columns = np.zeros((len(poses), 4, 4))
    columns[:, :3, :3] = rotation  # columns of the transpose
    columns[:, 3, :3] = -np.einsum('nij,ni->nj', rotation, poses[:, :3])
    columns[:, 3, 3] = 1.0
    return columns.astype(np.float32)


def _swung(
    simulator: SwaySimulator, basis: StateBasis, k: int, size: float
) -> tuple[Floats, Floats]:
    """Poses with one coordinate at a part of its unit, to one side and to the other."""
    coordinates = np.zeros(basis.n_coordinates)
    coordinates[k] = _SWING * size
    there = simulator.place_rotations(basis.rotations(coordinates)).copy()
    return there, simulator.place_rotations(basis.rotations(-coordinates)).copy()


def _change(mesh: TreeMesh, step: tuple[Floats, Floats]) -> Floats:
    """Return what a coordinate's unit does to vertices, half from each side to the other."""
    return (0.5 / _SWING) * (mesh.placed(step[0]) - mesh.placed(step[1]))


def _add_animation(document: GltfDocument, node: int, weights: Floats) -> None:
    times = np.arange(len(weights), dtype=np.float32) / np.float32(RATE)
    sampler = {
        'input': document.add_array(times, bounds=True),
        'output': document.add_array(weights.ravel().astype(np.float32)),
        'interpolation': 'LINEAR',
    }
    channel = {'sampler': 0, 'target': {'node': node, 'path': 'weights'}}
    document.add('animations', name='breeze', samplers=[sampler], channels=[channel])
