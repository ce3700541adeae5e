# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How strongly the wood damps each coordinate of a tree, over the damping ratio of the tree.

The slowest modes are damped evenly. Dampers in proportion to the stiffness of the wood give the
last of them its ratio, and faster ones more. No damper acts on what stiffness is of the weight:
that of a hanging twig, most of which is its weight, swings long.
"""

from __future__ import annotations

from typing import Any, TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats

if TYPE_CHECKING:
    from tree_sway.core.setup.modes import Modes
    from tree_sway.core.setup.reductions import TreeReductions

EVENLY_DAMPED = 40
"""
Number of natural modes with the damping ratio of the tree.
"""


def stiffness_by_weight(gravity: Any, shapes: Floats) -> Floats:
    """
    Find the stiffness of coordinates by weight in [1/s^2], (m,); negative where it softens one.

    Gravity's part of the stiffness is sparse, (N, N), the shapes are (N, m).
    """
    return np.asarray(np.einsum('im,im->m', shapes, gravity @ shapes))


def relative_damping(reductions: TreeReductions, modes: Modes) -> Floats:
    """Find the damping ratios of coordinates over that of the tree, (m,)."""
    reduction = reductions.with_subtrees.reduction
    count = min(EVENLY_DAMPED, reduction.n_coordinates)
    last_even = float(reductions.natural_modes(count).circular[-1])
    held = np.maximum(stiffness_by_weight(reduction.gravity, modes.shapes), 0.0)
    even = np.maximum(modes.circular / last_even, 1.0)
    return np.asarray(even - held / (modes.circular * last_even))
