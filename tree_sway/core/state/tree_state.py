# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
All that a simulator carries from one step to the next, to be stored and set again.

A simulator that is set to a state goes on bit for bit as the one that gave it. A state says which
tree, settings and model it belongs to, by a digest of all of them, and is refused by any other.
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
    A tree at one moment: what its model carries from step to step, the last wind [m/s] first.

    The digest is that of tree, species and settings.
    """

    tree: str
    digest: str
    model: str
    values: Floats


def digest_of(*header: Any) -> str:
    """Digest of trees and of frozen dataclasses that say how they are modelled, 16 hex digits."""
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
