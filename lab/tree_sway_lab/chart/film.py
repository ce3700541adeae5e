# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A few seconds of a pot plant in gusts, as a moving picture that goes round without a seam."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.commands import bar
from tree_sway.core.arrays import Floats
from tree_sway.core.scene import Scene
from tree_sway.files.trees import open_scene
from tree_sway.pictures import animate_poses

TREE = 'benjamina'
PERIOD, RATE, EVERY = 4.0, 60, 6
"""Period of the gusts [s], steps per second, and steps per picture."""

_SETTLING = 5
_LEAVES, _PIXELS = 3000, 420


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
    opened = open_scene(TREE)
    frames, winds, _ = _swayed(opened)
    file = folder / f'{TREE}_sways.gif'
    leaves = opened.leaves(None, _LEAVES)
    return animate_poses(
        opened.tree, frames, winds, file, rate=RATE / EVERY, leaves=leaves, pixels=_PIXELS
    )


def film_figures() -> dict[str, Any]:
    """Figures of what the film shows: segments, height, largest displacement of its tip in [m]."""
    opened = open_scene(TREE)
    tips = _swayed(opened)[2]
    east, _, up = tips[np.argmax(np.linalg.norm(tips, axis=1))].tolist()
    return {'segments': opened.tree.n_segments, 'height': f'{opened.tree.height:.4f}',
            'tip_east': f'{east:.4f}', 'tip_up': f'{up:.4f}'}  # fmt: skip


def _swayed(opened: Scene) -> tuple[list[Floats], Floats, Floats]:
    """Poses, wind and displacement of the tip in every picture of one period."""
    simulator = opened.simulator()
    frames, winds, tips = [], [], []
    steps = round(PERIOD * RATE)
    for step in bar(range((_SETTLING + 1) * steps), 'swaying'):
        wind = gusts(step / RATE)
        simulator.step(wind, 1.0 / RATE)
        if step >= _SETTLING * steps and step % EVERY == 0:
            frames.append(np.array(simulator.place()))
            winds.append(wind)
            tips.append(simulator.tip_displacement)
    return frames, np.array(winds), np.array(tips)


def gusts(time: float) -> Floats:
    """Wind of one westerly gust per period in [m/s], (3,), the same in every period."""
    phase = 2.0 * np.pi * time / PERIOD
    return np.array([9.0 - 6.0 * np.cos(phase), 2.0 * np.sin(phase), 0.0])
