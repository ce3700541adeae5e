# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Rigid bodies and springs that represent a tree: hinges inside the segments.

Rigid finite elements (Wittbrodt, Adamiec-Wojcik & Wojciech 2006, chapter 2): the bending of a
segment is gathered in one ball joint of stiffness ``1 / integral(ds / EI)`` at the centroid of
``ds / EI``, which is the middle where it does not taper, and body i is what lies between the
joints: the tip's part of segment i and the root's parts of all that sit on it. The tangent at a
fork then is the same for all who meet there, and frequencies converge with the square of the
length of the segments; joints at the nodes would be a power slower wherever a branch forks.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.tree import Tree


class Bodies(NamedTuple):
    """
    Arrays over the bodies, one per segment, in rest axes, which are the world's.

    Parameters
    ----------
    carrier
        Body that the root's part of each segment is part of; -1 is the ground, (n,).
    arm
        From the joint of the carrier, or the world's origin, to this joint in [m], (n, 3).
    axis
        Unit vector along the segment, (n, 3).
    reach
        From the start to the joint and from the joint to the end in [m], (n, 2).
    mass, centre, inertia
        Mass in [kg], centre of mass from the joint in [m] and inertia about it in [kg m^2].
    bend, twist
        Stiffness of the joint across and about the axis in [N m/rad], (n,).
    rest_torque
        What the spring of the joint bears at rest in [N m], (n, 3).
    area
        Length times mean diameter of the root's and the tip's part in [m^2], (n, 2).

    """

    carrier: Ints
    arm: Floats
    axis: Floats
    reach: Floats
    mass: Floats
    centre: Floats
    inertia: Floats
    bend: Floats
    twist: Floats
    rest_torque: Floats
    area: Floats


def articulated_bodies(
    tree: Tree,
    modulus: float | Floats,
    density: float,
    gravity: float,
    twist_ratio: float,
    leaf_mass: ArrayLike = 0.0,
    leaf_width: ArrayLike = 0.0,
    root_stiffness: float = np.inf,
) -> Bodies:
    """
    Part a tree into bodies.

    Parameters
    ----------
    tree
        The tree.
    modulus, density
        Young's modulus in [Pa], also of each segment, (n,), and density in [kg/m^3].
    gravity
        In [m/s^2]; the springs are set to hold the rest shape against it.
    twist_ratio
        Stiffness in twist over that in bending, GJ/EI, in [-].
    leaf_mass, leaf_width
        Mass and area of leaves per length of each segment in [kg/m] and [m], (n,).
    root_stiffness
        Of a spring in series with the first joint in [N m/rad].

    """
    n = tree.n_segments
    d0, d1 = tree.base_diameter, tree.tip_diameter
    square = d0 * d0 + d0 * d1 + d1 * d1
    hinge = 0.5 * d0 * (2.0 * d0 + d1) / square
    joint = tree.start + hinge[:, None] * (tree.end - tree.start)
    axis = tree.direction
    carrier = np.full(n, -1, dtype=np.int64)
    place = tree.place_on_parent
    for i in range(1, n):
        parent = tree.segment_parent[i]
        carrier[i] = parent if place[i] >= hinge[parent] else carrier[parent]

    mass, first, second = _part_moments(tree, axis, hinge, density, np.asarray(leaf_mass))
    total, moment, tensor = mass[:, 1].copy(), first[:, 1].copy(), second[:, 1].copy()
    carried = carrier >= 0
    arm = joint - np.where(carried[:, None], joint[carrier], 0.0)
    np.add.at(total, carrier[carried], mass[carried, 0])
    root_side = first[carried, 0] + mass[carried, 0, None] * arm[carried]
    np.add.at(moment, carrier[carried], root_side)
    moved = second[carried, 0] + _parallel(mass[carried, 0], arm[carried], first[carried, 0])
    np.add.at(tensor, carrier[carried], moved)
    centre = moment / total[:, None]

    bend = 3.0 * np.pi / 64.0 * modulus * d0**3 * d1**3 / (tree.length * square)
    bend[0] = 1.0 / (1.0 / bend[0] + 1.0 / root_stiffness)
    reach = tree.length[:, None] * np.stack([hinge, 1.0 - hinge], axis=1)
    middle = d0 + hinge * (d1 - d0)
    return Bodies(
        carrier=carrier,
        arm=arm,
        axis=axis,
        reach=reach,
        mass=total,
        centre=centre,
        inertia=tensor - _tensor(total, centre),
        bend=bend,
        twist=twist_ratio * bend,
        rest_torque=_holding_torque(carrier, arm, total, moment, gravity),
        area=reach
        * (0.5 * np.stack([d0 + middle, middle + d1], axis=1) + np.reshape(leaf_width, (-1, 1))),
    )


def _part_moments(
    tree: Tree, axis: Floats, hinge: Floats, density: float, leaf_mass: Floats
) -> tuple[Floats, Floats, Floats]:
    """Mass, first and second moment about the joint of both parts of each segment."""
    point, weight = np.polynomial.legendre.leggauss(4)
    bounds = np.stack([0.0 * hinge, hinge, 1.0 + 0.0 * hinge], axis=1)
    half = 0.5 * np.diff(bounds, axis=1)[..., None]
    place = bounds[:, :2, None] + half * (1.0 + point)
    taper = (tree.tip_diameter - tree.base_diameter)[:, None, None]
    diameter = tree.base_diameter[:, None, None] + taper * place
    span = tree.length[:, None, None]
    line = density * np.pi / 4.0 * diameter**2 * span * half * weight
    reach = (place - hinge[:, None, None]) * span
    disc = (line * diameter**2 / 16.0).sum(axis=2)
    line += leaf_mass.reshape(-1, 1, 1) * span * half * weight
    mass, first = line.sum(axis=2), (line * reach).sum(axis=2)
    second = (line * reach**2).sum(axis=2)
    along = np.einsum('ni,nj->nij', axis, axis)[:, None]
    tensor = second[..., None, None] * (np.eye(3) - along) + disc[..., None, None] * (
        np.eye(3) + along
    )
    return mass, first[..., None] * axis[:, None], tensor


def _tensor(mass: Floats, place: Floats) -> Floats:
    square = np.einsum('ni,ni->n', place, place)[:, None, None] * np.eye(3)
    out: Floats = mass[:, None, None] * (square - np.einsum('ni,nj->nij', place, place))
    return out


def _parallel(mass: Floats, shift: Floats, first: Floats) -> Floats:
    """Return what the inertia gains when its point is moved back by `shift`."""
    cross = np.einsum('ni,nj->nij', shift, first)
    both = 2.0 * np.einsum('nii->n', cross)[:, None, None] * np.eye(3)
    out: Floats = _tensor(mass, shift) + both - cross - cross.transpose(0, 2, 1)
    return out


def _holding_torque(
    carrier: Ints, arm: Floats, mass: Floats, moment: Floats, gravity: float
) -> Floats:
    """Torque at each joint that supports all that it carries, (n, 3)."""
    carried, lever = mass.copy(), moment.copy()
    for i in range(len(carrier) - 1, 0, -1):
        if carrier[i] >= 0:
            carried[carrier[i]] += carried[i]
            lever[carrier[i]] += lever[i] + carried[i] * arm[i]
    up = np.array([0.0, 0.0, gravity])
    return np.cross(lever, up)
