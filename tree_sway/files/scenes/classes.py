# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Classes of trees that share one grown tree, scaled to each.

Those of one species are of a class whose heights are within a factor of three, and whose heights
over diameters are within a factor of 1.3.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats

_HEIGHTS = 3.0
_SLENDERNESSES = 1.3


class KindClasses(NamedTuple):
    """Height [m] and height over diameter, 0 if unknown, of each tree's grown tree, (n,)."""

    height: Floats
    slenderness: Floats


def own_kinds(height: Floats, diameter: Floats) -> KindClasses:
    """Each tree is its own class; diameters are NaN where unknown."""
    return KindClasses(height, np.nan_to_num(height / diameter))


def kind_classes(
    keys: Sequence[str],
    height: Floats,
    diameter: Floats,
    *,
    heights: float = _HEIGHTS,
    slendernesses: float = _SLENDERNESSES,
) -> KindClasses:
    """
    Return the classes of trees by species, height [m] and diameter [m], NaN where unknown.

    ``heights`` and ``slendernesses`` are the factors within which one class is.
    """
    sizes = np.array(height)
    slender = np.zeros(len(keys))
    named = np.array(keys)
    ratio = np.nan_to_num(height / diameter)
    has_ratio = ratio > 0.0
    for key, is_known in set(zip(keys, has_ratio.tolist(), strict=True)):
        own = np.flatnonzero((named == key) & (has_ratio == is_known))
        groups = _steps(height[own], heights)
        if is_known:
            groups = 1000 * groups + _steps(ratio[own], slendernesses)
        for group in np.unique(groups):
            of_one = own[groups == group]
            sizes[of_one] = _middle(height[of_one])
            if is_known:
                slender[of_one] = _middle(ratio[of_one])
    return KindClasses(sizes, slender)


def _steps(values: Floats, factor: float) -> Floats:
    """Class of each value, such that values of a class are within a factor."""
    return np.round(np.log(values / np.median(values)) / math.log(factor))


def _middle(values: Floats) -> float:
    return float(np.exp(np.log(values).mean()))
