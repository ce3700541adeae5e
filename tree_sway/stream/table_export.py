# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Export of the table of a tree, for receivers that solve the tree themselves.

Over azimuths and levels the slopes of the load have a low rank: they are exported as factors,
``slopes = sqrt(k_i k_j) rows @ shapes``, weighted with the stiffness k of the coordinates, so that
the error is that of the bending of the tree. Shapes are integers of one step. `arrays_of_table`
makes the exported arrays a table again, which every receiver solves.

What factors leave out of a damping may feed a motion. Damping in proportion to the stiffness, as
much as the largest gain, is added before, so that the exported damping takes energy from every
motion as that of the model does.
"""

from __future__ import annotations

from collections.abc import Mapping
import math

import numpy as np

from tree_sway.core.arrays import Floats, Singles
from tree_sway.core.model import MEANINGS, SwayModel
from tree_sway.stream.check_description import Array, Arrays

_LEFT_OUT = 1e-2
"""
Share of the slopes that their factors leave out, root mean square.

This is a ten thousandth of the motion of benjamina at 14 m/s, as the equilibria in the table are
exact.
"""

_SLOPES = ('turning', 'damping', 'lean', 'steep_turning', 'steep_damping')
"""Fields of a table that are exported as factors."""

_PASSIVE = ('damping', 'steep_damping')
"""Those which take energy from every motion."""

_PLAIN = ('stiffness', 'limit', 'levels', 'motion', 'harmonics', 'equilibrium', 'amount', 'load',
         'cross_damping')  # fmt: skip
"""Fields that are exported as they are, in single precision."""

_NUMBERS = ('most_pressure', 'most_energy')

_ROUNDED = {'equilibrium': 8, 'load': 8, 'rows': 8, 'cross_damping': 16}
"""Number of last bits that are left out of some fields: to 1.5e-5, and a bound to 0.4 %."""

_MARGIN = 1e-6
"""Least energy that damping takes, over the most: single precision errs by less."""

_LARGEST_STEP = 32767
_QUANTISED = 12.0**-0.5
"""Root mean square rounding error, over its step."""


def exported_table(model: SwayModel, damping: Floats) -> tuple[dict[str, float], Arrays]:
    """
    Return numbers by name, and arrays of float32 and int16, of a model and its damping (m,).

    Beside the `_PLAIN` arrays of the model there are ``own_damping`` (m,), and of each one of
    `_SLOPES` its ``_rows`` and ``_shapes``.
    """
    numbers = {name: float(getattr(model, name)) for name in _NUMBERS}
    arrays = {name: rounded(getattr(model, name), _ROUNDED.get(name, 0)) for name in _PLAIN}
    arrays['own_damping'] = damping.astype(np.float32)
    m = len(damping)
    root = np.sqrt(arrays['stiffness'].astype(np.float64))
    for name in _SLOPES:
        slopes = getattr(model, name) / (root[:, None] * root)
        factors = _passive_factors if name in _PASSIVE else _factors
        arrays[f'{name}_rows'], arrays[f'{name}_shapes'] = factors(slopes.reshape(-1, m * m))
    return numbers, arrays


def arrays_of_table(numbers: Mapping[str, float], arrays: Arrays) -> Arrays:
    """Return the arrays of a model, as the native core takes them, of an exported table."""
    m = len(arrays['stiffness'])
    found = {name: np.array([numbers[name]]) for name in _NUMBERS}
    found |= {name: arrays[name].astype(np.float64) for name in (*_PLAIN, 'own_damping')}
    root = np.sqrt(found['stiffness'])
    for name in _SLOPES:
        rows = arrays[f'{name}_rows']
        shapes = arrays[f'{name}_shapes']
        slopes = np.zeros((len(rows), m * m))
        # One product after another, as receivers in other languages add them up.
        for row, shape in zip(rows.T.astype(np.float64), shapes, strict=True):
            slopes += row[:, None] * shape
        slopes *= (root[:, None] * root).ravel()
        sizes = [int(each) for each in MEANINGS[name].shape[:-2]]
        found[name] = slopes.reshape([*sizes, m, m]).astype(np.float32)
    return found


def rounded(values: Floats, bits: int) -> Singles:
    """Round to single precision without its last bits, at most 16, which then compress away."""
    single = values.astype(np.float32).view(np.uint32).astype(np.uint64)
    single += (1 << bits) >> 1
    return (single >> bits << bits).astype(np.uint32).view(np.float32)


def _passive_factors(slopes: Floats) -> tuple[Array, Array]:
    """Return rows and shapes as `_factors`, whose product adds energy to no motion."""
    m = math.isqrt(slopes.shape[1])
    unit = np.eye(m).ravel()
    added = 0.0
    while True:
        rows, shapes = _factors(slopes - added * unit)
        product = (rows.astype(np.float64) @ shapes).reshape(-1, m, m)
        work = np.linalg.eigvalsh(product + product.swapaxes(1, 2)) / 2.0
        gain = work.max() + _MARGIN * np.abs(work).max()
        if gain <= 0.0 or not work.any():
            return rows, shapes
        added += gain


def _factors(slopes: Floats) -> tuple[Array, Array]:
    """Return rows (k, r) and shapes (r, m^2) of the product slopes (k, m^2) up to `_LEFT_OUT`."""
    rows, sizes, shapes = np.linalg.svd(slopes, full_matrices=False)
    left = np.sqrt(np.maximum(1.0 - np.cumsum(sizes**2) / max(np.sum(sizes**2), 1e-300), 0.0))
    rank = int(np.argmax(left < _LEFT_OUT / 2.0)) + 1
    scaled = sizes[:rank, None] * shapes[:rank]
    step = _LEFT_OUT / 2.0 * float(np.linalg.norm(sizes)) / (_QUANTISED * scaled.size**0.5)
    step = max(step, float(np.abs(scaled).max()) / _LARGEST_STEP, 1e-300)
    return rounded(step * rows[:, :rank], _ROUNDED['rows']), np.rint(scaled / step).astype('<i2')
