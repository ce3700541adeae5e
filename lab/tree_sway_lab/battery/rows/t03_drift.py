# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T3: drift of the constraint over 1e5 steps (1e7 in full)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.battery.row import fails, holds, Row
from tree_sway_lab.methods import multiplier_form
from tree_sway_lab.methods.chain import single_segment
from tree_sway_lab.methods.method import Method
from tree_sway_lab.methods.multiplier.projection import Projection
from tree_sway_lab.methods.registry import method_named

TITLE = 'drift of the constraint'
DT = 1 / 60
PERIOD = 240  # steps of the wind's period
Array = NDArray[Any]


def run(full: bool = False) -> list[Row]:
    """Follow the gap of the default, of the reference and of two methods that let it grow."""
    steps = 10_000_000 if full else 100_000
    rows = []
    for name in ('exact_foh', 'radau_ggl'):
        length = steps if name == 'exact_foh' else steps // 10
        for kind, bound in ((np.float64, 1e-12), (np.float32, 1e-6)):
            worst = float(gaps(method_named(name), length, kind)[1].max())
            rows.append(
                holds(
                    f'{name}, {length:.0e} steps, {kind.__name__}',
                    f'gap <= {bound:.0e} m',
                    f'{worst:.1e} m',
                    worst <= bound,
                )
            )
    for label, method, slope in (
        ('rk4 unstabilised', method_named('multiplier_rk4'), 2.0),
        ('velocity projection', Projection(position=False), 1.0),
    ):
        length = min(steps, 1_000_000)
        found = drift_slope(*gaps(method, length, np.float64))
        rows.append(
            fails(
                label,
                f'gap grows as t^{slope:.1f} +- .1',
                f't^{found:.2f}',
                abs(found - slope) <= 0.1,
            )
        )
    return rows


def gaps(method: Method, steps: int, kind: Any) -> tuple[Array, Array]:
    """
    Return step numbers, evenly in their logarithm, and the gap at each in [m].

    All sway in a periodic wind but the projection, which swings freely, undamped, so that what it
    loses in a step does not cancel over a period.

    """
    free = isinstance(method, Projection)
    chain = single_segment(2.0, 0.0 if free else 0.05).astype(kind)
    phase = 2 * np.pi * (np.arange(PERIOD)[:, None] + np.asarray(method.nodes)) / PERIOD
    loads = np.stack([1 + np.sin(phase), 8 * np.cos(2 * phase)], -1)[:, :, None, :].astype(kind)
    loads *= 0 if free else 1
    state = method.start(
        chain, np.full(1, 0.5 if free else 0.0, kind), np.zeros(1, kind), loads[0, 0], DT
    )
    options, step, table = method.options(chain, DT).astype(kind), type(method).kernel, chain.table
    marks = np.unique(np.geomspace(10, steps, 60).astype(int))
    out, at = np.empty(len(marks)), 0
    for n in range(1, steps + 1):
        step(table, state, loads[(n - 1) % PERIOD], DT, options)
        if n == marks[at]:
            out[at] = _gap(method, table, state)
            at += 1
    return marks, out


def _gap(method: Method, table: Array, state: Array) -> float:
    """Violation of the constraints, of the coordinates as the method itself places them."""
    q = state[0]
    if method.form == 'minimal':
        q, _ = multiplier_form.place(table, state[0], state[1])
    return float(np.abs(multiplier_form.constraint(table, q)).max())


def drift_slope(marks: Array, gap: Array) -> float:
    """Slope in log-log over the last two decades."""
    late = marks >= marks[-1] / 100
    return float(np.polyfit(np.log(marks[late]), np.log(gap[late]), 1)[0])
