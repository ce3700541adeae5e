# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A receiver's side in Python: a frame and its description to poses, by the solver's own placing.

"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.motion.fill_records import head_records, lanes
from tree_sway_ros.core.motion.placing import place
from tree_sway_ros.core.motion.records import BRANCH, SEGMENT, WORK
from tree_sway_ros.core.state.full_scale import FULL_SCALE
from tree_sway_ros.errors import FormatError
from tree_sway_ros.page.protocol import Array, Description, Frame

_Records = NDArray[np.void]
_Tree = tuple[int, int, _Records, _Records, _Records, _Records]
"""First and last segment of a tree, its branches and segments, heads of these, and scratch."""


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
            self._lay_out(description.arrays)
        except (KeyError, IndexError, ValueError) as error:
            raise FormatError(
                f"arrays that do not fit each other ({type(error).__name__}: {error})",
                where="tree description",
                cure="ask the sender for it again",
            ) from None

    @property
    def n_segments(self) -> int:
        """Number of segments."""
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
                f"a frame of description {frame.identity:08x}",
                where="tree state",
                cure=f"this one has {self.description.short_identity:08x}: ask for the new one",
            )
        if len(frame.coordinates) != len(self._scale):
            raise FormatError(f"{len(frame.coordinates)} coordinates", where="tree state")
        return self._expanded(frame.coordinates * (self._scale / FULL_SCALE))

    def _expanded(self, values: Floats) -> Floats:
        """Key rotations (N,) of coordinates (m,)."""
        out = np.zeros(self._n_keys + 2)  # the last two are what rigid branches turn by
        for (key, key_end, first, end), matrix in self._blocks:
            out[key:key_end] = matrix @ values[first:end]
        return out[:-2]

    def place(self, frame: Frame) -> Floats:
        """Poses of a frame, (n, 7): x y z in [m] and the quaternion's x y z w."""
        return self.place_rotations(self.rotations(frame))

    def place_coordinates(self, coordinates: Floats) -> Floats:
        """Poses of coordinates in their own unit (m,), (n, 7)."""
        return self.place_rotations(self._expanded(coordinates))

    def place_rotations(self, rotations: Floats) -> Floats:
        """Poses of key rotations (N,) in [rad], (n, 7)."""
        rotations = np.append(rotations, (0.0, 0.0))
        poses = np.empty((self._n, 7))
        for first, end, branches, segments, heads, work in self._trees:
            place(branches, segments, heads, work, rotations, np.zeros(3), poses[first:end])
        return poses

    def _lay_out(self, arrays: dict[str, Array]) -> None:
        first = arrays["branch_first"].astype(np.int64)
        parent = arrays["branch_parent"].astype(np.int64)
        self._n = int(first[-1])
        self._scale = arrays["basis_scale"].astype(np.float64)
        self._blocks = []
        for key, key_end, begin, end, at in arrays["basis_block"].tolist():
            shape = key_end - key, end - begin
            part = arrays["basis_matrix"][at : at + shape[0] * shape[1]].astype(np.float64)
            self._blocks.append(((key, key_end, begin, end), part.reshape(shape)))
        self._n_keys = int(arrays["basis_block"][:, 1].max())
        roots = np.flatnonzero(parent < 0)
        ends = np.append(roots[1:], len(parent))
        self._trees = [
            self._tree(arrays, first, parent, int(root), int(end))
            for root, end in zip(roots, ends, strict=True)
        ]

    def _tree(
        self, arrays: dict[str, Array], first: Ints, parent: Ints, root: int, end: int
    ) -> _Tree:
        """Records of the branches from a root up to the next one."""
        own, start = slice(root, end), int(first[root])
        rows = slice(start, int(first[end]))
        n_branches = end - root
        shape = SimpleNamespace(
            branch_first=first[root : end + 1] - start,
            branch_parent=np.where(parent[own] < 0, -1, parent[own] - root),
            subtree_end=_subtree_ends(parent[own] - root),
        )
        branches = np.zeros(n_branches, dtype=BRANCH)
        branches["block"], branches["lane"], n_records = lanes(shape, [])  # type: ignore[arg-type]
        branches["parent"] = shape.branch_parent
        branches["base_segment"] = np.where(
            parent[own] < 0, -1, arrays["branch_base_segment"][own] - start
        )
        branches["first"], branches["end"] = shape.branch_first[:-1], shape.branch_first[1:]
        is_rigid = arrays["branch_coordinate"][own] < 0
        branches["coordinate"] = np.where(is_rigid, self._n_keys, arrays["branch_coordinate"][own])
        branches["n_coordinates"] = np.maximum(arrays["branch_keys"][own], 2)
        branches["frame"] = arrays["branch_frame"][own]
        branches["skew"], branches["tip_skew"] = arrays["branch_skew"][own].T
        branches["offset"] = arrays["branch_offset"][own]
        segments = np.zeros(n_records, dtype=SEGMENT)
        segments["rest"][:, 0] = 1.0
        slopes, tips = arrays["segment_slope"][rows], arrays["segment_tip_slope"][rows]
        keys, turns = arrays["branch_keys"][own], arrays["turn"]
        base_turn, own_turn = arrays["branch_base_turn"][own], arrays["branch_turn"][own]
        for branch, record in enumerate(branches):
            if base_turn[branch] >= 0:
                k = int(keys[record["parent"]])
                record["twist"][:k, 3:] = turns[base_turn[branch] :][:k]
            here = slice(record["first"], record["end"])
            at, lane = record["block"], record["lane"]
            to = slice(at, at + here.stop - here.start)
            segments["slope"][to, lane] = slopes[here]
            segments["tip_slope"][to, lane] = tips[here]
            segments["chord"][to, :, lane] = arrays["segment_chord"][rows][here]
            segments["rest"][to, :, lane] = arrays["segment_rest"][rows][here]
            segments["n_lanes"][to] = np.maximum(segments["n_lanes"][to], lane + 1)
            count, k = here.stop - here.start, int(record["n_coordinates"])
            drawn = np.multiply.outer(slopes[here], [record["frame"][2], -record["frame"][1]])
            if own_turn[branch] >= 0:
                drawn = turns[own_turn[branch] :][: count * k].reshape(count, k, 3)
            segments["turn"][to, :k, :, lane] = drawn
            record["steepest"][:k] = np.square(drawn).sum(axis=2).max(axis=0)
            record["steepest"][0] = max(record["steepest"][0], np.square(tips[here]).max())
        heads = head_records(branches, segments)
        work = np.zeros(n_branches, dtype=WORK)
        return start, rows.stop, branches, segments, heads, work


def _subtree_ends(parent: Ints) -> Ints:
    """One past the last branch that each branch carries, (b,), of branches depth first."""
    ends = np.arange(1, len(parent) + 1)
    for branch in range(len(parent) - 1, 0, -1):
        ends[parent[branch]] = max(ends[parent[branch]], ends[branch])
    return ends
