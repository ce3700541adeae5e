# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Parts of a tree that programs draw: its wood and its leaves, each with mesh and surface."""

from __future__ import annotations

from typing import NamedTuple

from tree_sway.core.leaves import LeafClusters
from tree_sway.core.species import Color, look_of
from tree_sway.core.tree import Tree
from tree_sway.files.export.spray_pictures import bark_picture, leaf_picture
from tree_sway.files.export.tree_mesh import crown_mesh, TreeMesh, wood_mesh


class TreePart(NamedTuple):
    """
    Mesh of a part of a tree, and its surface.

    Parameters
    ----------
    name, material
        ``Wood`` with ``bark``, or ``Leaves`` with ``leaves``.
    mesh
        The mesh; leaves are to be seen from both sides.
    picture
        Picture as PNG, cut out by its alpha if it is of leaves.
    tint
        Colour by which the picture is multiplied, as screens have it.
    color
        Colour of the part where there is no picture, as screens have it.

    """

    name: str
    material: str
    mesh: TreeMesh
    picture: bytes
    tint: Color
    color: Color

    @property
    def is_wood(self) -> bool:
        """Whether it is the wood, which is closed and seen from outside only."""
        return self.name == 'Wood'

    @property
    def linear_tint(self) -> list[float]:
        """Tint in linear light, to three digits."""
        return [round(share**2.2, 3) for share in self.tint]


def parts_of(tree: Tree, leaves: LeafClusters | None, shoots: int) -> list[TreePart]:
    """Return the wood of a tree, and its leaves if there are any, each cluster as some shoots."""
    look = look_of(tree.species)
    bark = bark_picture(look.bark_pattern)
    wood = TreePart('Wood', 'bark', wood_mesh(tree), bark, look.bark, look.bark)
    if leaves is None:
        return [wood]
    crown = crown_mesh(tree, leaves, look.spray, shoots)
    spray = leaf_picture(tree.species)
    return [wood, TreePart('Leaves', 'leaves', crown, spray, (1.0, 1.0, 1.0), look.green)]
