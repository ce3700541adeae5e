# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree as glTF 2.0, ready to sway: one mesh, by a skin or by morph targets.

With a skin, each segment is a node named as in `Tree.segment_names`, flat below the node of the
tree: a node's translation and rotation are the segment's pose, at rest and in every frame of
``segment_poses``. With morph targets, each is the motion of the vertices by one coordinate of the
tree's state, so that some twenty weights animate the tree; the targets are linear. glTF has y up;
the node of the tree has the rotation, and everything inside it is in our frame.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves import LeafClusters
from tree_sway.core.model import MARGIN
from tree_sway.core.run import basis_of, SwaySimulator
from tree_sway.core.tree import Tree
from tree_sway.errors import FormatError
from tree_sway.files.export.breeze import in_breeze, RATE, SECONDS, SPEED
from tree_sway.files.export.gltf_document import ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, GltfDocument
from tree_sway.files.export.tree_mesh import matrices_of
from tree_sway.files.export.tree_parts import parts_of, TreePart

_Y_UP = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]
_MAX_JOINTS = 65536
_SWING = 0.5
"""
Share of a coordinate's unit at which the slope of a target is computed: between a breeze and a
storm.
"""
_CUTOFF = 0.2
"""
Least alpha of a picture of leaves that is drawn: less than a small picture has on the average, so
that far crowns are no balder than near ones.
"""
_MOVED = 0.09
"""
Largest motion by a weight of 1 over the least width of the tree: viewers that bound a tree by its
targets see one little larger than it is, on every side.
"""
_SHOOTS, _FEW_SHOOTS = 4, 1
"""Shoots per cluster of leaves with a skin, and with morph targets, which each vertex has."""


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
    document = GltfDocument()
    poses = tree.rest_poses
    joints = [*range(1, tree.n_segments + 1)]
    root = document.add('nodes', name=tree.name, rotation=_Y_UP, children=joints)
    for name, pose in zip(tree.segment_names, poses.tolist(), strict=True):
        document.add('nodes', name=name, translation=pose[:3], rotation=pose[3:])
    back = Rotation.from_quat(poses[:, 3:]).inv()
    inverse = matrices_of(np.hstack([-back.apply(poses[:, :3]), back.as_quat()]))
    matrices = document.add_array(inverse.astype(np.float32))
    skin = document.add('skins', joints=joints, skeleton=root, inverseBindMatrices=matrices)
    primitives = []
    for part in parts_of(tree, leaves, _SHOOTS):
        mesh = part.mesh
        primitive = _primitive(document, part, mesh.placed(poses), mesh.turned(poses))
        joint = np.zeros((len(mesh.points), 4), dtype=np.uint16)
        joint[:, 0] = mesh.segment
        weight = np.zeros(joint.shape, dtype=np.uint8)
        weight[:, 0] = 255
        primitive['attributes'] |= {
            'JOINTS_0': document.add_array(joint, target=ARRAY_BUFFER),
            'WEIGHTS_0': document.add_array(weight, target=ARRAY_BUFFER, is_share=True),
        }
        primitives.append(primitive)
    body = document.add('meshes', name=tree.name, primitives=primitives)
    # Viewers ignore the place of the node of a skinned mesh: it is next to the joints.
    shown = document.add('nodes', name=f'{tree.name} mesh', mesh=body, skin=skin)
    document.add('scenes', nodes=[root, shown])
    return document


