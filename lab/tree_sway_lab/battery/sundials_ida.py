# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
SUNDIALS IDA on the paper's multiplier form: a solver library beside ours, if installed.

Its unknowns are those of `radau_ggl` (Gear, Leimkuhler & Gupta, 1985), q, v, lam and mu. It
chooses its own steps and order (BDF 1 to 5, Hindmarsh et al., 2005) and is asked for an answer
once a frame. The multipliers are left out of its error test, for in a form of index 2 they are an
order less smooth.
"""

from __future__ import annotations

from collections import Counter
from importlib.util import find_spec
import time
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.errors import MissingDependencyError
from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.chain import PlanarChain
from tree_sway_lab.methods.dense import solve
from tree_sway_lab.methods.multiplier_form import constraint, forces, index1, jacobian, place
from tree_sway_lab.methods.operation_count import counted, flops, plain

Array = NDArray[Any]

NAME = 'sundials_ida'
NODES = (0.0, 0.5, 1.0)
"""Fractions of a frame at which it is given the load; between them a parabola."""

RTOL, ATOL, NO_TEST = 1e-5, 1e-6, 1e9


class IdaRun(NamedTuple):
    """Angles [rad], (frames + 1, n); operations [flop] and time [s] per frame."""

    theta: Array
    flops: int
    seconds: float


def is_installed() -> bool:
    """Whether scikit-sundae is there."""
    return find_spec('sksundae') is not None


@kernel
def residual(table: Array, y: Array, rate: Array, load: Array, out: Array) -> None:
    """Gap of q' = v - G^T mu, M v' = F - G^T lam, phi = 0, G v = 0; y and out are (10n,)."""
    n = len(table)
    q, v, lam, mu = y[: 3 * n], y[3 * n : 6 * n], y[6 * n : 8 * n], y[8 * n :]
    g, force, gap = jacobian(table, q), forces(table, q, v, load), constraint(table, q)
    for i in range(3 * n):
        mass = table[i // 3, 0] if i % 3 < 2 else table[i // 3, 1]
        out[i] = rate[i] - v[i]
        out[3 * n + i] = mass * rate[3 * n + i] - force[i]
    for row in range(2 * n):
        out[6 * n + row] = gap[row]
        out[8 * n + row] = 0.0 * gap[row]
        for i in range(3 * n):
            if g[row, i] != 0.0:
                out[i] = out[i] + g[row, i] * mu[row]
                out[3 * n + i] = out[3 * n + i] + g[row, i] * lam[row]
                out[8 * n + row] = out[8 * n + row] + g[row, i] * v[i]


def run_ida(chain: PlanarChain, loads: Array, dt: float, first: Array) -> IdaRun:
    """
    Integrate from rest.

    Parameters
    ----------
    chain
        The mechanism.
    loads
        In [N] at `NODES` of each frame, (frames, 3, n, 2).
    dt
        Length of a frame in [s].
    first
        Load at the start, (n, 2).

    Raises
    ------
    MissingDependencyError
        If scikit-sundae is not installed.

    """
    if not is_installed():
        raise MissingDependencyError(
            'scikit-sundae is not installed', where=NAME, cure='pip install scikit-sundae'
        )
    from sksundae.ida import IDA

    n, table = chain.n_segments, chain.table
    q, v = place(table, np.zeros(n), np.zeros(n))
    accel, lam = index1(table, q, v, first, 0.0, 0.0)
    y = np.concatenate([q, v, lam, 0.0 * lam])
    rate = np.concatenate([v, accel, 0.0 * lam, 0.0 * lam])

    def gap(t: float, y: Array, rate: Array, out: Array) -> None:
        frame = min(int(t / dt), len(loads) - 1)
        s = min(t / dt - frame, 1.0)
        a, b, c = loads[frame]
        load = (1 - s) * (1 - 2 * s) * a + 4 * s * (1 - s) * b + s * (2 * s - 1) * c
        residual(table, y, rate, load, out)

    tested = np.where(np.arange(10 * n) < 6 * n, ATOL, NO_TEST)
    ida = IDA(
        gap,
        rtol=RTOL,
        atol=tested,
        algebraic_idx=np.arange(6 * n, 10 * n),
        max_step=dt,
        max_num_steps=5000,
    )
    started = time.perf_counter()
    answer = ida.solve(dt * np.arange(len(loads) + 1), y, rate)
    spent = time.perf_counter() - started
    theta = np.full((len(loads) + 1, n), np.nan)
    theta[: len(answer.y)] = answer.y[:, 2 : 3 * n : 3]
    an_iteration, a_matrix = _operations(table, y, rate, first)
    work = answer.nfev * an_iteration + answer.njev * a_matrix
    return IdaRun(theta, round(work / len(loads)), spent / len(loads))


def _operations(table: Array, y: Array, rate: Array, load: Array) -> tuple[int, int]:
    """Operations of an iteration with its back-substitution, and of a matrix with its factors."""
    n = len(y)
    matrix = np.random.default_rng(0).normal(size=(n, n))
    of_residual, of_product, of_factors = Counter[str](), Counter[str](), Counter[str]()
    plain(residual)(*(counted(a, of_residual) for a in (table, y, rate, load, y)))
    _ = counted(matrix, of_product) @ counted(y, of_product)
    plain(solve)(counted(matrix, of_factors), counted(y[:, None], of_factors))
    an_iteration = flops(of_residual) + flops(of_product)
    return an_iteration, n * flops(of_residual) + flops(of_factors)
