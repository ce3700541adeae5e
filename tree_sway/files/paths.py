# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Paths from texts that users write."""

from __future__ import annotations

import os
from pathlib import Path

from tree_sway.errors import FormatError


def path_of(name: str | Path) -> Path:
    """
    Return a path from text: ``~`` is the home folder.

    Raises a `FormatError` for a user that does not exist, or an impossible path.
    """
    text = str(name)
    try:
        path = Path(text).expanduser()
        os.stat(path)
    except (FileNotFoundError, NotADirectoryError, PermissionError):
        return path
    except RuntimeError:
        raise FormatError(
            f"no user '{text.split('/')[0]}'", where=text[:80], cure='write the folder in full'
        ) from None
    except (OSError, ValueError) as error:  # such as a name that is too long, or has a zero byte
        reason = error.strerror if isinstance(error, OSError) else error
        raise FormatError(f'not a path: {reason}', where=ascii(text[:80])) from None
    return path


def is_file(path: Path) -> bool:
    """Whether a path is that of a file; impossible paths, as too long ones, are not."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False
