# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The two-axis branch on whole arrays, in plain numpy: `two_axis` with sines and cosines.

e is the rotation vector of a branch, t = |e|^2, and W the force times its lever. Near zero the
fractions by t are replaced by their series.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.oscillators.two_axis import T_MAX

_SMALL = 1e-6
"""Square of the angle [rad^2] below which fractions by it are the first terms of their series."""


def within_guard(e: Floats) -> Floats:
    """Pull rotation vectors (n, 2) back to the circle of `oscillators.two_axis`."""
    squares = np.square(e).sum(axis=1, keepdims=True)
    share = np.sqrt(T_MAX / np.maximum(squares, T_MAX))
    return np.asarray(e * share)


def two_axis_moment(e: Floats, v: Floats, load: Floats, gyro: Floats, limit: ArrayLike) -> Floats:
    """
    Moment of a force on the two axes of each branch, with the gyroscopic term, clamped to a limit.

    Parameters
    ----------
    e, v
        Rotation vector in [rad] and its rate in [rad/s], (n, 2).
    load
        Force times lever along b, e1, e2 in [N m], (n, 3).
    gyro, limit
        Inertia of the gyroscopic term in [kg m^2] and largest moment in [N m], (n,).

    Returns
    -------
    Floats
        Moment in [N m], (n, 2).

    """
    e = within_guard(e)
    angles = _angles(e)
    moment = _of_load(e, angles, load) + _gyroscopic(e, v, angles, gyro)
    size = np.linalg.norm(moment, axis=1)
    share = np.minimum(1.0, np.asarray(limit) / np.maximum(size, 1e-300))
    return np.asarray(moment * share[:, None])


class _Angles(NamedTuple):
    """Square t = |e|^2 of the angle of each branch, its sinc and its cosine, (n,)."""

    t: Floats
    sinc: Floats
    cos: Floats


def _angles(e: Floats) -> _Angles:
    t = np.square(e).sum(axis=1)
    angle = np.sqrt(t)
    return _Angles(t, np.sinc(angle / np.pi), np.cos(angle))


def _of_load(e: Floats, angles: _Angles, load: Floats) -> Floats:
    """
    Moment of a load W (n, 3) at any deflection, (n, 2).

    ``W_perp / sinc + e [(e.W) (cos - 1 / sinc) / t - W_b sinc]``
    """
    t, sinc, cos = angles
    along = load[:, 0]
    across = load[:, 1:]
    radial = _over(t, cos - 1.0 / sinc, -2.0 / 3.0 + t / 45.0)
    e_load = (e * across).sum(axis=1)
    pull = e_load * radial - along * sinc
    return np.asarray(across / sinc[:, None] + e * pull[:, None])


def _gyroscopic(e: Floats, v: Floats, angles: _Angles, inertia: Floats) -> Floats:
    """
    Moment of an inertia I whose velocity turns with the sphere, (n, 2).

    With the spin ``L = e x v``, and n across e, it is
    ``I L / t [L (sinc cos - 1) / t e + 2 (e.v) (1 - cos / sinc) / t n]``.
    """
    t, sinc, cos = angles
    sphere = _over(t, sinc * cos - 1.0, -2.0 / 3.0 + 2.0 * t / 15.0)
    turning = _over(t, 1.0 - cos / sinc, 1.0 / 3.0 + t / 45.0)
    spin = e[:, 0] * v[:, 1] - e[:, 1] * v[:, 0]
    momentum = inertia * spin
    per_square = np.zeros_like(t)
    np.divide(momentum, t, out=per_square, where=t > 0.0)
    across = np.stack([-e[:, 1], e[:, 0]], axis=1)
    e_rate = (e * v).sum(axis=1)
    along_e = sphere * spin
    along_n = 2.0 * e_rate * turning
    direction = along_e[:, None] * e + along_n[:, None] * across
    return np.asarray(per_square[:, None] * direction)


def _over(t: Floats, numerator: Floats, series: Floats) -> Floats:
    """Return a numerator over t; near zero the first terms of its series."""
    quotient = numerator / np.maximum(t, _SMALL)
    return np.where(t < _SMALL, series, quotient)
