# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
All that a simulator carries from one step to the next, to be kept and set again.

A simulator that is set to a state goes on bit for bit as the one that gave it. A state says which
tree, settings and model it belongs to, by a digest of all of them, and is refused by any other.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
import hashlib
import json
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import StateError

VERSION = 1
"""Version of the form of a state; a state of another version is refused."""

_LARGEST_HEAD = 4096


@dataclass(frozen=True)
class TreeState:
    """
    A tree at one moment: what its model carries from step to step, the last wind [m/s] first.

    The digest is that of tree, species and settings, the version that of the program (`VERSION`).
    """

    tree: str
    digest: str
    model: str
    values: Floats
    version: int = VERSION

    def to_bytes(self) -> bytes:
        """Return one line of JSON, then the values as little-endian float64."""
        head = {name: getattr(self, name) for name in ('tree', 'digest', 'model', 'version')}
        return json.dumps(head).encode() + b'\n' + self.values.astype('<f8').tobytes()

    @staticmethod
    def from_bytes(data: bytes) -> TreeState:
        """Read what `to_bytes` wrote; a `StateError` for no state, or another version's."""
        head, _, values = data.partition(b'\n')
        try:
            header = json.loads(head[:_LARGEST_HEAD])
            version = header['version']
            tree, digest, model = (str(header[name]) for name in ('tree', 'digest', 'model'))
            numbers = np.frombuffer(values, dtype='<f8').astype(np.float64)
        except (ValueError, KeyError, TypeError) as error:
            raise StateError(
                f'{len(data)} bytes that hold no state', cure='give those of to_bytes'
            ) from error
        refuse_version(version)
        return TreeState(tree, digest, model, numbers)


def refuse_version(version: object) -> None:
    """Refuse, with a `StateError`, a state of another version than `VERSION`."""
    if version != VERSION:
        raise StateError(
            f'a state of version {version}',
            where='state',
            cure=f'this program reads version {VERSION}; run the same release at both ends',
        )


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
