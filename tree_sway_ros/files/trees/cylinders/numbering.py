"""Numbers that a file gives its cylinders or nodes, to positions in it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tree_sway_ros.core.arrays import Ints
from tree_sway_ros.errors import FormatError, TreeError


def positions_of_parents(
    numbers: Sequence[int], parents: Sequence[int], labels: Sequence[str], none: Sequence[int]
) -> Ints:
    """
    Position of each one's parent, -1 where it has none, (n,).

    Parameters
    ----------
    numbers, parents
        Number of each, and of its parent, (n,).
    labels
        What an error calls each.
    none
        Parent numbers that mean there is none.

    Raises
    ------
    FormatError
        A number that stands twice.
    TreeError
        A parent that is not there.

    """
    position: dict[int, int] = {}
    for index, number in enumerate(numbers):
        if number in position:
            raise FormatError(f"number {number} stands twice", where=labels[index])
        position[number] = index
    result = np.full(len(numbers), -1, dtype=np.int64)
    for index, number in enumerate(parents):
        if number in position:
            result[index] = position[number]
        elif number not in none:
            raise TreeError(
                f"orphan: its parent {number} is not in the file",
                where=labels[index],
                cure=f"name one that is, or {none[0]} for the root",
            )
    return result
