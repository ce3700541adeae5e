# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The state of a simulator between steps, to be stored and set again.

A simulator that is set to a state continues bit for bit as the one it was read from. A state has a
digest of its tree, settings and model, and others refuse it.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
import hashlib
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


def digest_of(*header: Any) -> str:
    """Digest of trees and of frozen dataclasses such as settings, 16 hexadecimal digits."""
    digest = hashlib.sha256()
    for each in header:
        for field in fields(each):
            value = getattr(each, field.name)
            if field.name in ('name', 'source_index'):
                continue
            digest.update(field.name.encode())
            is_array = isinstance(value, np.ndarray)
            digest.update(value.tobytes() if is_array else repr(value).encode())
    return digest.hexdigest()[:16]
