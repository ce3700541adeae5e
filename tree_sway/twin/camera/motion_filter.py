# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Kalman filter of what a model's motion lacks, by points in pictures that come at any time.

The state and its law are those of `steady_filter`: displacement, rate and an unknown force of each
coordinate. The covariance is kept, not steady, for points come and leave. A picture has many more
numbers than there are coordinates, so they are joined to the information on these: with rows H,
weights W and missed r, ``H' W H`` and ``H' W r``.

A limb is followed to 0.05 px across it, and to 0.3 px along it, where its edges tell nothing. So
each point has two errors of its own, along its limb and across it, which follow its residuals;
beyond that its weight in a picture falls with its residual as Geman & McClure's (1987), along and
across. So a fluttering leaf, a shadow or a bird move nothing.

How strong the unknown forces are over those of the law follows what they are found to be
(Dempster, Laird & Rubin 1977, Journal of the Royal Statistical Society B 39, 1-38): their squares
and what remains unknown of them.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.setup import one_thread
from tree_sway.twin.steady_filter import SwayLaw

TICK = 1.0 / 240.0
"""Grid of the times of pictures in [s], and the step of the law."""

_MOST_TICKS = 60
_NOISE = 0.03
"""Least error of a point in pixels."""
_FIRST_NOISE = 0.5
_JOINED = 6.0
"""
How many times the square of its error a point's variance is taken to be: its error is that of a
shape that the model lacks, which lasts for several pictures.
"""
_FOLLOWED = 0.02
"""Share of a picture's residual in the error of a point."""
_OUTLIER = 3.0
"""Residual over its expected size at which the weight of a point is a quarter."""
_ROUNDS = 2
_STRENGTHENED = 0.01
"""Share of a picture in the strength of the unknown forces."""
_STRONGEST = 16.0


class MotionFilter:
    """
    Difference between a real tree and its model, and how sure it is.

    Parameters
    ----------
    law
        How the difference moves over `TICK`.
    covariance
        Covariance of the state before any picture, (3 n, 3 n).

    """

    def __init__(self, law: SwayLaw, covariance: Floats) -> None:
        n = self.count = law.step.shape[2]
        self.state = np.zeros((3, n))
        """Displacement, rate and unknown force of each coordinate, (3, n)."""
        self.covariance = covariance.copy()
        """Covariance of the state, (3 n, 3 n)."""
        self.errors = np.zeros((0, 2))
        """Error of each point in pixels along its limb and across it, (p, 2)."""
        self.weights = np.zeros((0, 2))
        """Weights of each point in the last picture, so too, 0 to 1, (p, 2)."""
        self.strength = 1.0
        """Variance of the unknown forces over that of the law [-]."""
        self.set_law(law)

    def set_law(self, law: SwayLaw) -> None:
        """Go on by another law."""
        self._law = law
        self._usual = np.diag(law.driven) / (1.0 - np.square(law.step[2, 2]))
        self._ahead: dict[int, tuple[Floats, Floats]] = {}

    def _several(self, ticks: int) -> tuple[Floats, Floats]:
        """Step and driven covariance of some ticks at once, (3, 3, n) and (3, n, 3, n)."""
        if ticks not in self._ahead:
            n = self.count
            driven = np.zeros((3, n, 3, n))
            for _ in range(ticks):
                driven = _moved(self._law.step, driven)
                driven[2, :, 2] += self._law.driven
            self._ahead[ticks] = self._law.ahead(ticks), driven
        return self._ahead[ticks]

    def advance(self, ticks: int) -> None:
        """Move on by a number of ticks."""
        while ticks > 0:
            some = min(ticks, _MOST_TICKS)
            step, driven = self._several(some)
            self.state = np.einsum('ijn,jn->in', step, self.state)
            n = self.count
            blocks = _moved(step, self.covariance.reshape(3, n, 3, n)) + self.strength * driven
            self.covariance = blocks.reshape(3 * n, 3 * n)
            ticks -= some

    def moved(self, state: Floats, ticks: int) -> Floats:
        """Displacement and rate some ticks after a state (3, n), (2, n)."""
        step, _ = self._several(min(ticks, _MOST_TICKS))
        return np.einsum('ijn,jn->in', step[:2], state)

    def begin(self, n_points: int) -> None:
        """Follow other points."""
        self.errors = np.full((n_points, 2), _FIRST_NOISE)
        self.weights = np.zeros((n_points, 2))

    def see(self, slopes: Floats, missed: Floats) -> None:
        """
        Correct the state by a picture.

        Parameters
        ----------
        slopes
            Motion of each point along its limb and across it, in pixels per unit of each
            coordinate, (p, 2, n).
        missed
            Seen places less expected ones, so too, in pixels, (p, 2); not a number where it is not
            seen.

        """
        n = self.count
        seen = np.isfinite(missed).all(axis=1)
        rows = slopes[seen].reshape(-1, n)
        apart = missed[seen].ravel()
        expected = np.square(self.errors[seen]).ravel()
        with one_thread():
            moves = self.covariance[:n, :n]
            left = apart
            allowed = expected + np.einsum('ij,ij->i', rows @ moves, rows)
            for _ in range(1 + _ROUNDS):
                squares = np.square(left)
                shares = 1.0 / np.square(1.0 + squares / (_OUTLIER * _OUTLIER * allowed))
                weighted = rows * (shares / (_JOINED * expected))[:, None]
                told = rows.T @ weighted
                towards = weighted.T @ apart
                inner = np.linalg.solve(np.eye(n) + told @ moves, np.column_stack([towards, told]))
                left = apart - rows @ (moves @ inner[:, 0])
                allowed = 2.0 * expected
            across = self.covariance[:, :n]
            self.state += (across @ inner[:, 0]).reshape(3, n)
            self.covariance -= across @ inner[:, 1:] @ across.T
        self.covariance = 0.5 * (self.covariance + self.covariance.T)
        # The unknown forces are as strong as they are found to be.
        variance = np.diag(self.covariance)[2 * n :]
        found = (np.square(self.state[2]) + variance) / self._usual
        self.strength += _STRENGTHENED * (float(found.mean()) - self.strength)
        self.strength = min(self.strength, _STRONGEST)
        self.weights[:] = 0.0
        self.weights[seen] = shares.reshape(-1, 2)
        # A far outlier is not a usual error.
        beyond = np.minimum(squares, 100.0 * expected) - expected
        followed = expected + _FOLLOWED * beyond
        self.errors[seen] = np.maximum(np.sqrt(followed), _NOISE).reshape(-1, 2)


def _moved(step: Floats, blocks: Floats) -> Floats:
    """Covariance (3, n, 3, n) after a step (3, 3, n)."""
    rows = np.einsum('ijn,jnkm->inkm', step, blocks)
    return np.einsum('klm,inlm->inkm', step, rows)
