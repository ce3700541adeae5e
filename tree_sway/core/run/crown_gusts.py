# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Gusts that reach the limbs of a tree one after another, on models that load every branch.

On a table of winds the native core does the same (``native/limbs.h``).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.model import SwayModel, WIDTH
from tree_sway.core.wind.gusts import CrownWind


class CrownGusts:
    """The wind of a crown, and the branches that feel it."""

    def __init__(self, model: SwayModel, oscillators: Any) -> None:
        """Start without wind."""
        self._delay = model.limb_delay
        self.wind = CrownWind(float(model.limb_spread[0]), model.settings.crown_coherence)
        self._gust = oscillators.loads['gust']

    def push(self, x: float, y: float, z: float, dt: float) -> None:
        """Give each branch its wind in a step of dt [s] with a mean wind [m/s]."""
        apart = self.wind.push(x, y, z, dt)
        block, slot = np.divmod(np.arange(len(self._delay)), WIDTH)
        self._gust[block, :, slot] = apart[self._delay]
