# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Rows of a study as one table."""

from __future__ import annotations

from pathlib import Path

from tree_sway.files.export import write_columns
from tree_sway.forest.entries import Plain


def write_table(rows: list[Plain], path: Path) -> None:
    """
    Write one row per case atomically; columns are in the order of their first occurrence.

    Errors are those of `write_columns`.
    """
    names = dict.fromkeys(name for row in rows for name in row)
    write_columns({name: [row.get(name) for row in rows] for name in names}, path)
