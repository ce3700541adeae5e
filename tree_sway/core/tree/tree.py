# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tree: read-only arrays of segments, grouped in branches, in depth-first order.

The order is the data structure: segments of a branch are contiguous; branches are in depth-first
order, so that a branch comes after its parent and its subtree is one contiguous slice. Sums over
subtrees are then one backward pass and joining from the root is one forward pass.

Symbols: n segments, b branches. SI units; z points up, the frame is ENU (REP-103).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.tree.segment_frame import ends_of_poses, quaternions_from_x
from tree_sway.drawn import Drawn

_Number = TypeVar('_Number', np.float64, np.int64)


@dataclass(frozen=True, eq=False)
class Tree(Drawn):
    """
    A tree of straight segments; build it with `tree_from_segments`, which checks and orders.

    Parameters
    ----------
    start, end
        Root-side and tip-side node of each segment in [m], (n, 3).
    base_diameter, tip_diameter
        Diameter at the start and at the end of each segment in [m], (n,).
    segment_parent
        Parent of each segment, -1 for the root, (n,).
    branch_first
        First segment of each branch, and n at the end, (b + 1,).
    branch_parent
        Parent of each branch, -1 for the stem, (b,).
    subtree_end
        One past the last branch of the subtree of each branch, (b,): that of branch i is ``i ..
        subtree_end[i] - 1``.
    source_index
        Position of each segment in the input it was built from, (n,).
    branch_names
        One name per branch.
    name, species
        Name of the tree, and key of its species in the table.

    """

    start: Floats
    end: Floats
    base_diameter: Floats
    tip_diameter: Floats
    segment_parent: Ints
    branch_first: Ints
    branch_parent: Ints
    subtree_end: Ints
    source_index: Ints
    branch_names: tuple[str, ...]
    name: str = 'tree'
    species: str = 'broadleaf'

    def __post_init__(self) -> None:
        """Make every array read-only; a writable one is copied."""
        for name, value in list(vars(self).items()):
            if isinstance(value, np.ndarray) and value.flags.writeable:
                object.__setattr__(self, name, _read_only(value.copy()))

    def __repr__(self) -> str:
        """Return name, species, size and height on one line."""
        return (
            f'Tree {self.name!r}, {self.species}: {self.n_segments} segments, '
            f'{self.n_branches} branches, {self.height:.3g} m high'
        )

    @property
    def n_segments(self) -> int:
        """Return the number of segments."""
        return len(self.start)

    @property
    def n_branches(self) -> int:
        """Return the number of branches."""
        return len(self.branch_parent)

    @cached_property
    def length(self) -> Floats:
        """Length of each segment in [m], (n,)."""
        return _read_only(np.linalg.norm(self.end - self.start, axis=1))

    @cached_property
    def direction(self) -> Floats:
        """Return the unit vector along each segment at rest, (n, 3)."""
        return _read_only((self.end - self.start) / self.length[:, None])

    @cached_property
    def rest_frame(self) -> Floats:
        """Frame of each segment at rest as a quaternion w x y z (`quaternions_from_x`), (n, 4)."""
        return _read_only(quaternions_from_x(self.direction))

    @cached_property
    def place_on_parent(self) -> Floats:
        """
        Place of each segment along its parent: 0 at the start, 1 at the end, (n,).

        It is the projection of the start of the segment on the parent, between its ends.
        """
        parent = self.segment_parent
        chord = self.end[parent] - self.start[parent]
        along = np.einsum('ij,ij->i', self.start - self.start[parent], chord)
        place = np.clip(along / self.length[parent] ** 2, 0.0, 1.0)
        return _read_only(np.where(parent < 0, 1.0, place))

    @cached_property
    def branch_of_segment(self) -> Ints:
        """Branch of each segment, (n,)."""
        counts = np.diff(self.branch_first)
        return _read_only(np.repeat(np.arange(self.n_branches, dtype=np.int64), counts))

    @cached_property
    def branch_length(self) -> Floats:
        """Length of each branch along its segments in [m], (b,)."""
        return _read_only(np.add.reduceat(self.length, self.branch_first[:-1]))

    @property
    def rest_poses(self) -> Floats:
        """Poses at rest, bit for bit as the solver's: x y z, quaternion x y z w, (n, 7)."""
        return np.hstack([self.start, self.rest_frame[:, [1, 2, 3, 0]]])

    @cached_property
    def volume(self) -> Floats:
        """Volume of each segment, a conical frustum, in [m^3], (n,)."""
        d0 = self.base_diameter
        d1 = self.tip_diameter
        return _read_only(np.pi / 12.0 * self.length * (d0 * d0 + d0 * d1 + d1 * d1))

    @property
    def height(self) -> float:
        """Highest node above the root node in [m]."""
        return float(max(self.end[:, 2].max(), self.start[:, 2].max()) - self.start[0, 2])

    @property
    def segment_names(self) -> tuple[str, ...]:
        """Name of each segment: its branch's name and its place in it, as ``stem/3``."""
        return tuple(
            f'{name}/{i}'
            for branch, name in enumerate(self.branch_names)
            for i in range(int(self.branch_first[branch + 1] - self.branch_first[branch]))
        )

    def segments_of(self, branch: int) -> slice:
        """Slice of the segments of a branch."""
        return slice(int(self.branch_first[branch]), int(self.branch_first[branch + 1]))


def tree_in_order(
    *, segment_parent: Ints, branch_first: Ints, source_index: Ints, **fields: Any
) -> Tree:
    """
    Return a tree whose segments and branches are in depth-first order already.

    Arguments are the fields of `Tree`, less those that follow from the order of the segments.
    """
    branch_of_segment = np.repeat(np.arange(len(branch_first) - 1), np.diff(branch_first))
    on = segment_parent[branch_first[:-1]]
    branch_parent = np.where(on < 0, -1, branch_of_segment[on]).astype(np.int64)
    return Tree(
        segment_parent=segment_parent,
        branch_first=branch_first,
        branch_parent=branch_parent,
        subtree_end=_subtree_end(branch_parent),
        source_index=source_index,
        **fields,
    )


def _subtree_end(branch_parent: Ints) -> Ints:
    end = np.arange(1, len(branch_parent) + 1, dtype=np.int64)
    for branch in range(len(branch_parent) - 1, 0, -1):
        its_parent = branch_parent[branch]
        end[its_parent] = max(end[its_parent], end[branch])
    return end


def _read_only(array: NDArray[_Number]) -> NDArray[_Number]:
    array.setflags(write=False)
    return array


def tips_of_poses(tree: Tree, poses: Floats, branches: Ints | slice = slice(None)) -> Floats:
    """Tips of some branches, or of all, in [m], (k, 3), from a pose block (n, 7)."""
    last = tree.branch_first[1:][branches] - 1
    return ends_of_poses(poses[last], tree.length[last])[1]
