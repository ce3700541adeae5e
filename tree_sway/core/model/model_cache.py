# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Where prepared models are found again, by a digest of what they were made of.

The core stores nothing by itself: a program chooses a cache, such as that on disk (`cache.
model_cache`), by ``PREPARED.behind = ...``. Models that were read from files are found too.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from numpy.typing import NDArray

_Arrays = Mapping[str, NDArray[Any]]
"""Arrays of a `SwayModel` by name."""


_MOST_GIVEN = 32
"""Largest number of models of files in memory."""


class ModelCache(Protocol):
    """Arrays of models by digest."""

    def read(self, digest: str) -> _Arrays | None:
        """Return the arrays that were written under a digest; None if there are none."""

    def write(self, digest: str, arrays: _Arrays) -> None:
        """Write the arrays of a model; a failure is ignored."""


class PreparedModels:
    """Models in memory, in front of the cache that the program has chosen."""

    def __init__(self) -> None:
        self.behind: ModelCache | None = None
        """Cache that is asked after the models in memory; none if None."""
        self._given: dict[str, _Arrays] = {}

    def add(self, digest: str, arrays: _Arrays) -> None:
        """Add a model of a file; of more than `_MOST_GIVEN` the oldest is dropped."""
        self._given.pop(digest, None)
        self._given[digest] = arrays
        while len(self._given) > _MOST_GIVEN:
            self._given.pop(next(iter(self._given)))

    def read(self, digest: str) -> _Arrays | None:
        """Return the arrays of a model; None if there are none."""
        if digest in self._given:
            return self._given[digest]
        return None if self.behind is None else self.behind.read(digest)

    def write(self, digest: str, arrays: _Arrays) -> None:
        """Write the arrays of a model to the cache behind."""
        if self.behind is not None:
            self.behind.write(digest, arrays)


PREPARED = PreparedModels()
"""Models that simulators use unless another cache is given."""
