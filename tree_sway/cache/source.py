# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The digest of source, by which what it made is found again and told from what older made."""

from __future__ import annotations

from functools import cache
import hashlib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
"""Folder of the package."""


@cache
def source_digest(folder: Path) -> str:
    """Digest of all modules and tables of a folder; empty without files, as in an archive."""
    digest = hashlib.blake2b(digest_size=16)
    paths = sorted(path for path in folder.rglob('*') if path.suffix in ('.py', '.csv'))
    for path in paths:
        digest.update(path.relative_to(folder).as_posix().encode() + b'\0' + path.read_bytes())
    return digest.hexdigest() if paths else ''
