# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Use of matplotlib, imported only for pictures, and without windows."""

from __future__ import annotations

import hashlib
import io
from pathlib import Path
from typing import TYPE_CHECKING

from tree_sway.errors import FormatError, MissingDependencyError
from tree_sway.extras import cure_of_missing
from tree_sway.files import whole_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_DOTS_PER_INCH = 110.0


def new_figure(width: float, height: float) -> Figure:
    """
    Make an empty figure of a size [inch]; a `MissingDependencyError` without matplotlib.

    A notebook shows it, with no need of ``%matplotlib inline``.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ModuleNotFoundError as error:
        cure = cure_of_missing('matplotlib', 'plot')
        raise MissingDependencyError(str(error), cure=cure) from None

    class Shown(Figure):
        def _repr_png_(self) -> bytes:
            picture = io.BytesIO()
            self.savefig(picture, format='png', dpi=80)
            return picture.getvalue()

    figure = Shown(figsize=(width, height), facecolor='white')
    FigureCanvasAgg(figure)
    return figure


def checked_picture(path: str | Path) -> Path:
    """Return the path of a picture; a `FormatError` for a suffix of none."""
    target = Path(path)
    known = new_figure(1.0, 1.0).canvas.get_supported_filetypes()
    if target.suffix[1:].lower() not in known:
        raise FormatError(
            f"'{target.suffix}' is no picture format",
            where=str(target),
            cure=f'end the name with one of: {", ".join("." + k for k in sorted(known))}',
        )
    return target


def save_figure(
    figure: Figure,
    path: str | Path,
    dots_per_inch: float = _DOTS_PER_INCH,
    figures: Path | None = None,
) -> Path:
    """
    Write a figure to a file whose suffix is that of the format, such as ``.png``.

    If a file of its numbers is given, a PNG contains their digest, so that a picture older than
    its numbers is recognised. Raises a `FormatError` for an unknown format, or a file that cannot
    be written.
    """
    target = checked_picture(path)
    with whole_file(target) as partial:
        figure.savefig(
            partial,
            dpi=dots_per_inch,
            format=target.suffix[1:].lower(),
            metadata={'Description': digest_of(figures)} if figures else None,
        )
    return target


def digest_of(figures: Path) -> str:
    """Digest of a file of numbers, for its picture."""
    return hashlib.sha256(figures.read_bytes()).hexdigest()
