"""
What is left of a tree's records when some subtrees move with what they sit on.

A frozen subtree is one rigid body with its parent. Its mass has been the parent's to carry all
along, so its coordinates are crossed out of the matrices and nothing else changes there. Its wind
load joins the parent's, summed as the loads of pieces of one branch are. Solving then knows the
moving branches alone.

Symbols: b branches, m moving ones, N and M their coordinates.

"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.reduction.matrices import Reduction
from tree_sway_ros.core.tree.tree import Tree

Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class Pruning:
    """
    Which branches move, and where they stand among their like.

    Parameters
    ----------
    whole
        The tree.
    frozen
        Branches that move with their parent, (b,); with each all that it carries, and never the
        stem.

    """

    whole: Tree
    frozen: Bools

    def __post_init__(self) -> None:
        """Freeze with a branch all that it carries."""
        frozen, parent = self.frozen.copy(), self.whole.branch_parent
        frozen[0] = False
        for branch in range(1, len(frozen)):
            frozen[branch] |= frozen[parent[branch]]
        frozen.setflags(write=False)
        object.__setattr__(self, "frozen", frozen)

    @property
    def moving(self) -> Ints:
        """Branches that are solved, (m,)."""
        return np.flatnonzero(~self.frozen)

    @property
    def tops(self) -> Ints:
        """Frozen branches that sit on a moving one, (t,)."""
        return np.flatnonzero(self.frozen & ~self.frozen[self.whole.branch_parent])

    @property
    def place_among_moving(self) -> Ints:
        """
        Index of each branch among those that move, -1 for the frozen and for no branch, (b + 1,).

        """
        place = np.full(len(self.frozen) + 1, -1, dtype=np.int64)
        place[self.moving] = np.arange(len(self.moving))
        return place

    def coordinates(self, reduction: Reduction) -> Ints:
        """Coordinates of the moving branches, (M,)."""
        counts = np.diff(reduction.first)
        return np.flatnonzero(np.repeat(~self.frozen, counts))

    def tree(self) -> Tree:
        """Return the moving branches as a tree of their own."""
        tree, moving, place = self.whole, self.moving, self.place_among_moving
        rows = np.flatnonzero(~self.frozen[tree.branch_of_segment])
        row_place = np.full(tree.n_segments + 1, -1, dtype=np.int64)
        row_place[rows] = np.arange(len(rows))
        before = np.concatenate([[0], np.cumsum(~self.frozen)])
        return Tree(
            start=tree.start[rows],
            end=tree.end[rows],
            base_diameter=tree.base_diameter[rows],
            tip_diameter=tree.tip_diameter[rows],
            segment_parent=row_place[tree.segment_parent[rows]],
            branch_first=np.append(row_place[tree.branch_first[moving]], len(rows)),
            branch_parent=place[tree.branch_parent[moving]],
            subtree_end=before[tree.subtree_end[moving]],
            source_index=tree.source_index[rows],
            branch_names=tuple(tree.branch_names[branch] for branch in moving),
            name=tree.name,
            species=tree.species,
        )

    def reduction(self, whole: Reduction) -> Reduction:
        """Cross the frozen coordinates out of the matrices."""
        keep, moving = self.coordinates(whole), self.moving
        counts = np.diff(whole.first)[moving]
        return replace(
            whole,
            first=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
            twist=whole.twist[moving],
            mass=whole.mass[keep][:, keep],
            gravity=whole.gravity[keep][:, keep],
            elastic=whole.elastic[keep],
        )

    def branches(self, whole: Any) -> Any:
        """
        Keep the records of the moving branches, with the load of what they now carry as part of
        themselves.

        Parameters
        ----------
        whole
            Records of `BRANCH`, (b,).

        Returns
        -------
        ndarray
            Of `BRANCH`, (m,); segments keep their rows in the whole tree.

        """
        moving, place = self.moving, self.place_among_moving
        records = whole[moving].copy()
        carrier = self.carriers()
        for at in np.unique(carrier[self.frozen]):
            load = np.flatnonzero(self.frozen & (carrier == at))
            _join_loads(
                records[place[at]], whole[at], whole[load], whole["twist"][self._top_of()[load]]
            )
        records["parent"] = place[records["parent"]]
        records["source"] = np.arange(len(records))
        counts = records["n_coordinates"]
        records["coordinate"] = np.cumsum(counts) - counts
        return records

    def carriers(self) -> Ints:
        """Moving branch that each branch moves with: its own, or the nearest below, (b,)."""
        carrier = np.arange(len(self.frozen))
        for branch in np.flatnonzero(self.frozen):
            carrier[branch] = carrier[self.whole.branch_parent[branch]]
        return carrier

    def _top_of(self) -> Ints:
        """Frozen branch next to the moving ones that each frozen branch hangs on, (b,)."""
        top = np.arange(len(self.frozen))
        for branch in np.flatnonzero(self.frozen):
            parent = self.whole.branch_parent[branch]
            top[branch] = top[parent] if self.frozen[parent] else branch
        return top


def _join_loads(record: Any, own: Any, loads: Any, twists: Floats) -> None:
    """
    Make loads that a branch carries part of its own.

    Drag on a slanted piece is not linear in its projector P, but it is the slope of ``c (u . P
    u)^1.5 / 3`` in the wind u. The projector of all is the one that comes nearest to the sum of
    these.

    Parameters
    ----------
    record
        Of the branch, written.
    own
        The same before.
    loads, twists
        Records of what it carries, (k,), and how a unit of its coordinates moves each, (k, c, 6).

    """
    area = np.append(own["area"], loads["area"])
    speed = np.append(own["speed"], loads["speed"])
    pressed = area * speed**2
    if not pressed.any():
        return
    projectors = np.vstack([own["projector"], loads["projector"]])
    drag = np.maximum(_WINDS @ projectors.T, 0.0) ** 1.5 * pressed
    share = drag.sum(axis=0) / drag.sum()
    both = (drag.sum(axis=1) / pressed.sum()) ** (2.0 / 3.0)
    record["projector"] = _NEAREST @ both
    record["speed"] = share @ speed
    record["area"] = pressed.sum() / record["speed"] ** 2
    centre = loads["centre"]
    ways = twists[:, :, :3] + np.cross(twists[:, :, 3:], centre[:, None])
    record["centre"] = share[0] * own["centre"] + share[1:] @ centre
    record["push"] = share[0] * own["push"] + np.tensordot(share[1:], ways, axes=1)
    record["turn"] = share[0] * own["turn"] + np.tensordot(share[1:], twists[:, :, 3:], axes=1)
    # As in `fill_branch_loads`: push times flow is the mean square of the way, both axes as one.
    square = share[0] * (own["push"][:2] * own["flow"][:2]).sum()
    square += share[1:] @ np.square(ways[:, :2]).sum(axis=(1, 2))
    push = np.square(record["push"][:2]).sum()
    record["flow"] = record["push"]
    record["flow"][:2] *= square / push if push > 0.0 else 1.0
    record["lever"] = np.sqrt(0.5 * push)


def _squares(directions: Floats) -> Floats:
    """
    Weights of xx, yy, zz, xy, xz, yz of a projector P in ``u . P u``, for winds u (d, 3), (d, 6).

    """
    x, y, z = directions.T
    return np.stack([x * x, y * y, z * z, 2.0 * x * y, 2.0 * x * z, 2.0 * y * z], axis=1)


_WINDS = _squares(
    np.array(
        [
            (np.cos(rise) * np.cos(bearing), np.cos(rise) * np.sin(bearing), np.sin(rise))
            for rise in np.deg2rad([-20.0, 0.0, 20.0])
            for bearing in np.arange(16) * np.pi / 8.0
        ]
    )
)
"""Winds from all sides, along the ground and, as branches bend, aslant."""

_NEAREST = np.linalg.pinv(_WINDS)
"""From squares in those winds to the projector that fits them best, (6, d)."""
