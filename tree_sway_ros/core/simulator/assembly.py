# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From a tree to the oscillators that move it, for every model of the ladder.

What only one model needs is imported where that model is made.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, cast, Protocol, TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Records
from tree_sway_ros.core.branch.model import BranchModel, TreeBeams
from tree_sway_ros.core.checks import one_of_each
from tree_sway_ros.core.kernel import entry_of, need_compiler, WHY_PLAIN
from tree_sway_ros.core.leaves.foliage import clad_wood
from tree_sway_ros.core.motion.drag import crown_drag, DragLaw
from tree_sway_ros.core.motion.fill_records import (
    branch_records,
    copy_twigs,
    head_records,
    segment_records,
)
from tree_sway_ros.core.motion.placing import place
from tree_sway_ros.core.motion.records import branch_layout, in_lines, WORK
from tree_sway_ros.core.reduction.matrices import reduce_tree, Reduction
from tree_sway_ros.core.reduction.modes import Modes, most_driven, natural_modes, with_static
from tree_sway_ros.core.reduction.one_thread import one_thread
from tree_sway_ros.core.simulator.season import in_season
from tree_sway_ros.core.simulator.settings import MODELS, Settings
from tree_sway_ros.core.state.tree_state import digest_of
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import ParameterError

if TYPE_CHECKING:
    from tree_sway_ros.core.motion.modal import ModalBank
    from tree_sway_ros.core.motion.numpy_placing import NumpyPlacing
    from tree_sway_ros.core.motion.rigid_placing import RigidParts
    from tree_sway_ros.core.motion.uncoupled import UncoupledBank
    from tree_sway_ros.core.motion.wind_basis import WindBasisBank
    from tree_sway_ros.core.motion.wind_basis_table import WindBasisTable
    from tree_sway_ros.core.wind.crown_wind import CrownDelays


class Oscillators(Protocol):
    """What every model gives: key rotations that a wind moves."""

    carries: bool
    is_tabled: bool
    n_outside: int
    """Steps outside of its table, if it has one."""
    table_error: float
    """Share by which the table's static deflections are wrong [-]."""
    shapes: Floats
    """Of its modes, (N, m); empty where branches swing on their own."""
    branches: Records
    work: Records

    @property
    def loads(self) -> Records | None:
        """Return the records of `load_fields`; None where only an even wind is known."""

    def response(self, moments: Floats, circular: Floats) -> NDArray[np.complex128]:
        """Key rotations (N, k, f) under moments (N, k) that swing at w [rad/s], (f,)."""

    def set_step(self, dt: float) -> None:
        """Refill what depends on the time step [s]."""

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step under a mean wind [m/s]; returns how many loads were held."""

    def memory(self) -> tuple[Floats, ...]:
        """Return views of what is carried from one step to the next."""

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""

    def motion(self) -> tuple[Floats, Floats]:
        """Key rotations in [rad] and their rates in [rad/s], both (N,)."""

    def take_over(self, x: Floats, v: Floats) -> None:
        """Go on from key rotations and rates, (N,)."""

    def forces(self) -> Floats:
        """Force of the last step's wind on each branch in [N], (b, 3)."""

    def reset(self) -> None:
        """Go back to rest."""


_COUPLED = ('wind_basis', 'modes', 'coupled')

USUAL_MODES, TABLE_MODES = 12, 20
"""Modes that are stepped where no number is asked for."""

_FEW_MODES = 6
"""To more modes than this comes what they lack of the static sway along x, y and z."""

_FURTHER = 12_000
"""
Coordinates of all further modes together that a tree which wind drives in many modes may have: a
frame takes up to a tenth longer by them.

"""


class Kept(Protocol):
    """Where set-ups are kept, for a next start that has the same one."""

    def read(self, digest: str) -> dict[str, Any] | None:
        """Arrays by name, as they were written under this digest; None if there are none."""

    def write(self, digest: str, arrays: Mapping[str, Any]) -> None:
        """Keep arrays, or leave it."""


