# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The messages of a scene that the server keeps: description, tables and the newest frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from tree_sway.stream import Json

Tables = Callable[[], bytes | None]
"""Returns the tables by which clients solve the scene; None if they cannot."""

Gusts = Callable[[], Json | None]
"""Returns the gusts that are in the scene, as `GustHistory.recent`; None without."""


def nothing() -> None:
    """Return None, for a scene that clients cannot solve."""
    return None


@dataclass
class Published:
    """
    A scene as it was published last.

    Attributes
    ----------
    description
        Description of the following frames; empty before the first.
    tables, gusts
        Functions that return what a client needs to solve the scene.
    newest
        Number of the newest frame, from 0, and the frame, set at once, as threads read it while
        another publishes; -1 and empty before the first.

    """

    description: bytes = b''
    tables: Tables = nothing
    gusts: Gusts = nothing
    newest: tuple[int, bytes] = (-1, b'')
