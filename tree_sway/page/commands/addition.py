# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a house adds to ``tree-sway show``."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING

from tree_sway.core.scene import Scene, Simulator
from tree_sway.core.settings import Settings
from tree_sway.page import Choices
from tree_sway.stream import Control, Value

if TYPE_CHECKING:
    from tree_sway.live import MotionFeed


class PageAddition:
    """
    What a house adds to ``tree-sway show``: a class at an entry point of ``tree_sway.show``.

    It is made of the arguments, and refuses there what is wrong with them, before slow work. A
    house overrides what it needs, and nothing else.

    Parameters
    ----------
    arguments
        Arguments of the command.

    """

    motion: MotionFeed | None = None
    """Live sensors that the page reports, set by `open`."""

    @staticmethod
    def add_arguments(parser: argparse.ArgumentParser) -> None:
        """Add arguments to the command."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self.arguments = arguments

    def open(self, stack: ExitStack) -> None:  # noqa: A003
        """Open what stays open while the page is served; the stack closes it."""

    def controls(self) -> tuple[Control, ...]:
        """
        Make controls that the page shows before its own.

        One that is a field of `Choices` makes the tree anew; any other is for `apply`.
        """
        return ()

    def apply(self, name: str, value: Value) -> bool:
        """Do what a control asks, in the thread of the server; False if it is of another."""
        return False

    def facts(self, simulator: Simulator) -> Mapping[str, str]:
        """Return names and values that the page lists; called twice a second by the server."""
        return {}

    def simulator(self, scene: Scene, settings: Settings, choices: Choices) -> Simulator | None:
        """Make the simulator of the tree that the command names; None for the usual one."""
        return None

    def critical_winds(self, names: Sequence[str]) -> dict[str, tuple[float, float]] | None:
        """Return the winds by which trees are coloured, by their names; None for no colours."""
        return None

    def note(self, simulator: Simulator) -> None:
        """Keep what is new; called some ten times a second, and at the end."""

    def tell(self, simulator: Simulator) -> None:
        """Print what came of it, when the page has ended."""
