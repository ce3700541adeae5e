# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Ends of a record, which are faded in and out before it is transformed."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats

_FADED = 0.1
"""Share of a record that is faded at either end."""


def way_in(count: int) -> Floats:
    """Way of each sample of a record from its nearer end into what is not faded, 0 to 1, (n,)."""
    way = np.minimum((np.arange(count) + 0.5) / (_FADED * count), 1.0)
    return np.minimum(way, way[::-1])
