# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The exact propagator of a bank of oscillators, at the heart of every model.

One row of eight coefficients advances ``I x'' + k2 x' + k1 x = M(t)`` over a step h, exactly, for
a moment M that changes linearly from M0 to M1 (first-order hold)::

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
from tree_sway.core.oscillators.exponential import (
    exponential_differences,
    phi1,
    phi2,
    scaled_discriminant,
)
from tree_sway.errors import ParameterError

Floats = NDArray[np.float64]

_NO_MOTION = 'inertia, damping and stiffness are all zero'


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
        c0 .. c7 of the module's text, (n, 8). Where I and k2 are zero, they give the static
        response: x1 = M1 / k1, and the velocity of the line between the two responses.

    Raises
    ------
    ParameterError
        A step that is not positive, a value that is negative or not finite, or an oscillator whose
        coefficients are all zero, named by its index.

    """
    refuse_time_step(dt, math.inf)
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


def held_propagator(damping: Floats, stiffness: Floats, dt: float) -> Floats:
    """
    Coefficients of oscillators of unit inertia whose force F is constant over a step.

    Parameters
    ----------
    damping, stiffness
        Damping k2 in [1/s] and stiffness k1 in [1/s^2], (n,).
    dt
        Time step in [s].

    Returns
    -------
    Floats
        For the displacement and for the rate, those of the displacement, the rate and the force,
        (2, 3, n).

    """
    c = propagator(1.0, damping, stiffness, dt).T
    return np.array([[c[0], c[1], c[2] + c[3]], [c[4], c[5], c[6] + c[7]]])


def fill_propagator(
    inertia: Floats, damping: Floats, stiffness: Floats, dt: float, out: Floats
) -> int:
    """
    Refill coefficients (n, 8) in place, for a new step [s]; computed in float64.

    Arguments are those of `propagator`, not checked. Returned is the index of the first oscillator
    whose coefficients are all zero (its row is set to no motion), or -1.
    """
    i = inertia
    c = damping
    k = stiffness
    longest = max(dt, 1.0)
    with np.errstate(all='ignore'):
        is_damped_finitely = c * dt < 1e150 * i
        largest_of_inertia = np.maximum(k * dt, longest) * longest / i
        has_inertia = (i > 0.0) & is_damped_finitely & (largest_of_inertia < 1e300)
        largest_of_damping = np.maximum(k, 1.0) * longest / c
        is_overdamped = ~has_inertia & (c > 0.0) & (largest_of_damping < 1e300)
        is_static = ~has_inertia & ~is_overdamped & (k > 0.0)
        out[:] = 0.0
        out[has_inertia] = _second_order(i[has_inertia], c[has_inertia], k[has_inertia], dt).T
        out[is_overdamped] = _first_order(c[is_overdamped], k[is_overdamped], dt).T
        out[is_static] = _static(k[is_static], dt).T
    refused = np.flatnonzero(~(has_inertia | is_overdamped | is_static))
    out[refused, 0] = 1.0
    return int(refused[0]) if len(refused) else -1


def _second_order(i: Floats, c: Floats, k: Floats, h: float) -> Floats:
    """Oscillators with inertia, (8, n): divided differences to moment coefficients."""
    alpha = 0.5 * c * h / i
    kappa = k * h * h / i
    discriminant = scaled_discriminant(i, c, k, h, alpha, kappa)
    g, d, s, p, q, p_minus_q = exponential_differences(alpha, kappa, *discriminant)
    angle_by_moment = h * h / i
    velocity_by_moment = h / i
    return np.stack(
        [
            g,
            h * s,
            angle_by_moment * p_minus_q,
            angle_by_moment * q,
            -kappa * s / h,
            d,
            velocity_by_moment * (s - p),
            velocity_by_moment * p,
        ]
    )


def _first_order(c: Floats, k: Floats, h: float) -> Floats:
    """No inertia, (8, n): k2 x' + k1 x = M, so that the velocity follows from the moments."""
    z = -k / c * h
    none = np.zeros_like(c)
    decay = np.exp(z)
    whole = phi1(z)
    of_end = phi2(z)
    of_start = whole - of_end
    return np.stack(
        [
            decay,
            none,
            h / c * of_start,
            h / c * of_end,
            -k / c * decay,
            none,
            z * of_start / c,
            whole / c,
        ]
    )


def _static(k: Floats, h: float) -> Floats:
    """No inertia and no damping, (8, n): the response to the moment, ``x = M / k1``."""
    none = np.zeros_like(k)
    rate = 1.0 / (k * h)
    return np.stack([none, none, none, 1.0 / k, none, none, -rate, rate])
