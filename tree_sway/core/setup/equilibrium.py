# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Equilibrium of a tree in a steady wind: its springs balance the load.

It is found from the equilibrium in a weaker wind, by Broyden's method (Broyden 1965, Mathematics
of Computation 19, 577-593) with the slopes there, or new ones where these do not converge. Where a
branch flips, the path of equilibria ends: slopes follow the motion of a tree without inertia
(Kelley & Keyes 1998, SIAM Journal on Numerical Analysis 35, 508-523).
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.setup.load_derivatives import LoadSlopes
from tree_sway.core.setup.wind_moments import WindMoments

_MOST_TURNS = 20
_FARTHEST = 0.3
"""Largest change of a key rotation in one turn [rad]."""

_AT_REST, _NEAR_REST = 0.01, 0.05
"""
Imbalance of springs and load, over the load: where the search ends, and the largest of a result.
"""


class EquilibriumSearch:
    """
    Search for the equilibria of a tree on some coordinates.

    Parameters
    ----------
    moments, slopes
        Loads of the tree, and their slopes on the shapes.
    shapes
        Key rotations per unit of each coordinate, (N, m).
    stiffness
        Stiffness of the coordinates in [1/s^2], (m,).

    """

    def __init__(
        self, moments: WindMoments, slopes: LoadSlopes, shapes: Floats, stiffness: Floats
    ) -> None:
        self._moments = moments
        self._slopes = slopes
        self._shapes = shapes
        self._root = np.sqrt(stiffness)
        self._still = np.zeros(len(shapes))

    def near(self, weaker: Floats, pressure: float, ahead: Floats, turning: Floats) -> Floats:
        """
        Find the coordinates (m,) at rest in a wind.

        Parameters
        ----------
        weaker
            Coordinates at rest in a weaker wind, (m,).
        pressure
            Dynamic pressure in [kg/m/s^2].
        ahead
            Direction of the wind, (3,).
        turning
            Slopes of the load by the coordinates in the weaker wind, (m, m).

        Returns
        -------
        Floats
            The coordinates; the object ``weaker`` where there is no equilibrium near it.

        """
        pose = nearest = weaker
        step = rest = weaker
        least = np.inf
        size_before = np.inf
        inverse: Floats = np.eye(len(pose))
        for turn in range(_MOST_TURNS):
            rest_before = rest
            rest, size = self._imbalance(pose, pressure, ahead)
            if size < least:
                nearest = pose
                least = size
            if size < _AT_REST:
                break
            if size < size_before < np.inf:
                change = inverse @ (rest - rest_before)
                inverse += np.outer(step - change, step @ inverse) / float(step @ change)
            else:
                slopes = self._slopes(self._shapes @ pose, ahead)[0] if turn else turning
                inverse[:] = self._inverse_slope(slopes, pressure)
            size_before = size
            step = self._bounded(-inverse @ rest)
            pose = pose + step / self._root
        return nearest if least < _NEAR_REST else weaker

    def _imbalance(self, pose: Floats, pressure: float, ahead: Floats) -> tuple[Floats, float]:
        """Return the springs' forces less the load, scaled, (m,), and their size over the load."""
        moments = self._moments(self._shapes @ pose, self._still, ahead)
        load = pressure * (moments @ self._shapes) / self._root
        rest = self._root * pose - load
        size = float(np.linalg.norm(rest)) / max(float(np.linalg.norm(load)), 1e-300)
        return rest, size

    def _inverse_slope(self, slopes: Floats, pressure: float) -> Floats:
        """Return the inverse of the slope of the imbalance, stiffened to be stable, (m, m)."""
        scaled = slopes / self._root / self._root[:, None]
        unit = np.eye(len(slopes))
        slope = unit - pressure * scaled.T
        lowest = float(np.linalg.eigvalsh(0.5 * (slope + slope.T))[0])
        return np.asarray(np.linalg.inv(slope + max(0.0, 0.1 - 1.5 * lowest) * unit))

    def _bounded(self, step: Floats) -> Floats:
        """Shorten a step that turns a branch too far."""
        farthest = float(np.abs(self._shapes @ (step / self._root)).max())
        return step * min(1.0, _FARTHEST / max(farthest, 1e-12))
