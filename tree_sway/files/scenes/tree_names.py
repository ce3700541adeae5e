# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Names that the trees of a scene may have."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tree_sway.errors import FormatError


def refuse_same_names(names: Sequence[str], where: Callable[[int], str]) -> None:
    """Raise a `FormatError` for a slash in a name, or a name that occurs twice."""
    first: dict[str, int] = {}
    for number, name in enumerate(names):
        if '/' in name:
            raise FormatError(
                f"a slash in the name '{name}'",
                where=where(number),
                cure='leave it out: it separates tree and branch in the names of segments',
            )
        if first.setdefault(name, number) != number:
            line = where(first[name]).rsplit(':', 1)[1]
            raise FormatError(
                f"two trees called '{name}', the first in line {line}",
                where=where(number),
                cure='give each its own name',
            )
