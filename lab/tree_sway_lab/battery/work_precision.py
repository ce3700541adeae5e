# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Error against cost of every method, in three winds, for one segment and a chain of six."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.commands import bar
from tree_sway_lab.battery import sundials_ida
from tree_sway_lab.methods.chain import PlanarChain, uniform_chain
from tree_sway_lab.methods.method import Method
from tree_sway_lab.methods.operation_count import counted, CountedNumber, flops, plain
from tree_sway_lab.methods.registry import method_named, METHODS
from tree_sway_lab.methods.trajectory import integrate, sample

Array = NDArray[Any]
Wind = Callable[[Array], Array]
SECONDS = 8.0
REFERENCE_RATE = {1: 960, 6: 240}  # steps per second of the reference, by number of segments
RATES = (30, 60, 120)
MEAN_POINTS = 64
GUSTS = 3.7  # gusts per second, which no step meets


@dataclass(frozen=True)
class Point:
    """
    One method in one wind at one rate.

    Parameters
    ----------
    method, form, system, wind
        Names; system is "1 segment" or "6 segments".
    rate
        Steps per second [1/s].
    error
        Root mean square of the angles' error in [rad]; NaN where the method blew up or lost the
        motion.
    flops
        Operations per step, weighted, at 60 steps per second.
    wall_ratio
        Time per step over that of semi-implicit Euler on the minimal form, same run.

    """

    method: str
    form: str
    system: str
    wind: str
    rate: int
    error: float
    flops: int
    wall_ratio: float


def winds(n: int) -> dict[str, Wind]:
    """Make loads on n segments in [N], time (k,) -> (k, n, 2), that bend a stem by 20 degrees."""
    rng = np.random.default_rng(7)
    knots = rng.normal(0.0, 1.0, (int(SECONDS * GUSTS) + 2, 2))

    def smooth(t: Array) -> Array:
        return np.stack([3 * np.sin(1.9 * t), 14 + 8 * np.sin(1.45 * t) + 6 * np.sin(4.4 * t)], -1)

    def gusty(t: Array) -> Array:
        # a turbulence intensity of 0.2 is one of 0.4 of the load
        return np.asarray([0.0, 12.0] + np.array([2.0, 4.8]) * knots[(t * GUSTS).astype(int)])

    def turning(t: Array) -> Array:
        angle = 0.5 * np.pi * np.tanh(4 * np.sin(2 * np.pi * t / 4))
        return np.stack([25 * np.cos(angle), 25 * np.sin(angle)], -1)

    def spread(wind: Wind) -> Wind:
        return lambda t: np.asarray(np.repeat(wind(t)[:, None, :] / n, n, axis=1))

    return {'smooth': spread(smooth), 'gusty': spread(gusty), 'turning': spread(turning)}


def loads_for(method: Method, wind: Wind, name: str, rate: int) -> Array:
    """Sample at the method's nodes; in gusts take means over steps, as the solver is fed."""
    return _loads_at(method.nodes, wind, name, rate)


def _loads_at(nodes: tuple[float, ...], wind: Wind, name: str, rate: int) -> Array:
    steps = int(SECONDS * rate)
    if name != 'gusty':
        return sample(wind, nodes, 1 / rate, steps)
    middles = tuple((np.arange(MEAN_POINTS) + 0.5) / MEAN_POINTS)
    means = sample(wind, middles, 1 / rate, steps).mean(1)
    return np.ascontiguousarray(np.repeat(means[:, None], len(nodes), axis=1))


def flops_a_step(method: Method, chain: PlanarChain, wind: Wind, rate: int) -> int:
    """Count the operations of the second step, when iterations start from a step before."""
    loads = sample(wind, method.nodes, 1 / rate, 2)
    n, dt = chain.n_segments, 1 / rate
    state = method.start(chain, np.zeros(n), np.zeros(n), loads[0, 0], dt)
    options = method.options(chain, dt)
    type(method).kernel(chain.table, state, loads[0], dt, options)
    tally: Counter[str] = Counter()
    wrapped = [counted(a, tally) for a in (chain.table, state, loads[1])]
    plain(type(method).kernel)(*wrapped, CountedNumber(dt, tally), counted(options, tally))
    return flops(tally)


