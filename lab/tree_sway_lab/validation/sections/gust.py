# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A calm that a gust ends: what ``auto`` shows, against the full model."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from tree_sway.core.scene import make_simulator
from tree_sway.core.setup import prepare
from tree_sway.fidelity import AdaptiveSimulator
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.sections.models import SEEDS
from tree_sway_lab.validation.truth import SETTINGS, WOOD
from tree_sway_lab.validation.winds import FRAME

GUSTS = ((0.0, 10.0), (3.0, 12.0))
"""Wind speeds before and after in [m/s]."""

MET_AFTER = 0.3
"""Time from which on the shown tip must be near the full model's in [s]."""

_TOLERANCE = 0.005
_BEFORE, _AFTER = 20.0, 4.0


def measure(effort: Effort) -> Section:
    """Step from calm to 10 and from 3 to 12 m/s."""
    names = ['straight 1', *(f'crooked {seed}' for seed in SEEDS[:3])]
    cases = [(name, gust) for name in names for gust in GUSTS]
    found = effort.each(partial(_met), cases)
    checks = [
        Check(
            f'gap of the highest tip over its greatest displacement yet, from {MET_AFTER:g} s on',
            max(of.gap for of in found),
            high=0.1,
        ),
        Check(
            "move in a frame with another number beyond the full model's, largest [mm]",
            max(of.jump for of in found),
            high=1.0,
        ),
        Check(
            f'gap over the displacement of the moment, from {MET_AFTER:g} s on',
            max(of.gap_of_now for of in found),
            high=0.1,
        ),
        Check(
            "move in any frame beyond the full model's, largest [mm]",
            max(of.jump_of_any for of in found),
            high=1.0,
        ),
    ]
    rows = [
        [
            kind_called(name).name, f'{before:g} to {after:g} m/s',
            f'{of.gap:.3f}', f'{of.gap_of_now:.3f}', f'{of.jump:.2f}', f'{of.jump_of_any:.2f}',
        ]
        for (name, (before, after)), of in zip(cases, found, strict=True)
    ]  # fmt: skip
    text = (
        f'`auto` with a tolerance of {1e3 * _TOLERANCE:g} mm against `full`: {_BEFORE:g} s of '
        'one wind, then at once the other. A tip that swings back passes close to its place at '
        'rest; the gap over the displacement of that very moment is next to it. So does the '
        "largest move of any frame beyond the full model's, whatever was chosen in it."
    )
    head = ['tree', 'wind', 'gap', 'gap of the moment', 'move beyond [mm]', 'of any frame [mm]']
    return Section('A gust met at once', text, checks, markdown_table(head, rows))


class _Met(NamedTuple):
    """How one gust was met: gaps over displacement, and moves beyond the full model's in [mm]."""

    gap: float
    gap_of_now: float
    jump: float
    jump_of_any: float


def _met(case: tuple[str, tuple[float, float]]) -> _Met:
    """Meet one gust."""
    name, (before, after) = case
    tree = kind_called(name)
    shown = AdaptiveSimulator(prepare(tree, WOOD, SETTINGS), tolerance=_TOLERANCE)
    full = make_simulator(tree, WOOD, SETTINGS, model='full')
    places = np.empty((2, 2, tree.n_segments, 3))
    found, farthest = _Met(0.0, 0.0, 0.0, 0.0), 0.0
    for frame in range(round((_BEFORE + _AFTER) / FRAME)):
        wind = (before if frame * FRAME < _BEFORE else after, 0.0, 0.0)
        before_step = shown.choice.n_coordinates
        for model, place in zip((shown, full), places, strict=True):
            model.step(wind, FRAME)
            place[0], place[1] = place[1], model.place()[:, :3]
        since = (frame + 1) * FRAME - _BEFORE
        if since <= 0.0:
            continue
        move = np.abs(places[:, 1] - places[:, 0]).max(axis=(1, 2))
        beyond, gaps = 1e3 * float(move[0] - move[1]), (0.0, 0.0)
        now = float(np.linalg.norm(full.tip_displacement))
        farthest = max(farthest, now)
        if since >= MET_AFTER:
            gap = float(np.linalg.norm(shown.tip_displacement - full.tip_displacement))
            gaps = gap / farthest, gap / now
        here = _Met(*gaps, beyond if shown.choice.n_coordinates != before_step else 0.0, beyond)
        found = _Met(*map(max, found, here))
    return found
