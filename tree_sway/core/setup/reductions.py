# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Reductions of a tree, shared by its models: beams, key segments, matrices, modes.

`reduced_tree` has the two ways to reduce a tree.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import NamedTuple, TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import one_of_each
from tree_sway.core.drag import crown_drag, DragLaw
from tree_sway.core.settings import Settings
from tree_sway.core.setup.season import in_season
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree

if TYPE_CHECKING:
    from tree_sway.core.setup.modes import Modes
    from tree_sway.core.setup.reduced_tree import ReducedTree, TreeReducer
    from tree_sway.core.setup.wind_moments import WindMoments

FASTEST_LIMP, _LEAST_SPAN = 60.0, 4.0
"""
Circular frequency [rad/s] at rest below which a limp tree keeps a coordinate: it turns by 1 rad
in a frame. And the same over the slowest, below which it keeps each. Faster coordinates are short
waves with little inertia at rest. Where the tree is bent they move all that is beyond, with up to
5,000 times the inertia, and rattle.
"""

_STEADY = 2.0
"""
Weight of steady responses over gust responses, root mean square, as for a turbulence intensity of
some 0.25.
"""

_GALE = 20.0
"""Wind of `Responses.in_gale` [m/s]."""

_CANDIDATES, _LIMP_CANDIDATES = 120, 400
"""
Number of natural modes by which responses to gusts are computed; that of a limp tree, each of
whose twigs moves in short waves of its own.
"""


class Responses(NamedTuple):
    """
    Responses of a tree to gusts and steady winds, multiplied by their weights.

    They are key rotations, (N, c), and the motion of the tips by them, (any, c); times ``in_gale``
    they are poses in a wind of 20 m/s in [rad].
    """

    rotations: Floats
    tips: Floats
    in_gale: float


