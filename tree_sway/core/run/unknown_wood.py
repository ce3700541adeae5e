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

from tree_sway.core.arrays import Floats


def mean_damping(own: Floats, deviation: Floats) -> Floats:
    """Damping ratios of modes, (m,), as the mean over log-deviations of their frequencies."""
    spread = np.maximum(deviation, 1e-6)
    mean = spread * np.sqrt(2.0 / np.pi) / erfcx(own / (np.sqrt(2.0) * spread))
    return np.asarray(np.maximum(mean, own))
