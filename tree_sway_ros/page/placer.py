# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A receiver in Python: a frame and its description to poses, by the solver's own placing."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.motion.fill_records import head_records, lanes
from tree_sway_ros.core.motion.placing import place_standing_at
from tree_sway_ros.core.motion.records import BRANCH, SEGMENT
from tree_sway_ros.core.state.full_scale import FULL_SCALE
from tree_sway_ros.errors import FormatError
from tree_sway_ros.page.protocol import Array, Description, Frame

_Records = NDArray[np.void]


class Placer:
    """
    Rebuilds the poses of a described tree or scene.

    Parameters
    ----------
    description
        What the sender sent once.

    Raises
    ------
    FormatError
        An array that is missing or does not fit the others.

    """

    def __init__(self, description: Description) -> None:
        """Lay the tree out for the placing kernel."""
        self.description = description
        try:
            self._lay_out(description)
        except (KeyError, IndexError, ValueError) as error:
            raise FormatError(
                f'arrays that do not fit each other ({type(error).__name__}: {error})',
                where='tree description',
                cure='ask the sender for it again',
            ) from None

    @property
    def n_segments(self) -> int:
        """Return the number of segments."""
        return int(self._n)

    def rotations(self, frame: Frame) -> Floats:
        """
        Key rotations of a frame in [rad], (N,).

        Raises
        ------
        FormatError
            A frame of another description.

        """
        if frame.identity != self.description.short_identity:
            raise FormatError(
                f'a frame of description {frame.identity:08x}',
                where='tree state',
                cure=f'this one has {self.description.short_identity:08x}: ask for the new one',
            )
        if len(frame.coordinates) != len(self.description.scale):
            raise FormatError(f'{len(frame.coordinates)} coordinates', where='tree state')
        return self._expanded(frame.coordinates * (self.description.scale / FULL_SCALE))

    def _expanded(self, values: Floats) -> Floats:
        """Key rotations (N,) of coordinates (m,)."""
        out, first, key = np.empty(self._n_keys), 0, 0
        for _, kind in self._trees:
            rows, columns = kind.matrix.shape
            out[key : key + rows] = kind.matrix @ values[first : first + columns]
            key, first = key + rows, first + columns
        return out

    def place(self, frame: Frame) -> Floats:
        """Poses of a frame, (n, 7): x y z in [m] and the quaternion's x y z w."""
        return self.place_rotations(self.rotations(frame))

    def place_coordinates(self, coordinates: Floats) -> Floats:
        """Poses of coordinates in their own unit (m,), (n, 7)."""
        return self.place_rotations(self._expanded(coordinates))

    def place_rotations(self, rotations: Floats) -> Floats:
        """Poses of key rotations (N,) in [rad], (n, 7)."""
        poses, row, key = np.empty((self._n, 7)), 0, 0
        for (x, y, z, yaw, scale), kind in self._trees:
            keys = len(kind.matrix)
            # The last two are what rigid branches turn by.
            own = np.append(rotations[key : key + keys], (0.0, 0.0))
            c, s, end = math.cos(0.5 * yaw), math.sin(0.5 * yaw), row + kind.n_segments
            branches, segments, heads, bases = kind.records
            place_standing_at(
                branches, segments, heads, bases, own, x, y, z, c, s, scale, poses[row:end]
            )
            row, key = end, key + keys
        return poses

    def _lay_out(self, description: Description) -> None:
        header = description.header
        kinds = [_kind(description.of_kind(number)) for number in range(len(header['kinds']))]
        places = description.arrays['tree_place'].astype(np.float64).tolist()
        told = [kinds[tree['kind']] for tree in header['trees']]
        self._trees = list(zip(places, told, strict=True))
        self._n = sum(kind.n_segments for kind in told)
        self._n_keys = sum(len(kind.matrix) for kind in told)


class _Kind(NamedTuple):
    """A kind laid out for the placing kernel."""

    matrix: Floats
    n_segments: int
    records: tuple[_Records, _Records, _Records, Floats]
    """Its branches and segments, heads of these, and scratch."""


def _kind(arrays: dict[str, Array]) -> _Kind:
    first = arrays['branch_first'].astype(np.int64)
    parent = arrays['branch_parent'].astype(np.int64)
    matrix, keys = arrays['basis_matrix'].astype(np.float64), arrays['branch_keys']
    shape = SimpleNamespace(
        branch_first=first, branch_parent=parent, subtree_end=_subtree_ends(parent)
    )
    branches = np.zeros(len(parent), dtype=BRANCH)
    branches['block'], branches['lane'], n_records = lanes(shape, [])  # type: ignore[arg-type]
    branches['parent'] = parent
    branches['base_segment'] = arrays['branch_base_segment']
    branches['first'], branches['end'] = first[:-1], first[1:]
    coordinate = arrays['branch_coordinate']
    branches['coordinate'] = np.where(coordinate < 0, len(matrix), coordinate)
    branches['n_coordinates'] = np.maximum(keys, 2)
    branches['frame'] = arrays['branch_frame']
    branches['skew'], branches['tip_skew'] = arrays['branch_skew'].T
    branches['offset'] = arrays['branch_offset']
    segments = np.zeros(n_records, dtype=SEGMENT)
    segments['rest'][:, 0] = 1.0
    slopes, tips, turns = (arrays[name] for name in ('segment_slope', 'segment_tip_slope', 'turn'))
    base_turn, own_turn = arrays['branch_base_turn'], arrays['branch_turn']
    for branch, record in enumerate(branches):
        if base_turn[branch] >= 0:
            k = int(keys[record['parent']])
            record['twist'][:k, 3:] = turns[base_turn[branch] :][:k]
        here = slice(record['first'], record['end'])
        at, lane = record['block'], record['lane']
        to = slice(at, at + here.stop - here.start)
        segments['slope'][to, lane] = slopes[here]
        segments['tip_slope'][to, lane] = tips[here]
        segments['chord'][to, :, lane] = arrays['segment_chord'][here]
        segments['rest'][to, :, lane] = arrays['segment_rest'][here]
        segments['n_lanes'][to] = np.maximum(segments['n_lanes'][to], lane + 1)
        count, k = here.stop - here.start, int(record['n_coordinates'])
        drawn = np.multiply.outer(slopes[here], [record['frame'][2], -record['frame'][1]])
        if own_turn[branch] >= 0:
            drawn = turns[own_turn[branch] :][: count * k].reshape(count, k, 3)
        segments['turn'][to, :k, :, lane] = drawn
        record['steepest'][:k] = np.square(drawn).sum(axis=2).max(axis=0)
        record['steepest'][0] = max(record['steepest'][0], np.square(tips[here]).max())
    heads = head_records(branches, segments)
    return _Kind(matrix, int(first[-1]), (branches, segments, heads, np.zeros((len(branches), 8))))


def _subtree_ends(parent: Ints) -> Ints:
    """One past the last branch that each branch carries, (b,), of branches depth first."""
    ends = np.arange(1, len(parent) + 1)
    for branch in range(len(parent) - 1, 0, -1):
        ends[parent[branch]] = max(ends[parent[branch]], ends[branch])
    return ends
