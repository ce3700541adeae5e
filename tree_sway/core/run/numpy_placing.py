# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Key rotations to poses in plain numpy: `placing` without a compiler.

The formulas and records are the same, for whole levels of the tree at a time, with sines and
cosines in place of series.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.numpy_rotation import (
    quaternion_product,
    quaternion_rotated,
    quaternions_of,
)
from tree_sway.core.setup.numpy_branch_loads import NumpyPasses

_BLEND_FROM, _BLEND_TO, _STRETCH_TO = np.deg2rad([30.0, 45.0, 90.0]) ** 2


class NumpyPlacing:
    """Placing of the segments of a tree by its records."""

    def __init__(self, branches: Records, segments: Records) -> None:
        """Lay out the segments in the order of the branches."""
        names = ('parent', 'skew', 'tip_skew', 'offset')
        self._branch: dict[str, NDArray[Any]] = {name: branches[name].copy() for name in names}
        self._branch['base_rotation'] = branches['twist'][:, :, 3:].copy()
        self._passes = NumpyPasses(branches)
        counts = branches['end'] - branches['first']
        owner = np.repeat(np.arange(len(branches)), counts)
        begin = np.cumsum(counts) - counts
        rank = np.arange(int(counts.sum())) - begin[owner]
        self._owner = owner
        """Branch of each segment, in the order of the branches."""
        self._begin = begin
        self._rows = branches['first'][owner] + rank
        """Place of each segment in the pose block."""
        record = branches['first_record'][owner] + rank
        slot = branches['slot'][owner]
        self._segment: dict[str, NDArray[Any]] = {
            name: segments[name][record, ..., slot]
            for name in ('slope', 'tip_slope', 'chord', 'rest')
        }
        # x turns about e2 and y about -e1.
        frame = branches['frame'][owner]
        self._pair = np.stack([frame[:, 2], -frame[:, 1]], axis=1)
        if branches['load_mode'].shape[1] > 2:
            self._segment_turn = segments['segment_turn'][record, ..., slot]
        else:
            self._segment_turn = self._segment['slope'][:, None, None] * self._pair
        place = np.zeros(int(self._rows.max()) + 1, dtype=np.int64)
        place[self._rows] = np.arange(len(self._rows))
        self._base_row = place[np.maximum(branches['base_segment'], 0)]

    def place(
        self,
        rotations: Floats,
        origin: Floats,
        out: Floats,
        cosine: float = 1.0,
        sine: float = 0.0,
        scale: float = 1.0,
    ) -> None:
        """Place every segment, as `placing_by_keys.PlacingByKeys`."""
        segment = self._segment
        owner = self._owner
        angles = self._passes.per_branch(rotations)
        bend = self._bend(angles)
        base = self._turn_bases(angles, cosine, sine)
        turned = quaternion_product(base[owner], bend)
        pose = quaternion_product(turned, segment['rest'])

        ahead = quaternion_rotated(turned, scale * segment['chord'])
        ends = np.vstack([np.zeros(3), np.cumsum(ahead, axis=0)])
        within = ends[:-1] - ends[self._begin][owner]
        start = np.zeros((len(base), 3))
        start[0] = origin
        for level in self._passes.levels:
            on = self._base_row[level]
            offset = quaternion_rotated(pose[on], scale * self._branch['offset'][level])
            start[level] = start[owner[on]] + within[on] + offset

        out[self._rows, :3] = start[owner] + within
        out[self._rows, 3:] = pose[:, [1, 2, 3, 0]]

    def _bend(self, angles: Floats) -> Floats:
        """Find the rotation of each segment from its branch's base by key rotations (b, c)."""
        branch = self._branch
        segment = self._segment
        owner = self._owner
        square = np.square(angles[:, :2]).sum(axis=1)
        blend = np.clip((square - _BLEND_FROM) / (_BLEND_TO - _BLEND_FROM), 0.0, 1.0)
        skew = branch['skew'] + blend * (branch['tip_skew'] - branch['skew'])
        keys = self._stretched(angles, skew)
        difference = blend[owner] * (segment['tip_slope'] - segment['slope'])
        bend = np.einsum('jc,jck->jk', keys[owner], self._segment_turn)
        bend += difference[:, None] * np.einsum('jc,jck->jk', keys[owner, :2], self._pair)
        return quaternions_of(bend)

    def _stretched(self, angles: Floats, skew: Floats) -> Floats:
        """Stretch key rotations (b, c) so that the chord has the angle of the key."""
        square = np.square(angles[:, :2]).sum(axis=1)
        stretched = angles.copy()
        stretched[:, :2] *= (1.0 + np.minimum(square, _STRETCH_TO) * skew)[:, None]
        return stretched

    def _turn_bases(self, angles: Floats, cosine: float, sine: float) -> Floats:
        """Find the orientations of all bases by key rotations (b, c), (b, 4)."""
        branch = self._branch
        carrying = self._stretched(angles, branch['skew'])
        base = np.zeros((len(angles), 4))
        base[0] = cosine, 0.0, 0.0, sine
        for level in self._passes.levels:
            parent = branch['parent'][level]
            turn = self._turns(parent, branch['base_rotation'][level], carrying)
            base[level] = quaternion_product(base[parent], turn)
        return base

    def _turns(self, parent: Ints, turns: Floats, angles: Floats) -> Floats:
        """Find the rotation of bases from their parents' bases by stretched angles."""
        return quaternions_of(np.einsum('bc,bck->bk', angles[parent], turns))