class TreeReductions:
    """The reductions of a tree of a species, each made at its first use."""

    def __init__(self, tree: Tree, species: Species, settings: Settings) -> None:
        if settings.root_stiffness is not None:
            species = replace(species, root_stiffness=settings.root_stiffness)
        self.tree = tree
        self.species = species
        self.settings = in_season(tree, species, settings)
        self.drag_law, self.leaf_load_area = _crown_drag(tree, species, self.settings)
        """
        Law of the whole tree; equivalent area of bare wood of the leaves of each branch in [m^2],
        (b,).
        """
        self.frequencies = np.zeros(0)
        """Lowest known natural frequencies in [Hz]."""
        self._slowest: Modes | None = None

    @property
    def damping_ratio(self) -> float:
        """Damping ratio of every oscillator in [-]."""
        if self.settings.damping_ratio is not None:
            return self.settings.damping_ratio
        return self.species.damping(bool(self.settings.in_leaf))

    def natural_modes(self, count: int | None = None) -> Modes:
        """Return the slowest natural modes of the tree, or all, found once."""
        from tree_sway.core.setup.modes import natural_modes, solvable

        wanted = self.with_subtrees.reduction.n_coordinates if count is None else count
        if self._slowest is None or len(self._slowest.circular) < wanted:
            with solvable(self.tree):
                reduced = self.with_subtrees
                self._slowest = natural_modes(reduced.tree, reduced.reduction, count)
            self.frequencies = self._slowest.frequencies
        return self._slowest.slowest(wanted)

    def natural_frequencies(self, count: int) -> Floats:
        """Lowest natural frequencies in [Hz], (count,) or fewer."""
        if count > len(self.frequencies):
            self.natural_modes(min(count, self.with_subtrees.reduction.n_coordinates))
        return self.frequencies[:count]

    def modes(self, model: int | str) -> Modes:
        """Return all modes, or the leading ones in winds; of limp trees without the fastest."""
        from tree_sway.core.setup.modes import leading_modes

        reduction = self.with_subtrees.reduction
        n = reduction.n_coordinates
        count = n if isinstance(model, str) else min(model, n)
        if count == 0:
            return self.natural_modes(1).slowest(0)
        if count == n:
            return self._slow(self.natural_modes(None))
        rotations, tips, _ = self.responses
        known = self._candidates
        slow = self._slow(known)
        if len(slow.circular) < len(known.circular):
            # All slow ones are known: none of the leading is wasted on a fast one.
            rotations = slow.shapes @ (slow.shapes.T @ (reduction.mass @ rotations))
            tips = self._tips_moved(rotations)
        return self._slow(leading_modes(reduction, rotations, tips, count))

    def _slow(self, modes: Modes) -> Modes:
        """Leave out the modes of a limp tree that are too fast."""
        if not self.is_limp:
            return modes
        return modes.slower_than(max(FASTEST_LIMP, _LEAST_SPAN * float(modes.circular.min())))

    @property
    def _candidates(self) -> Modes:
        """Return the natural modes by which responses to gusts are computed."""
        n = self.with_subtrees.reduction.n_coordinates
        most = _LIMP_CANDIDATES if self.is_limp else _CANDIDATES
        return self.natural_modes(None if n <= most else most)

    def _tips_moved(self, rotations: Floats) -> Floats:
        """Find the motion of the tips by key rotations, (any, c)."""
        from tree_sway.core.setup.tree_motion import tip_motion

        branches = self.with_subtrees.branches
        return np.asarray(tip_motion(branches, rotations).reshape(-1, rotations.shape[1]))

    @cached_property
    def responses(self) -> Responses:
        """Return the responses to gusts and winds of the tree reduced with its subtrees."""
        from tree_sway.core.setup.gust_responses import gust_responses

        natural = self._candidates
        loss = self.damping_ratio * np.ones(len(natural.circular))
        tips = self._tips_moved(natural.shapes)
        branches = self.with_subtrees.branches
        gusts = gust_responses(branches, natural, tips, loss, self.drag_law)
        squares, mixes = np.linalg.eigh(gusts @ gusts.T)
        mixes *= np.sqrt(np.maximum(squares, 0.0))
        steady = self._static_responses()
        tips = tips @ mixes
        moved_steadily = self._tips_moved(steady)
        weight = _STEADY * np.linalg.norm(tips) / np.linalg.norm(moved_steadily)
        answers = np.hstack([natural.shapes @ mixes, weight * steady])
        in_gale = self.drag_law.dynamic_pressure(_GALE) / weight
        all_tips = np.hstack([tips, weight * moved_steadily])
        return Responses(answers, all_tips, float(in_gale))

    def _static_responses(self) -> Floats:
        """Responses of the tree to winds as key rotations, per pressure of 1 kg/m/s^2."""
        from tree_sway.core.setup.static_responses import static_responses

        solve = self.with_subtrees.reduction.factors.solve
        return static_responses(self.wind_moments, solve, self.drag_law)

    @cached_property
    def wind_moments(self) -> WindMoments:
        """Return the loads of the tree that is reduced with its subtrees."""
        from tree_sway.core.setup.wind_moments import WindMoments

        return WindMoments(self.with_subtrees.branches)

    @property
    def reduced(self) -> ReducedTree:
        """Reduction for the model of its settings."""
        return self.isolated if self.settings.model == 'branch' else self.with_subtrees

    @cached_property
    def _reducer(self) -> TreeReducer:
        # A prepared model needs no reduction, which is most of the set-up's code.
        from tree_sway.core.setup.reduced_tree import TreeReducer

        given = self.tree, self.species, self.settings
        return TreeReducer(*given, self.drag_law, self.leaf_load_area)

    @property
    def isolated(self) -> ReducedTree:
        """Reduction of isolated branches."""
        return self._reducer.isolated

    @property
    def with_subtrees(self) -> ReducedTree:
        """Reduction with subtrees; branches that rotate far are cut into key segments."""
        return self._reducer.with_subtrees

    @property
    def is_limp(self) -> bool:
        """Whether so much of the tree turns so far that a table of loads is too coarse."""
        return self._reducer.is_limp


def _crown_drag(tree: Tree, species: Species, settings: Settings) -> tuple[DragLaw, Floats]:
    """Find the drag law of wood and leaves, and the equivalent area of leaves by branch, (b,)."""
    if not settings.in_leaf or settings.leaf_area is None:
        law = DragLaw(*species.drag_law(bool(settings.in_leaf)))
        return law, np.zeros(tree.n_branches)
    from tree_sway.core.leaves import clad_wood

    area = one_of_each('leaf_area', settings.leaf_area, tree.n_branches, 'branch')
    wood = float(tree.length @ (tree.base_diameter + tree.tip_diameter)) / 2.0
    laws = species.drag_law(in_leaf=False)[0], species.drag_law(in_leaf=True)
    return crown_drag(wood, area, clad_wood(tree, species.leaves), *laws)
