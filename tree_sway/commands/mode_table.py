# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Natural modes for people: frequency, damping, direction, and the branch that bends most."""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.simulator.assembly import assembled
from tree_sway.core.simulator.bank import Bank
from tree_sway.core.simulator.reductions import TreeReductions
from tree_sway.core.simulator.settings import Settings
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.core.tree.species import Species
from tree_sway.core.tree.tree import Tree

_SMALL_ANGLE = 1e-4


def direction_of(axis: Floats) -> str:
    """Describe an axis, whose sign means nothing: degrees from east to north, and upwards."""
    x, y, z = axis if axis[np.argmax(np.abs(axis))] > 0.0 else -axis
    up = float(np.degrees(np.arctan2(z, np.hypot(x, y))))
    if abs(up) > 80.0:
        return 'up and down'
    azimuth = float(np.degrees(np.arctan2(y, x))) % 180.0
    side = up if y > 0.0 or (y == 0.0 and x > 0.0) else -up
    return f'{azimuth:5.1f} deg' + (f', {side:+.0f} up' if abs(side) >= 10.0 else '')


def mode_table(
    tree: Tree, species: Species, settings: Settings, count: int
) -> tuple[list[dict[str, Any]], float]:
    """
    List the slowest natural modes of a tree, a number of them or all, and its mass in [kg].

    A mode has frequency [Hz] and damping ratio of wood and leaves, both without air, the axis that
    most of the moving mass sways along, and the branch that bends most.
    """
    whole = TreeReductions(tree, species, settings)
    bank = assembled(whole, 0)
    modes = whole.natural_modes(min(count, whole.coupled.reduction.n_coordinates))
    reduced = whole.coupled
    owner = np.repeat(reduced.branch, reduced.branches['n_coordinates'])
    rows = []
    for frequency, shape in zip(modes.frequencies.tolist(), modes.shapes.T, strict=True):
        axis = _axis(tree, bank, shape)
        rows.append(
            {
                'frequency': frequency,
                'damping_ratio': whole.damping_ratio,
                'axis': [round(component, 6) for component in axis.tolist()],
                'direction': direction_of(axis),
                'branch': tree.branch_names[int(owner[np.argmax(np.abs(shape))])],
            }
        )
    return rows, bank.mass


def _axis(tree: Tree, bank: Bank, shape: Floats) -> Floats:
    """Principal direction of the motion of the wood in a mode, (3,)."""
    poses = np.zeros((tree.n_segments, 7))
    small = _SMALL_ANGLE / np.abs(shape).max() * shape
    bank.place(small, tree.start[0], poses)
    start, end = ends_of_poses(poses, tree.length)
    moved = (start + end - tree.start - tree.end) / (2.0 * _SMALL_ANGLE)
    _, axes = np.linalg.eigh(np.einsum('n,ni,nj->ij', tree.volume, moved, moved))
    axis: Floats = axes[:, -1]
    return axis
