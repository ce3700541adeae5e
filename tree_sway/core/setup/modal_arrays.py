# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Arrays of the modes of a tree, by which they are stepped and placed."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.setup.matrices import Reduction
from tree_sway.core.setup.modes import Modes
from tree_sway.core.setup.tree_motion import centre_motion


def modal_arrays(branches: Records, reduction: Reduction, modes: Modes) -> dict[str, Floats]:
    """Find the arrays of `ModalCoordinates`, which can be stored."""
    # One mode after the other, so that loops over coordinates are vectorised.
    shapes = np.ascontiguousarray(modes.shapes.T)
    return {
        'circular': modes.circular,
        'shapes': shapes,
        'diagonal': np.asarray(reduction.stiffness.diagonal()),
        'weight': np.einsum('im,im->m', shapes.T, reduction.gravity @ shapes.T),
        'momentum': reduction.mass @ modes.shapes,
        # Mean squared motion of each load centre, over three directions, (b, m).
        'participation': np.square(centre_motion(branches, modes.shapes)).sum(axis=1) / 2.0,
        'branch_compliance': reduction.compliance,
        'mode_compliance': np.linalg.inv(shapes @ (reduction.branchwise @ shapes.T)),
    }
