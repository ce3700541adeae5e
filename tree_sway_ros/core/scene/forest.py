# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Several trees in one wind, solved one after another and placed in one block.

Every tree is turned and moved to where it stands once, before it is calibrated, so that no wind
need be turned into its frame and no pose out of it. The gusts reach one tree after the other
(`gust_travel`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.checks import array_to_fill
from tree_sway_ros.core.scene.make import make_simulator
from tree_sway_ros.core.scene.placed_tree import joined, PlacedTree
from tree_sway_ros.core.simulator.assembly import Kept
from tree_sway_ros.core.simulator.live_tuning import Tuning
from tree_sway_ros.core.simulator.protocol import TreeSimulator
from tree_sway_ros.core.simulator.settings import Settings, settings_with
from tree_sway_ros.core.simulator.simulator import Counts, OK, refuse_time_step, WIND_REFUSED
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.core.wind.gust_travel import GustHistory
from tree_sway_ros.core.wind.limits import take_wind
from tree_sway_ros.errors import ParameterError, TreeSwayError


class Forest:
    """
    Trees that sway in one wind; used like a `SwaySimulator`.

    Parameters
    ----------
    trees
        The trees, each with a name of its own.
    settings
        How they are modelled, but for those with settings of their own.
    tolerance
        Largest error of the tips in [m] that the model ``auto`` may allow itself, in each tree on
        its own.
    anemometer
        Where the wind is measured in [m], (3,), best upwind of all trees; at the tree that the
        wind reaches first if None (`GustHistory`).
    convection_ratio
        Speed at which gusts travel over the mean wind speed in [-]; infinite for one wind
        everywhere.
    **changes
        Fields of the settings, as keywords.

    Raises
    ------
    ParameterError
        No trees, two of one name, a setting out of its range.
    SpeciesError
        A species that no table knows.
    TreeError
        A tree that buckles under its own weight.

    Examples
    --------
    >>> row = [PlacedTree(f"tree{i}", tree, x=8.0 * i) for i in range(5)]
    >>> forest = Forest(row, model="subtree")
    >>> forest.step((8.0, 0.0, 0.0), 1 / 60)
    0

    """

    def __init__(
        self,
        trees: Sequence[PlacedTree],
        settings: Settings | None = None,
        *,
        tolerance: float = 0.005,
        anemometer: ArrayLike | None = None,
        convection_ratio: float = 1.0,
        kept: Kept | None = None,
        **changes: Any,
    ) -> None:
        """Calibrate every tree where it stands."""
        for number, each in enumerate(trees):
            if not isinstance(each, PlacedTree):
                raise ParameterError(
                    f'a {type(each).__name__}, where a PlacedTree is asked for',
                    where=f'trees[{number}]',
                    cure='give PlacedTree(name, tree, x, y) each',
                )
        names = [tree.name for tree in trees]
        for name in names:
            if names.count(name) > 1:
                raise ParameterError(
                    f"two trees called '{name}'", where='forest', cure='name each'
                )
        self.settings = settings_with(settings, changes)
        self.names = tuple(names)
        self.tree: Tree = joined([tree.placed() for tree in trees])
        self.simulators = tuple(
            _simulator(tree, tree.settings_where_it_stands(self.settings), tolerance, kept)
            for tree in trees
        )
        self.gusts = GustHistory(
            np.array([sim.tree.start[0] for sim in self.simulators]),
            anemometer,
            convection_ratio=convection_ratio,
        )
        ends = np.cumsum([0, *(sim.tree.n_segments for sim in self.simulators)]).tolist()
        self._slices = tuple(map(slice, ends[:-1], ends[1:]))
        self._steps = self._refused = 0
        self._wind = np.zeros(3)

    @property
    def model(self) -> str:
        """Model in use; several where trees differ."""
        return ', '.join(dict.fromkeys(sim.model for sim in self.simulators))

    @property
    def n_solved(self) -> int:
        """Branches that are solved; the others copy."""
        return sum(sim.n_solved for sim in self.simulators)

    @property
    def n_copied(self) -> int:
        """Branches that copy the motion of another."""
        return sum(sim.n_copied for sim in self.simulators)

    @property
    def n_frozen(self) -> int:
        """Branches that move with their parent as one body."""
        return sum(sim.n_frozen for sim in self.simulators)

    @property
    def counts(self) -> Counts:
        """Return what was refused at the anemometer, and held or begun anew in any tree."""
        held = sum(sim.counts.held for sim in self.simulators)
        restarted = sum(sim.counts.restarted for sim in self.simulators)
        return Counts(self._steps, self._refused, held, restarted)

    @property
    def wind(self) -> Floats:
        """Wind at the anemometer in the last step in [m/s], (3,)."""
        return self._wind

    def segments_of(self, name: str) -> slice:
        """
        Return the rows of a tree in the pose block.

        Raises
        ------
        ParameterError
            If no tree has that name.

        """
        if name not in self.names:
            known = ', '.join(self.names)
            raise ParameterError(
                f"no tree is called '{name}'", where='forest', cure=f'use one of: {known}'
            )
        return self._slices[self.names.index(name)]

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """
        Advance one step.

        Parameters
        ----------
        wind_mean
            Mean of the wind over the step at the anemometer, the way the air goes, in [m/s], (3,).
        dt
            Length of the step in [s].

        Returns
        -------
        int
            As `SwaySimulator.step`, of all trees together.

        Raises
        ------
        ParameterError
            A step that is not above 0 or not finite.

        """
        refuse_time_step(dt)
        status = OK
        # The history must not remember what no tree would take.
        if not take_wind(self._wind, wind_mean, self.settings.max_wind):
            status = WIND_REFUSED
            self._refused += 1
        felt = self.gusts.push(self._wind, dt)
        for simulator, wind in zip(self.simulators, felt.tolist(), strict=True):
            status |= simulator.step(wind, dt)
        self._steps += 1
        return status

    def check_tuning(self, **changes: float) -> Tuning:
        """Refuse what any tree could not take, as `SwaySimulator.check_tuning`."""
        return [simulator.check_tuning(**changes) for simulator in self.simulators][-1]

    def tune(self, **changes: float) -> None:
        """Change every tree while it sways, as `SwaySimulator.tune`; all or none."""
        self.check_tuning(**changes)
        for simulator in self.simulators:
            simulator.tune(**changes)

    def place(self, out: Floats | None = None) -> Floats:
        """
        Place every segment of every tree.

        Parameters
        ----------
        out
            Where to write, (n, 7) float64, to be fast; a new array if None.

        Returns
        -------
        Floats
            Pose block of all trees, one after another, in the frame of the forest; see
            `SwaySimulator.place`.

        """
        shape = (self.tree.n_segments, 7)
        poses = np.empty(shape) if out is None else array_to_fill('out', out, shape)
        for simulator, rows in zip(self.simulators, self._slices, strict=True):
            simulator.place(poses[rows])
        return poses

    @property
    def tip_displacement(self) -> Floats:
        """Displacement of the highest tip of all from rest in [m], (3,)."""
        highest = max(self.simulators, key=lambda sim: float(sim.tree.end[:, 2].max()))
        return highest.tip_displacement

    def reset(self) -> None:
        """Bring every tree to rest and forget the wind; the counts stay."""
        for simulator in self.simulators:
            simulator.reset()
        self.gusts.reset()
        self._wind[:] = 0.0


def _simulator(
    tree: PlacedTree, settings: Settings, tolerance: float, kept: Kept | None
) -> TreeSimulator:
    """Make the simulator of one tree where it stands; what is wrong with it names the tree."""
    placed = tree.placed()
    try:
        return make_simulator(placed, tree.species, settings, tolerance=tolerance, kept=kept)
    except TreeSwayError as error:
        raise error.inside(tree.name) from error
