# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The mean wind at which a tree reaches its strength, from the shares that it uses in some winds.

The share of strength is taken as a power of the wind speed between two winds, near which the tree
reaches it.
"""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np

from tree_sway.core.arrays import Floats

_LEAST_POWER = 0.8
_LARGEST_POWER = 2.5


@dataclass(frozen=True)
class ShareCurve:
    """Shares of strength used in the largest gust [-] by mean wind speeds [m/s], (n,), rising."""

    speed: Floats
    share: Floats

    def speed_of(self, share: float) -> float:
        """Return the wind at which a share is used, by a power law through the two nearest."""
        log_speed = np.log(self.speed)
        log_share = np.log(np.maximum(self.share, 1e-9))
        wanted = math.log(share)
        # The pair of neighbours around the share, or the pair at the end that is nearer to it.
        right = int(np.clip(np.searchsorted(log_share, wanted), 1, len(log_share) - 1))
        step = log_speed[right] - log_speed[right - 1]
        power = (log_share[right] - log_share[right - 1]) / step
        power = min(max(float(power), _LEAST_POWER), _LARGEST_POWER)
        near = right - int(abs(log_share[right - 1] - wanted) < abs(log_share[right] - wanted))
        return math.exp(float(log_speed[near] + (wanted - log_share[near]) / power))
