# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tree as an Euler-Bernoulli frame in 3D: a truth for frequencies, mode shapes and static sway.

Each segment is one or more tapered elements with consistent mass, clamped at the root; a branch is
rigidly fixed at the nearest node of the segment it sits on, over a rigid offset where it starts
off that node. Gravity acts through the geometric stiffness only: the rest shape is the loaded
shape.

"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.tree import Tree
from tree_sway.errors import TreeError
from tree_sway_lab.frame import element
from tree_sway_lab.frame.self_weight import self_weight


@dataclass(frozen=True, eq=False)
class FrameModel:
    """
    Matrices of the frame; build it with `frame_model`.

    Parameters
    ----------
    tree
        The tree that it models.
    node
        Rest position of each node in [m], (m, 3); node 0 is the root.
    end_node
        Node at the end of each segment, (n,).
    base_node, base_offset
        Node each segment is fixed to, (n,), and its start from there in [m], (n, 3).
    stiffness, mass
        Matrices of the free coordinates, six per node; the root has none if it is clamped, and its
        rotation if it is on a spring.
    load
        Maps forces spread over the segments, 3 n, to the free coordinates.

    """

    tree: Tree
    node: Floats
    end_node: Ints
    base_node: Ints
    base_offset: Floats
    stiffness: sparse.csc_array
    mass: sparse.csc_array
    load: sparse.csc_array

    def frequencies(self, count: int) -> Floats:
        """
        Natural frequencies in [Hz], lowest first, (count,).

        Raises
        ------
        TreeError
            If the tree buckles under its own weight.

        """
        return self.modes(count)[0]

    def modes(self, count: int) -> tuple[Floats, Floats]:
        """
        Natural frequencies in [Hz], (count,), and displacements of the nodes, (count, m, 3).

        Shapes have unit modal mass in [kg].

        Raises
        ------
        TreeError
            If the tree buckles under its own weight.

        """
        factor = self._factor()
        # A fixed start vector keeps Lanczos deterministic.
        start = np.cos(1.0 + np.arange(self.mass.shape[0]))
        operator = linalg.LinearOperator(self.mass.shape, matvec=factor.solve, dtype=np.float64)
        square, vectors = linalg.eigsh(
            self.stiffness, k=count, M=self.mass, sigma=0.0, OPinv=operator, v0=start
        )
        order = np.argsort(square)
        shapes = self._whole(vectors[:, order].T)[..., :3]
        return np.sqrt(square[order]) / (2.0 * np.pi), shapes

    def _whole(self, free: Floats) -> Floats:
        """Displacements and rotations of all nodes, (..., m, 6), from the free coordinates."""
        fixed = np.zeros((*free.shape[:-1], 6 * len(self.node) - free.shape[-1]))
        out: Floats = np.concatenate([fixed, free], axis=-1)
        return out.reshape(*free.shape[:-1], -1, 6)

    def static(self, force: Floats) -> Floats:
        """
        Displacement of the nodes in [m], (m, 3), under a force on each segment in [N], (n, 3).

        The force is spread over the segment in proportion to its diameter, as drag is.

        """
        solution = self._factor().solve(self.load @ np.asarray(force, dtype=np.float64).ravel())
        return self._whole(solution)[:, :3]

    def static_nodal(self, force: Floats) -> Floats:
        """Displacement of the nodes in [m], (m, 3), by a force on each in [N], (m, 3)."""
        load = np.zeros((len(self.node), 6))
        load[:, :3] = np.asarray(force, dtype=np.float64)
        free = load.ravel()[-self.mass.shape[0] :]
        return self._whole(self._factor().solve(free))[:, :3]

    def _factor(self) -> linalg.SuperLU:
        # Without pivoting the pivots' signs are those of the eigenvalues (Sylvester's law of
        # inertia).
        factor = linalg.splu(
            self.stiffness,
            permc_spec='MMD_AT_PLUS_A',
            diag_pivot_thresh=0.0,
            options={'SymmetricMode': True},
        )
        if np.any(factor.U.diagonal() <= 0.0):
            raise TreeError(
                'buckles under its own weight: its stiffness is not positive with gravity',
                where=f"branch '{self._weakest_branch(factor)}' of tree '{self.tree.name}'",
                cure='check modulus, density and diameters, or leave gravity out',
            )
        return factor

    def _weakest_branch(self, factor: linalg.SuperLU) -> str:
        """Name the branch that bends most in the shape it falls over with."""
        shape = np.ones(self.stiffness.shape[0])
        for _ in range(30):
            shape = factor.solve(self.mass @ shape)
            shape /= np.abs(shape).max()
        turned = self._whole(shape)[:, 3:]
        first, last = self.tree.branch_first[:-1], self.tree.branch_first[1:] - 1
        bend = turned[self.end_node[last]] - turned[self.base_node[first]]
        return self.tree.branch_names[int(np.argmax(np.linalg.norm(bend, axis=1)))]