@cache
def _compiled_loop() -> Any:
    """Return a loop over the steps of any method, compiled; only here is numba needed."""
    from numba import njit

    def repeat(
        step: Any, table: Array, state: Array, loads: Array, dt: float, options: Array
    ) -> None:
        for k in range(len(loads)):
            step(table, state, loads[k], dt, options)

    return njit(repeat)


def seconds_a_step(method: Method, chain: PlanarChain, wind: Wind, rate: int) -> float:
    """Best of three timings of a compiled loop over a smooth wind, from rest each time."""
    loads, dt, n = sample(wind, method.nodes, 1 / rate, 120), 1 / rate, chain.n_segments
    options, best = method.options(chain, dt), np.inf
    for attempt in range(4):
        state = method.start(chain, np.zeros(n), np.zeros(n), loads[0, 0], dt)
        started = time.perf_counter()
        _compiled_loop()(type(method).kernel, chain.table, state, loads, dt, options)
        if attempt:  # the first call compiles
            best = min(best, time.perf_counter() - started)
    return best / len(loads)


def measure(
    rates: tuple[int, ...] = RATES, methods: tuple[str, ...] = tuple(METHODS)
) -> list[Point]:
    """Run every method in every wind at every rate."""
    points = []
    for n, system in ((1, '1 segment'), (6, '6 segments')):
        chain = uniform_chain(n, 2.0, 0.05)
        blowing = winds(n)
        reference = method_named('radau_ggl')
        fine = REFERENCE_RATE[n]
        truth = {
            name: integrate(
                reference,
                chain,
                loads_for(reference, wind, name, fine),
                1 / fine,
                first=wind(np.zeros(1))[0],
            ).theta
            for name, wind in blowing.items()
        }
        unit = seconds_a_step(method_named('semi_implicit_euler'), chain, blowing['smooth'], 60)
        for key in bar(methods, f'methods, {system}'):
            method = method_named(key)
            wall = seconds_a_step(method, chain, blowing['smooth'], 60) / unit
            cost = flops_a_step(method, chain, blowing['smooth'], 60)
            for rate in rates:
                for name, wind in blowing.items():
                    run = integrate(
                        method,
                        chain,
                        loads_for(method, wind, name, rate),
                        1 / rate,
                        first=wind(np.zeros(1))[0],
                    )
                    error = run.theta - truth[name][:: fine // rate]
                    rms = float(np.sqrt(np.mean(error**2)))
                    # worse than standing still, or standing still where it could not go on
                    gone = run.failed > 0.01 * len(error) or not rms < float(np.std(truth[name]))
                    points.append(
                        Point(
                            key,
                            method.form,
                            system,
                            name,
                            rate,
                            np.nan if gone else rms,
                            cost,
                            wall,
                        )
                    )
        if methods == tuple(METHODS) and sundials_ida.is_installed():
            points += _points_of_ida(chain, system, blowing, truth, rates, unit)
    return points


def _points_of_ida(
    chain: PlanarChain, system: str, blowing: dict[str, Wind], truth: dict[str, Array],
    rates: tuple[int, ...], unit: float,
) -> list[Point]:  # fmt: skip
    """SUNDIALS IDA, which steps on its own between frames: cost and time are those of a frame."""
    points = []
    for rate in rates:
        for name, wind in blowing.items():
            loads = _loads_at(sundials_ida.NODES, wind, name, rate)
            run = sundials_ida.run_ida(chain, loads, 1 / rate, wind(np.zeros(1))[0])
            every = (len(truth[name]) - 1) // (len(run.theta) - 1)
            rms = float(np.sqrt(np.mean((run.theta - truth[name][::every]) ** 2)))
            points.append(
                Point(
                    sundials_ida.NAME,
                    'multiplier',
                    system,
                    name,
                    rate,
                    rms,
                    run.flops,
                    run.seconds / unit,
                )
            )
    return points
