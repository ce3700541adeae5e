# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The mean sway of all trees that a tree might be: that of one with more damping.

The wood of a species differs from tree to tree, and a mode of circular frequency w and damping
ratio z sways about its frequency by a deviation s of the logarithm. One tree, at the wrong
frequency, is soon out of step with the true one, and then errs by more than one that does not
swing. The mean over all swings fades, ``exp(-z w t - (s w t)^2 / 2)``, and so does the swing of
one mode whose damping ratio is::

    s sqrt(2 / pi) / erfcx(z / (s sqrt(2)))

Both have the same integral, by which they respond to gusts of that frequency, and the same lean in
a steady wind.
"""

from __future__ import annotations

import numpy as np
from scipy.special import erfcx

from tree_sway.core.run.bank import Tunable

WOOD_SPREAD = 0.22
"""
Log-deviation of Young's modulus of clear wood of one species: 22 % (Forest Products Laboratory,
Wood Handbook, 2010, table 5-6).
"""


def damp_by_unknown_wood(tunable: Tunable, spread: float = WOOD_SPREAD) -> None:
    """Let coordinates sway as the mean over trees whose wood has a log-deviation."""
    critical = tunable.critical
    own = tunable.damping / critical - tunable.unknown
    # The weight is known, and what stiffness is by it.
    of_wood = np.abs(1.0 - tunable.weight / tunable.stiffness)
    deviation = np.maximum(0.5 * spread * of_wood, 1e-6)
    mean = deviation * np.sqrt(2.0 / np.pi) / erfcx(own / (np.sqrt(2.0) * deviation))
    tunable.unknown[:] = np.maximum(mean - own, 0.0)
    tunable.damping[:] = (own + tunable.unknown) * critical