def frame_model(
    tree: Tree,
    modulus: float,
    density: float,
    gravity: float = 0.0,
    subdivisions: int = 2,
    shear_ratio: float = 1.0 / 2.6,
    root_stiffness: float = np.inf,
) -> FrameModel:
    """
    Assemble the frame of a tree.

    Parameters
    ----------
    tree
        The tree.
    modulus, density
        Young's modulus in [Pa] and density in [kg/m^3] of the green wood.
    gravity
        In [m/s^2], downwards; 0 leaves the self-weight out.
    subdivisions
        Elements per segment.
    shear_ratio
        Shear modulus over Young's modulus in [-]: 1/2.6 for an isotropic rod of Poisson ratio 0.3,
        about 1/14 for wood along the grain (Wood Handbook FPL-GTR-282, table 5-1).
    root_stiffness
        Stiffness of the root against tilting in [N m/rad], and 2 G/E times that against twist, as
        the stem itself; infinite if it is clamped.

    """
    n, sub = tree.n_segments, subdivisions
    node, base_node, base_offset = _nodes(tree, sub)
    fraction = np.arange(sub)[None, :] / sub
    taper = (tree.tip_diameter - tree.base_diameter)[:, None]
    width = (tree.base_diameter[:, None] + taper * fraction).ravel()
    step = np.repeat(taper[:, 0] / sub, sub)
    length = np.repeat(tree.length / sub, sub)
    diameter = width[:, None] + step[:, None] * element.POINTS
    end_node = 1 + np.arange(n * sub, dtype=np.int64)
    start_node = end_node - 1
    start_node[::sub] = base_node
    offset = np.zeros((n * sub, 3))
    offset[::sub] = base_offset

    shapes = element.element_shapes(length)
    stiffness = element.elastic_stiffness(shapes, length, diameter, modulus, shear_ratio * modulus)
    mass = element.consistent_mass(shapes, length, diameter, density)
    axes = _element_axes(np.repeat(tree.direction, sub, axis=0))
    at_node = np.zeros((0, 3, 3))
    if gravity != 0.0:
        weight = self_weight(
            start_node, offset, axes[:, 0], length, width, step, density * gravity
        )
        local_force = np.einsum('mij,mgj->mgi', axes, weight.force)
        local_moment = np.einsum('mij,mgj->mgi', axes, weight.moment)
        stiffness = stiffness + element.geometric_stiffness(
            shapes, length, local_force, local_moment
        )
        at_node = weight.offset_stiffness(offset)

    to_nodes = _to_nodes(axes, offset)
    stiffness = to_nodes.transpose(0, 2, 1) @ stiffness @ to_nodes
    mass = to_nodes.transpose(0, 2, 1) @ mass @ to_nodes
    if len(at_node):
        stiffness[:, 3:6, 3:6] += at_node
    width_share = (
        diameter
        / np.repeat(0.5 * (tree.base_diameter + tree.tip_diameter) * tree.length, sub)[:, None]
    )
    load = to_nodes.transpose(0, 2, 1) @ element.load_rows(shapes, length, width_share) @ axes
    columns = np.concatenate([_coordinates(start_node), _coordinates(end_node)], axis=1)
    segment = 3 * np.repeat(np.arange(n), sub)[:, None] + np.arange(3)
    size = 6 * len(node)
    is_clamped = np.isinf(root_stiffness)
    if not is_clamped:
        along = np.outer(tree.direction[0], tree.direction[0])
        spring = root_stiffness * (np.eye(3) + (2.0 * shear_ratio - 1.0) * along)
        stiffness[0, 3:6, 3:6] += spring
    fixed = 6 if is_clamped else 3
    return FrameModel(
        tree=tree,
        node=node,
        end_node=1 + sub * np.arange(n, dtype=np.int64) + sub - 1,
        base_node=base_node,
        base_offset=base_offset,
        stiffness=_assembled(stiffness, columns, columns, (size, size))[fixed:, fixed:].tocsc(),
        mass=_assembled(mass, columns, columns, (size, size))[fixed:, fixed:].tocsc(),
        load=_assembled(load, columns, segment, (size, 3 * n))[fixed:].tocsc(),
    )


def _nodes(tree: Tree, sub: int) -> tuple[Floats, Ints, Floats]:
    """Place the nodes, the root's first, and find the one that each segment is fixed to."""
    n = tree.n_segments
    along = (1 + np.arange(sub))[None, :, None] / sub
    inner = tree.start[:, None] + along * (tree.end - tree.start)[:, None]
    node = np.vstack([tree.start[:1], inner.reshape(-1, 3)])
    base_node = np.zeros(n, dtype=np.int64)
    for segment in range(1, n):
        parent = tree.segment_parent[segment]
        chord = tree.end[parent] - tree.start[parent]
        place = (tree.start[segment] - tree.start[parent]) @ chord / (chord @ chord)
        step = round(sub * float(np.clip(place, 0.0, 1.0)))
        base_node[segment] = base_node[parent] if step == 0 else sub * parent + step
    return node, base_node, tree.start - node[base_node]


def _element_axes(axis: Floats) -> Floats:
    """Local axes as rows, x along the element, (m, 3, 3); round sections let any roll do."""
    aside = np.where(np.abs(axis[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    y = np.cross(aside, axis)
    y /= np.linalg.norm(y, axis=1)[:, None]
    return np.stack([axis, y, np.cross(axis, y)], axis=1)


def _to_nodes(axes: Floats, offset: Floats) -> Floats:
    """Local coordinates of the elements by global ones of their nodes, (m, 12, 12)."""
    out = np.zeros((len(axes), 12, 12))
    for block in range(0, 12, 3):
        out[:, block : block + 3, block : block + 3] = axes
    # u_start = u_node + theta x offset = u_node - offset x theta
    cross = np.cross(np.eye(3)[None], offset[:, None, :]).transpose(0, 2, 1)
    out[:, 0:3, 3:6] = axes @ cross
    return out


def _coordinates(node: Ints) -> Ints:
    return 6 * node[:, None] + np.arange(6)


def _assembled(
    blocks: Floats, rows: Ints, columns: Ints, shape: tuple[int, int]
) -> sparse.csr_array:
    row = np.broadcast_to(rows[:, :, None], blocks.shape).ravel()
    column = np.broadcast_to(columns[:, None, :], blocks.shape).ravel()
    return sparse.coo_array((blocks.ravel(), (row, column)), shape=shape).tocsr()
