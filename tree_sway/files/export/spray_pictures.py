# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Pictures of leaves and bark for files, as the page paints them.

They are made by ``tree-sway lab chart sprays`` from ``static/drawing/textures.js``.
"""

from __future__ import annotations

from pathlib import Path

from tree_sway.core.species import look_of

FOLDER = Path(__file__).with_name('pictures')


def leaf_picture(species: str) -> bytes:
    """Return the spray of a species as PNG, cut out by its alpha; x is along the shoot."""
    path = FOLDER / f'{species}.png'
    if not path.exists():  # a species of the user's own
        like = 'broadleaf' if look_of(species).form not in ('needles', 'bunches') else 'conifer'
        path = FOLDER / f'{like}.png'
    return path.read_bytes()


def bark_picture(pattern: str) -> bytes:
    """Return the shares of a bark's colour as PNG, twice as high as wide; it tiles both ways."""
    return (FOLDER / f'bark_{pattern}.png').read_bytes()
