# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Linear modes of the articulated tree: mass and stiffness of its joints at rest.

Both matrices couple a joint with those that carry it and those that it carries only, so they are
sparse.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from tree_sway.core.arrays import Floats, Ints
from tree_sway.errors import TreeError
from tree_sway_lab.segments.articulated_bodies import Bodies


class JointModes(NamedTuple):
    """
    Modes of unit modal mass, lowest first, (k,) in [Hz].

    Rotations of the joints are in [rad], (k, n, 3); momenta are the mass matrix times these.
    """

    frequency: Floats
    turn: Floats
    momentum: Floats


def joint_modes(bodies: Bodies, gravity: float, count: int) -> JointModes:
    """Lowest modes about rest; a `TreeError` if the tree buckles under its own weight."""
    mass, stiffness = joint_mass(bodies), joint_stiffness(bodies, gravity)
    factor = linalg.splu(
        stiffness,
        permc_spec='MMD_AT_PLUS_A',
        diag_pivot_thresh=0.0,
        options={'SymmetricMode': True},
    )
    if np.any(factor.U.diagonal() <= 0.0):
        raise TreeError(
            'buckles under its own weight: its stiffness is not positive with gravity',
            cure='check modulus, density and diameters, or leave gravity out',
        )
    size = mass.shape[0]
    solve = linalg.LinearOperator(mass.shape, matvec=factor.solve, dtype=np.float64)
    inverse_square, vectors = linalg.eigsh(
        mass, k=min(count, size - 1), M=stiffness, Minv=solve, v0=np.cos(1.0 + np.arange(size))
    )
    order = np.argsort(-inverse_square)
    # Lanczos gives unit stiffness; unit mass is asked for.
    circular = 1.0 / np.sqrt(inverse_square[order])
    turn = vectors[:, order].T * circular[:, None]
    momentum = np.ascontiguousarray((mass @ turn.T).T)  # laid out as the turns, as kernels expect
    shape = (len(circular), -1, 3)
    return JointModes(circular / (2.0 * np.pi), turn.reshape(shape), momentum.reshape(shape))


def joint_mass(bodies: Bodies) -> Any:
    """
    Mass matrix of the joints' rotations at rest in [kg m^2], sparse (3 n, 3 n).

    Composite rigid bodies (Featherstone 2008, table 6.2).
    """
    _, lever, tensor = _composite(bodies)
    own = [np.array(t) for t in tensor]
    pairs = []
    for i in range(len(bodies.mass)):
        # Momentum of the composite of i for a unit rate of joint i: linear, and angular about k.
        linear, angular = -_cross_matrix(lever[i]), tensor[i]
        k = i
        while bodies.carrier[k] >= 0:
            angular = angular + _cross_matrix(bodies.arm[k]) @ linear
            k = int(bodies.carrier[k])
            pairs.append((k, i, angular))
    return _symmetric(own, pairs)


def joint_stiffness(bodies: Bodies, gravity: float) -> Any:
    """
    Stiffness matrix of the joints' rotations at rest in [N m/rad], sparse (3 n, 3 n).

    Gravity's part is the second variation of the height of the masses, each joint turned in the
    axes its carrier has turned already, with the springs' share in holding the rest shape.
    """
    twist = np.einsum('ni,nj->nij', bodies.axis, bodies.axis)
    springs = (
        bodies.bend[:, None, None] * (np.eye(3) - twist) + bodies.twist[:, None, None] * twist
    )
    own, pairs = list(springs), []
    if gravity != 0.0:
        _, lever, _ = _composite(bodies)
        weight = np.array([0.0, 0.0, -gravity])
        for i, arm in enumerate(lever):
            # Potential -W . (a x (b x r)) of a joint a below and a joint b; half of it for one
            # alone.
            second = np.dot(weight, arm) * np.eye(3) - np.outer(arm, weight)
            own[i] = own[i] + 0.5 * (second + second.T)
            k = int(bodies.carrier[i])
            while k >= 0:
                pairs.append((k, i, second))
                k = int(bodies.carrier[k])
    return _symmetric(own, pairs)


def end_displacements(bodies: Bodies, turn: Floats) -> Floats:
    """Displacement of the end nodes by small rotations of the joints (k, n, 3), (k, n, 3)."""
    out, total, place = np.zeros_like(turn), np.zeros_like(turn), np.zeros_like(turn)
    for i, carrier in enumerate(bodies.carrier):
        total[:, i] = turn[:, i]
        if carrier >= 0:
            total[:, i] += total[:, carrier]
            place[:, i] = place[:, carrier] + np.cross(total[:, carrier], bodies.arm[i])
        out[:, i] = place[:, i] + np.cross(total[:, i], bodies.reach[i, 1] * bodies.axis[i])
    return out


def _composite(bodies: Bodies) -> tuple[Floats, Floats, Floats]:
    """Mass, first moment and inertia about its joint of all that each joint carries."""
    mass = bodies.mass.copy()
    lever = mass[:, None] * bodies.centre
    tensor = bodies.inertia + _point_inertia(mass, bodies.centre)
    for i in range(len(mass) - 1, 0, -1):
        k = bodies.carrier[i]
        if k < 0:
            continue
        d = bodies.arm[i]
        both = np.outer(d, lever[i])
        mass[k] += mass[i]
        tensor[k] += tensor[i] + _point_inertia(mass[i : i + 1], d[None])[0]
        tensor[k] += 2.0 * np.trace(both) * np.eye(3) - both - both.T
        lever[k] += lever[i] + mass[i] * d
    return mass, lever, tensor


def _point_inertia(mass: Floats, place: Floats) -> Floats:
    square = np.einsum('ni,ni->n', place, place)[:, None, None] * np.eye(3)
    out: Floats = mass[:, None, None] * (square - np.einsum('ni,nj->nij', place, place))
    return out


def _cross_matrix(v: Floats) -> Floats:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def _symmetric(own: list[Floats], pairs: list[tuple[int, int, Floats]]) -> Any:
    """Sparse matrix of blocks on the diagonal and of blocks above it, mirrored below."""
    n = len(own)
    row: Ints = np.array([*range(n), *(p[0] for p in pairs), *(p[1] for p in pairs)])
    column: Ints = np.array([*range(n), *(p[1] for p in pairs), *(p[0] for p in pairs)])
    values = np.array([*own, *(p[2] for p in pairs), *(p[2].T for p in pairs)])
    rows = np.broadcast_to(3 * row[:, None, None] + np.arange(3)[:, None], values.shape)
    columns = np.broadcast_to(3 * column[:, None, None] + np.arange(3), values.shape)
    entries = values.ravel(), (rows.ravel(), columns.ravel())
    return sparse.coo_array(entries, shape=(3 * n, 3 * n)).tocsc()
