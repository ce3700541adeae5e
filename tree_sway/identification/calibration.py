# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The modulus that gives a tree its measured frequency.

The squared frequency of a tree with weight is not proportional to the modulus, but its elastic
stiffness is: in ``(s K1 + Kg) phi = w^2 M phi`` only the scale s is unknown, so the tree is
reduced once. The lowest w^2 is an increasing, concave function of s, with the slope ``phi . K1
phi`` (phi of unit modal mass). So Newton's method converges from below; a bracket keeps it above
the buckling load, where w is 0.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
import math

import numpy as np

from tree_sway.core.checks import within
from tree_sway.core.settings import Settings
from tree_sway.core.setup import buckling_factor, in_season, natural_modes, TreeReductions
from tree_sway.core.species import Species
from tree_sway.core.tree import GrownTree, Tree, tree_and_species
from tree_sway.errors import nearest, ParameterError, TreeError

_MODELLINGS = 4
_TOLERANCE = 1e-9
_MODES = 24
"""Number of slowest modes among which the mode of a branch is searched."""
_STANDS = 1.001
"""Largest share of the buckling weight at which a tree counts as standing."""


@dataclass(frozen=True)
class Calibration:
    """
    A species whose modulus and damping fit one tree.

    Parameters
    ----------
    species
        Species with the modulus of the tree, and its damping ratio if measured.
    frequency
        Frequency of the slowest sway with it in [Hz].
    frequency_before
        Frequency of the slowest sway before; None if the tree buckled.
    modulus_ratio
        Ratio of the modulus to the modulus before in [-].
    branch
        Name of the branch that bends most in that sway; in most trees the stem.
    sensitivity
        Relative change of the modulus over that of the frequency in [-]: 2 without weight, less
        with it.

    """

    species: Species
    frequency: float
    frequency_before: float | None
    modulus_ratio: float
    branch: str
    sensitivity: float


def calibrate(
    tree: Tree | GrownTree,
    species: Species | None = None,
    frequency: float = math.nan,
    damping_ratio: float | None = None,
    settings: Settings | None = None,
    branch: str | None = None,
) -> Calibration:
    """
    Fit modulus and damping of a tree to its slowest sway, or to the slowest of a branch.

    Parameters
    ----------
    tree, species
        The species of the tree before calibration; the tree's own if None.
    frequency
        Measured natural frequency in [Hz].
    damping_ratio
        Measured damping ratio in [-]; taken for the season of the settings. That of the species
        stays if None.
    settings
        Season, leaves and gravity; the defaults if None.
    branch
        Name of the branch that the sway was measured on, such as ``stem``: the slowest sway that
        bends it most is fitted; the slowest of all if None.

    Returns
    -------
    Calibration
        Species to use, and the changes.

    Raises
    ------
    ParameterError
        A frequency or a damping ratio out of range, or no such branch.
    TreeError
        A tree that buckles at that frequency, or a branch without mass.

    """
    within('frequency', frequency, 0.0, 1e3, 'Hz', above=True)
    tree, species = tree_and_species(tree, species)
    settings = in_season(tree, species, settings or Settings())
    if branch is not None and branch not in tree.branch_names:
        cure = nearest(str(branch), tree.branch_names) or f'the first is {tree.branch_names[0]}'
        raise ParameterError(f"no branch '{branch}'", where=tree.name, cure=cure)
    model = _ScaledTree(tree, species, settings, branch)
    found = model.swaying_at((2.0 * math.pi * frequency) ** 2)
    if found is None:
        weakest = model.weakest
        limit = model.sway(model.least)
        raise TreeError(
            f'{frequency:.4g} Hz is out of reach: the tree sways at {limit.frequency:.3g} Hz '
            f'when branch '
            f"'{weakest}' nearly buckles under its own weight",
            where=tree.name,
            cure='check the measured frequency, the density and the diameters',
        )
    roots = species.root_stiffness if settings.root_stiffness is None else settings.root_stiffness

    def stiffened(scale: float) -> Species:
        return replace(species, modulus=scale * species.modulus, root_stiffness=scale * roots)

    scale = found.scale
    fitted = found
    for _ in range(_MODELLINGS):  # a stiffer branch rotates less and may need fewer pieces
        again = _ScaledTree(tree, stiffened(scale), settings, branch)
        step = again.swaying_at((2.0 * math.pi * frequency) ** 2)
        if step is None:
            break
        fitted = step
        scale = scale * step.scale
        if abs(step.scale - 1.0) <= _TOLERANCE:
            break
    changes: dict[str, float] = {}
    if damping_ratio is not None:
        within('damping ratio', damping_ratio, 0.0, 1.0)
        changes['damping_in_leaf' if settings.in_leaf else 'damping_bare'] = damping_ratio
    return Calibration(
        replace(stiffened(scale), **changes, is_estimate=False),  # type: ignore[arg-type]
        fitted.frequency,
        model.sway(1.0).frequency if model.least < 1.0 else None,
        scale,
        model.branch_of(found.coordinate),
        2.0 * fitted.square / (fitted.scale * fitted.slope),
    )


