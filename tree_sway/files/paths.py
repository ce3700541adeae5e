# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Paths from texts that users write."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
import os
from pathlib import Path
from typing import Concatenate, ParamSpec, TypeVar

from tree_sway.errors import FormatError, inside, ParameterError

P = ParamSpec('P')
T = TypeVar('T')


def path_of(name: str | Path) -> Path:
    """
    Return a path from text: ``~`` is the home folder.

    Raises a `FormatError` for a user that does not exist, or an impossible path, and a
    `ParameterError` for what is no path.
    """
    refuse_no_path(name)
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


def refuse_no_path(name: object) -> None:
    """Raise a `ParameterError` for what is neither text nor a path."""
    if not isinstance(name, str | os.PathLike):
        is_table = hasattr(name, 'to_csv')
        cure = "write it to one first: frame.to_csv('table.csv', index=False)" * is_table
        raise ParameterError(
            f'a {type(name).__name__}, where the path of a file is expected',
            cure=cure or "give its name, as 'oak.yaml'",
        )


def of_file(read: Callable[Concatenate[Path, P], T]) -> Callable[Concatenate[str | Path, P], T]:
    """Let a reader take its file as text, and its errors name the file where they do not."""

    @wraps(read)
    def named(path: str | Path, *arguments: P.args, **options: P.kwargs) -> T:
        file = path_of(path)
        with inside(str(file)):
            return read(file, *arguments, **options)

    return named  # type: ignore[return-value]


def is_file(path: Path) -> bool:
    """Whether a path is that of a file; impossible paths, as too long ones, are not."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False
