# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Strain of the outermost fibres along every branch, from the curvature of its fields."""

from __future__ import annotations

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy import sparse

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.setup import BranchBeam, N_POINTS, round_section, TreeReductions

_TO_BASE = np.linalg.pinv(np.vander((leggauss(N_POINTS)[0] + 1.0) / 2.0, 3))[-1]
"""Weights of the points of a panel for the value at its begin of the nearest parabola."""


class WoodStrain:
    """
    Strain of a tree's wood beyond that at rest.

    Each segment has two places: its base end, where a branch cut into few segments is bent most,
    and its middle, with the mean over the segment.

    Parameters
    ----------
    reductions
        Reductions of the tree; the one for the model of its settings is used.
    n_branches
        Branches that are read, the first; the first is the stem. All if None.

    """

    branch: Ints
    """Branch of each place, (2 m,): the base ends of all segments, then their middles."""
    height: Floats
    """Height of each place above the base of the tree at rest in [m], (2 m,)."""

    def __init__(self, reductions: TreeReductions, n_branches: int | None = None) -> None:
        """Find the curvature by each coordinate."""
        reduced = reductions.reduced
        tree = reduced.tree
        at_base = []
        in_middle = []
        radii = []
        for number, model in enumerate(reduced.models[:n_branches]):
            beam = model.beam
            base_diameter = tree.base_diameter[tree.segments_of(number)]
            bent = [_bending_of_wood(beam, field.curvature) for field in model.fields]
            bases = [_at_base_ends(beam, each, base_diameter) for each in bent]
            means = [beam.over_segments(each) for each in bent]
            at_base.append(np.stack(bases, axis=-1).reshape(-1, len(bent)))
            in_middle.append(np.stack(means, axis=-1).reshape(-1, len(bent)))
            radii.append(0.5 * beam.over_segments(beam.diameter))
        blocks = [sparse.block_diag(each, format='csr') for each in (at_base, in_middle)]
        self._curvature = sparse.vstack(blocks, format='csr')
        branch = np.repeat(reduced.branch[: len(radii)], [len(radius) for radius in radii])
        self.branch = np.tile(branch, 2)
        start = tree.start[: len(branch), 2]
        self._radius = np.concatenate([0.5 * tree.base_diameter[: len(branch)], *radii])
        middle = 0.5 * (start + tree.end[: len(branch), 2])
        self.height = np.concatenate([start, middle]) - start[0]

    def of(self, rotations: Floats) -> Floats:
        """Largest strain over the section at each place, (2 m,), by key rotations (N,)."""
        curvature = (self._curvature @ rotations[: self._curvature.shape[1]]).reshape(-1, 3)
        return np.asarray(np.sqrt(np.einsum('mi,mi->m', curvature, curvature)) * self._radius)


def _bending_of_wood(beam: BranchBeam, curvature: Floats) -> Floats:
    """
    Part of a curvature (p, 5, 3) at the points that bends the wood: without twist.

    A spring of the roots is in series with the wood of the first point; the wood has only its own
    part of the curvature there.
    """
    along = beam.tangent[:, None, :]
    twist = (curvature * along).sum(axis=-1, keepdims=True)
    wood_share = beam.second_moment / round_section(beam.diameter)
    return np.asarray(wood_share[..., None] * (curvature - twist * along))


def _at_base_ends(beam: BranchBeam, curvature: Floats, base_diameter: Floats) -> Floats:
    """
    Curvature at the base end of each segment [1/m], (m, 3), from that at the points, (p, 5, 3).

    The moment, curvature times second moment of area, is taken on from the points of the first
    panel by a parabola, that of an even load.
    """
    moment = round_section(beam.diameter)[..., None] * curvature
    first = np.searchsorted(beam.segment, np.arange(len(base_diameter)))
    at_base = np.einsum('g,mgi->mi', _TO_BASE, moment[first])
    return np.asarray(at_base / round_section(base_diameter)[:, None])
