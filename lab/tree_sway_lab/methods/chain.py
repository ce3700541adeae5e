# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The mechanism that the methods are set side by side on: a planar chain of pinned, sprung segments.

One segment is the paper's branch. Segment i has mass m, moment of inertia J about its centre of
mass, the lever c from its root-side node to that centre, length l, and at its root-side joint the
bending stiffness k1 and the damping k2. Angles are absolute, from the rest direction, in [rad]; a
load P in [N] acts at each centre of mass. SI units.

"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.core.oscillators import propagator
from tree_sway.errors import ParameterError

MASS, INERTIA, LEVER, LENGTH, STIFFNESS, DAMPING = range(6)


@dataclass(frozen=True, eq=False)
class PlanarChain:
    """
    Segments in order from the root.

    Parameters
    ----------
    table
        m [kg], J [kg m^2], c [m], l [m], k1 [N m], k2 [N m s] of each segment as columns, (n, 6).

    """

    table: NDArray[Any]

    def __post_init__(self) -> None:
        """Refuse what has no motion to compute."""
        numbers = np.asarray(self.table, dtype=float)
        if numbers.ndim != 2 or numbers.shape[1] != 6 or not len(numbers):
            raise ParameterError(f'chain table of shape {numbers.shape}', cure='give (n, 6)')
        bad = np.flatnonzero(~np.isfinite(numbers).all(1) | (numbers < 0).any(1))
        if len(bad):
            raise ParameterError('value that is negative or not finite', where=f'segment {bad[0]}')
        carried = np.append(np.cumsum(numbers[::-1, MASS])[::-1][1:], 0.0)
        swing = numbers[:, INERTIA] + numbers[:, MASS] * numbers[:, LEVER] ** 2
        still = np.flatnonzero(swing + numbers[:, LENGTH] ** 2 * carried == 0.0)
        if len(still):
            raise ParameterError(
                'no inertia about its node',
                where=f'segment {still[0]}',
                cure="give mass and lever, or use the oscillator's static limit",
            )

    @property
    def n_segments(self) -> int:
        """Return the number of segments."""
        return len(self.table)

    @property
    def stiffness_matrix(self) -> NDArray[np.float64]:
        """Joint stiffness on absolute angles in [N m], (n, n), tridiagonal."""
        return _joint_matrix(self.table[:, STIFFNESS])

    @property
    def damping_matrix(self) -> NDArray[np.float64]:
        """Joint damping on absolute angles in [N m s], (n, n), tridiagonal."""
        return _joint_matrix(self.table[:, DAMPING])

    @property
    def mass_matrix(self) -> NDArray[np.float64]:
        """Inertia of the straight chain in [kg m^2], (n, n)."""
        m, j, c, length = (self.table[:, k].astype(float) for k in range(4))
        beyond = np.append(np.cumsum(m[::-1])[::-1][1:], 0.0)
        first = m * c + length * beyond
        upper = np.triu(length[:, None] * first[None, :], 1)
        return np.asarray(upper + upper.T + np.diag(j + m * c**2 + length**2 * beyond))

    @property
    def frequencies(self) -> NDArray[np.float64]:
        """Undamped circular frequencies of small motion in [rad/s], (n,)."""
        values = np.linalg.eigvals(np.linalg.solve(self.mass_matrix, self.stiffness_matrix))
        return np.sort(np.sqrt(values.real))

    def first_order_hold(self, dt: float) -> NDArray[np.float64]:
        """
        Exact propagator of the straight chain: next angles, rates from those, M0, M1, (2n, 4n).

        One segment takes the closed form of `oscillators.propagator`; more take the exponential of
        the augmented matrix (Van Loan 1978).
        """
        n = self.n_segments
        inertia = self.mass_matrix
        if n == 1:
            row = self.table[0].astype(float)
            return propagator(inertia[0, 0], row[DAMPING], row[STIFFNESS], dt).reshape(2, 4)
        from scipy.linalg import expm

        a = np.zeros((4 * n, 4 * n))
        a[:n, n : 2 * n] = dt * np.eye(n)
        a[n : 2 * n, :n] = -dt * np.linalg.solve(inertia, self.stiffness_matrix)
        a[n : 2 * n, n : 2 * n] = -dt * np.linalg.solve(inertia, self.damping_matrix)
        a[n : 2 * n, 2 * n : 3 * n] = dt * np.linalg.inv(inertia)
        a[2 * n : 3 * n, 3 * n :] = np.eye(n)
        e = np.asarray(expm(a))[: 2 * n]
        ramp = e[:, 3 * n :]
        return np.hstack([e[:, : 2 * n], e[:, 2 * n : 3 * n] - ramp, ramp])

    def astype(self, dtype: Any) -> PlanarChain:
        """Return the same chain in another number type."""
        return PlanarChain(self.table.astype(dtype))


def single_segment(
    frequency: float = 2.0, damping_ratio: float = 0.05, length: float = 1.0, mass: float = 1.0
) -> PlanarChain:
    """Return a uniform rod that swings at a frequency in [Hz] with a damping ratio."""
    return uniform_chain(1, frequency, damping_ratio, length, mass)


def uniform_chain(
    n: int, frequency: float = 2.0, damping_ratio: float = 0.05, length: float = 1.0,
    mass: float = 1.0,
) -> PlanarChain:  # fmt: skip
    """Return n equal rods whose first mode has a frequency in [Hz] and a damping ratio."""
    rod, m, w = length / n, mass / n, 2.0 * np.pi * frequency
    row: ArrayLike = [m, m * rod**2 / 12.0, rod / 2.0, rod, 1.0, 0.0]
    unit = PlanarChain(np.tile(np.asarray(row, dtype=float), (n, 1)))
    table = unit.table.copy()
    table[:, STIFFNESS] = (w / unit.frequencies[0]) ** 2
    table[:, DAMPING] = 2.0 * damping_ratio / w * table[:, STIFFNESS]
    return PlanarChain(table)


def _joint_matrix(joint: NDArray[Any]) -> NDArray[np.float64]:
    k = joint.astype(float)
    return np.diag(k + np.append(k[1:], 0.0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
