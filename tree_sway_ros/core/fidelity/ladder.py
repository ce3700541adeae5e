# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The ladder of models of one tree: the error of every model in any wind, known before a step.

The coupled tree is linear to first order, so the error of a lesser model need not be tried: it is
the difference of the two responses, summed over the frequencies of the wind's load. That
difference, joined from the root to the tips of all branches, is what a viewer would see. To it
comes a margin for what no linear model knows.

Between the models stand those in which the quietest branches are frozen and move with their
parents as one body; they are models like any other, as the response of a tree with frozen branches
is known too.

Where gusts reach limb by limb, limbs are also loaded against each other, in four patterns of signs
that their delays deal them; what those differ by counts with the power that each limb feels by
itself.

Symbols: D(f) difference of two tip responses, S(f) spectrum of the load, C its covariance.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
import math

import numpy as np

from tree_sway_ros.core.arrays import Floats, Ints, Records
from tree_sway_ros.core.fidelity.estimate import Estimate, model_name
from tree_sway_ros.core.fidelity.frame_cost import frame_cost
from tree_sway_ros.core.fidelity.quiet_branches import quiet_sets
from tree_sway_ros.core.motion.drag import pressure
from tree_sway_ros.core.motion.response import Complexes, key_response, tip_motion
from tree_sway_ros.core.simulator.assembly import Bank, CalibratedTree
from tree_sway_ros.core.simulator.partly_frozen import PartlyFrozenTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.core.wind.climate import WindClimate
from tree_sway_ros.core.wind.crown_wind import shared_power

MARGIN = 1.3
"""Estimated over computed error: the wind is not quite linear in its effect."""

FLOOR = 0.05
"""Share of the motion by which even the coupled model may err against every segment solved."""

BEND = 0.15
"""Share on top of that per motion of the tips over the farthest tip's way from the root."""

TABLE_FLOOR, TABLE_MARGIN = 0.03, 7.0
"""
Share of the motion by which `wind_basis` may err further, whatever its table; and per error that
its table tells (`WindBasisTable.error`). Random crooked trees differed from `modes` by 2 to 6 %
where this says 5 to 7 %, at mean winds of 5 and 12 m/s; built-in ones by 1.4 to 2.7 %.

"""

LADDER: tuple[tuple[str, int, float], ...] = (
    ('coupled', 0, 0.0), ('coupled', 0, 0.01),
    ('modes', 12, 0.0), ('modes', 12, 0.003), ('modes', 12, 0.01), ('modes', 12, 0.03),
    ('modes', 12, 0.1),
    ('modes', 6, 0.0), ('modes', 3, 0.0),
    ('wind_basis', 20, 0.0),
    ('subtree', 0, 0.0), ('subtree', 0, 0.1), ('branch', 0, 0.0), ('frozen', 0, math.inf),
)  # fmt: skip
"""
Models, the best first, with their number of modes and the share of the motion that freezing may
cost.

"""

MOST_COUPLED, MOST_MODES = 250, 32
"""A tree of more branches than this is not solved in all its modes, but in this many."""

_SPARSE = 4
"""One frequency in so many will do to find the quiet branches."""

_FREQUENCIES = np.concatenate([[0.0], np.geomspace(0.01, 30.0, 160)])


