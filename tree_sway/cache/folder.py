# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The folder of prepared models, writable only by its user.

Who can write a file there decides how the trees of its reader move. So the folder and all above it
belong to the user or to root, others may not write into them (except /tmp, where users cannot
remove files of others), and files are opened without following links.
"""

from __future__ import annotations

from contextlib import suppress
from functools import cache
import os
from pathlib import Path
import stat
import tempfile
import time
import warnings

_FOLDER_VARIABLE = 'TREE_SWAY_CACHE'
"""Environment variable for a different folder of prepared models."""

_PART_LEFT = 3600.0
"""Age after which an unfinished file is removed [s]."""

_BY_OTHERS = stat.S_IWGRP | stat.S_IWOTH


@cache
def cache_folder() -> Path | None:
    """Return the folder: the given one, the user's, a temporary one; or None."""
    asked = os.environ.get(_FOLDER_VARIABLE)
    home = os.environ.get('XDG_CACHE_HOME') or os.path.expanduser('~/.cache')
    own = f'tree_sway-{os.getuid()}' if hasattr(os, 'getuid') else 'tree_sway'
    places = [Path(asked)] if asked else []
    places.append(Path(home) / 'tree_sway')
    with suppress(FileNotFoundError):  # no folder is writable
        places.append(Path(tempfile.gettempdir()) / own)
    for candidate in places:
        try:
            place = candidate.resolve()  # no link is followed from here on
            for folder in (*reversed(place.parents), place):
                if not folder.is_dir():
                    folder.mkdir(mode=0o700, exist_ok=True)
            if unsafe := why_unsafe(place):
                _complain(f'prepared models are not stored in {place}: {unsafe}')
                continue
            with tempfile.TemporaryFile(dir=place) as probe:
                probe.write(b'\0' * 4096)
        except (OSError, RuntimeError) as error:  # links in a circle are a RuntimeError until 3.12
            if asked and candidate is places[0]:
                _complain(f'nothing is stored in {candidate}, which was given: {error}')
            continue
        for path in place.glob('*.part'):  # what processes left that were killed
            with suppress(OSError):
                if time.time() - path.lstat().st_mtime > _PART_LEFT:
                    path.unlink()
        return place
    _complain('no folder for prepared models can be written; they are made in every process')
    return None


def why_unsafe(place: Path) -> str:
    """Return why other users could write into a folder, and the cure; empty where they cannot."""
    if not hasattr(os, 'getuid'):
        return ''
    for folder in (place, *place.parents):
        found = folder.lstat()
        if found.st_uid != os.getuid() and (found.st_uid != 0 or folder == place):
            return f'{folder} belongs to other users; set {_FOLDER_VARIABLE} to a folder of yours'
        is_shared = found.st_mode & stat.S_ISVTX and folder != place
        if found.st_mode & _BY_OTHERS and not is_shared:
            return f'others may write into {folder}; chmod go-w {folder}'
    return ''


def read_own(path: Path) -> bytes:
    """
    Read a file of this user that others cannot write, without following a link.

    Raises
    ------
    OSError
        There is no such file, it is a link, or others may have written it.

    """
    with open(os.open(path, os.O_RDONLY | getattr(os, 'O_NOFOLLOW', 0)), 'rb') as file:
        found = os.fstat(file.fileno())
        if not stat.S_ISREG(found.st_mode) or (
            hasattr(os, 'getuid') and (found.st_uid != os.getuid() or found.st_mode & _BY_OTHERS)
        ):
            raise PermissionError(f'others may have written {path}')
        with suppress(OSError):
            os.utime(file.fileno())  # it is in use
        return file.read()


def write_own(path: Path, content: bytes) -> None:
    """Write a file atomically; raises an `OSError` on failure."""
    handle, partial = tempfile.mkstemp(dir=path.parent, suffix='.part')
    try:
        with open(handle, 'wb') as file:
            file.write(content)
        os.replace(partial, path)
    except OSError:
        Path(partial).unlink(missing_ok=True)
        raise


_said: set[str] = set()


def _complain(text: str) -> None:
    """Print it on one line, once per process and cause."""
    cause = text.split(':')[0]
    if cause not in _said:
        _said.add(cause)
        warnings.warn_explicit(text, RuntimeWarning, 'tree_sway', 1)
