# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Real spherical harmonics of odd degree, by which the wind load on a tree is expanded.

The opposite wind has the opposite load, so that even degrees do not occur. The functions are
written as harmonic polynomials of the direction (Condon & Shortley's order, no sine or root), each
scaled to a mean square of 1 over the sphere.
"""

from __future__ import annotations

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import part

N_HARMONICS = 21
"""Number of functions up to the highest degree, 5."""

_A3, _B3, _C3, _D3 = (35.0 / 8.0) ** 0.5, 105.0**0.5, (21.0 / 8.0) ** 0.5, 7.0**0.5 / 2.0
_A5, _B5, _C5, _D5, _E5, _F5 = (
    3.0 * (77.0 / 128.0) ** 0.5, 3.0 * (385.0 / 16.0) ** 0.5 / 2.0, (385.0 / 128.0) ** 0.5,
    (1155.0 / 16.0) ** 0.5, (165.0 / 64.0) ** 0.5, 11.0**0.5 / 8.0,
)  # fmt: skip


@part
def fill_harmonics(x: float, y: float, z: float, out: Floats) -> None:
    """Write the functions (`N_HARMONICS`,) at a direction, a unit vector."""
    xx, yy, zz, xy = x * x, y * y, z * z, x * y
    u, v = xx - yy, 2.0 * xy
    s3, c3 = y * (3.0 * xx - yy), x * (xx - 3.0 * yy)
    s4, c4 = 2.0 * u * v, u * u - v * v
    s5, c5 = x * s4 + y * c4, x * c4 - y * s4
    ring = 21.0 * zz * zz - 14.0 * zz + 1.0
    out[0], out[1], out[2] = 3.0**0.5 * y, 3.0**0.5 * z, 3.0**0.5 * x
    out[3], out[9] = _A3 * s3, _A3 * c3
    out[4], out[8] = 0.5 * _B3 * v * z, 0.5 * _B3 * u * z
    out[5], out[7] = _C3 * y * (5.0 * zz - 1.0), _C3 * x * (5.0 * zz - 1.0)
    out[6] = _D3 * z * (5.0 * zz - 3.0)
    out[10], out[20] = _A5 * s5, _A5 * c5
    out[11], out[19] = _B5 * z * s4, _B5 * z * c4
    out[12], out[18] = _C5 * s3 * (9.0 * zz - 1.0), _C5 * c3 * (9.0 * zz - 1.0)
    out[13], out[17] = _D5 * z * v * (3.0 * zz - 1.0), _D5 * z * u * (3.0 * zz - 1.0)
    out[14], out[16] = _E5 * y * ring, _E5 * x * ring
    out[15] = _F5 * z * (63.0 * zz * zz - 70.0 * zz + 15.0)
