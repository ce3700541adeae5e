# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The state of a simulator between steps, to be stored and set again.

A simulator that is set to a state continues bit for bit as the one it was read from. A state has a
digest of its tree, settings and model, and others refuse it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass
import hashlib
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import GREATEST
from tree_sway.errors import StateError


@dataclass(frozen=True)
class TreeState:
    """
    State of a tree, or of all trees of a scene: that of its model, after the last wind [m/s].

    The digest is that of tree, species and settings.
    """

    tree: str
    digest: str
    model: str
    values: Floats

    def __repr__(self) -> str:
        """Return tree, model and digest on one line."""
        return f'TreeState of {self.tree}, model {self.model}, digest {self.digest}'


def values_of(memory: Sequence[NDArray[Any]]) -> Floats:
    """Copy the arrays of a state to one array, (n,)."""
    return np.concatenate([np.ravel(array) for array in memory], dtype=np.float64)


def fill_memory(memory: Sequence[NDArray[Any]], values: Floats) -> None:
    """Copy the values of a state to its arrays, as `values_of` returned them."""
    first = 0
    for array in memory:
        array[...] = values[first : first + array.size].reshape(array.shape)
        first += array.size


def refuse_other_state(state: TreeState, own: TreeState) -> None:
    """Refuse a state that is not finite, or of another tree or model, by a `StateError`."""
    if not isinstance(state, TreeState):
        raise StateError(
            f'a {type(state).__name__}, where a TreeState is expected',
            where=own.tree,
            cure='set what state() of the same simulator returned',
        )
    values = state.values
    if not (isinstance(values, np.ndarray) and values.ndim == 1 and values.dtype.kind in 'fiu'):
        what = 'a state whose values are no row of numbers'
        raise StateError(what, where=own.tree, cure='set what state() of a simulator returned')
    for what, theirs, mine in (
        ('tree', state.tree, own.tree),
        ('model', state.model, own.model),
        ('settings', state.digest, own.digest),
        ('number of values', len(values), len(own.values)),
    ):
        if theirs != mine:
            raise StateError(
                f"a state of {what} '{theirs}', and this is '{mine}'",
                where=own.tree,
                cure='set a state of the same tree with the same species, settings and model',
            )
    if not (np.abs(values) < GREATEST).all():
        what = 'a state with a number that no tree has, or that is not finite'
        raise StateError(what, where=own.tree, cure='set what state() of a simulator returned')


def digest_of(*header: Any) -> str:
    """
    Digest of trees and of frozen dataclasses such as settings, 16 hexadecimal digits.

    Equal values have equal digests, whatever type of number they have.
    """
    digest = hashlib.sha256()
    for each in header:
        for part in _parts(each):
            digest.update(part)
    return digest.hexdigest()[:16]


def _parts(value: Any) -> Iterator[bytes]:
    """Yield bytes that are equal for equal values."""
    if is_dataclass(value):
        for field in fields(value):
            if field.name not in ('name', 'source_index'):
                yield field.name.encode()
                yield from _parts(getattr(value, field.name))
    elif isinstance(value, np.ndarray):
        numbers = np.asarray(value, dtype=np.float64)
        yield str(numbers.shape).encode()
        yield numbers.tobytes()
    elif isinstance(value, Real | np.bool_):
        yield (float(value) + 0.0).hex().encode()  # without the sign of zero
    elif isinstance(value, tuple | list):
        yield f'{len(value)}:'.encode()
        for each in value:
            yield from _parts(each)
    else:
        yield repr(value).encode()
