"""
Columns of a TreeQSM cylinder model, in whichever file they come.

Cylinders are numbered from 1, parent 0 at the root; PyTLidar writes the same columns numbered from
0, parent -1 at the root. A cylinder that is the extension of its parent goes on with the branch;
any other starts one, on its parent's axis or skin and not at its end. Sources: Raumonen et al.
(2013), TreeQSM 2.4 manual.

"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders


def treeqsm_cylinders(
    radius: ArrayLike,
    length: ArrayLike,
    start: ArrayLike,
    axis: ArrayLike,
    parent: ArrayLike,
    extension: ArrayLike,
    labels: list[str],
    source: str,
) -> Cylinders:
    """
    Cylinders from the columns of TreeQSM.

    Parameters
    ----------
    radius, length
        In [m], (n,).
    start, axis
        Start in [m] and direction of the axis, (n, 3).
    parent, extension
        Numbers of other cylinders, (n,).
    labels
        What an error calls each.
    source
        The file.

    Raises
    ------
    FormatError
        Columns that do not match, numbers that are not whole, or no root.

    """
    width = 2.0 * np.asarray(radius, dtype=np.float64).ravel()
    reach = np.asarray(length, dtype=np.float64).ravel()
    starts, axes = np.asarray(start, dtype=np.float64), np.asarray(axis, dtype=np.float64)
    n = len(width)
    numbers = [np.asarray(column, dtype=np.float64).ravel() for column in (parent, extension)]
    if n == 0:
        raise FormatError("no cylinders", where=source)
    if starts.shape != (n, 3) or axes.shape != (n, 3) or {len(x) for x in (reach, *numbers)} != {n}:
        raise FormatError("columns of different lengths", where=source, cure="export it anew")
    for column in numbers:
        for index in np.flatnonzero((column != np.round(column)) | (np.abs(column) > 2**53))[:1]:
            raise FormatError(
                f"parent or extension is {column[index]:g}, not a whole number", where=labels[index]
            )
    if not np.isfinite(np.concatenate(numbers)).all():
        raise FormatError("a parent or extension that is not a number", where=source)
    first = 1 + int(numbers[0].min())
    if first not in (0, 1):
        raise FormatError(
            f"the least parent is {first - 1}", where=source, cure="the root has parent 0, or -1"
        )
    above, after = (column.astype(np.int64) - first for column in numbers)
    norm = np.linalg.norm(axes, axis=1)
    for index in np.flatnonzero((norm == 0.0) & (reach > 0.0))[:1]:
        raise FormatError("an axis of no direction", where=labels[index])
    ends = starts + (reach / np.where(norm > 0.0, norm, 1.0))[:, None] * axes
    valid = (after >= 0) & (after < n)
    continues = np.zeros(n, dtype=np.bool_)
    child = after[valid]
    continues[child[above[child] == np.flatnonzero(valid)]] = True
    return Cylinders(starts, ends, np.stack([width, width], axis=1), above, continues, labels)
