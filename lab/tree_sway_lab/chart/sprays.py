# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The page's own pictures of leaves and bark, painted in a headless Chromium for files."""

from __future__ import annotations

import asyncio
import base64
import io
import json
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.core.leaves import leaf_clusters
from tree_sway.core.species import SPECIES
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.growth import builtin_tree, BUILTIN_TREES, grow
from tree_sway.page import PageServer, PageSettings
from tree_sway_lab.browser import Browser, chromium

_PIXELS = 256
_COLORS = 64
_HEIGHT = 15.0
"""Height of the tree whose sprays are painted [m]."""

_PATTERNS = ('furrows', 'plates', 'scales', 'smooth', 'dashes', 'flakes')
_PAINT = """(async (looks, patterns, pixels) => {
  const { href } = new URL('static/drawing/textures.js', location.href);
  const { barkPicture, leafPicture, leavesAlong } = await import(href);
  const url = (canvas) => canvas.toDataURL('image/png');
  // Viewers light a crown less than the page does.
  const lit = (color) => color.map((each) => 1.4 * each);
  const bright = (look) => ({ ...look, green: lit(look.green), fresh: lit(look.fresh) });
  const leaves = Object.entries(looks).map(([key, { look, long }]) =>
    [key, url(leafPicture(bright(look), Math.max(5, leavesAlong(look, long)), { size: pixels }))]);
  const bark = patterns.map((pattern) => [`bark_${pattern}`, url(barkPicture(pattern))]);
  return Object.fromEntries([...leaves, ...bark]);
})"""


def chart_sprays(out_dir: str | Path) -> list[Path]:
    """
    Paint ``SPECIES.png`` of every species and ``bark_PATTERN.png`` of every bark.

    Parameters
    ----------
    out_dir
        Folder to write into; made if it is not there. A file that is there is written over.

    Raises
    ------
    ParameterError
        No Chromium is installed here.

    """
    if chromium() is None:
        raise ParameterError('there is no browser', where='chart sprays', cure='install chromium')
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    looks = {}
    for key, species in SPECIES.items():
        clusters = leaf_clusters(_typical(key), np.random.default_rng(0))
        long = species.look.spray.length * float(clusters.size.mean())
        looks[key] = {'look': species.look.described(species.leaves, species.habit), 'long': long}
    painted = asyncio.run(_painted(looks))
    return [_saved(folder / f'{name}.png', url) for name, url in painted.items()]


def _typical(key: str) -> Tree:
    if key in BUILTIN_TREES:
        return builtin_tree(key)
    return grow(key, _HEIGHT, rng=np.random.default_rng(0))


async def _painted(looks: dict[str, Any]) -> dict[str, str]:
    with PageServer(PageSettings(port=0), None, dict) as server:
        async with Browser() as browser:
            await browser.open(server.url)
            await browser.until("document.readyState === 'complete'")
            given = ', '.join(json.dumps(each) for each in (looks, _PATTERNS, _PIXELS))
            painted: dict[str, str] = await browser.run(f'{_PAINT}({given})')
    return painted


def _saved(path: Path, url: str) -> Path:
    """Save a picture with as few colours as look the same."""
    from PIL import Image

    image = Image.open(io.BytesIO(base64.b64decode(url.partition(',')[2])))
    image.quantize(_COLORS, Image.Quantize.FASTOCTREE).save(path, optimize=True)
    return path
