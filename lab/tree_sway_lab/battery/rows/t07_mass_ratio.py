# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T7: mass ratios from 1e-6 to 1e6 in a chain of two."""

from __future__ import annotations

import numpy as np

from tree_sway_lab.battery.row import holds, Row
from tree_sway_lab.methods.chain import DAMPING, PlanarChain, STIFFNESS
from tree_sway_lab.methods.registry import method_named
from tree_sway_lab.methods.trajectory import integrate, sample

TITLE = 'mass ratio'
STEPS, DT = 120, 1 / 60
RATIOS = tuple(10.0**k for k in range(-6, 7, 2))


def pair(ratio: float) -> PlanarChain:
    """Two rods of half a metre, first mode at 2 Hz, joints as stiff as their load is heavy."""
    mass = np.array([1.0, ratio])
    table = np.array([[m, m * 0.25 / 12, 0.25, 0.5, 0.0, 0.0] for m in mass])
    w = 2 * np.pi * 2.0
    table[:, STIFFNESS] = np.diag(PlanarChain(table).mass_matrix)
    table[:, STIFFNESS] *= (w / PlanarChain(table).frequencies[0]) ** 2
    table[:, DAMPING] = 0.1 / w * table[:, STIFFNESS]
    return PlanarChain(table)


def error(name: str, ratio: float, refine: int = 1) -> float:
    """Largest error of both angles in [rad] against the reference at a quarter of the step."""
    chain = pair(ratio)
    weight = chain.table[:, STIFFNESS, None]

    def wind(t: np.ndarray) -> np.ndarray:
        shape = np.stack([0.2 * np.sin(3 * t), 0.4 * np.sin(2 * t)], -1)
        return np.asarray(shape[:, None, :] * weight)

    truth, method = method_named('radau_ggl'), method_named(name)
    exact = integrate(truth, chain, sample(wind, truth.nodes, DT / 4, 4 * STEPS), DT / 4).theta[
        ::4
    ]
    got = integrate(
        method, chain, sample(wind, method.nodes, DT / refine, refine * STEPS), DT / refine
    ).theta[::refine]
    return float(np.abs(got - exact).max())


def run(full: bool = False) -> list[Row]:
    """Compare each ratio's error with the one at 1."""
    rows = []
    for name, floor in (('exact_foh', 0.0), ('radau_ggl', 1e-9)):
        at_one = max(error(name, 1.0), floor)
        errors = {ratio: error(name, ratio) for ratio in RATIOS}
        worst = max(errors, key=lambda ratio: errors[ratio])
        rows.append(
            holds(
                f'{name}, 1e-6 to 1e6',
                'within 3x of the error at 1',
                f'{errors[worst]:.1e} rad at {worst:.0e}, {at_one:.1e} at 1',
                errors[worst] <= 3 * at_one,
            )
        )
    return rows
