# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What grown trees of ten species look like, bare and in leaf, on one sheet."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway.commands import bar
from tree_sway.core.leaves import leaf_clusters
from tree_sway.core.species import species_named
from tree_sway.growth import grow
from tree_sway.pictures import draw_trees, new_figure, save_figure

SPECIES = (
    'oak', 'beech', 'birch', 'ash', 'sycamore', 'walnut', 'spruce', 'sitka', 'pine', 'douglas_fir',
)  # fmt: skip
HEIGHT = 16.0
"""Height of each tree [m]; captions name it."""

_CLUSTERS = 6000
_LIMITS = (-0.51 * HEIGHT, 0.51 * HEIGHT), (-0.07 * HEIGHT, 1.08 * HEIGHT)


def chart_habits(out_dir: str | Path) -> list[Path]:
    """
    Draw ``habits.png``.

    Parameters
    ----------
    out_dir
        Folder to write into; made if it is not there. A file that is there is written over.

    """
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    half = len(SPECIES) // 2
    figure = new_figure(2.9 * half, 13.0)
    axes = figure.subplots(4, half)
    for i, key in enumerate(bar(list(SPECIES), 'habits')):
        tree = grow(key, HEIGHT, rng=np.random.default_rng(1))
        clusters = leaf_clusters(tree, np.random.default_rng(0), count=_CLUSTERS)
        row, column = 2 * (i // half), i % half
        for below, worn in enumerate((None, clusters)):
            here = axes[row + below, column]
            draw_trees(here, [tree], tree.rest_poses, _LIMITS, leaves=worn)
        axes[row, column].set_title(species_named(key).title, y=0.98, fontsize=12)
    figure.subplots_adjust(0.0, 0.0, 1.0, 0.97, 0.0, 0.02)
    return [save_figure(figure, folder / 'habits.png', 80.0)]
