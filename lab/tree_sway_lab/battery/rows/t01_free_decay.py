# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T1: free decay at every ratio of step to period, with and without damping."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.oscillators import propagator
from tree_sway_lab.battery.branch_runs import run_branch
from tree_sway_lab.battery.row import fails, holds, Row
from tree_sway_lab.methods.branch_bank import single_precision
from tree_sway_lab.methods.chain import single_segment
from tree_sway_lab.methods.method import Method
from tree_sway_lab.methods.registry import method_named

TITLE = 'free decay'
DT = 1 / 60
RATIOS = (0.01, 0.1, 1.0, 1.9, 2.1, 3.0, 10.0, 30.0, 100.0, 1000.0)
DAMPING = (0.0, 0.05, 1.0, 5.0)
STEPS = 2000
DEAD = 1e3  # growth of the amplitude that counts as gone
Array = NDArray[Any]


def run(full: bool = False) -> list[Row]:
    """Watch the energy of the kernel and of the reference; let the four classic methods die."""
    rows = []
    for kind, bound in ((np.float64, 1e-9), (np.float32, 1e-5)):
        worst = max(kernel_growth(r, z, kind) for r in RATIOS for z in DAMPING)
        rows.append(
            holds(
                f'exact_foh kernel, w h .01-1000, z 0-5, {kind.__name__}',
                f'energy never grows ({bound:.0e})',
                f'{worst:.1e}',
                worst <= bound,
            )
        )
    steps = STEPS if full else 200
    for kind, bound in ((np.float64, 1e-9), (np.float32, 1e-5)):
        worst = max(
            growth(method_named('radau_ggl'), r, z, steps, 1e-2, kind)
            for r in RATIOS
            for z in DAMPING
        )
        rows.append(
            holds(
                f'radau_ggl, the same, {steps} steps, {kind.__name__}',
                f'energy never grows ({bound:.0e})',
                f'{worst:.1e}',
                worst <= bound,
            )
        )
    for name, ratio in (
        ('semi_implicit_euler', 2.1),
        ('rk4', 3.0),
        ('multiplier_explicit_euler', 0.1),
        ('newmark', 1.9),
    ):
        energy = growth(method_named(name), ratio, 0.0, STEPS, 1e-2, np.float64)
        rows.append(
            fails(
                f'{name} at w h = {ratio}', 'dies', f'energy x {1 + energy:.1e}', not energy < DEAD
            )
        )
    return rows


def kernel_growth(ratio: float, damping_ratio: float, kind: Any) -> float:
    """
    Largest rise of the energy over the one before, relative to the first, in free motion.

    A body at rest at an angle, and one thrown; energy of the oscillator in the plane.

    """
    w = ratio / DT
    row = propagator(1.0, 2 * damping_ratio * w, w * w, DT)[0]
    row = row if kind == np.float64 else single_precision(row)
    guard = np.array([0.0, np.inf, np.inf]).astype(kind)
    worst = 0.0
    for start in ((0.3, 0.0), (0.0, 0.3 * w)):
        states = run_branch(
            np.zeros((STEPS, 3), kind),
            row,
            guard,
            np.array([start[0], 0.0, start[1], 0.0]).astype(kind),
        ).astype(float)
        energy = (states[:, 2] / w) ** 2 + states[:, 0] ** 2
        worst = max(worst, _rise(energy))
    return worst


def growth(
    method: Method, ratio: float, damping_ratio: float, steps: int, angle: float, kind: Any
) -> float:
    """Largest rise of a method's energy over its smallest before, relative to the first."""
    w = ratio / DT
    chain = single_segment(w / (2 * np.pi), damping_ratio).astype(kind)
    calm = np.zeros((1, len(method.nodes), 1, 2), kind)
    state = method.start(chain, np.array([angle], kind), np.zeros(1, kind), calm[0, 0], DT)
    options = method.options(chain, DT).astype(kind)
    energy = []
    for _ in range(steps):
        x, v = float(method.angles(state)[0]), float(method.rates(state)[0])
        energy.append((v / w) ** 2 + x * x)
        if not energy[-1] < 1e12:
            break
        if type(method).kernel(chain.table, state, calm[0], DT, options) < 0:
            energy.append(np.inf)
            break
    return _rise(np.array(energy))


def _rise(energy: NDArray[np.float64]) -> float:
    lowest = np.minimum.accumulate(energy)
    with np.errstate(invalid='ignore'):
        return float(np.max((energy[1:] - lowest[:-1]) / energy[0]))
