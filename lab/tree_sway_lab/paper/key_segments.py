# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Key segments of a plant as the paper sets them: one pinned, sprung rod per branch, in a plane.

The segment turns about its root-side node in the plane of its own direction and the wind's
(2.2.1). Its bending stiffness and its damping come from the volumes of its branch and of the
branch that bears it (3.2); the paper gives no formula, so the geometric mean of both volumes is
taken, times one constant each, which are tuned per plant as the authors did.

Symbols: b branches, n segments.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway_lab.paper.similar_twigs import twig_sources

AIR_DENSITY = 1.2
"""In [kg/m^3]."""

DRAG_COEFFICIENT = 1.2
"""Drag coefficient of a bare cylinder across the wind [-]."""

TWIG_TOLERANCE = 0.05
"""How alike twigs are that reuse one solution [-]."""


@dataclass(frozen=True, eq=False)
class KeySegments:
    """
    The planar problem of every branch of a plant.

    Parameters
    ----------
    table
        Rows of `PlanarChain`: m, J, c, l, k1, k2 of each key segment, (b, 6).
    along, across
        X and Y axis of each rotation plane: the branch's chord, and what of the wind's direction
        is square to it, (b, 3). A branch along the wind has no plane of its own and any is right.
    load
        Wind load in the plane at 1 m/s in [N s^2/m^2], (b, 2).
    source
        Branch whose solution each branch reuses, its own number if it is solved, (b,).

    """

    table: Floats
    along: Floats
    across: Floats
    load: Floats
    source: Ints

    @property
    def solved(self) -> Ints:
        """Branches that are solved."""
        return np.flatnonzero(self.source == np.arange(len(self.source)))

    @property
    def frequency(self) -> Floats:
        """Natural frequency of each key segment in [Hz], (b,)."""
        inertia = self.table[:, 1] + self.table[:, 0] * self.table[:, 2] ** 2
        return np.asarray(np.sqrt(self.table[:, 4] / inertia) / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> Floats:
        """Damping ratio of each key segment [-], (b,)."""
        inertia = self.table[:, 1] + self.table[:, 0] * self.table[:, 2] ** 2
        return np.asarray(self.table[:, 5] / (2.0 * np.sqrt(self.table[:, 4] * inertia)))


def key_segments(
    tree: Tree, species: Species, direction: ArrayLike, stiffness: float, damping: float
) -> KeySegments:
    """
    Set up the paper's equation for every branch.

    Parameters
    ----------
    tree, species
        The plant.
    direction
        Where the wind blows to, (3,); of any length but zero.
    stiffness, damping
        The two constants of the volume rule in [N m/rad/m^3] and [N m s/rad/m^3].

    Returns
    -------
    KeySegments
        Uniform rods with the mass, the length and the wind area of their branches.

    Raises
    ------
    ParameterError
        A constant that is not above 0, or no direction.

    """
    for name, value in (('k1 constant', stiffness), ('k2 constant', damping)):
        if not (np.isfinite(value) and value > 0.0):
            raise ParameterError(f'{name} {value:g}', cure='give a finite number above 0')
    wind = np.asarray(direction, dtype=np.float64)
    speed = float(np.linalg.norm(wind))
    if not (np.isfinite(speed) and speed > 0.0):
        raise ParameterError(f'wind direction {wind}', cure='give a vector that is not zero')
    first, last = tree.branch_first[:-1], tree.branch_first[1:] - 1
    chord = tree.end[last] - tree.start[first]
    along = chord / np.linalg.norm(chord, axis=1)[:, None]
    across, ahead = _planes(along, wind / speed)
    volume = np.add.reduceat(tree.volume, first)
    diameter = 0.5 * (tree.base_diameter + tree.tip_diameter)
    area = np.add.reduceat(diameter * tree.length, first)
    mass, length = species.density * volume, tree.branch_length
    rule = np.sqrt(volume * volume[np.maximum(tree.branch_parent, 0)])
    table = np.stack(
        [mass, mass * length**2 / 12.0, 0.5 * length, length, stiffness * rule, damping * rule],
        axis=1,
    )
    pressure = 0.5 * AIR_DENSITY * DRAG_COEFFICIENT * area
    return KeySegments(
        table, along, across, pressure[:, None] * ahead, twig_sources(tree, TWIG_TOLERANCE)
    )


def _planes(along: Floats, wind: Floats) -> tuple[Floats, Floats]:
    """Y axis of each rotation plane, (b, 3), and the wind's direction in the plane, (b, 2)."""
    forward = along @ wind
    across = wind - forward[:, None] * along
    sine = np.linalg.norm(across, axis=1)
    lone = sine < 1e-9
    square = np.eye(3)[np.argmin(np.abs(along[lone]), axis=1)]
    across[lone] = square - np.sum(square * along[lone], axis=1)[:, None] * along[lone]
    across /= np.linalg.norm(across, axis=1)[:, None]
    return across, np.stack([forward, np.where(lone, 0.0, sine)], axis=1)
