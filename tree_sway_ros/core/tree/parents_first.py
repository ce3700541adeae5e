# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The order in which parents come before what they carry."""

from __future__ import annotations

from collections.abc import Iterable


def parents_first(parents: Iterable[int]) -> list[int]:
    """
    Order the numbers of a tree from its roots (negative parents) on, generation by generation.

    Those that follow from no root, as they go in a circle, are left out.
    """
    children: dict[int, list[int]] = {}
    for number, parent in enumerate(parents):
        children.setdefault(max(parent, -1), []).append(number)
    order = list(children.get(-1, ()))
    for number in order:
        order.extend(children.get(number, ()))
    return order
