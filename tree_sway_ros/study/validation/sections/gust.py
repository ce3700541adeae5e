# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A calm that a gust ends: what ``auto`` shows, against the full model."""

from __future__ import annotations

from functools import partial

import numpy as np

from tree_sway_ros.core.fidelity.adaptive import AdaptiveSimulator
from tree_sway_ros.core.simulator.protocol import TreeSimulator
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.study.validation.judge import SETTINGS, WOOD
from tree_sway_ros.study.validation.section import Check, Effort, Section, markdown_table
from tree_sway_ros.study.validation.sections.models import SEEDS, tree_called
from tree_sway_ros.study.validation.winds import FRAME

GUSTS = ((0.0, 10.0), (3.0, 12.0))
"""Wind speeds before and after in [m/s]."""

MET_AFTER = 0.3
"""Time from which on the shown tip must be near the full model's in [s]."""

_TOLERANCE = 0.005
_BEFORE, _AFTER = 20.0, 4.0


def measure(effort: Effort) -> Section:
    """Step from calm to 10 and from 3 to 12 m/s."""
    names = ["straight 1", *map(str, SEEDS[:3])]
    cases = [(name, gust) for name in names for gust in GUSTS]
    found = effort.each(partial(_met), cases)
    checks = [
        Check(
            f"gap of the highest tip over its way from {MET_AFTER:g} s on, largest",
            max(gap for gap, _ in found),
            high=0.1,
        ),
        Check(
            "move per frame beyond the full model's, largest [mm]",
            max(jump for _, jump in found),
            high=1.0,
        ),
    ]
    rows = [
        [tree_called(name).name, f"{before:g} to {after:g} m/s", f"{gap:.3f}", f"{jump:.2f}"]
        for (name, (before, after)), (gap, jump) in zip(cases, found, strict=True)
    ]
    text = (
        f"`auto` with a tolerance of {1e3 * _TOLERANCE:g} mm against `coupled`: {_BEFORE:g} s of "
        "one wind, then at once the other."
    )
    head = ["tree", "wind", "gap", "move beyond [mm]"]
    return Section("A gust met at once", text, checks, markdown_table(head, rows))


def _met(case: tuple[str, tuple[float, float]]) -> tuple[float, float]:
    """Largest gap over way, and largest move of a segment per frame beyond the model's in [mm]."""
    name, (before, after) = case
    tree = tree_called(name)
    shown: TreeSimulator = AdaptiveSimulator(tree, WOOD, SETTINGS, tolerance=_TOLERANCE)
    full: TreeSimulator = SwaySimulator(tree, WOOD, SETTINGS, model="coupled")
    places = np.empty((2, 2, tree.n_segments, 3))
    gaps, beyond = [0.0], [0.0]
    for frame in range(round((_BEFORE + _AFTER) / FRAME)):
        wind = (before if frame * FRAME < _BEFORE else after, 0.0, 0.0)
        for model, place in zip((shown, full), places, strict=True):
            model.step(wind, FRAME)
            place[0], place[1] = place[1], model.place()[:, :3]
        since = (frame + 1) * FRAME - _BEFORE
        if since > 0.0:
            move = np.abs(places[:, 1] - places[:, 0]).max(axis=(1, 2))
            beyond.append(1e3 * float(move[0] - move[1]))
        if since >= MET_AFTER:
            way = np.linalg.norm(full.tip_displacement)
            gap = np.linalg.norm(shown.tip_displacement - full.tip_displacement)
            gaps.append(float(gap / way))
    return max(gaps), max(beyond)
