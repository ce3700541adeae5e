# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The load of a light wind on a branch at rest."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.beams.beam import BranchBeam

_BEARINGS = 8
_ALONG_SQUARED = np.cos((np.arange(_BEARINGS) + 0.5) * np.pi / (2 * _BEARINGS)) ** 2
"""Squared cosine between winds from a quarter of the horizon and the branch's own bearing."""


def wind_loads(beam: BranchBeam, drag_area: Floats) -> Floats:
    """
    Force per length on the branch at rest, of winds from all sides, (p, 5, 3, 3), the wind first.

    It is linear in the wind: per m/s of winds along x, y and z, in air of 1 kg/m^3 and winds along
    the ground of 1 m/s.
    """
    tangent = beam.tangent
    across_branch = np.eye(3) - tangent[..., :, None] * tangent[..., None, :]
    exposed = drag_area * exposure(tangent)[..., None]
    return np.asarray(exposed[..., None, None] * across_branch[..., None, :, :])


def exposure(tangent: Floats) -> Floats:
    """Return the share of the wind across each panel, averaged over winds from all sides, (m,)."""
    level_squared = 1.0 - tangent[..., 2:] ** 2
    return np.asarray(np.sqrt(1.0 - level_squared * _ALONG_SQUARED).mean(axis=-1))
