# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Strain of the outermost fibres along every branch, from the curvature of its fields."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.setup.reductions import TreeReductions


class WoodStrain:
    """
    Strain of a tree's wood beyond that at rest.

    Parameters
    ----------
    reductions
        Reductions of the tree; the one for the model of its settings is used.

    """

    branch: Ints
    """Branch of each segment, (m,)."""
    height: Floats
    """Height of the middle of each segment above the base of the tree at rest in [m], (m,)."""

    def __init__(self, reductions: TreeReductions) -> None:
        """Find the curvature by each coordinate."""
        reduced = reductions.reduced(reductions.settings.model)
        blocks = []
        radii = []
        for model in reduced.models:
            beam = model.beam
            along = beam.tangent[:, None, :]
            bent = [
                field.curvature - (field.curvature * along).sum(axis=-1, keepdims=True) * along
                for field in model.fields
            ]
            mean = np.stack([beam.over_segments(each) for each in bent], axis=-1)
            blocks.append(mean.reshape(-1, len(bent)))
            radii.append(0.5 * beam.over_segments(beam.diameter))
        self._curvature = sparse.block_diag(blocks, format='csr')
        self._radius = np.concatenate(radii)
        tree = reduced.tree
        self.branch = np.repeat(reduced.branch, [len(radius) for radius in radii])
        self.height = 0.5 * (tree.start[:, 2] + tree.end[:, 2]) - tree.start[0, 2]

    def of(self, rotations: Floats) -> Floats:
        """Largest strain over a section, mean over each segment, (m,), by key rotations (N,)."""
        curvature = (self._curvature @ rotations).reshape(-1, 3)
        return np.asarray(np.sqrt(np.einsum('mi,mi->m', curvature, curvature)) * self._radius)
