# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The reduced tree: mass, stiffness and load levers of the key rotations of all branches.

Coordinates are the key rotations of all branches here, before `modes` reduces them to a few. A
child moves with its parent: a unit of a parent's coordinate moves the subtree of the child as one
rigid body, by a twist (v, w) about the root of the tree. With H_j, the momentum (linear, angular)
of a unit rate of coordinate j with its subtree, the entries for an ancestor's coordinate i are

    M_ij = (v, w)_i . H_j          mass
    Kg_ij = g e_z . (w_i x p_j)     gravity, p_j the linear part of H_j

and depth-first order makes the j of one i a contiguous slice. Elastic stiffness couples only the
shapes of one branch, and those are made orthogonal, so it is diagonal. Gravity acts about the rest
shape, which is the loaded one, and only its geometric stiffness enters.

Symbols: N coordinates, in the order of branches, shapes, axes; T the twists of the parent's
coordinates on each child. SI units.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.model import MAX_COORDINATES
from tree_sway.core.rotation import cross
from tree_sway.core.setup.beams.beam import energies, many_of, products
from tree_sway.core.setup.beams.branch_model import BranchModel
from tree_sway.core.tree import Tree


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
        """Solve for one right side, (N,), or some, (N, k)."""
        return np.asarray(self._factors.solve(right[::-1])[::-1])


