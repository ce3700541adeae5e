"""
How much model a scene needs: the error of every rung in this wind, and the least rung that will do.

The coupled tree is linear to first order, so the error of a lesser rung need not be tried: it is the difference of the
two responses, summed over the frequencies of the wind's load. That difference, joined from the root to the tips of all
branches, is what a viewer would see. To it comes a margin for what no linear model knows.

Symbols: D(f) difference of two tip responses, S(f) spectrum of the load, C its covariance.

"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tree_sway_ros.core.banks import Bank, CalibratedTree
from tree_sway_ros.core.response import Complexes, tip_response
from tree_sway_ros.core.settings import SimulatorSettings
from tree_sway_ros.core.species import Species
from tree_sway_ros.core.tree import Floats, Tree
from tree_sway_ros.core.wind_climate import WindClimate
from tree_sway_ros.core.wind_load import pressure
from tree_sway_ros.errors import ParameterError

MARGIN = 1.3
"""Estimated over computed error: the wind is not quite linear in its effect."""

FLOOR = 0.03
"""Share of the motion by which even the coupled model may err against every segment solved."""

LADDER: tuple[tuple[str, int], ...] = (
    ("frozen", 0), ("branch", 0), ("subtree", 0), ("modes", 3), ("modes", 6), ("modes", 12), ("coupled", 0),
)  # fmt: skip
"""Rungs with their number of modes, in the order of what they cost."""

MOST_COUPLED, MOST_MODES = 400, 32
"""A tree of more branches than this is not solved in all its modes, but in this many."""

_FREQUENCIES = np.concatenate([[0.0], np.geomspace(0.01, 30.0, 160)])


@dataclass(frozen=True)
class Estimate:
    """
    What a rung is worth in a wind.

    Parameters
    ----------
    rung, n_modes
        The rung, and its number of modes if it is ``modes``.
    error
        Bound of the root mean square over time and tips of the error in [m].
    motion
        Root mean square of the motion of the tips about its mean in [m].
    cost
        Of one step and one placing on an ordinary core in [us].

    """

    rung: str
    n_modes: int
    error: float
    motion: float
    cost: float

    @property
    def name(self) -> str:
        """As people say it: ``modes 6``."""
        return f"{self.rung} {self.n_modes}" if self.rung == "modes" else self.rung


class FidelityLadder:
    """
    The rungs of a tree, each with its response.

    Parameters
    ----------
    tree, species, settings
        As for `SwaySimulator`; the settings' rung does not matter.

    """

    def __init__(self, tree: Tree, species: Species, settings: SimulatorSettings) -> None:
        """Find the response of every rung."""
        self.tree, self.species = tree, species
        self._coefficient = species.drag_law(settings.in_leaf)
        truth: Complexes | None = None
        self._errors: list[Floats] = []
        self._rungs: list[tuple[str, int, float]] = []
        self.calibrated = CalibratedTree(tree, species, replace(settings, stiffness="beam"))
        for rung, n_modes in reversed(LADDER):
            if rung == "modes" and n_modes > 2 * tree.n_branches:
                continue
            if rung == "coupled" and tree.n_branches > MOST_COUPLED:
                rung, n_modes = "modes", MOST_MODES
            bank = self.calibrated.bank(rung, n_modes)
            n = int((bank.branches["coordinate"] + bank.branches["n_coordinates"]).max())
            answer = tip_response(bank.oscillators, n, _FREQUENCIES)
            if truth is None:
                truth = answer
                self._motion = _gram(truth)
            self._errors.append(_gram(answer - truth))
            self._rungs.append((rung, n_modes, step_cost(bank, tree, n)))

    def estimates(self, climate: WindClimate) -> list[Estimate]:
        """
        Judge every rung in a wind.

        Parameters
        ----------
        climate
            The wind.

        Returns
        -------
        list of Estimate
            From the cheapest to the dearest.

        """
        load = pressure(climate.speed, *self._coefficient)
        swing = _root(self._motion, climate, with_mean=False) * load
        offset = _root(self._motion, climate, with_mean=True) * load
        found = []
        for (rung, n_modes, cost), error in zip(self._rungs, self._errors, strict=True):
            floor = FLOOR * offset if rung != "frozen" else 0.0
            bound = MARGIN * _root(error, climate, with_mean=True) * load + floor
            found.append(Estimate(rung, n_modes, bound, swing, cost))
        return sorted(found, key=lambda e: e.cost)


def choose(
    estimates: Sequence[Estimate], *, tolerance: float | None = None, budget: float | None = None
) -> Estimate:
    """
    Choose the least rung that a scene needs.

    Parameters
    ----------
    estimates
        Of all rungs.
    tolerance
        Largest error in [m]; the cheapest rung within it is chosen.
    budget
        Largest cost of a step in [us]; the most accurate rung within it is chosen. With both, the cheapest within the
        tolerance among those within the budget.

    Returns
    -------
    Estimate
        The choice.

    Raises
    ------
    ParameterError
        A tolerance or budget that no rung meets; the error names the nearest.

    """
    within = [e for e in estimates if budget is None or e.cost <= budget]
    if not within:
        cheapest = min(estimates, key=lambda e: e.cost)
        raise ParameterError(
            f"no rung costs less than {budget:g} us a step",
            where="budget",
            cure=f"allow {cheapest.cost:.3g} us for '{cheapest.name}'",
        )
    if tolerance is None:
        return min(within, key=lambda e: (e.error, e.cost))
    good = [e for e in within if e.error <= tolerance]
    if not good:
        best = min(within, key=lambda e: e.error)
        raise ParameterError(
            f"no rung errs less than {tolerance:g} m in this wind",
            where="tolerance",
            cure=f"allow {best.error:.3g} m for '{best.name}', or pin a rung",
        )
    return min(good, key=lambda e: e.cost)


def tolerance_in_metres(pixels: float, distance: float, focal_length: float) -> float:
    """
    Turn a tolerance on the picture into one in the scene.

    Parameters
    ----------
    pixels
        Tolerance in [px].
    distance
        From the camera to the tree in [m].
    focal_length
        Of the camera in [px].

    Returns
    -------
    float
        In [m].

    """
    if not (pixels > 0.0 and distance > 0.0 and focal_length > 0.0):
        raise ParameterError(
            f"tolerance of {pixels:g} px at {distance:g} m with a focal length of {focal_length:g} px",
            cure="give three numbers above 0",
        )
    return pixels * distance / focal_length


def distance_to(tree: Tree, position: Floats) -> float:
    """
    Distance from a camera to the nearest branch tip or to the root in [m], at least 1 cm.

    Parameters
    ----------
    tree
        The tree.
    position
        Of the camera in the tree's frame in [m], (3,).

    """
    seen = np.vstack([tree.start[:1], tree.end[tree.branch_first[1:] - 1]])
    return max(float(np.linalg.norm(seen - position, axis=1).min()), 0.01)


def step_cost(bank: Bank, tree: Tree, n_coordinates: int) -> float:
    """Cost of one step and one placing in [us], from counts and the measured prices of `tree-sway bench step`."""
    place = 2.0 + 0.016 * tree.n_segments
    if not bank.frequencies.size:
        return place
    alone = 2.0 + (0.09 if not bank.oscillators.carries else 0.12) * tree.n_branches
    shapes = getattr(bank.oscillators, "shapes", None)
    if shapes is None:
        return place + alone
    return place + alone + 3e-3 * n_coordinates * int(shapes.shape[1])


def _gram(response: Complexes) -> Floats:
    """Mean over tips of the inner products of the answers along x and y, (f, 2, 2)."""
    gram = np.einsum("bkif,bkjf->fij", response.conj(), response).real / len(response)
    return np.asarray(gram, dtype=np.float64)


def _root(gram: Floats, climate: WindClimate, *, with_mean: bool) -> float:
    """Root mean square that a load makes of a response, per unit of drag pressure."""
    density = np.einsum("fij,ij->f", gram, climate.covariance) * climate.spectrum(_FREQUENCIES)
    square = float((0.5 * (density[1:] + density[:-1]) * np.diff(_FREQUENCIES)).sum())
    if with_mean:
        square += float(climate.mean @ gram[0] @ climate.mean)
    return math.sqrt(max(square, 0.0))
