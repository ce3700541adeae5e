# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Prepared models of trees on disk, so that a solver restarts faster.

They are in numpy's own format, which is read without pickles. A file
is found by a digest of the tree, its species and settings, of the source of the core, of the
versions of numpy and scipy, and of the machine; an unreadable file is made again, and failures to
write are ignored.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
import hashlib
import io
from pathlib import Path
import platform
from typing import Any

import numpy as np
import scipy

from tree_sway.cache.folder import cache_folder, read_own, write_own
from tree_sway.cache.source import ROOT, source_digest

MOST = 32
"""Largest number of models on disk; those not read for longest are removed first."""

MOST_BYTES = 1 << 29
"""Largest size of all models on disk [bytes], some forty large trees."""

LARGEST = 1 << 27
"""Largest size of a model on disk [bytes]: all modes of a large tree are more."""

_SUFFIX = '.model.npz'


class ModelFiles:
    """
    Prepared models as the ``cache`` of simulators.

    Parameters
    ----------
    folder
        Folder of the files; that of `cache_folder` if None.

    """

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder
        self.most = MOST
        """Largest number of models in it."""

    def read(self, digest: str) -> dict[str, Any] | None:
        """Return the arrays by name that were written under a digest; None if there are none."""
        if (folder := self.folder or cache_folder()) is None:
            return None
        key = _key(digest)
        try:
            content = read_own(folder / f'{key}{_SUFFIX}')
            with np.load(io.BytesIO(content)) as file:
                arrays = dict(file)
            if str(arrays.pop('key')) != key:
                return None
        except Exception:  # of the system, or any of numpy for a damaged file
            return None
        return arrays

    def write(self, digest: str, arrays: Mapping[str, Any]) -> None:
        """Write arrays atomically, and remove those not read for longest."""
        size = sum(each.nbytes for each in arrays.values())
        if (folder := self.folder or cache_folder()) is None or size > LARGEST:
            return
        key = _key(digest)
        content = io.BytesIO()
        np.savez(content, key=np.array(key), **arrays)
        with suppress(OSError):
            write_own(folder / f'{key}{_SUFFIX}', content.getvalue())
            found = [(each, each.stat()) for each in folder.glob(f'*{_SUFFIX}')]
            found.sort(key=lambda one: -one[1].st_mtime)
            sizes = np.cumsum([state.st_size for _, state in found])
            for number, (path, _) in enumerate(found):
                if number >= self.most or sizes[number] > MOST_BYTES:
                    path.unlink()


MODELS = ModelFiles()
"""Default place of prepared models."""


def _key(digest: str) -> str:
    """Name of a model, which is stored inside as well."""
    versions = np.__version__, scipy.__version__
    parts = digest, source_digest(ROOT / 'core'), platform.node(), *versions
    return hashlib.blake2b('\0'.join(parts).encode(), digest_size=16).hexdigest()
