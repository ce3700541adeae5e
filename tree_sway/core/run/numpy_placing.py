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
        self._owner = np.repeat(np.arange(len(branches)), counts)
        begin = np.cumsum(counts) - counts
        rank = np.arange(int(counts.sum())) - begin[self._owner]
        self._begin, self._rows = begin, branches['first'][self._owner] + rank
        at, slot = branches['first_record'][self._owner] + rank, branches['slot'][self._owner]
        self._segment: dict[str, NDArray[Any]] = {
            name: segments[name][at, ..., slot] for name in ('slope', 'tip_slope', 'chord', 'rest')
        }
        # x turns about e2 and y about -e1.
        e1, e2 = branches['frame'][self._owner, 1], branches['frame'][self._owner, 2]
        self._pair = np.stack([e2, -e1], axis=1)
        self._segment_turn = self._segment['slope'][:, None, None] * self._pair
        if branches['load_mode'].shape[1] > 2:
            self._segment_turn = segments['segment_turn'][at, ..., slot]
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
        branch, segment, owner = self._branch, self._segment, self._owner
        angles = self._passes.per_branch(rotations)
        t = np.square(angles[:, :2]).sum(axis=1)
        blend = np.clip((t - _BLEND_FROM) / (_BLEND_TO - _BLEND_FROM), 0.0, 1.0)
        stretch = 1.0 + np.minimum(t, _STRETCH_TO) * (
            branch['skew'] + blend * (branch['tip_skew'] - branch['skew'])
        )
        keys = angles.copy()
        keys[:, :2] *= stretch[:, None]
        difference = blend[owner] * (segment['tip_slope'] - segment['slope'])
        bend = np.einsum('jc,jck->jk', keys[owner], self._segment_turn)
        bend += difference[:, None] * np.einsum('jc,jck->jk', keys[owner, :2], self._pair)
        bend = quaternions_of(bend)

        angles[:, :2] *= (1.0 + np.minimum(t, _STRETCH_TO) * branch['skew'])[:, None]
        base = np.zeros((len(t), 4))
        base[0] = cosine, 0.0, 0.0, sine
        for level in self._passes.levels:
            parent = branch['parent'][level]
            turn = self._turns(parent, branch['base_rotation'][level], angles)
            base[level] = quaternion_product(base[parent], turn)
        turned = quaternion_product(base[owner], bend)
        pose = quaternion_product(turned, segment['rest'])

        ahead = quaternion_rotated(turned, scale * segment['chord'])
        ends = np.vstack([np.zeros(3), np.cumsum(ahead, axis=0)])
        within = ends[:-1] - ends[self._begin][owner]
        start = np.zeros((len(t), 3))
        start[0] = origin
        for level in self._passes.levels:
            on = self._base_row[level]
            offset = quaternion_rotated(pose[on], scale * branch['offset'][level])
            start[level] = start[owner[on]] + within[on] + offset

        out[self._rows, :3] = start[owner] + within
        out[self._rows, 3:] = pose[:, [1, 2, 3, 0]]

    def _turns(self, parent: Ints, turns: Floats, angles: Floats) -> Floats:
        """Find the rotation of bases from their parents' bases by stretched angles."""
        return quaternions_of(np.einsum('bc,bck->bk', angles[parent], turns))
