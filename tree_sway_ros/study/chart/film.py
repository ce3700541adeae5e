# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A few seconds of a pot plant in gusts, as a moving picture that goes round without a seam."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.scene.make import make_simulator
from tree_sway_ros.files.trees.source import open_tree
from tree_sway_ros.tools.progress import bar
from tree_sway_ros.view.animation import animate_poses

TREE = "benjamina"
PERIOD, RATE, EVERY = 4.0, 60, 6
"""Of the gusts in [s], steps per second, and steps per picture."""

_SETTLING = 5
_LEAVES, _PIXELS = 900, 420


def chart_film(out_dir: str | Path) -> Path:
    """
    Draw ``TREE_sways.gif``.

    Parameters
    ----------
    out_dir
        Folder to write into; made if it is not there.

    """
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    opened = open_tree(TREE)
    simulator = make_simulator(opened.tree, opened.species)
    frames, winds = [], []
    steps = round(PERIOD * RATE)
    for step in bar(range((_SETTLING + 1) * steps), "swaying"):
        wind = gusts(step / RATE)
        simulator.step(wind, 1.0 / RATE)
        if step >= _SETTLING * steps and step % EVERY == 0:
            frames.append(np.array(simulator.place()))
            winds.append(wind)
    file = folder / f"{TREE}_sways.gif"
    leaves = opened.leaves(None, _LEAVES)
    rate = RATE / EVERY
    return animate_poses(
        opened.tree, frames, np.array(winds), file, rate=rate, leaves=leaves, pixels=_PIXELS
    )


def gusts(time: float) -> Floats:
    """Wind of one westerly gust per period in [m/s], (3,), the same in every period."""
    phase = 2.0 * np.pi * time / PERIOD
    return np.array([9.0 - 6.0 * np.cos(phase), 2.0 * np.sin(phase), 0.0])
