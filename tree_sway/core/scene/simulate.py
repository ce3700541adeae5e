# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree taken through a wind from rest, in one call: what happens without clock and ROS."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.checks import within
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.sway_record import SwayRecord
from tree_sway.core.simulator.assembly import CalibratedTree
from tree_sway.core.simulator.settings import Settings, settings_with
from tree_sway.core.simulator.simulator import SwaySimulator
from tree_sway.core.strength.strength_use import StrengthGauge, StrengthUse
from tree_sway.core.tree.grown_tree import GrownTree, tree_and_species
from tree_sway.core.tree.tree import tips_of_poses, Tree
from tree_sway.core.wind.frame_means import recorded_means
from tree_sway.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway.errors import ParameterError


@runtime_checkable
class WindSamples(Protocol):
    """Wind over time, as `read_wind` gives."""

    @property
    def time(self) -> Floats:
        """Return the times in [s], rising, (m,)."""

    @property
    def velocity(self) -> Floats:
        """Velocities in [m/s], (m, 3)."""


def simulate(
    tree: Tree | GrownTree,
    wind: WindSamples | ArrayLike,
    *,
    rate: float = 60.0,
    seconds: float | None = None,
    branches: Sequence[int] | None = None,
    settings: Settings | None = None,
    progress: Callable[[float], None] | None = None,
    **changes: Any,
) -> SwayRecord:
    """
    Let a tree sway in a wind from rest.

    Parameters
    ----------
    tree
        A tree, or one with its species.
    wind
        A record with ``time`` and ``velocity``, which passes the gate and fades in gaps as a live
        one does (`recorded_means`); or the mean wind of each step in [m/s], (t, 3), as it is.
    rate
        Steps per second in [Hz].
    seconds
        Length of what is simulated in [s]; all of the wind if None.
    branches
        Branches whose tips are recorded; the one that bears the highest tip if None.
    settings, **changes
        The model, as for `make_simulator`.
    progress
        Called now and then with the part that is done, from 0 to 1.

    Returns
    -------
    SwayRecord
        Wind, tips, moment and strain at the base, one row per step.

    Raises
    ------
    ParameterError
        A wind that is empty, not finite or of another shape, a branch that is not there, or a
        setting out of its range.
    TreeError
        A tree that cannot stand.

    """
    rig = Rig(tree, settings, **changes)
    return rig.run(wind, rate=rate, seconds=seconds, branches=branches, progress=progress)


