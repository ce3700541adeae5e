# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree as the matrices and records that its models are made from.

Branches become beams, those that rotate far are cut into key segments, and these are reduced to
key rotations: with subtrees, where a branch moves with its subtree, or isolated (the paper's).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.checks import one_of_each
from tree_sway.core.drag import DragLaw
from tree_sway.core.settings import Settings
from tree_sway.core.setup.beams.branch_model import BranchModel, TreeBeams
from tree_sway.core.setup.beams.cutting import cut_tree, CutTree, pieces_by_turn, whole_tree
from tree_sway.core.setup.branch_places import Places, places_of
from tree_sway.core.setup.branch_records import branch_records
from tree_sway.core.setup.matrices import reduce_tree, Reduction
from tree_sway.core.setup.threads import one_thread
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree

_CUT_FOR = 15.0
"""Wind in [m/s] for whose rotations branches are cut."""

_LEAST_WIND = 1e-3
"""
Least wind at a segment over that at the anemometer: one that no wind reaches is loaded by a
millionth of the pressure, so that a branch at or below the ground has shapes under a load.
"""

_LIMP_TURN, _LIMP_SHARE, _MOST_LIMP = 1.0, 0.1, 2000
"""
Rotation [rad] in the wind that branches are cut for, by linear beams, beyond which a branch is
limp; the share of all branches, by length, that makes a limp tree; and its largest number of
segments, for a step takes time in proportion. Of trees that were tried those whose twigs hang or
whip have a share of 0.25 to 0.87, a grown willow of 12 m in leaf 0.07, and all others none.
"""

_WHIP_TURN, _MOST_WHIPPY = 0.5, 500
"""
The same rotation [rad] for bare trees of few segments, and their number: young whips and rods,
which bend as a whole, have a share of 0.30 to 0.59 beyond it, and a step of theirs takes little
time. A sapling in leaf is not among them: its stem bends as far, but the table with its leaves is
within 0.05 of all coordinates.
"""

STRUNG = 10.0
"""
Weight over stiffness up to which a limp branch gets a further pair of shapes. Twigs of birches and
whips have 0.5 to 8, and are nearer to the truth with it; those of a willow, which hang as strings,
have 11 to 45: with it they are further from the truth in winds of 9 m/s and above.
"""


@dataclass(frozen=True)
class ReducedTree:
    """
    A tree reduced in one of the two ways.

    Its branches may be pieces of those of the given tree, whose numbers are ``branch``, (p,), and
    ``row`` has the given tree's number of each segment, (n,); each segment has its ``mass`` [kg],
    with leaves, (n,).
    """

    tree: Tree
    branch: Ints
    row: Ints
    models: list[BranchModel]
    reduction: Reduction
    branches: Records
    places: Places
    mass: Floats


class TreeReducer:
    """
    The two reductions of a tree, each made at its first use.

    Parameters
    ----------
    tree, species, settings
        Tree, its species with its roots, and the settings in season.
    drag_law
        Drag law of the whole tree.
    leaf_load_area
        Area of bare wood that meets as much wind as the leaves of each branch in [m^2], (b,).

    """

    def __init__(
        self,
        tree: Tree,
        species: Species,
        settings: Settings,
        drag_law: DragLaw,
        leaf_load_area: Floats,
    ) -> None:
        self._tree = tree
        self._species = species
        self._settings = settings
        self._drag_law = drag_law
        self._leaf_load_area = leaf_load_area
        middle = 0.5 * (tree.start[:, 2] + tree.end[:, 2])
        self._speed = np.maximum(settings.profile.over_anemometer(middle), _LEAST_WIND)
        """Wind at each segment's middle over that at the anemometer, (n,)."""

    @cached_property
    def isolated(self) -> ReducedTree:
        """Reduction of isolated branches."""
        models = self._beams.models(subtrees=False)
        return self._reduced(whole_tree(self._tree), models, subtrees=False)

    @cached_property
    def with_subtrees(self) -> ReducedTree:
        """
        Reduction with subtrees, enriched branches with further shapes.

        Branches that rotate far are cut into key segments.
        """
        pieces = pieces_by_turn(self._tree, self.turns, is_limp=self.is_limp)
        cut = cut_tree(self._tree, pieces)
        is_cut = cut.tree.n_branches > self._tree.n_branches
        beams = self._beams_of(cut) if is_cut else self._beams
        enriched = beams.enriched(self._settings.enrich)
        limp = frozenset(np.flatnonzero(self._is_bent[cut.branch]).tolist())
        models = beams.models(subtrees=True, enriched=enriched, limp=limp)
        return self._reduced(cut, models, subtrees=True)

    @cached_property
    def turns(self) -> Floats:
        """Rotation [rad] of each branch in the wind that branches are cut for, (b,)."""
        dynamic_pressure = self._drag_law.dynamic_pressure(_CUT_FOR)
        return np.asarray(dynamic_pressure * self._beams.turns(self._species.modulus))

    @cached_property
    def is_limp(self) -> bool:
        """Whether so much of the tree turns so far that a table of loads is too coarse."""
        length = self._tree.branch_length
        turned = float(length[self._is_far].sum())
        is_small = self._tree.n_segments <= _MOST_LIMP
        return is_small and turned > _LIMP_SHARE * float(length.sum())

    @property
    def _is_far(self) -> NDArray[np.bool_]:
        """Whether each branch turns so far that it is limp, (b,)."""
        may_whip = self._tree.n_segments <= _MOST_WHIPPY and not self._settings.in_leaf
        return np.asarray(self.turns > (_WHIP_TURN if may_whip else _LIMP_TURN))

    @property
    def _is_bent(self) -> NDArray[np.bool_]:
        """Whether each branch gets a further pair: one of a limp tree, and no string, (b,)."""
        if self._settings.enrich != 'needed' or not self.is_limp:
            return np.zeros(self._tree.n_branches, dtype=np.bool_)
        return self._is_far & (self._beams.weight_over_stiffness() < STRUNG)

    @cached_property
    def _beams(self) -> TreeBeams:
        """Return the beams of whole branches."""
        return self._beams_of(whole_tree(self._tree))

    def _beams_of(self, cut: CutTree) -> TreeBeams:
        species = self._species
        settings = self._settings
        leaf_mass = np.zeros(self._tree.n_branches)
        if settings.leaf_mass is not None:
            leaf_mass = one_of_each(
                'leaf_mass', settings.leaf_mass, self._tree.n_branches, 'branch'
            )
        return TreeBeams(
            cut.tree,
            species.density,
            shear_ratio=species.shear_ratio,
            speed_profile=self._speed[cut.row],
            leaf_mass=cut.share * leaf_mass[cut.branch],
            leaf_area=cut.share * self._leaf_load_area[cut.branch],
            root_compliance=species.modulus / species.root_stiffness,
            gravity=settings.gravity / species.modulus,
        )

    @one_thread()
    def _reduced(self, cut: CutTree, models: list[BranchModel], *, subtrees: bool) -> ReducedTree:
        tree = cut.tree
        species = self._species
        shear_modulus = species.shear_ratio * species.modulus
        reduction = reduce_tree(
            tree,
            models,
            species.modulus,
            shear_modulus,
            self._settings.gravity,
            subtrees=subtrees,
        )
        places = places_of(tree, models, reduction)
        records = branch_records(tree, models, reduction, places, self._speed[cut.row])
        _number_as_whole(records, cut.row)
        masses = [
            model.beam.over_segments(model.mass) * model.beam.segment_length for model in models
        ]
        return ReducedTree(
            tree=tree,
            branch=cut.branch,
            row=cut.row,
            models=models,
            reduction=reduction,
            branches=records,
            places=places,
            mass=np.concatenate(masses),
        )


def _number_as_whole(records: Records, row: Ints) -> None:
    """Write the numbers that segments have in the whole branches, (n,): these are placed."""
    first = row[records['first']]
    records['end'] += first - records['first']
    records['first'] = first
    base_segment = records['base_segment']
    records['base_segment'] = np.where(base_segment < 0, -1, row[base_segment])
