# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Steady-state Kalman filter of what a model's motion lacks.

The state is the difference between the real and the computed motion: displacement eta and rate v
of each coordinate, and a disturbance d of its force, a first-order process. Over a step it moves
by the exact propagator of the coordinates::

    eta' = c0 eta + c1 v + (c2 + c3) d,   v' = c4 eta + c5 v + (c6 + c7) d,   d' = phi d + w

The covariance P of the prediction solves the discrete algebraic Riccati equation. It is found by
the structure-preserving doubling algorithm (Chu, Fan, Lin & Wang 2004, International Journal of
Control 77, 767-788), some ten products of matrices.

Symbols: H measurements by the state, R their noise, S their predicted covariance, L gain.
"""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.oscillators import held_propagator
from tree_sway.core.setup import one_thread

_MOST_DOUBLINGS, _ENOUGH = 60, 1e-10


@dataclass(frozen=True)
class SwayLaw:
    """
    How the difference moves over one step.

    Parameters
    ----------
    step
        Displacement, rate and disturbance after a step by those before, of each coordinate, (3, 3,
        m).
    driven
        Covariance of what a step adds to the disturbances, (m, m).

    """

    step: Floats
    driven: Floats

    @property
    def matrix(self) -> Floats:
        """The step as a matrix on the state, (3 m, 3 m)."""
        return np.block([[np.diag(each) for each in row] for row in self.step])

    def ahead(self, n_steps: int) -> Floats:
        """Several steps at once, (3, 3, m)."""
        by_mode = np.moveaxis(self.step, 2, 0)
        return np.ascontiguousarray(np.moveaxis(np.linalg.matrix_power(by_mode, n_steps), 0, 2))


def sway_law(
    stiffness: Floats, damping: Floats, covariance: Floats, time_constant: float, dt: float
) -> SwayLaw:
    """
    Return the law of coordinates of unit mass.

    Parameters
    ----------
    stiffness, damping
        Stiffness [1/s^2] and damping [1/s], of wood and air, (m,).
    covariance
        Covariance of the disturbances of the forces, (m, m).
    time_constant
        Time in [s] after which a disturbance has decayed to 1/e.
    dt
        Time step in [s].

    """
    decay = math.exp(-dt / time_constant)
    step = np.zeros((3, 3, len(stiffness)))
    step[:2] = held_propagator(damping, stiffness, dt)
    step[2, 2] = decay
    return SwayLaw(step, (1.0 - decay * decay) * covariance)


@dataclass(frozen=True)
class SteadyFilter:
    """
    Gains of a law with some measurements.

    Parameters
    ----------
    law
        The law.
    sensed
        Measurements by the state, H, (p, 3 m).
    gain
        Correction of the state by the innovations, L, (3 m, p).
    deviation
        Standard deviation of each innovation, (p,).
    covariance
        Covariance of the state after the correction, (3 m, 3 m).

    """

    law: SwayLaw
    sensed: Floats
    gain: Floats
    deviation: Floats
    covariance: Floats


def steady_filter(law: SwayLaw, sensed: Floats, noise: Floats) -> SteadyFilter:
    """
    Find the steady gains.

    Parameters
    ----------
    law
        How the state moves.
    sensed
        Measurements by the state, (p, 3 m).
    noise
        Standard deviation of the noise of each measurement, (p,).

    """
    step = law.matrix
    m = law.step.shape[2]
    driven = np.zeros_like(step)
    driven[2 * m :, 2 * m :] = law.driven
    with one_thread():
        predicted = predicted_covariance(step, sensed, driven, noise)
        cross = predicted @ sensed.T
        innovation = sensed @ cross + np.diag(np.square(noise))
        gain = np.linalg.solve(innovation, cross.T).T
        left = np.eye(3 * m) - gain @ sensed
        corrected = left @ predicted
    deviation = np.sqrt(np.diag(innovation))
    return SteadyFilter(law, sensed, gain, deviation, 0.5 * (corrected + corrected.T))


def predicted_covariance(step: Floats, sensed: Floats, driven: Floats, noise: Floats) -> Floats:
    """
    Solve ``P = A P A' - A P H' (H P H' + R)^-1 H P A' + Q`` for P by doubling.

    Parameters
    ----------
    step, sensed, driven
        A (n, n), H (p, n) and Q (n, n).
    noise
        Roots of the diagonal of R, (p,).

    """
    onward = step.T.copy()
    seen = sensed.T @ (sensed / np.square(noise)[:, None])
    found = driven.copy()
    one = np.eye(len(step))
    for _ in range(_MOST_DOUBLINGS):
        both = np.linalg.solve(one + seen @ found, np.hstack([onward, seen]))
        next_onward, spread = np.hsplit(both, 2)
        added = onward.T @ found @ next_onward
        seen = seen + onward @ spread @ onward.T
        seen = 0.5 * (seen + seen.T)
        onward = onward @ next_onward
        found = found + 0.5 * (added + added.T)
        if np.abs(added).max() <= _ENOUGH * np.abs(found).max():
            break
    return found


def stationary_covariance(law: SwayLaw) -> Floats:
    """
    Covariance of the state without any measurement, (3 m, 3 m).

    ``P = A P A' + Q`` falls apart into one equation of nine unknowns for each pair of coordinates,
    for A couples no two of them (Horn & Johnson 1991, *Topics in Matrix Analysis*, 4.3).
    """
    m = law.step.shape[2]
    steps = np.moveaxis(law.step, 2, 0)
    both = np.einsum('iac,jbd->ijabcd', steps, steps).reshape(m, m, 9, 9)
    added = np.zeros((m, m, 9, 1))
    added[..., 8, 0] = law.driven
    pairs = np.linalg.solve(np.eye(9) - both, added).reshape(m, m, 3, 3)
    return np.ascontiguousarray(pairs.transpose(2, 0, 3, 1)).reshape(3 * m, 3 * m)


def told_shares(gains: SteadyFilter, law: SwayLaw, noise: Floats) -> Floats:
    """
    Find the share of each displacement's variance that gains take away under another law.

    What a gain leaves moves as ``E = (1 - L H) (A E A' + Q) (1 - L H)' + L R L'``, whatever the
    law that it was found for. The shares, (m,), are negative where the correction adds.

    Parameters
    ----------
    gains
        The gains.
    law
        How the state moves in truth.
    noise
        Standard deviation of the noise of each measurement, (p,).

    """
    step, m = law.matrix, law.step.shape[2]
    with one_thread():
        kept = np.eye(3 * m) - gains.gain @ gains.sensed
        noisy = gains.gain * noise
        added = noisy @ noisy.T + kept[:, 2 * m :] @ law.driven @ kept[:, 2 * m :].T
        left = predicted_covariance(kept @ step, np.zeros((0, 3 * m)), added, np.zeros(0))
    alone = np.diag(stationary_covariance(law))[:m]
    return 1.0 - np.diag(left)[:m] / np.maximum(alone, 1e-300)
