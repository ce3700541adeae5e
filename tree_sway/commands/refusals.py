# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What commands refuse before they do anything."""

from __future__ import annotations

from pathlib import Path

from tree_sway.errors import ParameterError


def refuse_unused(option: str, needs: str) -> None:
    """Raise the `ParameterError` of an option without the one that it belongs to."""
    raise ParameterError('it would change nothing', where=option, cure=f'add {needs}')


def refuse_overwriting(path: str | Path, option: str) -> None:
    """Raise a `ParameterError` if a file of an option exists."""
    if Path(path).is_file():
        raise ParameterError(
            f"'{path}' exists",
            where=option,
            cure='give a different file, or write over it with --force',
        )