class Frozen:
    """Model 0: a tree that stands still, for one too far away to be seen moving."""

    carries = True
    is_tabled = False
    n_outside, table_error = 0, 0.0
    shapes = np.zeros((0, 0))
    loads: Records | None = None

    def __init__(self, branches: Records, n_coordinates: int) -> None:
        """Rest is all there is."""
        self.branches = branches
        self.work = np.zeros(len(branches), dtype=WORK)
        self._x = np.zeros(n_coordinates)

    def set_step(self, dt: float) -> None:
        """Any step [s] will do."""

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Stand still."""
        return 0

    def response(self, moments: Floats, circular: Floats) -> NDArray[np.complex128]:
        """Zeros, (N, k, f)."""
        return np.zeros((*moments.shape, len(circular)), dtype=np.complex128)

    def memory(self) -> tuple[Floats, ...]:
        """Nothing."""
        return ()

    def rotations(self) -> Floats:
        """Zeros, (N,)."""
        return self._x

    def motion(self) -> tuple[Floats, Floats]:
        """Zeros, both (N,)."""
        return self._x, self._x

    def take_over(self, x: Floats, v: Floats) -> None:
        """Stay at rest."""

    def forces(self) -> Floats:
        """None, (b, 3)."""
        forces: Floats = self.work['force']
        return forces

    def reset(self) -> None:
        """Stay at rest."""


@dataclass(frozen=True)
class Bank:
    """
    A tree ready to be stepped and placed: oscillators, and records of branches, segments, heads.

    Frequencies are without air in [Hz], rising; ``mass`` is of wood and leaves in [kg]; ``frozen``
    is what moves with its parent as one body; ``plain`` tells that nothing is compiled.
    """

    oscillators: Oscillators
    branches: Records
    segments: Records
    heads: Records
    frequencies: Floats
    n_solved: int
    mass: float
    frozen: RigidParts | None = None
    n_frozen: int = 0
    plain: bool = bool(WHY_PLAIN)

    @cached_property
    def bases(self) -> Floats:
        """Return what `place` writes of bases, (b, 8)."""
        return np.zeros((len(self.branches), 8))

    @cached_property
    def _plain_placing(self) -> NumpyPlacing:
        from tree_sway_ros.core.motion.numpy_placing import NumpyPlacing

        return NumpyPlacing(self.branches, self.segments, self.frozen)

    @cached_property
    def _compiled_placing(self) -> Callable[[Floats, Floats, Floats], None]:
        arrays = (self.branches, self.segments, self.heads, self.bases)
        given = np.zeros(1), np.zeros(3), np.zeros((1, 7))
        return partial(entry_of(place, *arrays, *given), *arrays)

    @cached_property
    def place_now(self) -> Callable[[Floats, Floats], None]:
        """Place every segment as the oscillators stand, from a root node (3,) on, as `place`."""
        if self.frozen is None and self.oscillators.is_tabled:
            tabled = cast('WindBasisBank', self.oscillators)
            return tabled.placing(self.segments, self.heads, self.bases)
        return lambda origin, out: self.place(self.oscillators.rotations(), origin, out)

    def place(self, rotations: Floats, origin: Floats, out: Floats) -> None:
        """
        Place every segment by key rotations (N,) in [rad], from a root node (3,) on, (n, 7).

        Nothing is checked: arrays must be of float64, in one piece and of these shapes.
        """
        if self.plain:
            self._plain_placing.place(rotations, origin, out)
            return
        self._compiled_placing(rotations, origin, out)
        if self.frozen is not None:
            self.frozen.place(self.branches, self.bases, rotations, out)


def build_bank(tree: Tree, species: Species, settings: Settings) -> Bank:
    """Calibrate a tree for the model of its settings; see `CalibratedTree.bank`."""
    return CalibratedTree(tree, species, settings).bank(settings.model, settings.n_modes)


@dataclass(frozen=True)
class Layer:
    """A tree reduced in one of the three ways that models differ in."""

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
        self._tables: dict[int, WindBasisTable] = {}
        self._known: list[tuple[list[BranchModel], Records]] = []

    @property
    def damping_ratio(self) -> float:
        """Of every oscillator in [-]."""
        settings, species = self.settings, self.species
        if settings.damping_ratio is not None:
            return settings.damping_ratio
        return species.damping(bool(settings.in_leaf))

    @cached_property
    def _crown_drag(self) -> tuple[DragLaw, Floats | None]:
        """Law of the tree, and the area of bare wood that the leaves of each branch stand for."""
        species, given = self.species, self.settings.leaf_area
        if not self.settings.in_leaf or given is None:
            return DragLaw(*species.drag_law(bool(self.settings.in_leaf))), None
        tree = self.tree
        area = one_of_each('leaf_area', given, tree.n_branches, 'branch')
        wood = float(tree.length @ (tree.base_diameter + tree.tip_diameter)) / 2.0
        laws = species.drag_law(in_leaf=False)[0], species.drag_law(in_leaf=True)
        return crown_drag(wood, area, clad_wood(tree, species.leaves), *laws)

    @property
    def drag_law(self) -> DragLaw:
        """Of the whole tree, wood and leaves."""
        return self._crown_drag[0]

    @property
    def leaf_load_area(self) -> Floats | None:
        """Area of bare wood that the leaves of each branch stand for in [m^2], (b,)."""
        return self._crown_drag[1]

    @cached_property
    def crown_delays(self) -> CrownDelays:
        """When each branch meets a gust."""
        from tree_sway_ros.core.simulator.crown_gusts import delays_of

        return delays_of(self.tree, self.leaf_load_area)

    def bank(self, model: str, n_modes: int | None = None) -> Bank:
        """
        Build the oscillators of a model, ``modes`` and ``wind_basis`` with so many modes.

        If None, these are `USUAL_MODES` or `TABLE_MODES`, or all if there are fewer.

        Raises
        ------
        TreeError
            A tree that buckles under its own weight, or a branch without mass.
        ParameterError
            More modes than there are, or a model that is none of `MODELS`.

        """
        if model not in MODELS:
            raise ParameterError(
                f"'{model}' is no model of one set of oscillators",
                where='model',
                cure=f'use one of: {", ".join(MODELS)}; make_simulator knows the others',
            )
        if model in _COUPLED:
            return self._bank_of_modes(model, n_modes)
        layer = self.layer(model)
        branches, oscillators = layer.branches.copy(), cast(Oscillators, None)
        if model == 'frozen':
            oscillators, frequencies = Frozen(branches, layer.reduction.n_coordinates), np.zeros(0)
        else:
            oscillators = bank = self._bank_of_branches(layer, branches, model)
            frequencies = np.sort(np.sqrt(bank.stiffness / bank.inertia)) / (2.0 * np.pi)
        return self._laid_out(oscillators, branches, layer.segments, frequencies, layer.mass)

    def _bank_of_modes(self, model: str, n_modes: int | None) -> Bank:
        """Take a set-up that is kept, or make one; the same bits either way."""
        digest, found = '', None
        if self._kept is not None:
            digest = digest_of(self.tree, self.species, replace(self.settings, model=model))
            digest = f'{digest}-{n_modes}-{WHY_PLAIN}'
            found = self._kept.read(digest)
        made_of = self._modal_arrays(model, n_modes) if found is None else found
        branches = made_of['branches'].copy()
        modal = self._modal_bank()(branches, made_of, self.damping_ratio, self.settings.integrator)
        oscillators: Oscillators = modal
        if model == 'wind_basis':
            from tree_sway_ros.core.motion.wind_basis import WindBasisBank
            from tree_sway_ros.core.motion.wind_basis_table import WindBasisTable

            need_compiler("the model 'wind_basis'")
            n = len(modal.stiffness)
            if found is not None:
                self._tables[n] = WindBasisTable.of_arrays(found)
            if n not in self._tables:
                self._tables[n] = self._table(modal)
            made_of |= self._tables[n].arrays
            oscillators = WindBasisBank(modal, self._tables[n])
        if found is None and self._kept is not None:
            self._kept.write(digest, made_of)
        frequencies = made_of['circular'] / (2.0 * np.pi)
        segments = made_of['segments'] if found is None else in_lines(made_of['segments'])
        mass = float(made_of['tree_mass'])
        return self._laid_out(oscillators, branches, segments, frequencies, mass)

    @one_thread()
    def _modal_arrays(self, model: str, n_modes: int | None) -> dict[str, Any]:
        """Find all that modes are stepped and placed by."""
        from tree_sway_ros.core.motion.modal import modal_arrays

        layer = self.coupled
        told = {'branches': layer.branches, 'segments': layer.segments}
        arrays = modal_arrays(layer.branches, layer.reduction, self._modes(model, n_modes))
        return {**told, **arrays, 'tree_mass': np.array(layer.mass)}

    @one_thread()
    def _table(self, modal: ModalBank) -> WindBasisTable:
        from tree_sway_ros.core.motion.wind_basis_table import WindBasisTable

        return WindBasisTable(modal, self.drag_law, self.settings.degree)

    def _laid_out(
        self,
        oscillators: Oscillators,
        branches: Records,
        segments: Records,
        frequencies: Floats,
        mass: float,
    ) -> Bank:
        solved = int((branches['source'] == np.arange(len(branches))).sum())
        heads = head_records(branches, segments)
        return Bank(
            oscillators, branches, segments, heads, frequencies, solved, mass, plain=self.plain
        )

    def at_rest(self, model: str) -> Bank:
        """Return what places the key rotations of a model, and steps nothing."""
        layer = self.layer(model)
        branches, segments = layer.branches.copy(), layer.segments
        still = Frozen(branches, layer.reduction.n_coordinates)
        heads = head_records(branches, segments)
        return Bank(still, branches, segments, heads, np.zeros(0), 0, layer.mass)

    def layer(self, model: str) -> Layer:
        """Reduction that a model starts from."""
        if model == 'branch':
            return self.alone
        return self.coupled if model in _COUPLED else self.carried

    @cached_property
    def alone(self) -> Layer:
        """Every branch on its own."""
        return self._reduced(carries=False, enriched=frozenset())

    @cached_property
    def carried(self) -> Layer:
        """Branches that carry their children, one shape each."""
        return self._reduced(carries=True, enriched=frozenset())

    @cached_property
    def coupled(self) -> Layer:
        """Branches that carry their children, those of the enriched ones with further shapes."""
        return self._reduced(carries=True, enriched=self._beams.enriched(self.settings.enrich))

    @cached_property
    def _speed(self) -> Floats:
        """Wind at each segment's middle over that at the anemometer, (n,)."""
        middle = 0.5 * (self.tree.start[:, 2] + self.tree.end[:, 2])
        return self.settings.profile.over_anemometer(middle)

    @cached_property
    def _beams(self) -> TreeBeams:
        """Return what the layers share."""
        species, settings = self.species, self.settings
        return TreeBeams(
            self.tree,
            species.density,
            shear_ratio=species.shear_ratio,
            speed_profile=self._speed,
            leaf_mass=settings.leaf_mass,
            leaf_area=self.leaf_load_area,
            root_compliance=species.modulus / species.root_stiffness,
        )

    @one_thread()
    def _reduced(self, *, carries: bool, enriched: frozenset[int]) -> Layer:
        tree, species = self.tree, self.species
        models = self._beams.models(carries=carries, enriched=enriched)
        shear = species.shear_ratio * species.modulus
        reduction = reduce_tree(
            tree, models, species.modulus, shear, self.settings.gravity, carries=carries
        )
        layout = branch_layout() if enriched else branch_layout(2)
        records = branch_records(tree, models, reduction, self._speed, layout, self._known)
        self._known.append((models, records))
        mass = float(sum(model.beam.integral(model.mass) for model in models))
        return Layer(models, reduction, records, segment_records(tree, models), mass)

    def _modes(self, model: str, count: int | None) -> Modes:
        """All modes, or of the slowest those the wind drives most and the sway that they lack."""
        reduction = self.coupled.reduction
        n = reduction.n_coordinates
        usual = TABLE_MODES if model == 'wind_basis' else USUAL_MODES
        n_modes = min(usual, n) if count is None else count
        is_driven = model != 'coupled' and self.settings.mode_choice == 'driven' and n_modes <= n
        candidates = min(n, n_modes + min(3 * n_modes, 24)) if is_driven else n_modes
        wanted = n if model == 'coupled' else candidates
        if self._slowest is None or len(self._slowest.circular) < wanted:
            self._slowest = natural_modes(self.tree, reduction, None if wanted == n else wanted)
        modes = self._slowest.slowest(wanted)
        if not is_driven:
            return modes
        from tree_sway_ros.core.motion.numpy_passes import even_wind_moments, mean_wind_moments
        from tree_sway_ros.core.motion.response import tip_motion

        branches = self.coupled.branches
        moved = np.square(tip_motion(branches, modes.shapes)).sum(axis=(0, 1))
        loads = mean_wind_moments(branches, n)
        n_static = loads.shape[1]
        if not _FEW_MODES < n_modes < n - n_static:
            return most_driven(modes, even_wind_moments(branches, n), moved, n_modes)
        if model == 'wind_basis':
            chosen = most_driven(modes, loads, moved, n_modes - n_static)
        else:
            further = min(n_modes, _FURTHER // n) if n_modes >= USUAL_MODES else 0
            chosen = most_driven(modes, loads, moved, n_modes, further)
        return with_static(chosen, reduction, loads)

    def _modal_bank(self) -> type[ModalBank]:
        if self.plain:
            from tree_sway_ros.core.motion.numpy_banks import NumpyModalBank

            return NumpyModalBank
        from tree_sway_ros.core.motion.modal import ModalBank

        return ModalBank

    @one_thread()
    def _bank_of_branches(self, layer: Layer, branches: Records, model: str) -> UncoupledBank:
        """Each branch's own oscillator: the mean of its two axes."""
        from tree_sway_ros.core.motion.uncoupled import UncoupledBank
        from tree_sway_ros.core.reduction.carried_inertia import carried_inertia
        from tree_sway_ros.core.reduction.modes import refuse_buckling
        from tree_sway_ros.core.tree.similar_twigs import twig_sources

        tree, settings, carries = self.tree, self.settings, model == 'subtree'
        refuse_buckling(tree, layer.reduction)
        copy_twigs(branches, twig_sources(tree, settings.twig_tolerance))
        inertia = carried_inertia(tree, layer.reduction).reshape(-1, 2).mean(axis=1)
        stiffness = np.asarray(layer.reduction.stiffness.diagonal()).reshape(-1, 2).mean(axis=1)
        if not carries:
            inertia = inertia * np.array([model.inertia_share for model in layer.models])
        damping = 2.0 * self.damping_ratio * np.sqrt(stiffness * inertia)
        if settings.stiffness == 'volume_rule':
            volume = np.add.reduceat(tree.volume, tree.branch_first[:-1])
            parent = volume[np.maximum(tree.branch_parent, 0)]
            rule = np.sqrt(volume * parent)
            stiffness, damping = settings.volume_stiffness * rule, settings.volume_damping * rule
        kind: type[UncoupledBank] = UncoupledBank
        if self.plain:
            from tree_sway_ros.core.motion.numpy_banks import NumpyUncoupledBank

            kind = NumpyUncoupledBank
        return kind(branches, inertia, damping, stiffness, carries, settings.integrator)
