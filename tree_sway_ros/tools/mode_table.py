# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Natural modes for people: frequency, damping, direction, and the branch that bends most."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.motion.modal import ModalBank
from tree_sway_ros.core.motion.uncoupled import UncoupledBank
from tree_sway_ros.core.simulator.assembly import Bank
from tree_sway_ros.core.tree.rest_frame import ends_of_poses
from tree_sway_ros.core.tree.tree import Tree

_SMALL_ANGLE = 1e-4


@dataclass(frozen=True)
class ModeRow:
    """
    A natural mode: frequency [Hz] and damping ratio of wood and leaves, both without air.

    ``axis`` is the unit vector (its sign means nothing) that most of the moving mass sways along,
    ``branch`` the one that bends most.
    """

    frequency: float
    damping_ratio: float
    axis: Floats
    branch: str

    @property
    def direction(self) -> str:
        """Tell the axis for people: degrees from east to north, and upwards if not level."""
        x, y, z = self.axis if self.axis[np.argmax(np.abs(self.axis))] > 0.0 else -self.axis
        level = float(np.hypot(x, y))
        up = float(np.degrees(np.arctan2(z, level)))
        if abs(up) > 80.0:
            return 'up and down'
        azimuth = float(np.degrees(np.arctan2(y, x))) % 180.0
        side = up if y > 0.0 or (y == 0.0 and x > 0.0) else -up
        return f'{azimuth:5.1f} deg' + (f', {side:+.0f} up' if abs(side) >= 10.0 else '')


def mode_table(tree: Tree, bank: Bank, count: int) -> list[ModeRow]:
    """
    List so many of the slowest modes of one model of a tree; none of a frozen one.

    Where branches swing on their own, each has a mode per branch and axis.
    """
    frequencies, ratios, shapes = _modes(bank, count)
    owner = np.repeat(np.arange(tree.n_branches), bank.branches['n_coordinates'])
    rows = []
    for frequency, ratio, shape in zip(frequencies, ratios, shapes.T, strict=True):
        branch = int(owner[np.argmax(np.abs(shape))])
        axis = _axis(tree, bank, shape)
        rows.append(ModeRow(float(frequency), float(ratio), axis, tree.branch_names[branch]))
    return rows


def _modes(bank: Bank, count: int) -> tuple[Floats, Floats, Floats]:
    """Frequencies in [Hz], damping ratios and key rotations (N, m) of the slowest modes."""
    oscillators = bank.oscillators
    if isinstance(oscillators, ModalBank):
        circular = np.sqrt(oscillators.stiffness[:count])
        ratios = oscillators.damping[:count] / (2.0 * circular)
        return circular / (2.0 * np.pi), ratios, oscillators.shapes[:, :count]
    if not isinstance(oscillators, UncoupledBank):
        return np.zeros(0), np.zeros(0), np.zeros((0, 0))
    circular = np.repeat(np.sqrt(oscillators.stiffness / oscillators.inertia), 2)
    ratios = np.repeat(oscillators.damping / oscillators.inertia, 2) / (2.0 * circular)
    slowest = np.argsort(circular, kind='stable')[:count]
    shapes = np.zeros((len(circular), len(slowest)))
    shapes[slowest, np.arange(len(slowest))] = 1.0
    return circular[slowest] / (2.0 * np.pi), ratios[slowest], shapes


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
