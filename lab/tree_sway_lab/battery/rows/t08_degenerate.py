# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T8: twelve bodies without inertia, damping or stiffness, or with extreme ones."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from tree_sway.core.oscillators import propagator
from tree_sway.errors import TreeSwayError
from tree_sway_lab.battery.branch_runs import run_branch
from tree_sway_lab.battery.row import holds, Row
from tree_sway_lab.methods.branch_bank import guards
from tree_sway_lab.methods.chain import PlanarChain, single_segment

TITLE = 'degenerate bodies'
DT = 1 / 60
# I [kg m^2], k2 [N m s], k1 [N m] and how each must end under a steady side load of 0.8 N m
BODIES = (
    ('ordinary', 1.0, 5.0, 160.0, 'static'),
    ('no inertia', 0.0, 0.5, 2.0, 'static'),
    ('no inertia, no damping', 0.0, 0.0, 2.0, 'static'),
    ('inertia of 1e-300', 1e-300, 0.5, 2.0, 'static'),
    ('mass of a dust grain', 1e-15, 1e-9, 1.0, 'finite'),
    ('no damping', 1.0, 0.0, 160.0, 'finite'),
    ('no stiffness', 1.0, 5.0, 0.0, 'finite'),
    ('no stiffness, no damping', 1.0, 0.0, 0.0, 'finite'),
    ('no stiffness, no inertia', 0.0, 5.0, 0.0, 'finite'),
    ('overdamped a thousand times', 1.0, 2e3, 1.0, 'finite'),
    ('stiff as a rock', 1e-3, 1.0, 1e12, 'static'),
    ('nothing at all', 0.0, 0.0, 0.0, 'refused'),
)


def outcome(inertia: float, damping: float, stiffness: float) -> tuple[str, float]:
    """Return "finite" or "refused" and the error of the static angle after 20 s."""
    try:
        row = propagator(inertia, damping, stiffness, DT)[0]
    except TreeSwayError as error:
        return ('refused' if 'oscillator 0' in str(error) else 'nameless'), np.nan
    guard = guards(np.array([inertia]), np.array([stiffness]), DT)[0]
    load = np.tile([0.0, 0.8, 0.0], (1200, 1))
    states = run_branch(load, row, guard, np.zeros(4))
    if not np.isfinite(states).all():
        return 'not finite', np.nan
    if stiffness == 0:
        return 'finite', np.nan
    s = 0.8 / stiffness
    return 'finite', abs(states[-1, 0] - brentq(lambda x: x - s * np.cos(x), 0, 1.6, xtol=1e-15))


def run(full: bool = False) -> list[Row]:
    """Swing each for 20 s; then chains that must be refused with the segment's number."""
    rows = []
    for name, inertia, damping, stiffness, wanted in BODIES:
        found, error = outcome(inertia, damping, stiffness)
        if wanted == 'static':
            rows.append(
                holds(
                    name,
                    'finite, static angle right to 1e-6',
                    f'{found}, {error:.0e} rad',
                    found == 'finite' and error <= 1e-6,
                )
            )
        else:
            rows.append(holds(name, wanted, found, found == wanted))
    good = single_segment().table[0]
    for name, column, value in (
        ('chain, zero mass and inertia', slice(0, 2), 0.0),
        ('chain, NaN length', slice(3, 4), np.nan),
        ('chain, negative stiffness', slice(4, 5), -1.0),
    ):
        table = np.stack([good, good])
        table[1, column] = value
        try:
            PlanarChain(table)
            found = 'accepted'
        except TreeSwayError as error:
            found = str(error)
        rows.append(holds(name, "refused with the segment's number", found, 'segment 1' in found))
    return rows