class Rig:
    """A tree set up once as for `simulate`, to be taken through wind after wind from rest."""

    def __init__(
        self, tree: Tree | GrownTree, settings: Settings | None = None, **changes: Any
    ) -> None:
        """Calibrate the tree, once for the simulator and for what is measured on it."""
        self.tree, self.species = tree_and_species(tree)
        self.settings = settings_with(settings, changes)
        self.calibrated = CalibratedTree(self.tree, self.species, self.settings)
        self._simulator: SwaySimulator | None = None
        self._per_rotation = moment_per_rotation(self.calibrated)

    def run(
        self,
        wind: WindSamples | ArrayLike,
        *,
        rate: float = 60.0,
        seconds: float | None = None,
        branches: Sequence[int] | None = None,
        progress: Callable[[float], None] | None = None,
    ) -> SwayRecord:
        """Sway the tree in a wind from rest, as `simulate`, whatever it went through before."""
        means, chosen = _step_means(wind, rate, seconds), _chosen(self.tree, branches)
        simulator, gauge = self._at_rest(), StrengthGauge(self.calibrated)
        strain = np.empty((len(means), len(chosen)))
        rest = tips_of_poses(self.tree, simulator.place(), chosen)
        tips, moment = np.empty((len(means), len(chosen), 3)), np.empty((len(means), 3))
        poses, every = np.empty((self.tree.n_segments, 7)), max(len(means) // 100, 1)
        for step, mean in enumerate(means):
            simulator.step(mean, 1.0 / rate)
            tips[step] = tips_of_poses(self.tree, simulator.place(poses), chosen) - rest
            rotations = simulator.rotations()
            moment[step] = rotations[: len(self._per_rotation)] @ self._per_rotation
            strain[step] = gauge.read(rotations, moment[step])[chosen]
            if progress is not None and step % every == 0:
                progress(step / len(means))
        radius = 0.5 * float(self.tree.base_diameter[0])
        per_moment = radius / (self.species.modulus * np.pi / 4.0 * radius**4)
        return SwayRecord(
            self.tree.name,
            simulator.model,
            np.arange(1, len(means) + 1) / rate,
            means,
            chosen,
            tuple(self.tree.branch_names[branch] for branch in chosen),
            tips,
            moment,
            per_moment * np.stack([-moment[:, 1], moment[:, 0]], axis=1),
            strain,
            gauge.use(),
        )

    def strength_curve(
        self, speeds: ArrayLike, *, rng: np.random.Generator, seconds: float = 60.0
    ) -> list[StrengthUse]:
        """
        Find the shares of strength used in turbulence of each of some mean speeds.

        Parameters
        ----------
        speeds
            Mean speeds in [m/s], (n,).
        rng
            Where the turbulence comes from; all speeds have the same gusts, faster.
        seconds
            Length of each wind in [s].

        """
        seed, used = int(rng.integers(2**32)), []
        for speed in np.asarray(speeds, dtype=np.float64).tolist():
            same = np.random.default_rng(seed)
            wind = simulate_turbulence(speed, rate=60.0, duration=seconds, rng=same)
            used.append(self.run(wind).strength)
        return used

    def _at_rest(self) -> SwaySimulator:
        """Return the simulator at rest; one that chooses its model by its winds is made again."""
        if self.settings.model == 'auto':
            return make_simulator(self.tree, self.species, self.settings)
        if self._simulator is None:
            self._simulator = SwaySimulator(
                self.tree, self.species, self.settings, calibrated=self.calibrated
            )
        self._simulator.reset()
        return self._simulator


def moment_per_rotation(calibrated: CalibratedTree) -> Floats:
    """
    Bending moment at the base of the stem per key rotation of it, in [N m/rad], (k, 3).

    It is by the curvature of the stem's shapes there, and so what a strain gauge measures: the
    moment of wind and inertia together, as the wood carries it.
    """
    stem = calibrated.reduced(calibrated.settings.model).models[0]
    along, found = stem.beam.tangent[0], []
    for field in stem.fields:
        across = field.curvature[0] - np.outer(field.curvature[0] @ along, along)
        bending = stem.beam.second_moment[0][:, None] * across
        found.append(calibrated.species.modulus * np.polyfit(stem.beam.place[0], bending, 2)[-1])
    return np.array(found)


def _step_means(wind: WindSamples | ArrayLike, rate: float, seconds: float | None) -> Floats:
    """Mean wind of each step in [m/s], (t, 3)."""
    within('rate', rate, 1.0, 10_000.0, 'Hz')
    if isinstance(wind, WindSamples):
        means = recorded_means(wind.time, wind.velocity, 1.0 / rate)
    else:
        means = np.asarray(wind, dtype=np.float64)
    if means.ndim != 2 or means.shape[1:] != (3,) or not len(means):
        raise ParameterError(
            f'wind of shape {means.shape}',
            where='wind',
            cure='give a record of two samples or more, or the mean of each step, (t, 3)',
        )
    if not np.isfinite(means).all():
        raise ParameterError('wind that is not finite', where='wind', cure='leave such rows out')
    if seconds is None:
        return np.asarray(means)
    within('seconds', seconds, 0.0, 1e9, 's', above=True)
    return np.asarray(means[: max(round(seconds * rate), 1)])


def _chosen(tree: Tree, branches: Sequence[int] | None) -> Ints:
    """Branches whose tips are recorded, (k,)."""
    if branches is None:
        return np.array([tree.branch_of_segment[int(np.argmax(tree.end[:, 2]))]])
    chosen = np.asarray(branches, dtype=np.int64)
    wrong = chosen[(chosen < 0) | (chosen >= tree.n_branches)]
    if len(wrong):
        raise ParameterError(
            f'branch {wrong[0]}', where='branches', cure=f'give 0 to {tree.n_branches - 1}'
        )
    return chosen
