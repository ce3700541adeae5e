# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What has a picture: `Drawn.plot`, which a notebook shows by itself.

Who draws is found by the entry points ``tree_sway.pictures``: the name of a kind, and a function
that makes a figure of matplotlib of it.
"""

from __future__ import annotations

from importlib.metadata import entry_points
from typing import Any


class Drawn:
    """An object of a kind that somebody draws."""

    def plot(self, kind: str = '') -> Any:
        """Return a figure of it, as of a kind; None where nothing that draws it is installed."""
        for point in entry_points(group='tree_sway.pictures', name=kind or type(self).__name__):
            return point.load()(self)
        return None

    def _repr_html_(self) -> Any:
        """Return its line of text above its picture, for a notebook; None without matplotlib."""
        return self.plot('html')
