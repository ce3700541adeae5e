# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The reduced tree: mass, stiffness and load levers of the key rotations of all branches.

A child moves with its parent: a unit of a parent's coordinate moves the subtree of the child as
one rigid body, by a twist (v, w) about the root of the tree. With H_j, the momentum (linear,
angular) of a unit rate of coordinate j with its subtree, the entries for an ancestor's coordinate
i are

    M_ij = (v, w)_i . H_j          mass
    Kg_ij = g e_z . (w_i x p_j)     gravity, p_j the linear part of H_j

and depth-first order makes the j of one i a contiguous slice. Elastic stiffness couples only the
shapes of one branch, and those are made orthogonal, so it is diagonal. Gravity acts about the rest
shape, which is the loaded one, and only its geometric stiffness enters.

Symbols: N coordinates, in the order of branches, shapes, axes; T the twists of the parent's
coordinates on each child. SI units.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.branch.beam import cross, cross_matrix, energies
from tree_sway.core.branch.model import BranchModel
from tree_sway.core.branch.shapes import MAX_COORDINATES
from tree_sway.core.tree.tree import Tree


@dataclass(frozen=True)
class Reduction:
    """
    Matrices of the key rotations.

    Parameters
    ----------
    first
        First coordinate of each branch, and N at the end, (b + 1,).
    twist
        Motion (v, w) of each branch's base per unit of its parent's coordinates, about the root,
        (b, 9, 6).
    compliance
        Inverse of ``branchwise``, the block of its branch in each row, (N, 9) in [rad/(N m)].
    mass, gravity
        Symmetric sparse matrices (N, N) in [kg m^2] and [N m/rad].
    elastic
        Stiffness of bending and twist, symmetric sparse (N, N) in [N m/rad]; it couples the
        coordinates of one branch.
    branchwise
        Stiffness of the isolated branches, symmetric sparse (N, N).

    """

    first: Ints
    twist: Floats
    compliance: Floats
    mass: Any
    gravity: Any
    elastic: Any
    branchwise: Any

    @property
    def n_coordinates(self) -> int:
        """Number of coordinates, N."""
        return int(self.first[-1])

    @property
    def stiffness(self) -> Any:
        """Elastic and geometric stiffness, sparse (N, N), in [N m/rad]."""
        return (self.elastic + self.gravity).tocsc()

    @cached_property
    def factors(self) -> Factors:
        """Factors of the stiffness, found once."""
        return Factors(self.stiffness)


class Factors:
    """
    Factors of a sparse symmetric matrix of coordinates, parents before children.

    Eliminated from the twigs to the stem, they have no more entries than the matrix itself.
    """

    def __init__(self, matrix: Any) -> None:
        """Factorise; a singular matrix raises `RuntimeError`."""
        from scipy.sparse.linalg import splu

        self._factors = splu(
            matrix.tocsc()[::-1, ::-1], permc_spec='NATURAL', diag_pivot_thresh=0.0,
            options={'SymmetricMode': True},
        )  # fmt: skip

    @property
    def is_positive(self) -> bool:
        """Whether the matrix is positive definite: as many pivots are (Sylvester's law)."""
        return bool((self._factors.U.diagonal() > 0.0).all())

    def solve(self, right: Floats) -> Floats:
        """Solve for one right side, (N,)."""
        return np.asarray(self._factors.solve(right[::-1])[::-1])


def reduce_tree(
    tree: Tree, models: list[BranchModel], modulus: float, shear_modulus: float, gravity: float,
    *, subtrees: bool = True,
) -> Reduction:  # fmt: skip
    """
    Assemble the matrices of the key rotations.

    Parameters
    ----------
    tree
        Tree to be reduced.
    models
        Models of its branches.
    modulus, shear_modulus
        E and G of the wood in [Pa].
    gravity
        Gravity in [m/s^2]; 0 leaves weight out.
    subtrees Whether children move with their parents and load them; if not, every branch is
    isolated.

    Returns
    -------
    Reduction
        Mass, gravity and stiffness.

    """
    n_branches = tree.n_branches
    first = np.concatenate([[0], np.cumsum([len(m.fields) for m in models])]).astype(np.int64)
    momentum = np.zeros((first[-1], 6))
    twist = np.zeros((n_branches, MAX_COORDINATES, 6))
    body = np.zeros((n_branches, 6, 6))
    compliance = np.zeros((first[-1], MAX_COORDINATES))
    mass, weight, elastic, apart = _Blocks(), _Blocks(), _Blocks(), _Blocks()
    for branch in range(n_branches - 1, -1, -1):
        model = models[branch]
        own = slice(int(first[branch]), int(first[branch + 1]))
        fields, twists = _motions(model)
        dm = model.mass * model.beam.weight
        moved = dm[..., None] * fields
        own_mass = moved.reshape(len(fields), -1) @ fields.reshape(len(fields), -1).T
        momentum[own, :3] = moved.sum(axis=(1, 2))
        lever = model.beam.point.reshape(-1, 3).T @ moved.reshape(len(fields), -1, 3)
        momentum[own, 3:] = (lever - lever.transpose(0, 2, 1))[:, [1, 2, 0], [2, 0, 1]]
        own_weight = gravity * _own_geometric(model, body[model.children])
        for number, child in enumerate(model.children):
            base_twists = twists[:, number]
            twist[child, : len(base_twists)] = base_twists
            if not subtrees:
                continue
            carried = base_twists @ body[child]
            own_mass += carried @ base_twists.T
            momentum[own] += carried
            below = slice(int(first[child]), int(first[tree.subtree_end[child]]))
            mass.add(own, below, base_twists @ momentum[below].T)
            lift = momentum[below]
            tilt = np.outer(base_twists[:, 3], lift[:, 1]) - np.outer(
                base_twists[:, 4], lift[:, 0]
            )
            weight.add(own, below, gravity * tilt)
        mass.add(own, own, own_mass)
        weight.add(own, own, own_weight)
        bent = energies(model.fields, modulus, shear_modulus)
        elastic.add(own, own, bent)
        apart.add(own, own, bent + own_weight)
        compliance[own, : len(fields)] = np.linalg.inv(bent + own_weight)
        if subtrees:
            body[branch] = _spatial_inertia(model) + body[model.children].sum(axis=0)
    shape = (int(first[-1]), int(first[-1]))
    matrices = (each.symmetric(shape) for each in (mass, weight, elastic, apart))
    return Reduction(first, twist, compliance, *matrices)


