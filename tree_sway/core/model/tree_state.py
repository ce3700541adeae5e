# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The state of a simulator between steps, to be stored and set again.

A simulator that is set to a state continues bit for bit as the one it was read from. A state has a
digest of its tree, settings and model, and others refuse it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, is_dataclass
import hashlib
from numbers import Real
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats


@dataclass(frozen=True)
class TreeState:
    """
    State of a tree: that of its model, after the last wind [m/s].

    The digest is that of tree, species and settings.
    """

    tree: str
    digest: str
    model: str
    values: Floats

    def __repr__(self) -> str:
        """Return tree, model and digest on one line."""
        return f'TreeState of {self.tree}, model {self.model}, digest {self.digest}'


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
