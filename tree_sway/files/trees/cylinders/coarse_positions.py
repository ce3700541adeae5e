# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Positions of a scan so far from the origin that its file has too few digits for them."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats

_COARSE = 0.01
"""Step of positions in [m] from which on a scan is out of shape."""

_FEWEST = 10
"""Number of cylinders from which on whole numbers are no chance."""


def coarse_positions(start: Floats) -> tuple[str, ...]:
    """
    Report the step of positions that single precision has rounded.

    TreeQSM works in single precision, which has 0.5 m at the northings of UTM; a text with seven
    digits has 1 m there.

    Parameters
    ----------
    start
        Starts of the cylinders in the coordinates of the file [m], (n, 3).

    Returns
    -------
    tuple
        One sentence, or none.

    """
    if len(start) < _FEWEST:
        return ()
    with np.errstate(over='ignore'):
        single = start.astype(np.float32)
    is_rounded = (single == start).all(axis=0)
    spacing = np.spacing(np.abs(single).max(axis=0))
    is_coarse = is_rounded & (spacing > _COARSE)
    steps = [np.diff(np.unique(axis)) for axis in start.T[is_coarse]]
    coarsest = max((each.min() for each in steps if len(each)), default=0.0)
    if coarsest <= _COARSE:
        return ()
    return (
        f'its positions come in steps of {coarsest:g} m, as its numbers have too few digits for '
        'coordinates so far from the origin: take an offset off the points before the fit',
    )