@dataclass(frozen=True)
class _Sway:
    """Slowest mode at a scale of the modulus: w^2 [1/s^2], slope, largest coordinate."""

    scale: float
    square: float
    slope: float
    coordinate: int

    @property
    def frequency(self) -> float:
        return math.sqrt(self.square) / (2.0 * math.pi)


class _ScaledTree:
    """A coupled tree whose modulus is scaled."""

    def __init__(
        self, tree: Tree, species: Species, settings: Settings, branch: str | None
    ) -> None:
        self.tree = tree
        self._reduced = reduced = TreeReductions(tree, species, settings).with_subtrees
        self.reduction = reduced.reduction
        self._branches = np.repeat(reduced.branch, np.diff(self.reduction.first))
        """Branch of each coordinate: a branch may be cut into several pieces."""
        self._wanted = None if branch is None else tree.branch_names.index(branch)
        factor, coordinate = buckling_factor(self.reduction)
        #: Scale at which the tree just carries its weight, and the branch that buckles first.
        self.least = _STANDS / factor
        self.weakest = self.branch_of(coordinate)

    def branch_of(self, coordinate: int) -> str:
        """Name of the branch of a coordinate."""
        return self.tree.branch_names[self._branches[coordinate]]

    def sway(self, scale: float) -> _Sway:
        """Slowest mode at a scale, of those that bend the wanted branch most."""
        scaled = replace(self.reduction, elastic=scale * self.reduction.elastic)
        count = 1 if self._wanted is None else min(_MODES, scaled.elastic.shape[0])
        modes = natural_modes(self._reduced.tree, scaled, count)
        energy = modes.shapes * (self.reduction.elastic @ modes.shapes)
        most = np.argmax(energy, axis=0)
        mode = 0
        if self._wanted is not None:
            is_own = self._branches == self._wanted
            share = energy[is_own].sum(axis=0) / energy.sum(axis=0)
            mode = int(np.argmax(is_own[most]) if is_own[most].any() else np.argmax(share))
        square = float(modes.circular[mode]) ** 2
        return _Sway(scale, square, float(energy[:, mode].sum()), int(most[mode]))

    def swaying_at(self, square: float) -> _Sway | None:
        """Find the scale for a square circular frequency [1/s^2]; None if the tree buckles."""
        low = self.least
        high = math.inf
        sway = self.sway(max(1.0, 2.0 * low))
        while abs(sway.square / square - 1.0) > _TOLERANCE:
            low, high = (sway.scale, high) if sway.square < square else (low, sway.scale)
            if high - low < _TOLERANCE * low:
                return None
            step = sway.scale + (square - sway.square) / sway.slope
            sway = self.sway(step if low < step < high else 0.5 * (low + high))
        return sway