def morphing_tree(
    simulator: SwaySimulator,
    leaves: LeafClusters | None = None,
    *,
    small: bool = True,
    speed: float = SPEED,
) -> GltfDocument:
    """
    Return a tree on any model of a simulator as a mesh with a morph target per coordinate.

    A weight is the coordinate over its ``unit``, which the mesh's extras list with the digest of
    the basis and the amplitude of the coordinate in a ``storm``. The node scales the targets: a
    weight of 1 moves some vertex by a tenth of the width of the tree. They are integers in a
    ``small`` document (KHR_mesh_quantization, which Godot does not read), for which the vertices
    of a ring of wood move together. An animation shows a breeze of a mean speed [m/s].
    """
    tree = simulator.tree
    basis = basis_of(simulator)
    storm = basis.scale / MARGIN
    document = GltfDocument()
    rest = tree.rest_poses
    parts = parts_of(tree, leaves, _FEW_SHOOTS)
    swings = _SWING * np.diag(storm)
    steps = [
        [simulator.place_rotations(basis.rotations(each)).copy() for each in (swing, -swing)]
        for swing in swings
    ]
    changes = [[_change(part, *step) for step in steps] for part in parts]
    places = [part.mesh.placed(rest) for part in parts]
    low, high = (limit(np.vstack(places), axis=0) for limit in (np.min, np.max))
    size = _MOVED * float((high - low)[:2].min())
    middle = 0.5 * (low + high)
    greatest = np.max([[np.abs(change).max() for change in each] for each in changes], axis=0)
    unit = storm * size / greatest
    primitives = []
    for part, points, moved in zip(parts, places, changes, strict=True):
        scaled = (points - middle) / size
        primitive = _primitive(document, part, scaled, part.mesh.turned(rest), small)
        primitive['targets'] = [
            {'POSITION': _add_vertices(document, change / most, small, bounds=True)}
            for change, most in zip(moved, greatest, strict=True)
        ]
        primitives.append(primitive)
    body = document.add(
        'meshes',
        name=tree.name,
        primitives=primitives,
        weights=[0.0] * len(storm),
        extras={
            'targetNames': [f'sway {k + 1}' for k in range(len(storm))],
            'unit': unit.tolist(),
            'storm': storm.tolist(),
            'basis': basis.digest,
        },
    )
    shown = document.add(
        'nodes', name=tree.name, mesh=body, rotation=_Y_UP, scale=[size] * 3,
        translation=Rotation.from_quat(_Y_UP).apply(middle).tolist(),
    )  # fmt: skip
    document.add('scenes', nodes=[shown])
    if small:
        quantised = ['KHR_mesh_quantization']
        document.set(extensionsUsed=quantised, extensionsRequired=quantised)
    weights = in_breeze(
        simulator,
        SECONDS['.glb'],
        lambda: basis.coordinates(simulator.rotations()) / unit,
        speed,
    )
    _add_animation(document, shown, np.array(weights))
    return document


def _add_vertices(
    document: GltfDocument, values: Floats, small: bool = False, *, bounds: bool = False
) -> int:
    """Add values in single precision, or those within -1 .. 1 in small numbers of a byte."""
    stored: NDArray[Any] = values.astype(np.float32)
    if small:
        stored = np.rint(np.clip(values, -1.0, 1.0) * 127).astype(np.int8)
    return document.add_array(stored, target=ARRAY_BUFFER, bounds=bounds, is_share=small)


def _primitive(
    document: GltfDocument,
    part: TreePart,
    points: Floats,
    normals: Floats,
    small: bool = False,
) -> dict[str, Any]:
    """Part of a mesh at its places, with normals, small ones or not, texture and material."""
    triangles = part.mesh.triangles
    if not part.is_wood:
        # From both sides: viewers turn the normals of a back, which is dark then.
        triangles = np.vstack([triangles, triangles[:, ::-1]])
    kind = np.uint16 if len(points) < 65535 else np.uint32  # 65535 starts a new strip
    return {
        'attributes': {
            'POSITION': _add_vertices(document, points, bounds=True),
            'NORMAL': _add_vertices(document, normals, small),
            'TEXCOORD_0': _add_vertices(document, part.mesh.texture),
        },
        'indices': document.add_array(triangles.ravel().astype(kind), target=ELEMENT_ARRAY_BUFFER),
        'material': document.add(
            'materials',
            name=part.material,
            alphaMode=None if part.is_wood else 'MASK',
            alphaCutoff=None if part.is_wood else _CUTOFF,
            pbrMetallicRoughness={
                'baseColorTexture': {'index': document.add_picture(part.material, part.picture)},
                'baseColorFactor': [*part.linear_tint, 1.0],
                'metallicFactor': 0.0,
                'roughnessFactor': 1.0,
            },
        ),
    }


def _change(part: TreePart, there: Floats, back: Floats) -> Floats:
    """Motion of vertices per unit of a coordinate, from poses at plus and minus `_SWING` of it."""
    mesh = part.mesh
    if part.is_wood:  # a ring moves with its centre, so that rounding keeps its shape
        mesh = mesh._replace(points=mesh.points * [1.0, 0.0, 0.0])
    return (0.5 / _SWING) * (mesh.placed(there) - mesh.placed(back))


def _add_animation(document: GltfDocument, node: int, weights: Floats) -> None:
    times = np.arange(len(weights), dtype=np.float32) / np.float32(RATE)
    sampler = {
        'input': document.add_array(times, bounds=True),
        'output': document.add_array(weights.ravel().astype(np.float32)),
        'interpolation': 'LINEAR',
    }
    channel = {'sampler': 0, 'target': {'node': node, 'path': 'weights'}}
    document.add('animations', name='breeze', samplers=[sampler], channels=[channel])
