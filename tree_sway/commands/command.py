# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A command of ``tree-sway``, as its help shows it."""

from __future__ import annotations

from typing import NamedTuple


class Command(NamedTuple):
    """What a command does, an example of it, and the module that runs it."""

    summary: str
    example: str
    module: str
