# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Whether places are in the United States, whose foresters measure in inches and feet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.tables import table_beside

_SOUTH = 24.0
"""Latitude south of Florida and Texas [deg]."""

_NORTHERN_BORDER = np.array(
    [tuple(row.values()) for row in table_beside(__file__, 'northern_border.csv')]
)
"""Longitude and latitude along the border with Canada, from west to east, roughly [deg]."""


def are_in_states(latitude: Floats, longitude: Floats) -> NDArray[np.bool_]:
    """Whether each place, (n,) in [deg], is in the contiguous United States."""
    border_longitude, border_latitude = _NORTHERN_BORDER.T
    nowhere = -90.0  # west and east of the border's ends
    border = np.interp(longitude, border_longitude, border_latitude, left=nowhere, right=nowhere)
    return np.asarray((latitude > _SOUTH) & (latitude < border))
