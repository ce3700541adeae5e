# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T16: coefficients of the propagator against 80 digits, and the clock after 30 days."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np

from tree_sway.core.oscillators import propagator
from tree_sway.errors import MissingDependencyError
from tree_sway_lab.battery.row import fails, holds, Row
from tree_sway_lab.kernel import kernel

TITLE = 'coefficients and clock'
RATIOS = (0, 1e-8, 1e-3, 0.02, 0.05, 0.5, 0.999, 1, 1.0000001, 1.001, 1.05, 1.2, 2, 5, 50, 1000)
DAYS, RATE = 30, 60


def _mpmath() -> Any:
    try:
        import mpmath  # type: ignore[import-untyped]
    except ImportError as error:
        raise MissingDependencyError(
            'mpmath is not installed', where='battery T16', cure='pip install mpmath'
        ) from error
    return mpmath


def textbook(inertia: float, damping: float, stiffness: float, dt: float) -> tuple[list[Any], Any]:
    """Return the eight coefficients by the textbook formulas in 80 digits, and the scale of c5."""
    mp = _mpmath()
    with mp.workdps(80):
        i, c, k, h = (mp.mpf(float(value)) for value in (inertia, damping, stiffness, dt))
        a, kap = c / (2 * i), k / i
        root = mp.sqrt(mp.mpc(a * a - kap))
        fast, slow = mp.exp((-root - a) * h), mp.exp((root - a) * h)
        s = ((slow - fast) / (2 * root)).real if root else h * mp.exp(-a * h)
        mean = ((slow + fast) / 2).real
        g = mean + a * s
        p1 = (1 - g) / kap
        p2 = (h - s - 2 * a * p1) / (kap * h)
        row = [g, s, (p1 - p2) / i, p2 / i, -kap * s, mean - a * s, (s - p1 / h) / i, p1 / h / i]
        return row, abs(mean) + abs(a * s)


def worst_coefficient(exponents: range) -> float:
    """Largest relative error of any coefficient; that of c5, which crosses 0, by its terms."""
    worst = 0.0
    for exponent in exponents:
        for ratio in RATIOS:
            inertia, dt = 0.37, 1 / 60
            w = 10.0**exponent / dt
            damping, stiffness = 2 * ratio * w * inertia, inertia * w * w
            exact, scale = textbook(inertia, damping, stiffness, dt)
            got = propagator(inertia, damping, stiffness, dt)[0]
            for k, true in enumerate(exact):
                unit = scale if k == 5 else abs(true)
                if unit > 1e-290:
                    worst = max(worst, float(abs(got[k] - true) / unit))
    return worst


@kernel
def summed_clock(ticks: int, dt: float) -> float:
    """Time as t += h, which is not how the clock counts."""
    t = 0.0
    for _ in range(ticks):
        t += dt
    return t


def run(full: bool = False) -> list[Row]:
    """Compare coefficients from w h 1e-8 to 1e4, and two clocks with the fraction."""
    worst = worst_coefficient(range(-8, 5))
    ticks = DAYS * 86400 * RATE
    exact = Fraction(ticks) * Fraction(1 / RATE)
    counted = float(abs(Fraction(ticks * (1 / RATE)) - exact))
    drift = float(abs(Fraction(summed_clock(ticks, 1 / RATE)) - exact))
    return [
        holds(
            'coefficients, w h 1e-8 to 1e4, z 0 to 1000',
            '<= 1e-12 relative',
            f'{worst:.1e}',
            worst <= 1e-12,
        ),
        holds(
            f'ticks times h after {DAYS} days',
            'exact to rounding',
            f'{counted:.0e} s',
            counted <= float(np.spacing(ticks / RATE)),
        ),
        fails(f't += h after {DAYS} days', 'drifts', f'{drift:.0e} s', drift > 1e-6),
    ]
