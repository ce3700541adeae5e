# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The segment that a point lies on, where a branch is joined to another."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats


def nearest_axis(start: Floats, end: Floats, point: Floats) -> tuple[int, float]:
    """Return the number of the axis (n, 3) nearest to a point, and its distance [m]."""
    axis = end - start
    squared = np.maximum(np.einsum('ij,ij->i', axis, axis), 1e-24)
    along = np.clip(np.einsum('ij,ij->i', point - start, axis) / squared, 0.0, 1.0)
    distance = np.linalg.norm(start + along[:, None] * axis - point, axis=1)
    best = int(np.argmin(distance))
    return best, float(distance[best])
