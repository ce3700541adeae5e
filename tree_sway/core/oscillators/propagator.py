# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The exact propagator of a bank of oscillators, the kernel of every model.

One row of eight coefficients advances ``I x'' + k2 x' + k1 x = M(t)`` over a step h, exactly, for
a moment M that runs linearly from M0 to M1 (first-order hold)::

    x1 = c0 x + c1 v + c2 M0 + c3 M1
    v1 = c4 x + c5 v + c6 M0 + c7 M1

Symbols: alpha = k2 h / 2 I, kappa = k1 h^2 / I, and mu1, mu2 = -alpha +- sqrt(alpha^2 - kappa),
the two eigenvalues times h. With e[..] for the divided differences of the exponential, everything
follows from ``s = e[mu1, mu2]``, ``p = e[0, mu1, mu2]`` and ``q = e[0, 0, mu1, mu2]`` (Higham
2008, Functions of Matrices, 10.7: the phi functions), which `exponential_differences` finds
without cancellation.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.core.checks import one_of_each, refuse_time_step
from tree_sway.core.kernel import kernel
from tree_sway.core.oscillators.exponential import (
    exponential_differences,
    phi1,
    phi2,
    scaled_discriminant,
)
from tree_sway.errors import ParameterError

Floats = NDArray[np.float64]

_NO_MOTION = 'inertia, damping and stiffness are all zero: nothing resists the moment'


def propagator(inertia: ArrayLike, damping: ArrayLike, stiffness: ArrayLike, dt: float) -> Floats:
    """
    Coefficients that advance each oscillator exactly over one step.

    Parameters
    ----------
    inertia
        Moment of inertia I in [kg m^2], (n,) or a scalar for all; zero gives the first-order
        limit.
    damping
        Damping coefficient k2 in [N m s], (n,) or a scalar.
    stiffness
        Stiffness k1 in [N m], (n,) or a scalar; zero gives the free, damped body.
    dt
        Time step h in [s].

    Returns
    -------
    Floats
        c0 .. c7 of the module's text, (n, 8). Where I and k2 are zero, the static answer: x1 = M1
        / k1 with the velocity of the line between the two answers.

    Raises
    ------
    ParameterError
        A step that is not positive, a value that is negative or not finite, or an oscillator with
        nothing but zeros, named by its index.

    """
    refuse_time_step(dt)
    parts = {'inertia': inertia, 'damping': damping, 'stiffness': stiffness}
    values = np.broadcast_arrays(*(np.atleast_1d(each) for each in parts.values()))
    i, c, k = (
        one_of_each(name, each, len(each), 'oscillator')
        for name, each in zip(parts, values, strict=True)
    )
    out = np.empty((len(i), 8))
    refused = fill_propagator(i, c, k, dt, out)
    if refused >= 0:
        raise ParameterError(_NO_MOTION, where=f'oscillator {refused}')
    return out


@kernel
def fill_propagator(
    inertia: Floats, damping: Floats, stiffness: Floats, dt: float, out: Floats
) -> int:
    """
    Refill coefficients (n, 8) in place, for a step [s] that changes; computed in float64.

    Arguments are those of `propagator`, not checked; nothing is allocated. Returned is the index
    of the first oscillator with nothing but zeros (its row is set to stand still), or -1.
    """
    refused = -1
    for row in range(len(inertia)):
        i, c, k = inertia[row], damping[row], stiffness[row]
        if i > 0.0 and c * dt < 1e150 * i and max(k * dt, dt, 1.0) * max(dt, 1.0) / i < 1e300:
            _fill_second_order(i, c, k, dt, out[row])
        elif c > 0.0 and max(k, 1.0) * max(dt, 1.0) / c < 1e300:
            _fill_first_order(c, k, dt, out[row])
        else:
            out[row, :] = 0.0
            if k > 0.0:
                out[row, 3] = 1.0 / k
                out[row, 6] = -1.0 / (k * dt)
                out[row, 7] = 1.0 / (k * dt)
            else:
                out[row, 0] = 1.0
                refused = row if refused < 0 else refused
    return refused


@kernel
def _fill_second_order(i: float, c: float, k: float, h: float, row: Floats) -> None:
    """Oscillator with inertia: divided differences to moment coefficients."""
    alpha = 0.5 * c * h / i
    kappa = k * h * h / i
    delta, phase, phase_low = scaled_discriminant(i, c, k, h, alpha, kappa)
    g, d, s, p, q, p_minus_q = exponential_differences(alpha, kappa, delta, phase, phase_low)
    row[0] = g
    row[1] = h * s
    row[2] = h * h / i * p_minus_q
    row[3] = h * h / i * q
    row[4] = -kappa * s / h
    row[5] = d
    row[6] = h / i * (s - p)
    row[7] = h / i * p


@kernel
def _fill_first_order(c: float, k: float, h: float, row: Floats) -> None:
    """No inertia: k2 x' + k1 x = M, so that the velocity is what the moments leave it."""
    z = -k / c * h
    f1, f2 = phi1(z), phi2(z)
    decay = math.exp(z)
    row[0] = decay
    row[1] = 0.0
    row[2] = h / c * (f1 - f2)
    row[3] = h / c * f2
    row[4] = -k / c * decay
    row[5] = 0.0
    row[6] = z * (f1 - f2) / c
    row[7] = f1 / c