class _Blocks:
    """Dense blocks of a sparse symmetric matrix, each above or on the diagonal."""

    def __init__(self) -> None:
        self.rows: list[Ints] = []
        self.columns: list[Ints] = []
        self.values: list[Floats] = []

    def add(self, rows: slice, columns: slice, values: Floats) -> None:
        height, width = values.shape
        r = np.arange(rows.start, rows.stop).repeat(width)
        c = np.arange(columns.start, columns.stop)[None].repeat(height, axis=0).ravel()
        self.rows.append(r)
        self.columns.append(c)
        self.values.append(values.ravel())
        if rows != columns:
            self.rows.append(c)
            self.columns.append(r)
            self.values.append(values.ravel())

    def symmetric(self, shape: tuple[int, int]) -> Any:
        from scipy import sparse  # it takes long to load, and a stored set-up does not need it

        entries = np.concatenate(self.values)
        where = np.concatenate(self.rows), np.concatenate(self.columns)
        return sparse.coo_matrix((entries, where), shape=shape).tocsc()


def _motions(model: BranchModel) -> tuple[Floats, Floats]:
    """Displacement at points (k, p, 5, 3) and twist on children (k, c, 6) of each coordinate."""
    places = model.beam.child_point
    twists = [
        np.hstack([one.children - cross(one.child_slope, places), one.child_slope])
        for one in model.fields
    ]
    return np.stack([one.points for one in model.fields]), np.stack(twists)


def _spatial_inertia(model: BranchModel) -> Floats:
    """Inertia (6, 6) of a branch as a rigid body about the root: momentum of a twist (v, w)."""
    point = model.beam.point
    dm = model.mass * model.beam.weight
    mass = dm.sum()
    cross = cross_matrix(np.einsum('sg,sgk->k', dm, point))
    second = np.einsum('sg,sgi,sgj->ij', dm, point, point)
    inertia = np.zeros((6, 6))
    inertia[:3, :3] = mass * np.eye(3)
    inertia[:3, 3:] = -cross
    inertia[3:, :3] = cross
    inertia[3:, 3:] = np.trace(second) * np.eye(3) - second
    return inertia


def _own_geometric(model: BranchModel, bodies: Floats) -> Floats:
    """
    Return the second-order lift of a branch and its subtrees per unit of gravity, (k, k).

    Every piece ds rotates the mass beyond it: with m that mass, the entry is the integral of psi_i
    psi_j m(s) e_z . (rho_i x (rho_j x t)) ds, made symmetric, and the first moment of each child's
    subtree about its base takes the place of m t for the child.

    Rotations about different axes do not add up: bending followed by twist adds half of their
    cross product, and the weight, whose moment the branch bears at rest, does work on that (as in
    lateral buckling of beams: Timoshenko & Gere, 1961).
    """
    beam = model.beam
    own, nodes, _ = beam.from_base(model.mass)
    beyond = nodes[-1] - own
    masses = bodies[:, 0, 0]
    if len(masses):
        beyond = beyond + beam.child_lever[1] @ masses
    slopes = [one.slope for one in model.fields]
    child_slopes = [one.child_slope for one in model.fields]
    lever = beam.weight[..., None] * beyond[..., None] * beam.tangent[:, None, :]
    moment = np.stack([bodies[:, 5, 1], bodies[:, 3, 2], bodies[:, 4, 0]], axis=-1)
    hanging = moment - masses[:, None] * beam.child_point
    arms = np.vstack([lever.reshape(-1, 3), hanging])
    turns = np.stack(
        [np.vstack([a.reshape(-1, 3), c]) for a, c in zip(slopes, child_slopes, strict=True)]
    )
    once = turns[..., 2] @ (turns * arms).sum(axis=-1).T
    n = len(turns)
    both = (turns * arms[:, 2:]).reshape(n, -1) @ turns.reshape(n, -1).T
    outer = beam.from_base(lever / beam.weight[..., None])
    hung = outer[1][-1] - outer[0] + beam.child_lever[1] @ hanging
    borne = beam.weight[..., None] * np.stack(
        [hung[..., 1], -hung[..., 0], np.zeros_like(beam.weight)], axis=-1
    )
    curvatures = np.stack([one.curvature for one in model.fields]).reshape(n, -1)
    about = np.stack([cross(borne, slope) for slope in slopes]).reshape(n, -1)
    unlike = about @ curvatures.T
    return np.asarray(0.5 * (once + once.T + unlike + unlike.T) - both)
