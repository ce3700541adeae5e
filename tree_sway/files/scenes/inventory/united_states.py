# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Whether places are in the United States, whose foresters measure in inches and feet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats

_SOUTH = 24.0
"""Latitude south of Florida and Texas [deg]."""

_NORTHERN_BORDER = np.array(
    [
        (-125.0, 49.0),
        (-95.2, 49.0),
        (-89.6, 48.0),
        (-84.6, 46.5),
        (-83.0, 45.5),
        (-82.5, 43.0),
        (-82.0, 41.9),
        (-79.0, 42.8),
        (-78.9, 43.5),
        (-76.5, 44.1),
        (-75.0, 45.0),
        (-71.5, 45.0),
        (-70.3, 46.2),
        (-69.2, 47.4),
        (-67.8, 47.1),
        (-66.9, 44.8),
    ]
)
"""Longitude and latitude along the border with Canada, from west to east, roughly [deg]."""


def are_in_states(latitude: Floats, longitude: Floats) -> NDArray[np.bool_]:
    """Whether each place, (n,) in [deg], is in the contiguous United States."""
    border_longitude, border_latitude = _NORTHERN_BORDER.T
    nowhere = -90.0  # west and east of the border's ends
    border = np.interp(longitude, border_longitude, border_latitude, left=nowhere, right=nowhere)
    return np.asarray((latitude > _SOUTH) & (latitude < border))
