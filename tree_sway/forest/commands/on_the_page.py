# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``--risk`` of ``tree-sway show``: trees coloured by the wind at which they fail."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from tree_sway.errors import ParameterError
from tree_sway.files.scenes import read_critical_winds
from tree_sway.page.commands import PageAddition


class RiskOnThePage(PageAddition):
    """Critical winds of a table of ``tree-sway risk``."""

    @staticmethod
    def add_arguments(parser: argparse.ArgumentParser) -> None:
        """Add ``--risk``."""
        parser.add_argument(
            '--risk', metavar='FILE',
            help='table of tree-sway risk of the inventory: a slider of the storm colours the '
            'trees',
        )  # fmt: skip

    def __init__(self, arguments: argparse.Namespace) -> None:
        super().__init__(arguments)
        self._winds = None if arguments.risk is None else read_critical_winds(arguments.risk)

    def critical_winds(self, names: Sequence[str]) -> dict[str, tuple[float, float]] | None:
        """Return those of the trees that the table names."""
        winds = self._winds
        if winds is None:
            return None
        found = {name: winds[name] for name in names if name in winds}
        if not found:
            what = f"no tree is called as one of the table, such as '{next(iter(winds), '')}'"
            cure = 'name the inventory of which tree-sway risk wrote the table'
            raise ParameterError(what, where='--risk', cure=cure)
        return found