def reduce_tree(
    tree: Tree,
    models: list[BranchModel],
    modulus: float,
    shear_modulus: float,
    gravity: float,
    *,
    subtrees: bool = True,
) -> Reduction:
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
    subtrees
        Whether children move with their parents and load them; if not, every branch is isolated.

    Returns
    -------
    Reduction
        Mass, gravity and stiffness.

    """
    assembly = _Assembly(tree, models, gravity)
    for branches, model in _together(models):
        assembly.add(branches, model, modulus, shear_modulus, moves_subtrees=subtrees)
    return assembly.reduction()


class _Assembly:
    """
    Sums over the branches of a tree, children before their parents.

    Row `own` of the matrices are the coordinates of a branch, `below` those of its subtrees.
    """

    def __init__(self, tree: Tree, models: list[BranchModel], gravity: float) -> None:
        self.tree = tree
        self.gravity = gravity
        counts = [len(model.fields) for model in models]
        self.first = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
        size = int(self.first[-1])
        self.momentum = np.zeros((size, 6))
        """Momentum H of each branch with its subtrees per unit rate of each coordinate."""
        self.twist = np.zeros((tree.n_branches, MAX_COORDINATES, 6))
        self.inertia = np.zeros((tree.n_branches, 6, 6))
        """Inertia of each branch with its subtrees as a rigid body about the root."""
        self.compliance = np.zeros((size, MAX_COORDINATES))
        self.mass = _Blocks()
        self.weight = _Blocks()
        self.elastic = _Blocks()
        self.branchwise = _Blocks()

    def add(
        self,
        branches: int | Ints,
        model: BranchModel,
        modulus: float,
        shear_modulus: float,
        *,
        moves_subtrees: bool,
    ) -> None:
        """Add a branch, or several twigs that are alike."""
        count = len(model.fields)
        own = self.first[branches][..., None] + np.arange(count)
        own_mass, self.momentum[own] = _own_inertia(model)
        bodies = self.inertia[model.children]
        if len(model.children):
            base_twists = _base_twists(model)
            self.twist[model.children, :count] = base_twists
            if moves_subtrees:
                carried = base_twists @ bodies
                own_mass += (carried @ base_twists.swapaxes(-1, -2)).sum(axis=0)
                self.momentum[own] += carried.sum(axis=0)
                self._couple(own, model.children, base_twists)
        own_weight = self.gravity * _own_geometric(model, bodies)
        bending = energies(model.fields, modulus, shear_modulus)
        alone = bending + own_weight
        self.mass.add(own, own, own_mass)
        self.weight.add(own, own, own_weight)
        self.elastic.add(own, own, bending)
        self.branchwise.add(own, own, alone)
        self.compliance[own, :count] = np.linalg.inv(alone)
        if moves_subtrees:
            self.inertia[branches] = _spatial_inertia(model) + bodies.sum(axis=0)

    def _couple(self, own: Ints, children: Ints, base_twists: Floats) -> None:
        """Couple a branch with all coordinates of its subtrees, M_ij and Kg_ij of the module."""
        begins = self.first[children]
        ends = self.first[self.tree.subtree_end[children]]
        below = np.arange(begins[0], ends[-1])
        twists = base_twists.repeat(ends - begins, axis=0)
        momentum = self.momentum[below]
        self.mass.add(own, below, (twists @ momentum[..., None])[..., 0].T)
        # e_z . (w x p)
        rotation = twists[:, :, 3:]
        lift = rotation[:, :, 0] * momentum[:, 1:2] - rotation[:, :, 1] * momentum[:, :1]
        self.weight.add(own, below, self.gravity * lift.T)

    def reduction(self) -> Reduction:
        """Return the matrices."""
        size = int(self.first[-1])
        return Reduction(
            first=self.first,
            twist=self.twist,
            compliance=self.compliance,
            mass=self.mass.symmetric(size),
            gravity=self.weight.symmetric(size),
            elastic=self.elastic.symmetric(size),
            branchwise=self.branchwise.symmetric(size),
        )


class _Blocks:
    """Dense blocks of a sparse symmetric matrix, each above or on the diagonal."""

    def __init__(self) -> None:
        self.rows: list[Ints] = []
        self.columns: list[Ints] = []
        self.values: list[Floats] = []

    def add(self, rows: Ints, columns: Ints, values: Floats) -> None:
        """Add blocks (..., k, c) at rows (..., k) and columns (..., c), and their transposes."""
        own_rows = np.broadcast_to(rows[..., None], values.shape).ravel()
        own_columns = np.broadcast_to(columns[..., None, :], values.shape).ravel()
        self._add(own_rows, own_columns, values)
        if rows is not columns:
            self._add(own_columns, own_rows, values)

    def _add(self, rows: Ints, columns: Ints, values: Floats) -> None:
        self.rows.append(rows)
        self.columns.append(columns)
        self.values.append(values.ravel())

    def symmetric(self, size: int) -> Any:
        """Return the matrix, (size, size)."""
        from scipy import sparse  # it takes long to load, and a stored set-up does not need it

        entries = np.concatenate(self.values)
        where = np.concatenate(self.rows), np.concatenate(self.columns)
        return sparse.coo_matrix((entries, where), shape=(size, size)).tocsc()


def _together(models: list[BranchModel]) -> Iterator[tuple[int | Ints, BranchModel]]:
    """Yield branches and their models, children first: twigs that are alike as one model."""
    twigs: dict[tuple[int, int], list[int]] = {}
    for branch, model in enumerate(models):
        if not len(model.children):
            shape = len(model.beam.length), len(model.fields)
            twigs.setdefault(shape, []).append(branch)
    for alike in twigs.values():
        yield np.array(alike), _as_one([models[branch] for branch in alike])
    for branch in reversed(range(len(models))):
        if len(models[branch].children):
            yield branch, models[branch]


def _as_one(twigs: list[BranchModel]) -> BranchModel:
    """Return twigs whose arrays have the same shapes as one model of many."""
    beam = many_of([twig.beam for twig in twigs])
    by_coordinate = zip(*(twig.fields for twig in twigs), strict=True)
    fields = tuple(many_of(each, beam=beam) for each in by_coordinate)
    mass = np.array([twig.mass for twig in twigs])
    return replace(twigs[0], beam=beam, mass=mass, fields=fields)


def _base_twists(model: BranchModel) -> Floats:
    """Twist on each child of each coordinate, (c, k, 6)."""
    places = model.beam.child_point
    parts = [
        np.concatenate([one.children - cross(one.child_slope, places), one.child_slope], axis=-1)
        for one in model.fields
    ]
    return np.stack(parts, axis=-2)


def _own_inertia(model: BranchModel) -> tuple[Floats, Floats]:
    """Mass matrix (k, k) of a branch without its subtrees, and its momentum about the root."""
    displacement = np.stack([field.points for field in model.fields], axis=-4)
    rotation = np.stack([field.slope for field in model.fields], axis=-4)
    momentum = _mass_of(model)[..., None] * displacement
    spin = _spins(model, rotation)
    own_mass = products(momentum, displacement, 3) + products(spin, rotation, 3)
    angular = cross(model.beam.point[..., None, :, :, :], momentum) + spin
    of_points = np.concatenate([momentum, angular], axis=-1)
    return own_mass, of_points.sum(axis=(-3, -2))


def _mass_of(model: BranchModel) -> Floats:
    """Mass of each point of quadrature in [kg], (..., 1, p, 5) for arrays of several fields."""
    return np.asarray((model.mass * model.beam.weight)[..., None, :, :])


def _spins(model: BranchModel, slopes: Floats) -> Floats:
    """Spin of cross-sections that rotate by slopes, (..., k, p, 5, 3) both (Rayleigh, 1877)."""
    beam = model.beam
    about_diameter = beam.second_moment / beam.area * model.mass * beam.weight
    tangent = beam.tangent[..., None, :, None, :]
    twist = (slopes * tangent).sum(-1, keepdims=True) * tangent
    # About the axis of the branch a section has twice the inertia.
    return np.asarray(about_diameter[..., None, :, :, None] * (slopes + twist))


def _spatial_inertia(model: BranchModel) -> Floats:
    """Inertia (6, 6) of a branch as a rigid body about the root: momentum of a twist (v, w)."""
    axes = np.eye(3)[:, None, None]
    by_rotation = cross(axes, model.beam.point[..., None, :, :, :])
    by_translation = np.broadcast_to(axes, by_rotation.shape)
    velocity = np.concatenate([by_translation, by_rotation], axis=-4)
    inertia = products(_mass_of(model)[..., None] * velocity, velocity, 3)
    inertia[..., 3:, 3:] += products(_spins(model, by_translation), by_translation, 3)
    return inertia


def _own_geometric(model: BranchModel, bodies: Floats) -> Floats:
    """
    Return the second-order lift of a branch and its subtrees per unit of gravity, (k, k).

    Every piece ds rotates the mass beyond it: with m that mass, the entry is the integral of rho_i
    and rho_j, m(s) e_z . (rho_i x (rho_j x t)) ds, made symmetric, and the first moment of each
    child's subtree about its base takes the place of m t for the child.

    Rotations about different axes do not add up: bending followed by twist adds half of their
    cross product, and the weight, whose moment the branch bears at rest, does work on that (as in
    lateral buckling of beams: Timoshenko & Gere, 1961).
    """
    beam = model.beam
    masses, hanging = _hanging(bodies, beam.child_point)
    mass_beyond, moment_beyond = _mass_beyond(model, masses, hanging)
    along, vertical = _lift(model, mass_beyond, hanging)
    along += _work_of_weight(model, moment_beyond)
    return np.asarray(0.5 * (along + along.swapaxes(-1, -2)) - vertical)


def _lift(model: BranchModel, mass_beyond: Floats, hanging: Floats) -> tuple[Floats, Floats]:
    """
    Sum e_z . (rho_i x (rho_j x a)) over all arms a, of points and of children.

    It is rho_iz (rho_j . a) - a_z (rho_i . rho_j): both terms are returned, (k, k) each.
    """
    beam = model.beam
    flat = (*beam.chord.shape[:-1], -1, 3)
    of_points = mass_beyond[..., None] * beam.tangent[..., None, :] * beam.weight[..., None]
    arms = np.concatenate([of_points.reshape(flat), hanging], axis=-2)[..., None, :, :]
    turns = np.stack(
        [
            np.concatenate([field.slope.reshape(flat), field.child_slope], axis=-2)
            for field in model.fields
        ],
        axis=-3,
    )
    along = turns[..., 2] @ (turns * arms).sum(axis=-1).swapaxes(-1, -2)
    vertical = products(turns * arms[..., 2:], turns, 2)
    return along, vertical


def _work_of_weight(model: BranchModel, moment_beyond: Floats) -> Floats:
    """Sum the work of the moment at rest, e_z x the moment of mass, on rho x d rho, (k, k)."""
    east = moment_beyond[..., 0]
    north = moment_beyond[..., 1]
    borne = np.stack([north, -east, np.zeros_like(east)], axis=-1)
    borne *= model.beam.weight[..., None]
    about = np.stack([cross(borne, field.slope) for field in model.fields], axis=-4)
    curvatures = np.stack([field.curvature for field in model.fields], axis=-4)
    return np.asarray(products(about, curvatures, 3))


def _hanging(bodies: Floats, places: Floats) -> tuple[Floats, Floats]:
    """Mass of each child's subtree, (c,), and its first moment about its base, (c, 3)."""
    masses = bodies[:, 0, 0]
    about_root = np.stack([bodies[:, 5, 1], bodies[:, 3, 2], bodies[:, 4, 0]], axis=-1)
    return masses, about_root - masses[:, None] * places


def _mass_beyond(model: BranchModel, masses: Floats, hanging: Floats) -> tuple[Floats, Floats]:
    """Mass beyond each point, (p, 5), and its first moment about that point, (p, 5, 3)."""
    beam = model.beam
    before, at_nodes, _ = beam.from_base(model.mass)
    mass = at_nodes[..., -1:, None] - before
    if len(masses):
        mass = mass + beam.child_lever[1] @ masses
    before, at_nodes, _ = beam.from_base(mass[..., None] * beam.tangent[..., None, :])
    moment = at_nodes[..., -1:, None, :] - before
    if len(masses):
        moment += beam.child_lever[1] @ hanging
    return mass, moment
