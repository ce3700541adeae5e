# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Internal force and moment of a tree of tapered elements at rest under its own weight.

A tree is statically determinate: what a section carries is the weight beyond it, whatever the
wood.

"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway_lab.frame.element import POINTS, WEIGHTS


@dataclass(frozen=True, eq=False)
class SelfWeight:
    """
    What the tip's side of each section exerts on the root's side, world axes.

    Parameters
    ----------
    force, moment
        At the Gauss points in [N] and [N m], (m, 5, 3).
    base_force
        At the start of each element in [N], (m, 3).

    """

    force: Floats
    moment: Floats
    base_force: Floats

    def offset_stiffness(self, offset: Floats) -> Floats:
        """Stiffness of a rigid offset in [m] on its node's rotation in [N m/rad], (m, 3, 3)."""
        outer = np.einsum('mi,mj->mij', self.base_force, offset)
        along = np.einsum('mi,mi->m', self.base_force, offset)
        turned: Floats = along[:, None, None] * np.eye(3) - 0.5 * (
            outer + outer.transpose(0, 2, 1)
        )
        return turned


def self_weight(
    start_node: Ints,
    offset: Floats,
    axis: Floats,
    length: Floats,
    diameter: Floats,
    diameter_step: Floats,
    weight_density: float,
) -> SelfWeight:
    """
    Add up the weight beyond each Gauss point.

    Parameters
    ----------
    start_node
        Node that each element starts at, (m,); element i ends at node i + 1, and starts at a
        node below i + 1.
    offset
        Start of each element from that node in [m], (m, 3).
    axis, length
        Unit vector (m, 3) and length in [m], (m,).
    diameter, diameter_step
        Diameter at the start, and its change over the element, in [m], (m,).
    weight_density
        Density times gravity in [N/m^3].

    """
    down = np.array([0.0, 0.0, -1.0])
    weight, lever = _beyond(np.zeros(1), length, diameter, diameter_step, weight_density)
    end_force = np.zeros((len(length) + 1, 3))
    end_moment = np.zeros((len(length) + 1, 3))
    base_force = np.zeros((len(length), 3))
    for i in range(len(length) - 1, -1, -1):
        force, moment = end_force[i + 1], end_moment[i + 1]
        base_force[i] = force + weight[i, 0] * down
        base_moment = moment + np.cross(axis[i], length[i] * force + lever[i, 0] * down)
        node = start_node[i]
        end_force[node] += base_force[i]
        end_moment[node] += base_moment + np.cross(offset[i], base_force[i])
    weight, lever = _beyond(POINTS, length, diameter, diameter_step, weight_density)
    force = end_force[1:, None] + weight[..., None] * down
    arm = (length[:, None] * (1.0 - POINTS))[..., None] * end_force[1:, None] + lever[
        ..., None
    ] * down
    return SelfWeight(force, end_moment[1:, None] + np.cross(axis[:, None], arm), base_force)


def _beyond(
    place: Floats, length: Floats, diameter: Floats, step: Floats, weight_density: float
) -> tuple[Floats, Floats]:
    """Weight of each element beyond these places of it in [N], and its first moment about them."""
    ahead = place[:, None] + (1.0 - place[:, None]) * POINTS
    share = (1.0 - place[:, None]) * WEIGHTS
    area = np.pi / 4.0 * (diameter[:, None, None] + step[:, None, None] * ahead) ** 2
    line = weight_density * length[:, None, None] * area * share
    return line.sum(axis=2), (line * (ahead - place[:, None])).sum(axis=2) * length[:, None]
