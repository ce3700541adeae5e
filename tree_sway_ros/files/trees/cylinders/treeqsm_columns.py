# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Columns of a TreeQSM cylinder model, in whichever file they come.

Cylinders are numbered from 1, parent 0 at the root; PyTLidar writes the same columns numbered from
0, parent -1 at the root. A cylinder that is the extension of its parent goes on with the branch;
any other starts one, on its parent's axis or skin and not at its end. Sources: Raumonen et al.
(2013), TreeQSM 2.4 manual.

"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders

USED_COLUMNS = 10
"""Columns from the left that are used: radius, length, start (3), axis (3), parent, extension."""
_LEAST_COLUMNS = 13
"""Fewer columns do not tell a matrix of cylinders from other tables."""
_LARGEST_NUMBER = 2**53


def looks_like_cylinders(table: NDArray[np.generic]) -> bool:
    """
    Whether a matrix is a table of cylinders, judged by all its rows: seven of ten must fit.

    A fitting row has a positive radius, a length, an axis of some direction and whole numbers from
    -1 for its parent and extension. Axes need not be of length 1.

    """
    if len(table) == 0 or not _LEAST_COLUMNS <= table.shape[1] <= 2 * _LEAST_COLUMNS:
        return False
    used = table[:, :USED_COLUMNS].astype(np.float64)
    numbers = used[:, 8:]
    fits = np.isfinite(used).all(axis=1) & (used[:, 0] > 0.0) & (used[:, 1] >= 0.0)
    fits &= (used[:, 5:8] != 0.0).any(axis=1) & (np.abs(used[:, 5:8]) <= 100.0).all(axis=1)
    fits &= (numbers == np.round(numbers)).all(axis=1) & (numbers >= -1.0).all(axis=1)
    return bool(np.mean(fits) >= 0.7) and bool((numbers > 0.0).any() or len(table) == 1)


def treeqsm_cylinders(table: Floats, labels: list[str], source: str) -> Cylinders:
    """
    Cylinders from the columns of TreeQSM.

    Parameters
    ----------
    table
        Radius and length in [m], start in [m], direction of the axis, and numbers of parent and
        extension, (n, 10).
    labels
        What an error calls each row.
    source
        The file.

    Raises
    ------
    FormatError
        Numbers that are not whole, an axis of no direction, or no root.

    """
    n = len(table)
    if n == 0:
        raise FormatError("no cylinders", where=source)
    reach, starts, axes, numbers = table[:, 1], table[:, 2:5], table[:, 5:8], table[:, 8:10]
    is_whole = (numbers == np.round(numbers)) & (np.abs(numbers) <= _LARGEST_NUMBER)
    for row, column in np.argwhere(~is_whole)[:1]:
        raise FormatError(
            f"parent or extension is {numbers[row, column]:g}, not a whole number",
            where=labels[row],
        )
    first = 1 + int(numbers[:, 0].min())
    if first not in (0, 1):
        raise FormatError(
            f"the least parent is {first - 1}", where=source, cure="the root has parent 0, or -1"
        )
    above, after = numbers.T.astype(np.int64) - first
    norm = np.linalg.norm(axes, axis=1)
    for row in np.flatnonzero((norm == 0.0) & (reach > 0.0))[:1]:
        raise FormatError("an axis of no direction", where=labels[row])
    ends = starts + (reach / np.where(norm > 0.0, norm, 1.0))[:, None] * axes
    valid = (after >= 0) & (after < n)
    continues = np.zeros(n, dtype=np.bool_)
    child = after[valid]
    continues[child[above[child] == np.flatnonzero(valid)]] = True
    width = 2.0 * table[:, 0]
    return Cylinders(starts, ends, np.stack([width, width], axis=1), above, continues, labels)
