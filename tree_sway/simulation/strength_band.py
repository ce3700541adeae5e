# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The band of a used share of strength: 80 % of trees are within it.

What a tree can bear and what the wind does to it are known with a spread each. They are taken as
independent and log-normal, so that the variances of their logarithms add up. Log-deviations:

- wood 0.16: small clear specimens of one species (Forest Products Laboratory, Wood Handbook, 2010,
  table 5-6). Knots take up to 15 % of that (Gardiner et al. 2000, Ecological Modelling 129, 1-23);
  any value up to 15 % is as likely as another, which moves the band.
- roots 0.43: 0.33 of trees of one species and size (283 trees that were pulled over, residual of
  table A1 in Detter, Rust & Krisans 2023, Forests 14, 533), and 0.27 of species, whose moments are
  145.6, 118.6, 94.5 and 77.4 N m per kg of the stem (Byrne 2005).
- drag 0.25: crowns of one kind (three hardwoods in Vollsinger et al. 2005: 0.15 to 0.22 at 20 m/s;
  Mayhead 1973).
- leaves 0.35, in leaf: area per section of the stem within a factor of two (`LeafTraits`).
- wind at the crown 0.3 of the load, 0.15 of the speed: an estimate; no source has it for one tree
  and one anemometer.
"""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.drag import DRAG, LEAVES, WIND

WOOD, KNOTS = 0.16, 0.15
"""Log-deviation of clear wood, and the largest part of its strength that knots take [-]."""

ROOTS_OF_A_SPECIES, ROOTS_OF_SPECIES = 0.33, 0.27
"""Log-deviations of the strength of roots, of trees of one species and size, and of species."""

_DEVIATIONS = 1.2816
"""Standard deviations on both sides of the mean that hold `SHARE_WITHIN` of a normal variable."""


def wood_band(*, in_leaf: bool) -> Floats:
    """Return 1 and the bounds of the used share of the strength of wood over it, (3,)."""
    most = -math.log(1.0 - KNOTS)
    return _band(math.hypot(WOOD, most / math.sqrt(12.0), _load(in_leaf)), 0.5 * most)


def root_band(*, in_leaf: bool) -> Floats:
    """Return 1 and the bounds of the used share of the strength of roots over it, (3,)."""
    return _band(math.hypot(ROOTS_OF_A_SPECIES, ROOTS_OF_SPECIES, _load(in_leaf)))


def load_band(*, in_leaf: bool) -> Floats:
    """Return 1 and the bounds of a moment by the wind over it, (3,)."""
    return _band(_load(in_leaf))


def _load(in_leaf: bool) -> float:
    """Log-deviation of the load."""
    return math.hypot(DRAG, WIND, LEAVES if in_leaf else 0.0)


def _band(deviation: float, shift: float = 0.0) -> Floats:
    away = _DEVIATIONS * deviation
    return np.array([1.0, math.exp(shift - away), math.exp(shift + away)])
