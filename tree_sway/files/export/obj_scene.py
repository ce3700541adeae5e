# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees as Wavefront OBJ: triangles of one moment, for programs that take still scenes.

Coordinates are ours: x east, y north, z up, in metres. The groups ``wood`` and ``leaves`` use
materials of these names, for which a reader has values of its own: OBJ has no reflectances.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves import LeafClusters
from tree_sway.core.species import look_of
from tree_sway.core.tree import Tree
from tree_sway.files.export.tree_mesh import leaf_mesh, TreeMesh, wood_mesh

_DIGITS = 4
"""Digits of a coordinate after the point [m]."""


class ObjScene:
    """
    The same trees as OBJ in any pose; vertices keep their numbers.

    Parameters
    ----------
    tree
        All trees in one record.
    leaves
        Clusters of leaves to draw, if any.

    """

    def __init__(self, tree: Tree, leaves: LeafClusters | None) -> None:
        self._meshes: list[TreeMesh] = [wood_mesh(tree)]
        if leaves is not None:
            self._meshes.append(leaf_mesh(leaves, look_of(tree.species).spray))
        self._faces = list[str]()
        first = 1
        for name, mesh in zip(('wood', 'leaves'), self._meshes, strict=False):
            triangles = (mesh.triangles + first).tolist()
            lines = '\n'.join(f'f {a} {b} {c}' for a, b, c in triangles)
            self._faces.append(f'g {name}\nusemtl {name}\n{lines}\n')
            first += len(mesh.points)

    def text(self, poses: Floats, comment: str) -> str:
        """Return the file of poses (n, 7): x y z [m], quaternion x y z w; with a line on top."""
        points = np.vstack([mesh.placed(poses) for mesh in self._meshes])
        line = f'v %.{_DIGITS}f %.{_DIGITS}f %.{_DIGITS}f'
        vertices = '\n'.join(line % tuple(each) for each in points.tolist())
        return f'# {comment}\n{vertices}\n{"".join(self._faces)}'
