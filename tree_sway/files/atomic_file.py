# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Atomic writing of files: the old file stays until the new one is complete."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import os
from pathlib import Path
from uuid import uuid4

from tree_sway.errors import FormatError
from tree_sway.files.paths import path_of

_CURE = 'give an existing folder that you may write to, with room for the file'


def refuse_unwritable(path: str | Path) -> None:
    """Raise a `FormatError` for a file that `whole_file` cannot write, before work for it."""
    target = _target(path)
    why = ''
    if not target.parent.is_dir():
        why = 'no such folder'
    elif not os.access(target.parent, os.W_OK) and (target.is_file() or not target.exists()):
        why = 'no permission'
    if why:
        raise FormatError(f'cannot be written: {why}', where=str(path), cure=_CURE)


def _target(path: str | Path) -> Path:
    """Return the file that a path leads to; a `FormatError` for a folder."""
    target = path_of(path).resolve()
    if target.is_dir():
        raise FormatError('a folder', where=str(path), cure='name a file to write')
    return target


@contextmanager
def refusing(path: str | Path, cure: str = _CURE) -> Iterator[None]:
    """Raise a `FormatError` in place of an `OSError` of writing a file."""
    try:
        yield
    except OSError as error:
        raise FormatError(
            f'cannot be written: {error.strerror or error}', where=str(path), cure=cure
        ) from error


@contextmanager
def whole_file(path: str | Path) -> Iterator[Path]:
    """
    Yield a path to write to, which replaces the file when the block ends without an error.

    It is a new, empty file of the same suffix in the same folder. A link is followed; a device or
    a pipe is written to directly. Raises a `FormatError` if the file cannot be written, or an
    `OSError` ended the block.
    """
    target = _target(path)
    with refusing(path):
        if target.exists() and not target.is_file():
            yield target
            return
        # The name of a temporary file is short, so that a long name of the target still fits.
        partial = target.with_name(f'.part-{uuid4().hex[:16]}{target.suffix[:16]}')
        try:
            partial.touch(exist_ok=False)
            yield partial
            if target.exists():
                partial.chmod(target.stat().st_mode & 0o777)
            partial.replace(target)
        finally:
            partial.unlink(missing_ok=True)


def write_text_whole(path: str | Path, text: str) -> None:
    """Write a text file in UTF-8 atomically; see `whole_file`."""
    with whole_file(path) as partial:
        partial.write_text(text, encoding='utf-8')
