# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Real spherical harmonics of odd degree, by which the wind load on a tree is expanded.

The opposite wind has the opposite load, so that even degrees do not occur. The functions are
written as harmonic polynomials of the direction (Condon & Shortley's order, no sine or root), each
scaled to a mean square of 1 over the sphere.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.model import N_HARMONICS

# Scales by degree and order.
_SCALE_1 = 3.0**0.5
_SCALE_30 = 0.5 * 7.0**0.5
_SCALE_31 = (21.0 / 8.0) ** 0.5
_SCALE_32 = 0.5 * 105.0**0.5
_SCALE_33 = (35.0 / 8.0) ** 0.5
_SCALE_50 = 0.125 * 11.0**0.5
_SCALE_51 = (165.0 / 64.0) ** 0.5
_SCALE_52 = (1155.0 / 16.0) ** 0.5
_SCALE_53 = (385.0 / 128.0) ** 0.5
_SCALE_54 = 1.5 * (385.0 / 16.0) ** 0.5
_SCALE_55 = 3.0 * (77.0 / 128.0) ** 0.5


def harmonics_at(directions: Floats) -> Floats:
    """
    Return the functions at directions, unit vectors (k, 3), as (k, `N_HARMONICS`).

    Those of degree n are columns ``c - n .. c + n`` about a centre c: of order m after the
    centre with the cosine of the azimuth, before it with the sine.
    """
    out = np.zeros((N_HARMONICS, len(directions)))
    x, y, z = directions.T
    # Cosine and sine of m times the azimuth, times the m-th power of the horizontal part.
    cosine_2 = x * x - y * y
    sine_2 = 2.0 * x * y
    cosine_3 = x * cosine_2 - y * sine_2
    sine_3 = x * sine_2 + y * cosine_2
    cosine_4 = x * cosine_3 - y * sine_3
    sine_4 = x * sine_3 + y * cosine_3
    cosine_5 = x * cosine_4 - y * sine_4
    sine_5 = x * sine_4 + y * cosine_4
    zz = z * z

    degree_1 = 1
    out[degree_1] = _SCALE_1 * z
    _put_pair(out, degree_1, 1, _SCALE_1, x, y)

    degree_3 = 6
    out[degree_3] = _SCALE_30 * z * (5.0 * zz - 3.0)
    _put_pair(out, degree_3, 1, _SCALE_31 * (5.0 * zz - 1.0), x, y)
    _put_pair(out, degree_3, 2, _SCALE_32 * z, cosine_2, sine_2)
    _put_pair(out, degree_3, 3, _SCALE_33, cosine_3, sine_3)

    degree_5 = 15
    out[degree_5] = _SCALE_50 * z * (63.0 * zz * zz - 70.0 * zz + 15.0)
    _put_pair(out, degree_5, 1, _SCALE_51 * (21.0 * zz * zz - 14.0 * zz + 1.0), x, y)
    _put_pair(out, degree_5, 2, _SCALE_52 * z * (3.0 * zz - 1.0), cosine_2, sine_2)
    _put_pair(out, degree_5, 3, _SCALE_53 * (9.0 * zz - 1.0), cosine_3, sine_3)
    _put_pair(out, degree_5, 4, _SCALE_54 * z, cosine_4, sine_4)
    _put_pair(out, degree_5, 5, _SCALE_55, cosine_5, sine_5)
    return out.T


def _put_pair(
    out: Floats, centre: int, order: int, amount: Floats | float, cosine: Floats, sine: Floats
) -> None:
    """Write the two functions of an order above 0: an amount times cosine and sine."""
    out[centre + order] = amount * cosine
    out[centre - order] = amount * sine
