"""
Linear modes of the articulated tree: mass and stiffness of its joints at rest.

The mass is the sum of J^T I J over the bodies, the stiffness the springs' and gravity's second variation;
both are dense in the joints and meant for trees of up to some thousand segments.

"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from tree_sway_ros.core.reference.articulated_bodies import Bodies
from tree_sway_ros.errors import TreeError

Floats = NDArray[np.float64]


def joint_mass(bodies: Bodies) -> Floats:
    """
    Mass matrix of the joints' rotations at rest in [kg m^2], (3 n, 3 n).

    Composite rigid bodies (Featherstone 2008, table 6.2).

    """
    n = len(bodies.mass)
    mass, lever, tensor = _composite(bodies)
    out = np.zeros((n, 3, n, 3))
    for i in range(n):
        # Momentum of the composite of i for a unit rate of joint i: linear (rows), angular about i.
        linear, angular = -_cross_matrix(lever[i]), tensor[i].copy()
        out[i, :, i, :] = angular
        k = i
        while bodies.carrier[k] >= 0:
            angular = angular + _cross_matrix(bodies.arm[k]) @ linear
            k = bodies.carrier[k]
            out[k, :, i, :] = angular
            out[i, :, k, :] = angular.T
    return out.reshape(3 * n, 3 * n)


def joint_stiffness(bodies: Bodies, gravity: float) -> Floats:
    """
    Stiffness matrix of the joints' rotations at rest in [N m/rad], (3 n, 3 n).

    Gravity's part is the second variation of the height of the masses, with the torque that the springs
    hold at rest: each joint turned in the axes its carrier has turned already.

    """
    n = len(bodies.mass)
    out = np.zeros((n, 3, n, 3))
    twist = np.einsum("ni,nj->nij", bodies.axis, bodies.axis)
    own = bodies.bend[:, None, None] * (np.eye(3) - twist) + bodies.twist[:, None, None] * twist
    out[np.arange(n), :, np.arange(n), :] = own
    if gravity == 0.0:
        return out.reshape(3 * n, 3 * n)
    _, lever, _ = _composite(bodies)
    weight = np.array([0.0, 0.0, -gravity])
    for i in range(n):
        # Potential -W . (a x (b x r)) for an outer joint a and an inner joint b; half of it for itself.
        r = lever[i]
        second = np.dot(weight, r) * np.eye(3) - np.outer(r, weight)
        out[i, :, i, :] += 0.5 * (second + second.T)
        k = bodies.carrier[i]
        while k >= 0:
            out[k, :, i, :] += second
            out[i, :, k, :] += second.T
            k = bodies.carrier[k]
    return out.reshape(3 * n, 3 * n)


def joint_modes(
    bodies: Bodies, mass: Floats, stiffness: Floats, count: int, *, twist: bool
) -> tuple[Floats, Floats]:
    """
    Frequencies in [Hz], (count,), and displacements of the end nodes for unit modal mass.

    Raises
    ------
    TreeError
        If the stiffness is not positive: the tree buckles under its own weight.

    """
    basis = _joint_axes(bodies.axis, twist)
    M, K = basis.T @ mass @ basis, basis.T @ stiffness @ basis
    square, vectors = linalg.eigh(K, M, subset_by_index=(0, count - 1))
    if square[0] <= 0.0:
        raise TreeError(
            "buckles under its own weight: its stiffness is not positive with gravity",
            cure="check modulus, density and diameters, or leave gravity out",
        )
    turn = (basis @ vectors).T.reshape(count, -1, 3)
    shapes = np.zeros_like(turn)
    total, place = np.zeros_like(turn), np.zeros_like(turn)
    for i, carrier in enumerate(bodies.carrier):
        held = carrier >= 0
        total[:, i] = turn[:, i] + (total[:, carrier] if held else 0.0)
        if held:
            place[:, i] = place[:, carrier] + np.cross(total[:, carrier], bodies.arm[i])
        half = bodies.reach[i, 1] * bodies.axis[i]
        shapes[:, i] = place[:, i] + np.cross(total[:, i], half)
    return np.sqrt(square) / (2.0 * np.pi), shapes


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
    square = np.einsum("ni,ni->n", place, place)[:, None, None] * np.eye(3)
    return mass[:, None, None] * (square - np.einsum("ni,nj->nij", place, place))


def _cross_matrix(v: Floats) -> Floats:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def _joint_axes(axis: Floats, twist: bool) -> Floats:
    """Columns that span the joints' rotations, with or without twist, (3 n, 2 n or 3 n)."""
    n = len(axis)
    if twist:
        return np.eye(3 * n)
    aside = np.where(np.abs(axis[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    first = np.cross(aside, axis)
    first /= np.linalg.norm(first, axis=1)[:, None]
    both = np.stack([first, np.cross(axis, first)], axis=2)
    out = np.zeros((n, 3, n, 2))
    out[np.arange(n), :, np.arange(n), :] = both
    return out.reshape(3 * n, 2 * n)
