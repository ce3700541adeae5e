# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The exact propagator of a bank of oscillators, at the heart of every model.

One row of eight coefficients advances ``I x'' + k2 x' + k1 x = M(t)`` over a step h, exactly, for
a moment M that changes linearly from M0 to M1 (first-order hold)::

    x1 = c0 x + c1 v + c2 M0 + c3 M1
    v1 = c4 x + c5 v + c6 M0 + c7 M1

``native/propagate.cpp`` finds them without cancellation.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import one_of_each, refuse_time_step
from tree_sway.core.native import contiguous, LIBRARY
from tree_sway.errors import ParameterError

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


def fill_propagator(
    inertia: Floats, damping: Floats, stiffness: Floats, dt: float, out: Floats
) -> int:
    """
    Refill coefficients (n, 8) in place, for a new step [s].

    Arguments are those of `propagator`, not checked. Returned is the index of the first oscillator
    whose coefficients are all zero (its row is set to no motion), or -1.
    """
    count = len(out)
    given = [np.ascontiguousarray(each) for each in (inertia, damping, stiffness)]
    at = [contiguous(each, (count,)) for each in given]
    return int(LIBRARY.sway_propagators(*at, count, dt, contiguous(out, (count, 8))))


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
    return step_propagators(damping, stiffness, dt)[0]


def step_propagators(damping: Floats, stiffness: Floats, dt: float) -> tuple[Floats, Floats]:
    """
    Coefficients as `held_propagator`, over a step and over half of it, (2, 3, n) each.

    The half goes to where the load of the wind is found. Of an oscillator that swings nearly once
    a step or more it is an implicit Euler step, whose rate always follows the force.
    """
    count = len(damping)
    given = [np.ascontiguousarray(each, dtype=np.float64) for each in (stiffness, damping)]
    whole, half = np.zeros((2, 2, 3, count))
    at = [contiguous(each, (count,)) for each in given]
    LIBRARY.sway_steps(*at, count, dt, contiguous(whole), contiguous(half))
    return whole, half
