# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How the drag of still air damps a free swing, against its closed form."""

from __future__ import annotations

import numpy as np

from tree_sway.core.drag import AIR_DENSITY
from tree_sway.core.scene import make_simulator
from tree_sway.core.species import species_named
from tree_sway_lab.example_trees import tapered_stem
from tree_sway_lab.validation.section import Check, Effort, Section

MODELS = ('branch', 'full')

_LENGTH, _WIDTH, _ANGLE = 2.0, 0.02, 0.1
_RATE, _CYCLES = 2000, 12


def measure(effort: Effort) -> Section:
    """Let a uniform stem swing freely."""
    growth = closed_form()
    checks = [
        Check(f'`{model}`, relative error', each / growth - 1.0, -0.03, 0.03)
        for model, each in zip(MODELS, effort.each(growth_of, MODELS), strict=True)
    ]
    text = (
        'A uniform stem without damping of its own: one over the amplitude of its tip grows in '
        'each cycle by 8/3 of the drag of all pieces over the inertia (energy over a cycle).'
    )
    return Section('Damping by still air', text, checks)


def closed_form() -> float:
    """Growth of one over the tip's amplitude per cycle in [1/m]."""
    wood, s = species_named('broadleaf'), np.linspace(0.0, 1.0, 2001)
    psi = (6.0 * s**2 - 4.0 * s**3 + s**4) / 3.0
    drag = 0.5 * AIR_DENSITY * wood.bare_drag_coefficient * _WIDTH
    line_mass = wood.density * np.pi / 4.0 * _WIDTH**2
    ratio = _trapezium(drag * psi**3, s) / _trapezium(line_mass * psi**2, s)
    return 8.0 / 3.0 * ratio


def growth_of(model: str) -> float:
    """Measure it on one branch that swings by 0.1 rad at first."""
    tree, wood = tapered_stem(_LENGTH, np.full(9, _WIDTH)), species_named('broadleaf')
    sim = make_simulator(
        tree, wood, model=model, gravity=0.0, damping_ratio=0.0, in_leaf=False, enrich='none'
    )
    x, v = sim.banks[0].oscillators.motion()
    x[0] = _ANGLE
    sim.banks[0].oscillators.take_over(x, v)
    tip = []
    for _ in range(round((_CYCLES + 0.2) * _RATE / sim.frequencies(1)[0])):
        sim.step((0.0, 0.0, 0.0), 1.0 / _RATE)
        tip.append(np.hypot(*sim.tip_displacement[:2]))
    way = np.array(tip)
    tops = np.flatnonzero((way[1:-1] > way[:-2]) & (way[1:-1] >= way[2:])) + 1
    return float(np.polyfit(0.5 * np.arange(len(tops)), 1.0 / way[tops], 1)[0])


def _trapezium(y: np.ndarray, x: np.ndarray) -> float:
    return float(0.5 * ((y[1:] + y[:-1]) * np.diff(x)).sum())
