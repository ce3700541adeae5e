# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Goals of the default integrator, in figures."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.oscillators import propagator
from tree_sway_lab.battery.branch_runs import Branch, chord
from tree_sway_lab.battery.row import holds, Row
from tree_sway_lab.battery.work_precision import flops_a_step, loads_for, winds
from tree_sway_lab.methods.branch_bank import guards
from tree_sway_lab.methods.branch_blocks import BranchBlocks
from tree_sway_lab.methods.chain import uniform_chain
from tree_sway_lab.methods.registry import method_named
from tree_sway_lab.methods.trajectory import integrate

TITLE = 'goals of the default integrator'
RATE, FINE = 60, 960


def planar_error(wind_name: str) -> float:
    """Error of exact_foh in [rad] rms, one segment, 60 steps per second, against the reference."""
    chain, wind = uniform_chain(1, 2.0, 0.05), winds(1)[wind_name]
    first = wind(np.zeros(1))[0]
    reference, method = method_named('radau_ggl'), method_named('exact_foh')
    exact = integrate(
        reference, chain, loads_for(reference, wind, wind_name, FINE), 1 / FINE, first=first
    )
    got = integrate(method, chain, loads_for(method, wind, wind_name, RATE), 1 / RATE, first=first)
    return float(np.sqrt(np.mean((got.theta - exact.theta[:: FINE // RATE]) ** 2)))


def spatial_error(size: float) -> tuple[float, float]:
    """Rms error over the length, and the largest deflection [deg], of swaying in two axes."""

    def wind(t: NDArray[np.float64]) -> NDArray[np.float64]:
        e1 = 0.75 * np.sin(2 * np.pi * 0.23 * t) + 0.3 * np.sin(2 * np.pi * 0.7 * t)
        e2 = 0.75 * np.cos(2 * np.pi * 0.17 * t) - 0.3 * np.cos(2 * np.pi * 0.9 * t)
        return size * np.stack([0.2 * np.sin(1.9 * t), e1, e2], 1)

    branch = Branch(2.0, 0.05)
    truth = branch.truth(wind, 1200)
    error = chord(branch.run(branch.means(wind, 1200))) - truth
    rms = float(np.sqrt((error**2).sum(1).mean()))
    return rms, float(np.degrees(np.arccos(truth[:, 0].min())))


def precession(a: float, b: float) -> float:
    """Turn of a free elliptic swing in [rad] per cycle, over (2 pi / 3) a b."""
    branch = Branch(2.0, 0.0, 1 / 240)
    states = branch.run(np.zeros((24000, 3)), np.array([a, 0.0, 0.0, b * branch.w]))
    x, y = states[:, 0], states[:, 1]
    far = np.flatnonzero(np.diff(np.sign(np.diff(x**2 + y**2))) < 0) + 1  # two per cycle
    angle = np.unwrap(2 * np.arctan2(y[far], x[far])) / 2
    return float(2 * np.polyfit(np.arange(len(far)), angle, 1)[0] / (2 * np.pi / 3 * a * b))


def milliseconds_a_frame(n: int = 100_000, frames: int = 40) -> float:
    """Best time of one frame of n two-axis branches in float32, one thread, in [ms]."""
    rng = np.random.default_rng(0)
    w = 2 * np.pi * rng.uniform(0.5, 8, n)
    stiffness = w * w
    blocks = BranchBlocks(
        propagator(1.0, 0.1 * w, stiffness, 1 / 60), guards(np.ones(n), stiffness, 1 / 60)
    )
    blocks.load = rng.normal(0, 0.2, (3, n)) * stiffness
    best = np.inf
    for _ in range(frames):
        started = time.perf_counter()
        blocks.step()
        best = min(best, time.perf_counter() - started)
    return 1e3 * best


def run(full: bool = False) -> list[Row]:
    """Measure each goal; the time per frame only in full, as it asks for a quiet machine."""
    cost = flops_a_step(method_named('exact_foh'), uniform_chain(1), winds(1)['smooth'], RATE)
    rows = [holds('operations per step, one segment', '<= 130 flops', f'{cost}', cost <= 130)]
    for name, bound in (('smooth', 1.5e-4), ('gusty', 7e-4)):
        error = planar_error(name)
        rows.append(
            holds(f'{name} wind, 60 Hz', f'<= {bound:.1e} rad rms', f'{error:.1e}', error <= bound)
        )
    for size, degrees, bound in ((0.14, 10, 2e-4), (0.42, 30, 2e-3), (1.2, 60, 1e-2)):
        error, peak = spatial_error(size)
        rows.append(
            holds(
                f'two axes to {degrees} degrees',
                f'<= {bound:.0e} L rms',
                f'{error:.1e} at {peak:.0f} degrees',
                error <= bound and peak >= degrees,
            )
        )
    turn = precession(0.2, 0.1)
    rows.append(
        holds(
            'free elliptic swing',
            '(2 pi / 3) a b a cycle within 1 %',
            f'{turn:.4f} of it',
            abs(abs(turn) - 1) <= 0.01,
        )
    )
    if full:
        spent = milliseconds_a_frame()
        rows.append(
            holds(
                '100,000 two-axis branches, float32, one core',
                '<= 1 ms per frame',
                f'{spent:.2f} ms',
                spent <= 1.0,
            )
        )
    return rows