class FidelityLadder:
    """
    The models of a tree, each with its response.

    Parameters
    ----------
    tree, species, settings
        As for `SwaySimulator`; the settings' model does not matter.

    """

    def __init__(self, tree: Tree, species: Species, settings: Settings) -> None:
        """Find the response of every model."""
        self.tree, self.species = tree, species
        whole = CalibratedTree(tree, species, replace(settings, stiffness='beam'))
        self._drag_law = whole.drag_law
        best, best_modes = _best(tree)
        self._coherence = settings.crown_coherence
        self._reach = float(np.linalg.norm(tree.end - tree.start[0], axis=1).max())
        bank = whole.bank(best, best_modes)
        rotations = self._response(whole, bank)
        self._truth = tip_motion(bank.branches, rotations)
        self._motion = _gram(self._truth)
        shares = sorted({share for *_, share in LADDER} - {0.0, math.inf})
        few = slice(None, None, _SPARSE)
        sets = quiet_sets(tree, bank.branches, rotations[:, :2, few], _FREQUENCIES[few], shares)
        all_still = np.ones(tree.n_branches, dtype=np.bool_)
        self._trees = {0.0: whole, math.inf: PartlyFrozenTree(whole, all_still)}
        for share, quiet in zip(shares, sets, strict=True):
            if quiet.any():
                self._trees[share] = PartlyFrozenTree(whole, quiet)
        self._models: dict[str, _Model] = {}
        for model, n_modes, share in LADDER:
            if model == 'coupled':
                model, n_modes = best, best_modes
            self._add(model, n_modes, share)
        self._grams = np.stack([self._motion, *(each.error for each in self._models.values())])
        del self._truth

    def calibrated(self, estimate: Estimate) -> CalibratedTree:
        """Return the tree, calibrated and frozen as an estimate has it."""
        return self._trees[self._models[estimate.name].share]

    @property
    def whole(self) -> CalibratedTree:
        """Return the tree, calibrated, nothing frozen."""
        return self._trees[0.0]

    def moving(self, name: str) -> Ints:
        """Branches that the model of this name moves, (m,)."""
        calibrated = self._trees[self._models[name].share]
        if isinstance(calibrated, PartlyFrozenTree):
            return calibrated.pruning.moving
        return np.arange(self.tree.n_branches)

    def estimates(self, climate: WindClimate) -> list[Estimate]:
        """Judge every model in a wind; the one of least cost first."""
        load = pressure(climate.speed, *self._drag_law)
        power = climate.power(_FREQUENCIES)[None]
        if self._coherence < 1.0:
            spread = self.whole.crown_delays.spread
            shares = shared_power(self._coherence, spread, climate.speed, _FREQUENCIES)
            power = shares[:, :, None, None] * power
        swings = np.maximum(_mean_squares(self._grams, power), 0.0)
        power[0, 0] += np.outer(climate.mean, climate.mean)
        squares = np.maximum(_mean_squares(self._grams, power), 0.0)
        swing, offset = load * math.sqrt(swings[0]), load * math.sqrt(squares[0])
        errors = MARGIN * load * np.sqrt(squares[1:])
        found = []
        for each, error in zip(self._models.values(), errors.tolist(), strict=True):
            # What no linear model knows has nothing to do with what a lesser one leaves out.
            share = FLOOR + BEND * offset / self._reach + each.table_error
            rest = share * offset if each.model != 'frozen' else 0.0
            bound = math.hypot(error, rest)
            found.append(
                Estimate(each.model, each.n_modes, bound, swing, each.cost, each.n_frozen)
            )
        return sorted(found, key=lambda e: e.cost)

    def _add(self, model: str, n_modes: int, share: float) -> None:
        """Set a model against the best one, both on the coordinates of the whole tree."""
        calibrated, whole = self._trees.get(share), self._trees[0.0].layer(model)
        n = whole.reduction.n_coordinates
        if model == 'wind_basis' and self.whole.plain:
            return
        if calibrated is None or n_modes > calibrated.layer(model).reduction.n_coordinates:
            return
        bank = calibrated.bank(model, n_modes)
        name = model_name(model, n_modes, bank.n_frozen)
        if name in self._models:
            return
        moving = np.arange(n)
        if isinstance(calibrated, PartlyFrozenTree):
            moving = calibrated.pruning.coordinates(whole.reduction)
        rotations = np.zeros((n, *self._truth.shape[2:]), dtype=np.complex128)
        rotations[moving] = self._response(calibrated, bank)
        error = _gram(tip_motion(whole.branches, rotations) - self._truth)
        cost = frame_cost(bank, self.tree)
        of = bank.oscillators
        told = TABLE_FLOOR + TABLE_MARGIN * of.table_error if of.is_tabled else 0.0
        self._models[name] = _Model(model, n_modes, share, bank.n_frozen, cost, error, told)

    def _response(self, calibrated: CalibratedTree, bank: Bank) -> Complexes:
        """Answers of a model to an even wind and to limbs against each other, (N, 2 p, f)."""
        n = _n_coordinates(bank.branches)
        if self._coherence == 1.0:
            return key_response(bank.oscillators, n, _FREQUENCIES)
        delays = calibrated.crown_delays
        if not bank.oscillators.is_tabled:
            patterns = [np.ones(len(bank.branches)), *_signs(delays.of_branch)]
            return key_response(bank.oscillators, n, _FREQUENCIES, patterns)
        even = key_response(bank.oscillators, n, _FREQUENCIES)
        means = _signs(np.arange(len(delays.share))) @ delays.share
        return np.concatenate([even, *(mean * even for mean in means)], axis=1)


@dataclass(frozen=True)
class _Model:
    """One way to solve the tree, its cost and its error, as `_gram`."""

    model: str
    n_modes: int
    share: float
    n_frozen: int
    cost: float
    error: Floats
    table_error: float = 0.0


def _best(tree: Tree) -> tuple[str, int]:
    """Find the model that all others are set against, and its number of modes."""
    return ('coupled', 0) if tree.n_branches <= MOST_COUPLED else ('modes', MOST_MODES)


def _n_coordinates(branches: Records) -> int:
    return int(branches['n_coordinates'].sum())


def _signs(delay: Ints) -> Floats:
    """Four patterns of plus and minus one, by the bits of delays (b,), (4, b)."""
    return np.asarray(1.0 - 2.0 * (delay >> np.arange(4)[:, None] & 1))


def _gram(response: Complexes) -> Floats:
    """
    Mean over tips of the answers' inner products to an even wind and patterns, (1 or 2, f, 2, 2).

    The answers (b, 3, 2 p, f) are along x and y; of the patterns it is the mean.
    """
    b, _, columns, f = response.shape
    by_pattern = response.reshape(b, 3, columns // 2, 2, f)
    grams = np.einsum('bkpif,bkpjf->pfij', by_pattern.conj(), by_pattern).real / b
    return np.stack([grams[0], *([grams[1:].mean(axis=0)] if len(grams) > 1 else [])])


def _mean_squares(grams: Floats, power: Floats) -> Floats:
    """Mean squares (k,) that the power of a load makes of each `_gram`, both (..., f, 2, 2)."""
    squares: Floats = grams.reshape(len(grams), -1) @ power.ravel()
    return squares
