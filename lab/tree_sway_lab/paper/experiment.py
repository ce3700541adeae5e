# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The experiment: a whole plant in a wind from the right, its key segments solved in both forms.

By multipliers, as the paper writes it (eq. 1, with Baumgarte's terms against drift), and in the
reduced form that eliminating them gives, both by Runge-Kutta's method at the same step; and by the
exact propagator at the rate of the picture, which is what this package streams. Every form gives
angles and the joint reaction, which for the first are the multipliers themselves.

"""

from __future__ import annotations

from dataclasses import dataclass
import time

import numpy as np

from tree_sway.commands import bar
from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.scene import make_simulator
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.core.wind import simulate_turbulence
from tree_sway.errors import ParameterError
from tree_sway_lab.battery.work_precision import flops_a_step
from tree_sway_lab.methods import minimal_form, multiplier_form
from tree_sway_lab.methods.chain import PlanarChain
from tree_sway_lab.methods.registry import method_named
from tree_sway_lab.methods.trajectory import integrate
from tree_sway_lab.paper.key_segments import key_segments, KeySegments

RATE = 60
"""Frames per second."""

_TIMINGS = 5

SUBSTEPS = 4
"""Steps of Runge-Kutta's method per frame, in both forms."""

FORMS = {
    'multipliers': ('baumgarte', SUBSTEPS),
    'reduced': ('rk4', SUBSTEPS),
    'propagator': ('exact_foh', 1),
}
"""Method and steps per frame of each form."""

CONSTANTS = {'benjamina': (1.2e4, 60.0), 'goldcrest': (6.0e3, 15.0)}
"""k1 constant in [N m/rad/m^3] and k2 constant in [N m s/rad/m^3] per plant, found by trial."""

FROM_THE_RIGHT = (-1.0, 0.0, 0.0)
"""Where the wind blows to; east is to the right in the pictures."""


@dataclass(frozen=True)
class Solution:
    """
    What one form gives.

    Parameters
    ----------
    angle
        Key angle of every branch after each frame in [rad], (frames + 1, b).
    reaction
        Force that the joint of each solved branch carries at the end in [N], (solved, 2).
    operations
        Weighted operations per frame for one key segment.
    seconds
        Time of the processor that all solved branches took.

    """

    angle: Floats
    reaction: Floats
    operations: int
    seconds: float


@dataclass(frozen=True)
class Experiment:
    """
    A plant, its key segments, the wind, and what each form gives.

    Parameters
    ----------
    tree, keys
        The plant.
    speed
        Wind speed at the frames in [m/s], (frames + 1,).
    solutions
        By the name of the form, as in `FORMS`.
    ours
        Displacement of the highest tip in [m] under the default model of this package in the
        same wind, (frames + 1, 3).

    """

    tree: Tree
    keys: KeySegments
    speed: Floats
    solutions: dict[str, Solution]
    ours: Floats


def wind_from_the_right(mean: float, seconds: float, seed: int = 0) -> Floats:
    """Speed of a gusty wind of one direction at the frames, 0 or more, in [m/s], (frames + 1,)."""
    frames = round(seconds * RATE) + 1
    record = simulate_turbulence(
        mean, rate=RATE, duration=seconds + 1.0, rng=np.random.default_rng(seed), bearing_to=0.0
    )
    return np.maximum(record[:frames, 1], 0.0)


def run_experiment(
    tree: Tree, species: Species, speed: Floats, stiffness: float, damping: float
) -> Experiment:
    """
    Solve a plant in all forms.

    Parameters
    ----------
    tree, species
        The plant.
    speed
        Wind speed at the frames in [m/s], (frames + 1,).
    stiffness, damping
        The two constants of the volume rule, as for `key_segments`.

    Raises
    ------
    ParameterError
        Constants under which an explicit form is unstable.

    """
    keys = key_segments(tree, species, FROM_THE_RIGHT, stiffness, damping)
    solutions = {name: solve(keys, speed, *form, what=name) for name, form in FORMS.items()}
    return Experiment(tree, keys, speed, solutions, _ours(tree, species, speed))


def solve(
    keys: KeySegments, speed: Floats, method_name: str, substeps: int, *, what: str = ''
) -> Solution:
    """
    Solve the key segment of every branch that no other's solution is reused for.

    Progress is shown under the name ``what``.
    """
    method, dt = method_named(method_name), 1.0 / (RATE * substeps)
    square = np.square(
        np.interp(_instants(len(speed), substeps, method.nodes), _frames(speed), speed)
    )
    angle = np.zeros((len(speed), len(keys.table)))
    reaction = np.zeros((len(keys.solved), 2))
    began = time.process_time()
    for place, branch in enumerate(bar(keys.solved, what or method_name)):
        chain = PlanarChain(keys.table[branch][None])
        loads = square[:, :, None, None] * keys.load[branch]
        run = integrate(method, chain, loads, dt)
        angle[:, branch] = run.theta[::substeps, 0]
        reaction[place] = _reaction(method.form, chain, run.state, loads[-1, -1])
    seconds = time.process_time() - began
    if not np.isfinite(angle).all():
        raise ParameterError(
            f"the form '{method_name}' is unstable at {RATE * substeps} steps per second",
            where=f'key segment of {float(keys.frequency[keys.solved].max()):.0f} Hz',
            cure='lower the constants of stiffness and damping',
        )
    angle = angle[:, keys.source]
    chain = PlanarChain(keys.table[:1])
    operations = substeps * flops_a_step(method, chain, lambda t: np.ones((len(t), 1, 2)), RATE)
    return Solution(angle, reaction, operations, seconds)


def measured_share(tree: Tree, keys: KeySegments, speed: Floats) -> float:
    """
    Time to solve every segment of the branches of several, over the time for their key segments.

    Both by multipliers, in turn, the shortest of five each, in time of the processor: what
    else a computer does counts little.

    """
    counts = np.diff(tree.branch_first)
    several = np.flatnonzero(counts > 1)
    few = [_alone(keys, several), _alone(keys, np.repeat(several, counts[several]))]
    solve(few[0], speed[:3], *FORMS['multipliers'])
    seconds = [
        [solve(part, speed[:31], *FORMS['multipliers']).seconds for part in few]
        for _ in range(_TIMINGS)
    ]
    keys_alone, every_segment = np.min(seconds, axis=0)
    return float(every_segment / keys_alone)


def _alone(keys: KeySegments, rows: Ints) -> KeySegments:
    """Return the key segments of some branches, repeated ones as often, each solved."""
    return KeySegments(
        keys.table[rows], keys.along[rows], keys.across[rows], keys.load[rows],
        np.arange(len(rows)),
    )  # fmt: skip


def _reaction(form: str, chain: PlanarChain, state: Floats, load: Floats) -> Floats:
    """Force that the joint carries: the multipliers, or mass times acceleration less the load."""
    if form == 'multiplier':
        return multiplier_form.index1(chain.table, state[0], state[1], load, 0.0, 0.0)[1]
    return np.asarray(minimal_form.reactions(chain.table, state[0], state[1], load)[0])


def _frames(speed: Floats) -> Floats:
    return np.arange(len(speed)) / RATE


def _instants(frames: int, substeps: int, nodes: tuple[float, ...]) -> Floats:
    """Return the times at which a method needs its load in [s], (steps, nodes)."""
    steps = np.arange((frames - 1) * substeps)[:, None] + np.asarray(nodes)
    return steps / (RATE * substeps)


def _ours(tree: Tree, species: Species, speed: Floats) -> Floats:
    """Displacement of the highest tip in [m], (frames + 1, 3), in the default model."""
    simulator = make_simulator(tree, species)
    tips = np.zeros((len(speed), 3))
    for frame in bar(range(1, len(speed)), 'the default model'):
        mean = 0.5 * (speed[frame - 1] + speed[frame])
        simulator.step(mean * np.asarray(FROM_THE_RIGHT), 1.0 / RATE)
        simulator.place()
        tips[frame] = simulator.tip_displacement
    return tips
