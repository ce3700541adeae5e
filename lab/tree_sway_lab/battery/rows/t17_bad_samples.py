# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T17: one sample that cannot be: NaN, infinity, 1e300, 1e6 m/s."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.wind import WindGate
from tree_sway_lab.battery.branch_runs import Branch
from tree_sway_lab.battery.row import holds, Row

TITLE = 'bad samples'
BAD = (np.nan, np.inf, -np.inf, 1e300, 1e6)
STEPS, AT = 240, 120


def run(full: bool = False) -> list[Row]:
    """Pass a smooth wind with one bad sample through gate and kernel; then only the kernel."""
    rows = []
    for kind in (np.float64, np.float32):
        for bad in BAD:
            clean, spoilt = _gated(None, kind), _gated(bad, kind)
            at_once = float(np.abs(spoilt[AT + 1] - clean[AT + 1])[:2].max())
            later = float(np.abs(spoilt[AT + 2] - clean[AT + 2])[:2].max())
            rows.append(
                holds(
                    f'gate and kernel, {bad:g} m/s once, {kind.__name__}',
                    'finite; within 3e-4 rad one step later',
                    f'{at_once:.1e} at the sample, {later:.1e} rad one step later',
                    bool(np.isfinite(spoilt).all()) and max(at_once, later) <= 3e-4,
                )
            )
    branch = Branch()
    finite, peak = True, 0.0
    for bad in BAD:
        for axis in range(3):
            loads = np.tile([0.0, 0.2, 0.1], (STEPS, 1))
            loads[AT, axis] = bad
            states = branch.run(loads)
            finite = finite and bool(np.isfinite(states).all())
            peak = max(peak, float(np.hypot(states[:, 0], states[:, 1]).max()))
    rows.append(
        holds(
            'kernel alone, the same as loads',
            'finite, below 3 rad',
            f'peak {peak:.2f} rad',
            finite and peak < 3.0,
        )
    )
    return rows


def _gated(bad: float | None, kind: type) -> NDArray[np.float64]:
    """States under a smooth wind at 60 Hz, bad samples replaced by the last good one."""
    gate, branch = WindGate(), Branch()
    last, loads = np.zeros(3), np.zeros((STEPS, 3))
    for n in range(STEPS):
        t = n / 60
        wind = np.array([5 + np.sin(1.5 * t), 2 * np.sin(1.1 * t), 0.3 * np.cos(2 * t)])
        if n == AT and bad is not None:
            wind[0] = bad
        if gate.offer(round(1e9 * (t + 1.0)), wind).accepted:
            last = wind
        loads[n] = 0.004 * np.linalg.norm(last) * last[[2, 0, 1]]
    return branch.run(loads, dtype=kind)
