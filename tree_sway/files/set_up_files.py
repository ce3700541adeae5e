# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Set-ups of trees on disk, so that a solver that is started again sways sooner.

They lie beside the compiled kernels, in numpy's own format, which is read without pickles. A
file is found by a digest of the tree, its species and settings, of the source of the core, of the
versions of numpy and scipy, and of the machine; what cannot be read is made again, and what cannot
be written is left.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
import hashlib
from importlib.metadata import version
from pathlib import Path
import platform
from typing import Any

import numpy as np

from tree_sway.errors import TreeSwayError
from tree_sway.files.whole_file import whole_file
from tree_sway.kernel_cache import ROOT, source_digest
from tree_sway.kernel_folder import kernel_folder

MOST = 32
"""Number of set-ups on disk; the oldest are removed first."""

_SUFFIX = '.set_up.npz'


class SetUpFiles:
    """What `SwaySimulator` and others take as ``cache``; in the folder of the kernels if None."""

    def __init__(self, folder: Path | None = None) -> None:
        self._folder = folder or kernel_folder()

    def read(self, digest: str) -> dict[str, Any] | None:
        """Arrays by name, as they were written under this digest; None if there are none."""
        if self._folder is None:
            return None
        key = _key(digest)
        try:
            with np.load(self._folder / f'{key}{_SUFFIX}') as file:
                arrays = dict(file)
            return arrays if str(arrays.pop('key')) == key else None
        except Exception:  # whatever numpy makes of a damaged file
            return None

    def write(self, digest: str, arrays: Mapping[str, Any]) -> None:
        """Write arrays, all of them or nothing, in place of the oldest set-ups."""
        if self._folder is None:
            return
        key = _key(digest)
        with suppress(OSError, TreeSwayError):
            with whole_file(self._folder / f'{key}{_SUFFIX}') as partial:
                np.savez(partial, key=np.array(key), **arrays)
            found = sorted(self._folder.glob(f'*{_SUFFIX}'), key=lambda path: path.stat().st_mtime)
            for path in found[:-MOST]:
                path.unlink()


def _key(digest: str) -> str:
    """Name of a set-up, which it bears inside as well."""
    parts = [
        *(digest, source_digest(ROOT / 'core'), platform.node()),
        *(version(name) for name in ('numpy', 'scipy')),
    ]
    return hashlib.blake2b('\0'.join(parts).encode(), digest_size=16).hexdigest()
