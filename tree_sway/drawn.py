# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What has a picture: `Drawn.plot`, which a notebook shows by itself.

Who draws is found by the entry points ``tree_sway.pictures``: the name of a kind, and a function
that makes a figure of matplotlib of it.
"""

from __future__ import annotations

import base64
from html import escape
from importlib.metadata import entry_points
import io
from typing import Any


class Drawn:
    """An object of a kind that somebody draws."""

    def plot(self) -> Any:
        """Return a figure of it; a `ModuleNotFoundError` without matplotlib."""
        kind = type(self).__name__
        for point in entry_points(group='tree_sway.pictures', name=kind):
            return point.load()(self)
        raise ModuleNotFoundError(f'nothing that draws a {kind} is installed', name='tree_sway')

    def _repr_html_(self) -> str | None:
        """Return its line of text above its picture, for a notebook; None without matplotlib."""
        try:
            figure = self.plot()
        except ModuleNotFoundError:
            return None
        picture = io.BytesIO()
        figure.savefig(picture, format='png', dpi=80)
        data = base64.b64encode(picture.getvalue()).decode()
        return f'{escape(repr(self))}<br><img src="data:image/png;base64,{data}">'
