# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Spectra of records: their ends, which are faded in and out before, and the power of waves."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Complexes, Floats

_FADED = 0.1
"""Share of a record that is faded at either end."""


def way_in(count: int) -> Floats:
    """Way of each sample of a record from its nearer end into what is not faded, 0 to 1, (n,)."""
    way = np.minimum((np.arange(count) + 0.5) / (_FADED * count), 1.0)
    return np.minimum(way, way[::-1])


def power_of(waves: Complexes) -> Floats:
    """Squared amplitudes of waves of any shape."""
    return np.square(np.abs(waves))
