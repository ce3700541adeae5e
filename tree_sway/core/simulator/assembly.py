# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From a tree to the oscillators that move it, for every model.

What only one model needs is imported where that model is made.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol, TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.branch.cutting import cut_tree, CutTree, pieces_by_turn, whole_tree
from tree_sway.core.branch.model import BranchModel, TreeBeams
from tree_sway.core.checks import one_of_each
from tree_sway.core.kernel import WHY_PLAIN
from tree_sway.core.motion.drag import crown_drag, DragLaw, pressure
from tree_sway.core.motion.fill_records import (
    branch_records,
    copy_twigs,
    head_records,
    places_of,
    segment_records,
)
from tree_sway.core.motion.records import in_lines
from tree_sway.core.reduction.matrices import reduce_tree, Reduction
from tree_sway.core.reduction.modes import (
    by_importance,
    Modes,
    most_driven,
    natural_modes,
    solvable,
    with_answers,
)
from tree_sway.core.reduction.one_thread import one_thread
from tree_sway.core.simulator.bank import Bank, Oscillators
from tree_sway.core.simulator.season import in_season
from tree_sway.core.simulator.settings import Settings
from tree_sway.core.state.tree_state import digest_of
from tree_sway.core.tree.species import Species
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError

if TYPE_CHECKING:
    from tree_sway.core.motion.modal import ModalBank
    from tree_sway.core.motion.static_answers import WindMoments
    from tree_sway.core.motion.uncoupled import UncoupledBank
    from tree_sway.core.motion.wind_basis_table import WindBasisTable
    from tree_sway.core.wind.crown_wind import CrownDelays


_ONE_ADDED = 3
"""One of this number of coordinates of a table makes up for what the modes cannot do."""

EVENLY_DAMPED = 40
"""
Natural modes of an even damping ratio; above them it grows with the frequency, as by dampers in
the wood that go with its stiffness.

"""

CUT_FOR = 15.0
"""Wind in [m/s] whose turns branches are cut for."""

_FEW_MODES = 6
"""Coordinates that are static answers alone."""


class Kept(Protocol):
    """Where set-ups are kept, for a next start that has the same one."""

    def read(self, digest: str) -> dict[str, Any] | None:
        """Arrays by name, as they were written under this digest; None if there are none."""

    def write(self, digest: str, arrays: Mapping[str, Any]) -> None:
        """Keep arrays, or leave it."""


@dataclass(frozen=True)
class ReducedTree:
    """
    A tree reduced in one of the two ways that models differ in.

    Its branches may be pieces of those of the tree as it is given: ``branch`` are these, (p,).
    """

    tree: Tree
    branch: Ints
    models: list[BranchModel]
    reduction: Reduction
    branches: Records
    segments: Records
    mass: float


