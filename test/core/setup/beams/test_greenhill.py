# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Greenhill's length is where the equation of the bent column has its first root."""

from __future__ import annotations

import pytest
from scipy import special
from scipy.optimize import brentq

from tree_sway.core.setup.beams.greenhill import greenhill_length


def test_greenhills_number_is_the_bessel_zero():
    zero = brentq(lambda x: special.jv(-1.0 / 3.0, x), 1.5, 2.2, xtol=1e-13)
    assert greenhill_length(1.0, 1.0) == pytest.approx((2.25 * zero**2) ** (1 / 3), rel=1e-5)
