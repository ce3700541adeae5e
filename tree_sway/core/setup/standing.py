# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Thicken the limbs of a scan that cannot carry themselves, by as little as lets the tree stand.

A tree that grew stands, so a limb that buckles under its own weight is a fault of its scan: a
thickness that the laser did not resolve. With the bending moments M of the buckling mode
unchanged, an element that is made d' thick in place of d has (d / d')^4 of its elastic energy, and
the least wood that lowers the energy of all by a factor is ``d' = max(d, c M^(1/3))``: thickened
wood has the same stress everywhere (Metzger's rule for stems, 1893). The constant c is the
smallest by which the tree carries its weight and a margin; repetition takes the weight of the
added wood into account.

A tree is judged in one season: one that stands bare is not made thicker for its leaves.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.model import ModelCache, PREPARED
from tree_sway.core.settings import Settings
from tree_sway.core.setup.modes import buckling_modes, solvable
from tree_sway.core.setup.reduced_tree import ReducedTree
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.setup.threads import one_thread
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.core.tree_state import digest_of

MARGIN = 1.5
"""
Weight over its own that a thickened limb carries [-]. Saplings in the shade of others, the most
slender trees, carry some 1.3 and more (King 1981, Ecological Monographs 51(3), 351-375).
"""

_SHAPES = {'needed': 1.0, 'all': MARGIN}
"""
Further shapes of the branches (`Settings.enrich`), one choice after the other, and the weight over
its own up to which limbs are thickened with it. With those needed most limbs are found in less
time; but a limb of a published scan carried 1.5 times its weight with them and 0.75 times with
all, as a wind that bends it far gives it.
"""

_ROUNDS = 40
"""Largest number of times that limbs are thickened; the most faulty scans take some ten."""

_AT_ONCE = 40
"""Number of buckling modes whose limbs are thickened at once."""

_OVERSHOOT = 1.02
"""Further growth of the carried weight, for that of the added wood [-]."""


@dataclass(frozen=True)
class Thickening:
    """
    Limbs of a tree that were thickened.

    Parameters
    ----------
    segments
        Number of segments that grew.
    branch
        Branches, the one that grew most first, (k,).
    before, after
        Diameter of each in [m] where it grew most, (k,).
    carried
        Share of its own weight that the tree carried before [-].
    added
        Volume of the added wood over that of the tree before [-].
    in_leaf
        Whether it bore its leaves.

    """

    segments: int
    branch: Ints
    before: Floats
    after: Floats
    carried: float
    added: float
    in_leaf: bool

    def sentence(self, tree: Tree) -> str:
        """Say what was changed, in one sentence."""
        count = len(self.branch)
        worst = tree.branch_names[int(self.branch[0])]
        limbs = '1 limb' if count == 1 else f'{count} limbs'
        season = 'in leaf' if self.in_leaf else 'bare'
        from_mm = 1e3 * self.before[0]
        to_mm = 1e3 * self.after[0]
        return (
            f'changed, as {season} it could carry {100.0 * self.carried:.0f} % of its weight: '
            f'{self.segments} of {tree.n_segments} segments of {limbs} thickened, '
            f"most '{worst}', from {from_mm:.3g} to {to_mm:.3g} mm; "
            f'{100.0 * self.added:.3g} % of wood added (thicken=no leaves it)'
        )


def standing_tree(
    tree: Tree, species: Species, *, in_leaf: bool, cache: ModelCache | None = PREPARED
) -> tuple[Tree, Thickening | None]:
    """
    Thicken the limbs of a tree that cannot carry themselves.

    Parameters
    ----------
    tree
        Tree as scanned.
    species
        Its wood and its leaves.
    in_leaf
        Whether it bears its leaves.
    cache
        Where the result is written and found again; nowhere if None.

    Returns
    -------
    tuple
        The tree that stands, and the changes; the tree itself and None if it stands already.

    Raises
    ------
    TreeError
        A tree with numbers that linear algebra cannot solve.

    """
    digest = f'{digest_of(tree, species)}-standing{"-in-leaf" if in_leaf else ""}'
    known = cache.read(digest) if cache else None
    if known is None:
        least, carried = _thickest(tree, species, in_leaf=in_leaf)
        known = {'least': least, 'carried': np.array(carried)}
        if cache:
            cache.write(digest, known)
    least = known['least']
    if not least.any():
        return tree, None
    found = _filled(tree, least)
    return found, _changes(tree, found, float(known['carried']), in_leaf=in_leaf)


@one_thread()
def _thickest(tree: Tree, species: Species, *, in_leaf: bool) -> tuple[Floats, float]:
    """Find least diameters of all segments [m], (n,), and the share of its weight it carries."""
    least = np.zeros(tree.n_segments)
    carried = 1.0
    for shapes, below in _SHAPES.items():
        settings = Settings(in_leaf=in_leaf, enrich=shapes)
        for number in range(_ROUNDS):
            found = _filled(tree, least)
            with solvable(found):
                reduced = TreeReductions(found, species, settings).with_subtrees
                if not (reduced.reduction.mass.diagonal() > 0.0).all():
                    break  # the simulator refuses a branch without mass by its name
                if not least.any() and reduced.reduction.factors.is_positive:
                    break
                factors, vectors = buckling_modes(reduced.reduction, _AT_ONCE, below)
            if len(factors) == 0:
                break
            if number == 0:
                carried = min(carried, float(factors[0]))
            for factor, vector in zip(factors, vectors.T, strict=True):
                wanted = _least_diameters(reduced, vector, _OVERSHOOT * MARGIN / float(factor))
                np.maximum(least, wanted, out=least)
    return least, carried


def _filled(tree: Tree, least: Floats) -> Tree:
    """Return the tree with segments no thinner than their least diameters [m], (n,)."""
    base, tip = (np.maximum(each, least) for each in (tree.base_diameter, tree.tip_diameter))
    return replace(tree, base_diameter=base, tip_diameter=tip)


def _least_diameters(reduced: ReducedTree, vector: Floats, growth: float) -> Floats:
    """Least diameter of each segment [m], (n,), by which a mode carries a weight that grows."""
    reduction = reduced.reduction
    energies = []
    moments = []
    for piece, model in enumerate(reduced.models):
        amounts = vector[reduction.first[piece] : reduction.first[piece + 1]]
        curvature = np.tensordot(amounts, [field.curvature for field in model.fields], 1)
        moment = model.beam.second_moment * np.linalg.norm(curvature, axis=-1)
        energy = model.beam.over_segments(moment**2 / model.beam.second_moment)
        energies.append(energy * model.beam.segment_length)
        moments.append(model.beam.over_segments(moment))
    energy = np.concatenate(energies)
    shape = np.cbrt(np.concatenate(moments))
    diameter = 0.5 * (reduced.tree.base_diameter + reduced.tree.tip_diameter)
    has = shape > 0.0
    energy = energy[has]
    shape = shape[has]
    diameter = diameter[has]
    low = 0.0
    high = growth**0.25 * float((diameter / shape).max())
    for _ in range(60):
        middle = 0.5 * (low + high)
        left = energy @ np.minimum(diameter / (middle * shape), 1.0) ** 4
        low, high = (middle, high) if left > energy.sum() / growth else (low, middle)
    least = np.zeros(len(has))
    least[reduced.row[has]] = np.where(high * shape > diameter, high * shape, 0.0)
    return least


def _changes(tree: Tree, found: Tree, carried: float, *, in_leaf: bool) -> Thickening:
    before = np.minimum(tree.base_diameter, tree.tip_diameter)
    after = np.minimum(found.base_diameter, found.tip_diameter)
    growth = after / np.maximum(before, 1e-9)
    grew = (found.base_diameter > tree.base_diameter) | (found.tip_diameter > tree.tip_diameter)
    most = np.lexsort((-growth, tree.branch_of_segment))[tree.branch_first[:-1]]
    most = most[growth[most] > 1.0]
    most = most[np.argsort(-growth[most], kind='stable')]
    added = float(found.volume.sum() / tree.volume.sum()) - 1.0
    return Thickening(
        int(grew.sum()), tree.branch_of_segment[most], before[most], after[most], carried, added,
        in_leaf,
    )  # fmt: skip
