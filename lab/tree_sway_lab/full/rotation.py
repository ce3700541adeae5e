# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Rotations of the hot path, as scalars: quaternions w x y z and rotation vectors.

They are compiled into their callers, without arrays or allocation.
"""

from __future__ import annotations

import math

from tree_sway_lab.kernel import part

SERIES_LIMIT = 2.25
"""Squared half angle in [rad^2] up to which `half_angle_series` is valid: 1.5 rad."""

NEAR_LIMIT = 0.04
"""Squared half angle in [rad^2] up to which `half_angle_near` is valid: 0.2 rad."""

_C0, _C1, _C2, _C3, _C4, _C5, _C6, _C7, _C8 = (
    (-1.0) ** k / math.factorial(2 * k) for k in range(9)
)
_S0, _S1, _S2, _S3, _S4, _S5, _S6, _S7, _S8 = (
    (-1.0) ** k / math.factorial(2 * k + 1) for k in range(9)
)


@part
def half_angle_series(t: float) -> tuple[float, float]:
    """Return the same as `half_angle`, by series, for t up to `SERIES_LIMIT`."""
    cosine = _C8 * t + _C7
    sinc = _S8 * t + _S7
    cosine = cosine * t + _C6
    sinc = sinc * t + _S6
    cosine = cosine * t + _C5
    sinc = sinc * t + _S5
    cosine = cosine * t + _C4
    sinc = sinc * t + _S4
    cosine = cosine * t + _C3
    sinc = sinc * t + _S3
    cosine = cosine * t + _C2
    sinc = sinc * t + _S2
    cosine = cosine * t + _C1
    sinc = sinc * t + _S1
    cosine = cosine * t + _C0
    sinc = sinc * t + _S0
    return cosine, sinc


@part
def half_angle_near(t: float) -> tuple[float, float]:
    """Return the same as `half_angle`, for t up to `NEAR_LIMIT` (error below 3e-14)."""
    cosine = _C4 * t + _C3
    sinc = _S4 * t + _S3
    cosine = cosine * t + _C2
    sinc = sinc * t + _S2
    cosine = cosine * t + _C1
    sinc = sinc * t + _S1
    cosine = cosine * t + _C0
    sinc = sinc * t + _S0
    return cosine, sinc


@part
def half_angle(t: float) -> tuple[float, float]:
    """
    Cosine of ``sqrt(t)`` and sine over it, t the square of half the angle in [rad^2].

    By series up to 1.5 rad (error below 3e-13), exact beyond.
    """
    if t > SERIES_LIMIT:
        root = math.sqrt(t)
        return math.cos(root), math.sin(root) / root
    return half_angle_series(t)


@part
def quaternion(rx: float, ry: float, rz: float) -> tuple[float, float, float, float]:
    """Return the unit quaternion of a rotation vector in [rad]."""
    hx = 0.5 * rx
    hy = 0.5 * ry
    hz = 0.5 * rz
    c, s = half_angle(hx * hx + hy * hy + hz * hz)
    return c, s * hx, s * hy, s * hz


@part
def product(
    aw: float, ax: float, ay: float, az: float, bw: float, bx: float, by: float, bz: float
) -> tuple[float, float, float, float]:
    """Return the quaternion of b followed by a."""
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


@part
def rotated(
    w: float, x: float, y: float, z: float, vx: float, vy: float, vz: float
) -> tuple[float, float, float]:
    """Rotate a vector by a unit quaternion."""
    tx = 2.0 * (y * vz - z * vy)
    ty = 2.0 * (z * vx - x * vz)
    tz = 2.0 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )


@part
def turned(
    rx: float, ry: float, rz: float, vx: float, vy: float, vz: float
) -> tuple[float, float, float]:
    """
    Rotate a vector by a rotation vector through Cayley's map, without root, sine or cosine.

    That map is always a rotation, by the angle 2 atan(|r| / 2). So the vector is stretched first,
    by the series of the tangent: the error of the angle is 1e-4 at 1 rad and 2 % at 2 rad. The
    opposite rotation vector inverts it to rounding.
    """
    t = rx * rx + ry * ry + rz * rz
    half = 0.5 + t * (1.0 / 24.0 + t * (1.0 / 240.0 + t * (17.0 / 40320.0)))
    hx = half * rx
    hy = half * ry
    hz = half * rz
    f = 2.0 / (1.0 + hx * hx + hy * hy + hz * hz)
    cx = hy * vz - hz * vy
    cy = hz * vx - hx * vz
    cz = hx * vy - hy * vx
    return (
        vx + f * (cx + hy * cz - hz * cy),
        vy + f * (cy + hz * cx - hx * cz),
        vz + f * (cz + hx * cy - hy * cx),
    )
