# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
T18: adversarial runs: loads switch with the motion, at random frequency, damping and angle.

The kernel of one branch is attacked by loads, whole trees by wind, through the step that programs
call.

"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.oscillators import propagator
from tree_sway.core.scene import make_simulator
from tree_sway.core.settings import Settings
from tree_sway_lab.battery.row import fails, holds, Row
from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.branch_bank import guards, single_precision
from tree_sway_lab.methods.minimal import rk4, semi_implicit_euler, verlet
from tree_sway_lab.methods.two_axis import step_branch
from tree_sway_lab.model_names import settings_called
from tree_sway_lab.validation.crooked_trees import crooked_tree
from tree_sway_lab.validation.truth import WOOD

TITLE = 'adversarial runs'
STEPS = 200
BLOWN_UP = 1e3  # [rad]
RUNS_A_TREE = 50
Array = NDArray[Any]


def adversaries(n: int, rng: np.random.Generator) -> tuple[Array, Array, Array, Array]:
    """Draw w h in 0.1 to 100, z in 0.001 to 1, a share of the load, any angle in space, (n,)."""
    ratio = 10 ** rng.uniform(-1, 2, n)
    damping = 10 ** rng.uniform(-3, 0, n)
    direction = rng.normal(size=(n, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    return ratio, damping, rng.uniform(0, 1, n), direction


def bound(damping: Array) -> Array:
    """Largest |e| over the moment's largest |M| / k1: coth(pi z / 2 sqrt(1 - z^2))."""
    with np.errstate(divide='ignore'):
        return np.asarray(
            1 / np.tanh(np.pi * damping / (2 * np.sqrt(np.maximum(1 - damping**2, 0))))
        )


@kernel
def _attack(
    rows: Array,
    guard: Array,
    stiffness: Array,
    size: Array,
    direction: Array,
    planar: int,
    steps: int,
    peak: Array,
) -> None:
    """Largest |e| of each run under a load along the velocity, or turning against the motion."""
    for n in range(len(rows)):
        c, g, d = rows[n], guard[n], direction[n]
        x = y = vx = vy = c[0] * 0
        worst = x
        load = size[n] * stiffness[n]
        for step in range(steps):
            if planar:
                sign = 1 if vx * d[1] >= 0 else -1
                wb, w1, w2 = load * d[0] * sign, load * d[1] * sign, x * 0
            else:
                speed = np.sqrt(vx * vx + vy * vy)
                across = np.sqrt(d[1] * d[1] + d[2] * d[2])
                if speed > 0 and step % 64 < 48:
                    w1, w2 = load * across * vx / speed, load * across * vy / speed
                else:
                    w1, w2 = load * d[1], load * d[2]
                wb = load * d[0]
            x, y, vx, vy, _ = step_branch(
                x,
                y,
                vx,
                vy,
                wb,
                w1,
                w2,
                c[0],
                c[1],
                c[2],
                c[3],
                c[4],
                c[5],
                c[6],
                c[7],
                g[0],
                g[1],
                g[2],
            )
            e = np.sqrt(x * x + y * y)
            if not e <= worst:
                worst = e
        peak[n] = worst


def attack(n: int, planar: bool, kind: Any, seed: int = 0) -> tuple[int, float]:
    """Return how many runs blew up and the largest peak over its bound."""
    rng = np.random.default_rng(seed)
    ratio, damping, share, direction = adversaries(n, rng)
    if planar:
        direction[:, 1] = np.hypot(direction[:, 1], direction[:, 2])
        direction[:, 2] = 0
    stiffness = np.ones(n)
    inertia = 1 / ratio**2
    rows = propagator(inertia, 2 * damping / ratio, stiffness, 1.0)
    coefficients: Array = rows if kind == np.float64 else single_precision(rows)
    guard = guards(inertia, stiffness, 1.0)
    size = share * guard[:, 1]
    peak = np.empty(n, kind)
    guard_, stiffness_ = guard.astype(kind), stiffness.astype(kind)
    _attack(
        coefficients,
        guard_,
        stiffness_,
        size.astype(kind),
        direction.astype(kind),
        int(planar),
        STEPS,
        peak,
    )
    limit = (size if planar else guard[:, 2]) * bound(damping)
    return int(np.count_nonzero(~(peak < BLOWN_UP * guard[:, 1]))), float(np.max(peak / limit))


def classic(step: Any, n: int, seed: int = 0) -> float:
    """Fraction of planar runs at s <= 1 in which a classic method blows up."""
    rng = np.random.default_rng(seed)
    ratio, damping, size, direction = adversaries(n, rng)
    blown = 0
    for r, z, s, d in zip(ratio, damping, size, direction, strict=True):
        inertia = 1 / r**2
        table = np.array([[0.0, inertia, 1.0, 1.0, 1.0, 2 * z / r]])  # lever 1, mass in J
        state, load = np.zeros((4, 1)), np.zeros((3, 1, 2))
        for _ in range(STEPS):
            sign = 1.0 if state[1, 0] * d[1] >= 0 else -1.0
            load[:, 0] = s * d[0] * sign, s * np.hypot(d[1], d[2]) * sign
            step(table, state, load, 1.0, state[0])
            if not abs(state[0, 0]) < BLOWN_UP:
                blown += 1
                break
    return blown / n


def attack_trees(model: str, n: int, seed: int = 0) -> tuple[int, float]:
    """
    Turn the wind on whole trees against the motion at every frame.

    Each run has a speed of 1 to 150 m/s, any direction, and a key rotation that the wind's sign
    follows; a tree of its own damping ratio, 0.001 to 1, every `RUNS_A_TREE`.

    Returns
    -------
    tuple
        How many runs blew up or began again from rest, and the largest key rotation in [rad].

    """
    rng = np.random.default_rng(seed)
    blown, peak = 0, 0.0
    for run in range(n):
        if run % RUNS_A_TREE == 0:
            settings = settings_called(model, Settings(damping_ratio=10 ** rng.uniform(-3, 0)))
            simulator = make_simulator(crooked_tree(int(rng.integers(30))), WOOD, settings)
        simulator.reset()
        direction = rng.normal(size=3)
        direction *= rng.uniform(1, 150) / np.linalg.norm(direction)
        x, rates = simulator.banks[0].oscillators.motion()
        follows = int(rng.integers(len(x)))
        before = simulator.counts.restarted
        for _ in range(STEPS):
            simulator.step(direction if rates[follows] >= 0 else -direction, 1 / 60)
            x, rates = simulator.banks[0].oscillators.motion()
        largest = float(np.abs(x).max())
        peak = max(peak, largest)
        blown += not (largest < BLOWN_UP and simulator.counts.restarted == before)
    return blown, peak


def run(full: bool = False) -> list[Row]:
    """Attack the kernel in the plane and in space; then the classic methods."""
    n = 1_000_000 if full else 100_000
    rows = []
    for kind, slack in ((np.float64, 1e-9), (np.float32, 1e-4)):
        for planar in (True, False):
            runs = n if kind == np.float64 and not planar else n // 5
            blown, share = attack(runs, planar, kind)
            where = 'in the plane, s coth(..)' if planar else "in space, guard's moment x coth(..)"
            rows.append(
                holds(
                    f'exact_foh kernel, {runs} runs, {kind.__name__}',
                    f'0 blow-ups, never above the bound ({where})',
                    f'{blown} blow-ups, peak {share:.4f} of the bound',
                    blown == 0 and share <= 1 + slack,
                )
            )
    for model in ('default', 'branch', 'full'):
        runs = n // 1000
        blown, peak = attack_trees(model, runs)
        rows.append(
            holds(
                f'whole trees, model {model}, {runs} runs to 150 m/s',
                '0 blow-ups, and none begins again from rest',
                f'{blown} blow-ups, largest turn {peak:.1f} rad',
                blown == 0,
            )
        )
    for name, step in (
        ('semi_implicit_euler', semi_implicit_euler.step),
        ('verlet', verlet.step),
        ('rk4', rk4.step),
    ):
        share = classic(step, 2000 if full else 150)
        rows.append(
            fails(f'{name} at s <= 1', 'more than half blow up', f'{share:.0%}', share > 0.5)
        )
    return rows
