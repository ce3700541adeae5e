"""
The tree in the wind: owns the order of work, and no clock.

"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.motion.drag import pressure
from tree_sway_ros.core.motion.placing import place
from tree_sway_ros.core.simulator.assembly import Bank, CalibratedTree
from tree_sway_ros.core.simulator.season import in_season
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.tree.species import Species, species_named
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import ParameterError

OK, WIND_REFUSED, LOAD_HELD = 0, 1, 2
"""What `SwaySimulator.step` tells, as bits."""


@dataclass
class Counts:
    """
    What was refused or held, since the start.

    Parameters
    ----------
    steps
        Steps taken.
    refused
        Steps whose wind was not finite or faster than the limit; the wind before was kept.
    held
        Loads that were held at the limit of the model.

    """

    steps: int = 0
    refused: int = 0
    held: int = 0


class SwaySimulator:
    """
    A tree that sways.

    Parameters
    ----------
    tree
        The tree.
    species
        Its wood, damping and drag; looked up by the tree's own species if None.
    settings
        How it is modelled.
    calibrated
        The same tree, species and settings calibrated before, to share the work among models.
    **changes
        Fields of the settings, as keywords: ``SwaySimulator(tree, model="branch")``.

    Raises
    ------
    ParameterError
        A setting out of its range.
    SpeciesError
        A species that no table knows.
    TreeError
        A tree that buckles under its own weight.

    Examples
    --------
    >>> sim = SwaySimulator(tree, model="subtree")
    >>> for wind in record:
    ...     sim.step(wind, 1 / 60)
    ...     poses = sim.place()

    """

    def __init__(
        self,
        tree: Tree,
        species: Species | None = None,
        settings: Settings | None = None,
        *,
        calibrated: CalibratedTree | None = None,
        **changes: Any,
    ) -> None:
        """Calibrate the tree; nothing is left to do at the first step but to compile."""
        self.tree = tree
        self.species = species if species is not None else species_named(tree.species)
        self.settings = in_season(tree, self.species, replace(settings or Settings(), **changes))
        self.counts = Counts()
        if calibrated is None:
            calibrated = CalibratedTree(tree, self.species, self.settings)
        self._bank: Bank = calibrated.bank(self.settings.model, self.settings.n_modes)
        self._drag_law = self.species.drag_law(bool(self.settings.in_leaf))
        self._advance = self._bank.oscillators.advance
        self._max_wind = self.settings.max_wind
        self._dt = 0.0
        self._wind = (0.0, 0.0, 0.0)
        self._poses = np.zeros((tree.n_segments, 7))
        self._origin = tree.start[0].copy()
        self._highest = int(np.argmax(tree.end[:, 2]))
        self._rest_tip = tree.end[self._highest].copy()
        self.place()

    @property
    def model(self) -> str:
        """Model in use."""
        return self.settings.model

    @property
    def n_solved(self) -> int:
        """Branches that are solved; the others copy."""
        return self._bank.n_solved

    @property
    def n_copied(self) -> int:
        """Branches that copy the motion of another."""
        return self.tree.n_branches - self._bank.n_solved - self._bank.n_frozen

    @property
    def n_frozen(self) -> int:
        """Branches that move with their parent as one body."""
        return self._bank.n_frozen

    @property
    def wind(self) -> Floats:
        """Wind of the last step in [m/s], (3,)."""
        return np.array(self._wind)

    @property
    def mass(self) -> float:
        """Mass of wood and leaves in [kg]."""
        return self._bank.mass

    def frequencies(self, count: int = 10) -> Floats:
        """
        Lowest natural frequencies of the model in use in [Hz], without air, (count,) or fewer.

        """
        return self._bank.frequencies[:count]

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """
        Advance one step.

        Parameters
        ----------
        wind_mean
            Mean of the wind over the step at the anemometer's height, the way the air goes, in
            [m/s], (3,).
        dt
            Length of the step in [s].

        Returns
        -------
        int
            0, or the sum of `WIND_REFUSED` (not finite or too fast: the wind before is kept) and
            `LOAD_HELD` (a load beyond what the model follows was held at its limit).

        Raises
        ------
        ParameterError
            A step that is not above 0 or not finite.

        """
        wx, wy, wz = float(wind_mean[0]), float(wind_mean[1]), float(wind_mean[2])  # type: ignore[index, arg-type]
        status = OK
        speed = math.hypot(wx, wy, wz)
        if speed <= self._max_wind:
            self._wind = wx, wy, wz
        else:
            status = WIND_REFUSED
            self.counts.refused += 1
            wx, wy, wz = self._wind
            speed = math.hypot(wx, wy, wz)
        if dt != self._dt:
            self._set_step(dt)
        load = pressure(speed, *self._drag_law)
        held = self._advance(wx, wy, wz, load)
        if held:
            self.counts.held += held
            status |= LOAD_HELD
        self.counts.steps += 1
        return status

    def place(self, out: Floats | None = None) -> Floats:
        """
        Place every segment.

        Parameters
        ----------
        out
            Where to write, (n, 7) float64; an array of the simulator's own, used again each time,
            if None.

        Returns
        -------
        Floats
            Pose block: x y z of each segment's root-side node in [m], quaternion x y z w, x axis
            along the segment.

        """
        poses = self._poses if out is None else out
        bank, work = self._bank, self._bank.oscillators.work
        rotations = bank.oscillators.rotations()
        place(bank.branches, bank.segments, bank.heads, work, rotations, self._origin, poses)
        if bank.frozen is not None:
            bank.frozen.place(bank.branches, work, rotations, poses)
        if out is not None:
            self._poses[self._highest] = out[self._highest]
        return poses

    @property
    def tip_displacement(self) -> Floats:
        """Way of the highest tip from rest in [m], (3,), as last placed."""
        x, y, z, qx, qy, qz, qw = self._poses[self._highest]
        length = self.tree.length[self._highest]
        along = np.array(
            [1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy + qz * qw), 2 * (qx * qz - qy * qw)]
        )
        displacement: Floats = np.array([x, y, z]) + length * along - self._rest_tip
        return displacement

    @property
    def base_moment(self) -> Floats:
        """
        Moment of the last step's wind about the root node, of all branches where they stand at
        rest, in [N m], (3,).

        """
        centre, force = self._bank.branches["centre"], self._bank.oscillators.work["force"]
        moment: Floats = np.cross(centre, force).sum(axis=0)
        return moment

    def motion(self) -> tuple[Floats, Floats]:
        """Key rotations in [rad] and their rates in [rad/s] in the model in use, both (N,)."""
        return self._bank.oscillators.motion()

    def take_over(self, x: Floats, v: Floats) -> None:
        """Go on from key rotations and rates, (N,), instead of from rest."""
        self._bank.oscillators.take_over(x, v)

    def reset(self) -> None:
        """Go back to rest, with no wind; the counts stay."""
        self._bank.oscillators.reset()
        self._wind = (0.0, 0.0, 0.0)
        self.place()

    def _set_step(self, dt: float) -> None:
        if not (math.isfinite(dt) and dt > 0.0):
            raise ParameterError(
                f"time step of {dt} s", where="step", cure="give a finite one above 0"
            )
        self._bank.oscillators.set_step(dt)
        self._dt = dt
