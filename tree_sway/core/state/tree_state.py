# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
All that a simulator carries from one step to the next, to be kept and set again.

A simulator that is set to a state goes on bit for bit as the one that gave it. A state says which
tree, settings and model it belongs to, by a digest of all of them, and is refused by any other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
import hashlib
import json
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import StateError

VERSION = 1
"""Of the form of a state; one of another version is refused."""

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
        """Read what `to_bytes` wrote; a `StateError` for no state, or one of another version."""
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


class KeepsState:
    """A simulator whose state can be kept, set and placed, for classes that give what it asks."""

    tree: Tree

    @property
    def told_as(self) -> str:
        """Name that its states bear."""
        return self.tree.name

    @property
    def model(self) -> str:
        """Model in use."""
        raise NotImplementedError

    def digest(self) -> str:
        """Digest of tree, species and settings."""
        raise NotImplementedError

    def memory(self) -> Sequence[Floats]:
        """Return views of all arrays that are carried from one step to the next."""
        raise NotImplementedError

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""
        raise NotImplementedError

    def place_rotations(self, rotations: Floats, out: Floats | None = None) -> Floats:
        """Place every segment by key rotations (N,), (n, 7)."""
        raise NotImplementedError

    def state(self) -> TreeState:
        """Return a copy of all that is carried from one step to the next."""
        values = np.concatenate([np.ravel(array) for array in self.memory()])
        return TreeState(self.told_as, self.digest(), self.model, values)

    def set_state(self, state: TreeState) -> None:
        """
        Go on from a state.

        Raises a `StateError` for another tree, model or version, or what is not finite; what was
        before stays.
        """
        refuse_version(state.version)
        arrays = self.memory()
        n_values = sum(array.size for array in arrays)
        for what, theirs, own in (
            ('tree', state.tree, self.told_as),
            ('model', state.model, self.model),
            ('settings', state.digest, self.digest()),
            ('number of values', len(state.values), n_values),
        ):
            if theirs != own:
                raise StateError(
                    f"a state of {what} '{theirs}', and this is '{own}'",
                    where=self.told_as,
                    cure='set a state of the same tree with the same species, settings and model',
                )
        if not np.isfinite(state.values).all():
            raise StateError('a state that is not finite', where=self.told_as)
        first = 0
        for array in arrays:
            array[...] = state.values[first : first + array.size].reshape(array.shape)
            first += array.size

    def expand(self, state: TreeState, out: Floats | None = None) -> Floats:
        """Poses of a state, (n, 7), as `place` gives them; the simulator stays as it is."""
        own = self.state()
        self.set_state(state)
        rotations = self.rotations().copy()
        self.set_state(own)
        return self.place_rotations(rotations, out)
