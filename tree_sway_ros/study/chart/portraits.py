# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees at rest and in a steady westerly, as the pages show them."""

from __future__ import annotations

import tempfile
from pathlib import Path

from tree_sway_ros.tools import cli
from tree_sway_ros.tools.progress import bar

SPEED = 10.0
"""Of the westerly [m/s]; captions name it."""

PORTRAITS = {
    **{name: name for name in ("benjamina", "goldcrest", "broadleaf")},
    "spruce": "--species spruce --height 14",
    "oak": "--species oak --height 12",
    "forest": "config/forest.yaml",
}
"""Pictures, and the tree of each: a name, a file, or how it is grown."""


def chart_portraits(out_dir: str | Path) -> list[Path]:
    """
    Draw every portrait as ``NAME_in_wind.png``.

    Parameters
    ----------
    out_dir
        Folder to write into; made if it is not there. Files that are there are written over.

    """
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    with tempfile.TemporaryDirectory() as grown:
        for name, tree in bar(list(PORTRAITS.items()), "portraits"):
            if tree.startswith("--"):
                tree_file = str(Path(grown) / f"{name}.yaml")
                cli.main(["grow", *tree.split(), "-o", tree_file])
                tree = tree_file
            file = folder / f"{name}_in_wind.png"
            words = ["--portrait", "--speed", f"{SPEED:g}", "--leaves", "on", "--force"]
            cli.main(["plot", tree, *words, "-o", str(file)])
            files.append(file)
    return files
