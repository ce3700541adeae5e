# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The load of a light wind on a branch at rest."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.setup.beams.beam import BranchBeam

_BEARINGS = 8
_ANGLES = (np.arange(_BEARINGS) + 0.5) * np.pi / (2 * _BEARINGS)
_ALONG_SQUARED = np.cos(_ANGLES) ** 2
"""Squared cosine between winds from a quarter of the horizon and the branch's own bearing."""


def wind_loads(beam: BranchBeam, drag_area: Floats) -> Floats:
    """
    Force per length on the branch at rest, of winds from all sides, (p, 5, 3, 3), the wind first.

    It is linear in the wind: per m/s of winds along x, y and z, in air of 1 kg/m^3 and winds along
    the ground of 1 m/s.
    """
    tangent = beam.tangent
    along_branch = tangent[..., :, None] * tangent[..., None, :]
    across_branch = np.eye(3) - along_branch
    exposed = drag_area * exposure(tangent)[..., None]
    loads = exposed[..., None, None] * across_branch[..., None, :, :]
    return np.asarray(loads)


def exposure(tangent: Floats) -> Floats:
    """Return the share of the wind across each panel, averaged over winds from all sides, (m,)."""
    level_squared = 1.0 - tangent[..., 2:] ** 2
    across_squared = 1.0 - level_squared * _ALONG_SQUARED
    share = np.sqrt(across_squared)
    return np.asarray(share.mean(axis=-1))