class CalibratedTree:
    """
    A tree calibrated once, for all models; its models run in numpy if ``plain``.

    What steps modes is looked for first where set-ups are ``kept``, and put there.
    """

    def __init__(
        self,
        tree: Tree,
        species: Species,
        settings: Settings,
        *,
        plain: bool = False,
        kept: Kept | None = None,
    ) -> None:
        """Wait to be asked."""
        self._kept = kept
        self.plain = plain or bool(WHY_PLAIN)
        if settings.root_stiffness is not None:
            species = replace(species, root_stiffness=settings.root_stiffness)
        self.tree, self.species = tree, species
        self.settings = in_season(tree, species, settings)
        self._slowest: Modes | None = None
        self._natural = np.zeros(0)

    @property
    def damping_ratio(self) -> float:
        """Of every oscillator in [-]."""
        settings, species = self.settings, self.species
        if settings.damping_ratio is not None:
            return settings.damping_ratio
        return species.damping(bool(settings.in_leaf))

    @cached_property
    def drag_law(self) -> DragLaw:
        """Of the whole tree, wood and leaves."""
        return self._crown_drag[0]

    @cached_property
    def leaf_load_area(self) -> Floats | None:
        """Area of bare wood that the leaves of each branch are equivalent to in [m^2], (b,)."""
        return self._crown_drag[1]

    @cached_property
    def _crown_drag(self) -> tuple[DragLaw, Floats | None]:
        tree, species, given = self.tree, self.species, self.settings.leaf_area
        if not self.settings.in_leaf or given is None:
            return DragLaw(*species.drag_law(bool(self.settings.in_leaf))), None
        laws = species.drag_law(in_leaf=False)[0], species.drag_law(in_leaf=True)
        area = one_of_each('leaf_area', given, tree.n_branches, 'branch')
        wood = float(tree.length @ (tree.base_diameter + tree.tip_diameter)) / 2.0
        from tree_sway.core.leaves.foliage import clad_wood

        return crown_drag(wood, area, clad_wood(tree, species.leaves), *laws)

    def crown_delays(self, model: int | str) -> CrownDelays:
        """When each branch of a model meets a gust."""
        from tree_sway.core.simulator.crown_gusts import delays_of

        whole = delays_of(self.tree, self.leaf_load_area)
        return whole._replace(of_branch=whole.of_branch[self.reduced(model).branch])

    def bank(self, model: int | str | None = None) -> Bank:
        """
        Build the oscillators of a model: a number of coordinates, ``branch`` or ``full``.

        It is that of the settings if None.

        Raises
        ------
        TreeError
            A tree that buckles under its own weight, or a branch without mass.
        ParameterError
            A model that has no oscillators of its own.

        """
        model = self.settings.model if model is None else model
        if model == 'auto':
            raise ParameterError(
                "model 'auto' has no oscillators of its own",
                where='model',
                cure='make it by make_simulator, or give a number of coordinates',
            )
        with solvable(self.tree):
            if model != 'branch':
                return self._bank_of_modes(model)
            reduced = self.isolated
            branches = reduced.branches.copy()
            oscillators = self._bank_of_branches(reduced, branches)
            return self._laid_out(oscillators, branches, reduced.segments, reduced.mass)

    def natural_modes(self, count: int | None = None) -> Modes:
        """Return the slowest natural modes of the tree, or all, found once."""
        wanted = self.coupled.reduction.n_coordinates if count is None else count
        if self._slowest is None or len(self._slowest.circular) < wanted:
            with solvable(self.tree):
                reduced = self.coupled
                self._slowest = natural_modes(reduced.tree, reduced.reduction, count)
        return self._slowest.slowest(wanted)

    def natural_frequencies(self, count: int) -> Floats:
        """Lowest natural frequencies in [Hz], (count,) or fewer."""
        if count > len(self._natural):
            count = min(count, self.coupled.reduction.n_coordinates)
            self._natural = self.natural_modes(count).circular
        return np.asarray(self._natural[:count] / (2.0 * np.pi))

    def _bank_of_modes(self, model: int | str) -> Bank:
        """Take a set-up that is kept, or make one; the same bits either way."""
        digest, found = '', None
        if self._kept is not None:
            digest = digest_of(self.tree, self.species, replace(self.settings, model=model))
            digest = f'{digest}-{WHY_PLAIN}'
            found = self._kept.read(digest)
        made_of = self._modal_arrays(model) if found is None else found
        self._natural = made_of['natural']
        branches = made_of['branches'].copy()
        modal = self._modal_bank()(branches, made_of, self.damping_ratio)
        oscillators: Oscillators = modal
        if model != 'full' and model != 0 and not self.plain:
            from tree_sway.core.motion.wind_basis import WindBasisBank
            from tree_sway.core.motion.wind_basis_table import WindBasisTable

            table = self._table(modal) if found is None else WindBasisTable.of_arrays(found)
            made_of |= table.arrays
            oscillators = WindBasisBank(modal, table)
        if found is None and self._kept is not None:
            self._kept.write(digest, made_of)
        segments = made_of['segments'] if found is None else in_lines(made_of['segments'])
        return self._laid_out(oscillators, branches, segments, float(made_of['tree_mass']))

    @one_thread()
    def _modal_arrays(self, model: int | str) -> dict[str, Any]:
        """Find all that modes are stepped and placed by."""
        from tree_sway.core.motion.modal import modal_arrays

        reduced = self.coupled
        records = {'branches': reduced.branches, 'segments': reduced.segments}
        arrays = modal_arrays(reduced.branches, reduced.reduction, self._modes(model))
        even = self.natural_modes(min(EVENLY_DAMPED, reduced.reduction.n_coordinates)).circular
        arrays['loss'] = np.maximum(arrays['circular'] / even[-1], 1.0)
        assert self._slowest is not None
        natural = self._slowest.circular
        return {**records, **arrays, 'natural': natural, 'tree_mass': np.array(reduced.mass)}

    @one_thread()
    def _table(self, modal: ModalBank) -> WindBasisTable:
        from tree_sway.core.motion.wind_basis_table import WindBasisTable

        return WindBasisTable(modal, self._wind_moments, self.drag_law, self.settings.degree)

    @cached_property
    def _wind_moments(self) -> WindMoments:
        """Return the loads of the coupled tree."""
        from tree_sway.core.motion.static_answers import WindMoments

        return WindMoments(self.coupled.branches, plain=self.plain)

    @cached_property
    def _answers(self) -> Floats:
        """Key rotations by which the tree answers to winds, for a pressure of 1 kg/m/s^2."""
        from tree_sway.core.motion.static_answers import static_answers

        law = self.drag_law
        solve = self.coupled.reduction.factors.solve
        return static_answers(self._wind_moments, solve, lambda u: pressure(u, *law) * u * u)

    def _laid_out(
        self, oscillators: Oscillators, branches: Records, segments: Records, mass: float
    ) -> Bank:
        solved = int((branches['source'] == np.arange(len(branches))).sum())
        heads = head_records(branches, segments)
        return Bank(oscillators, branches, segments, heads, solved, mass, self.plain)

    def reduced(self, model: int | str) -> ReducedTree:
        """Reduction that a model starts from."""
        return self.isolated if model == 'branch' else self.coupled

    @cached_property
    def isolated(self) -> ReducedTree:
        """Every branch on its own."""
        return self._reduced(
            whole_tree(self.tree), self._beams, carries=False, enriched=frozenset()
        )

    @cached_property
    def coupled(self) -> ReducedTree:
        """Branches that carry their children, those of the enriched ones with further shapes."""
        beams = self._cut_beams
        enriched = beams.enriched(self.settings.enrich)
        return self._reduced(self._cut, beams, carries=True, enriched=enriched)

    @cached_property
    def _cut(self) -> CutTree:
        """Key segments of the coupled tree: branches that turn far are cut."""
        push = pressure(CUT_FOR, *self.drag_law) * CUT_FOR**2
        turns = push * self._beams.turns(self.species.modulus)
        return cut_tree(self.tree, pieces_by_turn(self.tree, turns))

    @cached_property
    def _cut_beams(self) -> TreeBeams:
        cut = self._cut
        if cut.tree.n_branches == self.tree.n_branches:
            return self._beams
        same = np.where(cut.share == 1.0, cut.branch, -1)
        return self._beams_of(cut, (self._beams, same))

    @cached_property
    def _speed(self) -> Floats:
        """Wind at each segment's middle over that at the anemometer, (n,)."""
        middle = 0.5 * (self.tree.start[:, 2] + self.tree.end[:, 2])
        return self.settings.profile.over_anemometer(middle)

    @cached_property
    def _beams(self) -> TreeBeams:
        """Return the beams of whole branches."""
        return self._beams_of(whole_tree(self.tree))

    def _beams_of(self, cut: CutTree, known: tuple[TreeBeams, Ints] | None = None) -> TreeBeams:
        species, settings = self.species, self.settings
        given = {'leaf_mass': settings.leaf_mass, 'leaf_area': self.leaf_load_area}
        b = self.tree.n_branches
        leaves = {
            name: None
            if each is None
            else cut.share * one_of_each(name, each, b, 'branch')[cut.branch]
            for name, each in given.items()
        }
        return TreeBeams(
            cut.tree,
            species.density,
            shear_ratio=species.shear_ratio,
            speed_profile=self._speed[cut.row],
            **leaves,
            root_compliance=species.modulus / species.root_stiffness,
            known=known,
        )

    @one_thread()
    def _reduced(
        self, cut: CutTree, beams: TreeBeams, *, carries: bool, enriched: frozenset[int]
    ) -> ReducedTree:
        tree, species = cut.tree, self.species
        models = beams.models(carries=carries, enriched=enriched)
        shear = species.shear_ratio * species.modulus
        reduction = reduce_tree(
            tree, models, species.modulus, shear, self.settings.gravity, carries=carries
        )
        places = places_of(tree, models, reduction)
        records = branch_records(tree, models, reduction, places, self._speed[cut.row])
        # Poses are those of the whole branches' segments.
        row, on = cut.row[records['first']], records['base_segment']
        records['end'] += row - records['first']
        records['first'], records['base_segment'] = row, np.where(on < 0, -1, cut.row[on])
        mass = float(sum(model.beam.integral(model.mass) for model in models))
        segments = segment_records(places)
        return ReducedTree(tree, cut.branch, models, reduction, records, segments, mass)

    def _modes(self, model: int | str) -> Modes:
        """All modes, or of the slowest those the wind drives most and the sway that they lack."""
        reduction = self.coupled.reduction
        n = reduction.n_coordinates
        count = n if isinstance(model, str) else min(model, n)
        if count in (0, n):
            modes = self.natural_modes(1 if count == 0 else None)
            return modes.slowest(count)
        candidates = min(n, count + min(3 * count, 24))
        modes = self.natural_modes(None if candidates == n else candidates)
        from tree_sway.core.motion.plain.numpy_passes import mean_wind_moments
        from tree_sway.core.motion.response import tip_motion

        branches = self.coupled.branches
        moved = np.square(tip_motion(branches, modes.shapes)).sum(axis=(0, 1))
        loads = mean_wind_moments(branches, n)
        n_added = count if count <= _FEW_MODES else count // _ONE_ADDED
        chosen = most_driven(modes, loads, moved, max(count - n_added, 1))
        modes = with_answers(
            chosen.slowest(count - n_added),
            reduction,
            self._answers,
            lambda x: tip_motion(branches, x).reshape(-1, x.shape[1]),
            n_added,
        )
        moved = np.square(tip_motion(branches, modes.shapes)).sum(axis=(0, 1))
        return by_importance(modes, loads, moved)

    def _modal_bank(self) -> type[ModalBank]:
        if self.plain:
            from tree_sway.core.motion.plain.numpy_banks import NumpyModalBank

            return NumpyModalBank
        from tree_sway.core.motion.modal import ModalBank

        return ModalBank

    @one_thread()
    def _bank_of_branches(self, reduced: ReducedTree, branches: Records) -> UncoupledBank:
        """Each branch's own oscillator: the mean of its two axes."""
        from tree_sway.core.motion.uncoupled import UncoupledBank
        from tree_sway.core.reduction.carried_inertia import carried_inertia
        from tree_sway.core.reduction.modes import refuse_buckling
        from tree_sway.core.tree.similar_twigs import twig_sources

        tree, settings = self.tree, self.settings
        refuse_buckling(tree, reduced.reduction)
        copy_twigs(branches, twig_sources(tree, settings.twig_tolerance))
        inertia = carried_inertia(tree, reduced.reduction).reshape(-1, 2).mean(axis=1)
        inertia = inertia * np.array([model.inertia_share for model in reduced.models])
        stiffness = np.asarray(reduced.reduction.stiffness.diagonal()).reshape(-1, 2).mean(axis=1)
        weight = np.asarray(reduced.reduction.gravity.diagonal()).reshape(-1, 2).mean(axis=1)
        damping = 2.0 * self.damping_ratio * np.sqrt(stiffness * inertia)
        if settings.volume_stiffness:
            volume = np.add.reduceat(tree.volume, tree.branch_first[:-1])
            parent = volume[np.maximum(tree.branch_parent, 0)]
            rule = np.sqrt(volume * parent)
            stiffness, damping = settings.volume_stiffness * rule, settings.volume_damping * rule
        kind: type[UncoupledBank] = UncoupledBank
        if self.plain:
            from tree_sway.core.motion.plain.numpy_banks import NumpyUncoupledBank

            kind = NumpyUncoupledBank
        return kind(branches, inertia, damping, stiffness, weight)
