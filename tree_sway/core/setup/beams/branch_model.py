# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Every branch as a bending body: its axes, its mass and load along it, its fields of bending.

A branch turns about two fixed axes across its chord. Its coordinates are the components of a
rotation vector, ``x e2 - y e1``: a positive x moves the tip along e1, a positive y along e2. The
subtrees of a branch determine its load and shape: the shear force and the moment of each subtree
act at the base of the child.

Symbols: b chord direction, e1, e2 across it; psi slope shape; c drag area per length [m]; mu mass
per length [kg/m].
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.rotation import cross
from tree_sway.core.setup.beams.beam import (
    Attachments,
    BranchBeam,
    one_of,
    RotationField,
    SlopeShape,
)
from tree_sway.core.setup.beams.bent_by_weight import bent_by_weight, weight_over_stiffness
from tree_sway.core.setup.beams.field_counts import (
    BRANCH_PAIRS_OF_SMALL,
    BRANCH_TURNS,
    ENRICHED_PAIRS,
    LIMP_PAIRS,
    PLAIN_PAIRS,
    PLAIN_TURNS,
    SLENDER_BEAMS,
    SMALL_TREE,
    STEM_PAIRS_OF_SMALL,
    STEM_TURNS,
)
from tree_sway.core.setup.beams.shape_fields import shaken_energies, shape_fields
from tree_sway.core.setup.beams.subtree_sums import SubtreeSums
from tree_sway.core.setup.beams.wind_on_branch import wind_loads
from tree_sway.core.tree import Tree

_LEFT = 1e-4
"""Largest share of the energy of all branches but the stem that static fields may miss."""

_FEW, _ONE_OF = 24, 50
"""Largest number of branches beside the stem with further shapes, or one branch in this number."""

_NONE = np.zeros(0, dtype=np.int64)

_LIGHT = 1e-3
"""Share of the mass of a tree below which a branch with its subtree is not considered."""


@dataclass(frozen=True)
class BranchModel:
    """
    One branch, ready to be reduced.

    Parameters
    ----------
    beam
        Quadrature and bending of the branch.
    drag_area
        Drag area per length at each point in [m], (p, 5).
    mass
        Mass per length at each point in [kg/m], (p, 5).
    shape
        Slope of a plain branch per unit of its key rotation.
    fields
        Motion per unit of the key rotation x, y and of the further coordinates of an enriched
        branch.
    children
        Children of the branch, in the order of ``beam.children``.

    """

    beam: BranchBeam
    drag_area: Floats
    mass: Floats
    shape: SlopeShape
    fields: tuple[RotationField, ...]
    children: Ints

    @cached_property
    def inertia_share(self) -> float:
        """
        Inertia that gives the first frequency of the beam, over that of the static shape [-].

        Found by inverse iteration: each step bends the branch by its own inertia.
        """
        beam = self.beam
        shape = self.shape
        static = _square_frequency(beam, shape, self.mass)
        none = np.zeros(0)
        for _ in range(4):
            bending = beam.bending_moment(self.mass * shape.deflection, none, none)
            shape = SlopeShape(beam, bending / bending.max() / beam.second_moment)
        return static / _square_frequency(beam, shape, self.mass)


@dataclass(frozen=True)
class _LoadedBeam:
    """
    A branch, or twigs that are alike, before its fields are known.

    ``drag_area`` [m] and ``mass`` [kg/m] are per length at the points, (p, 5), ``loads`` those of
    `wind_loads`.
    """

    beam: BranchBeam
    drag_area: Floats
    mass: Floats
    loads: Floats
    children: Ints

    def twig(self, number: int) -> _LoadedBeam:
        """Return one of twigs that are alike."""
        return _LoadedBeam(
            one_of(self.beam, number),
            self.drag_area[number],
            self.mass[number],
            self.loads[number],
            _NONE,
        )


@dataclass(frozen=True)
class _AlikeTwigs:
    """Branches without children and with as many segments, in one batch."""

    branches: Ints
    batch: _LoadedBeam
    curvatures: Floats


class TreeBeams:
    """
    Beams of all branches of a tree and the sums over their subtrees, shared by all models.

    Parameters
    ----------
    tree
        Tree to be modelled.
    density
        Density of green wood in [kg/m^3].
    shear_ratio
        Shear modulus over Young's in [-].
    speed_profile
        Wind speed over that at the anemometer at each segment's middle [-], (n,); 1 if None.
    leaf_mass, leaf_area
        Leaves of each branch in [kg] and [m^2], (b,), spread evenly along it; none if None.
    root_compliance
        Root compliance of the stem in [1/m^3], as in `BranchBeam`.
    gravity
        Gravity over Young's modulus in [m/s^2/Pa]; 0 for no weight.

    """

    def __init__(
        self,
        tree: Tree,
        density: float,
        *,
        shear_ratio: float = 1.0 / 14.0,
        speed_profile: Floats | None = None,
        leaf_mass: Floats | None = None,
        leaf_area: Floats | None = None,
        root_compliance: float = 0.0,
        gravity: float = 0.0,
    ) -> None:
        """Make the beams and sum up the subtrees."""
        n = tree.n_branches
        self._tree = tree
        self._density = density
        self._shear_ratio = shear_ratio
        self._gravity = gravity
        self._is_small = _is_small(tree)
        self._leaf_mass = np.zeros(n) if leaf_mass is None else leaf_mass
        self._leaf_area = np.zeros(n) if leaf_area is None else leaf_area
        self._speed = np.ones(tree.n_segments) if speed_profile is None else speed_profile
        self._loaded: dict[int, _LoadedBeam] = {}
        self._alike: list[_AlikeTwigs] = []
        self._models: dict[tuple[int, ...], BranchModel] = {}
        self._curvatures_by_wind: dict[tuple[int, int], Floats] = {}
        self._sums = SubtreeSums.zeros(n)
        children_of: list[list[int]] = [[] for _ in range(n)]
        for branch in range(1, n):
            children_of[tree.branch_parent[branch]].append(branch)
        size = np.diff(tree.branch_first)
        is_twig = np.array([branch > 0 and not here for branch, here in enumerate(children_of)])
        for count in np.unique(size[is_twig]):
            twigs = np.flatnonzero(is_twig & (size == count))
            batch = self._load(twigs, _NONE, 0.0)
            curvatures = self._bent_by_wind(batch, _NONE)
            self._alike.append(_AlikeTwigs(twigs, batch, curvatures))
            for k, branch in enumerate(twigs.tolist()):
                self._loaded[branch] = batch.twig(k)
                self._curvatures_by_wind[branch, 0] = curvatures[k]
        for branch in np.flatnonzero(~is_twig)[::-1].tolist():  # children before parents
            children = np.array(children_of[branch], dtype=np.int64)
            compliance = 0.0 if branch else root_compliance
            self._loaded[branch] = self._load(branch, children, compliance)

    def _load(self, branch: int | Ints, children: Ints, root_compliance: float) -> _LoadedBeam:
        """Make the beam of a branch, or of twigs that are alike, and sum up their subtrees."""
        tree = self._tree
        foot = tree.branch_first[children]
        first = np.asarray(tree.branch_first[branch])[..., None]
        here = first + np.arange(np.diff(tree.branch_first)[branch].max())
        beam = BranchBeam(
            tree.start[here] - tree.start[0],
            tree.end[here] - tree.start[0],
            tree.base_diameter[here],
            tree.tip_diameter[here],
            Attachments((tree.segment_parent[foot] - first).ravel(), tree.place_on_parent[foot]),
            root_compliance,
        )
        leaf_mass, leaf_area = (
            np.asarray(each[branch])[..., None, None] / beam.node[..., -1:, None]
            for each in (self._leaf_mass, self._leaf_area)
        )
        mass = self._density * beam.area + leaf_mass
        drag_area = beam.diameter + leaf_area
        drag_area *= (self._speed[first + beam.segment] ** 2)[..., None]
        loads = wind_loads(beam, drag_area)
        weighed = mass[..., None] * beam.point
        own = SubtreeSums(
            area=beam.integral(drag_area),
            area_moment=beam.integral(drag_area[..., None] * beam.point),
            force=beam.integral(loads),
            moment=beam.integral(cross(beam.point[..., None, :], loads)),
            mass=beam.integral(mass),
            mass_moment=beam.integral(weighed),
            mass_second=beam.integral(weighed[..., None] * beam.point[..., None, :]),
        )
        for total, part in zip(self._sums, own, strict=True):
            total[branch] = part + total[children].sum(axis=0)
        return _LoadedBeam(beam, drag_area, mass, loads, children)

    def turns(self, modulus: float) -> Floats:
        """
        Bound the rotations of the chords [rad] of all branches, (b,).

        Loads are those of uniform winds along x and y of a dynamic pressure of 1 kg/m/s^2, on
        beams without weight.
        """
        turns = np.zeros(len(self._loaded))
        bent: list[tuple[int | Ints, BranchBeam, Floats]] = [
            (each.branches, each.batch.beam, each.curvatures) for each in self._alike
        ]
        for branch, loaded in self._loaded.items():
            n_children = len(loaded.children)
            if branch == 0 or n_children:
                bent.append((branch, loaded.beam, self._curvatures(branch, n_children)))
        for branches, beam, curvatures in bent:
            slopes = beam.from_base(curvatures[..., :2, :])[0]
            ends = beam.integral(cross(slopes, beam.tangent[..., None, None, :]))
            turned = np.sqrt(np.square(ends).sum(axis=-1).max(axis=-1))
            turns[branches] = turned / beam.chord_length
        return turns / modulus

    def weight_over_stiffness(self) -> Floats:
        """Weight of each branch with its subtree over its stiffness in bending [-], (b,)."""
        gravity = self._gravity
        found = np.zeros(len(self._loaded))
        for branch, loaded in self._loaded.items():
            subtrees = self._sums.select(loaded.children)
            found[branch] = weight_over_stiffness(loaded.beam, loaded.mass, subtrees, gravity)
        return found

    def _curvatures(self, branch: int, n_subtrees: int) -> Floats:
        """Curvatures (p, 5, 3, 3) by `wind_loads` of a branch and its first children."""
        key = branch, n_subtrees
        if key not in self._curvatures_by_wind:
            loaded = self._loaded[branch]
            bent = self._bent_by_wind(loaded, loaded.children[:n_subtrees])
            self._curvatures_by_wind[key] = bent
        return self._curvatures_by_wind[key]

    def _bent_by_wind(self, loaded: _LoadedBeam, children: Ints) -> Floats:
        beam = loaded.beam
        subtrees = self._sums.select(children)
        moments = beam.moment_in_space(loaded.loads, subtrees.force, subtrees.moment)
        return beam.curvature_in_space(moments, self._shear_ratio)

    def models(
        self,
        *,
        subtrees: bool,
        enriched: frozenset[int] = frozenset(),
        limp: frozenset[int] = frozenset(),
    ) -> list[BranchModel]:
        """
        Model each branch.

        Parameters
        ----------
        subtrees
            Whether children load and shape their parents; if not, every branch is isolated (the
            paper).
        enriched
            Branches with further shapes and twists.
        limp
            Branches with a further pair of shapes.

        Returns
        -------
        list of BranchModel
            Models in the order of the tree's branches.

        """
        for twigs in self._alike:
            self._model_twigs(twigs)
        self._alike = []
        found = []
        for branch, loaded in sorted(self._loaded.items()):
            n_subtrees = len(loaded.children) if subtrees else 0
            n_pairs, n_turns = self._richness(branch, enriched)
            if branch in limp:
                n_pairs = max(n_pairs, LIMP_PAIRS)
            found.append(self._model(branch, n_subtrees, n_pairs, n_turns))
        return found

    def _model_twigs(self, twigs: _AlikeTwigs) -> None:
        """Model plain twigs that are alike in one batch."""
        batch = twigs.batch
        none = self._sums.select(_NONE)
        bent = bent_by_weight(
            batch.beam, batch.mass, none, twigs.curvatures, self._shear_ratio, self._gravity
        )
        shape, fields = shape_fields(
            batch.beam, batch.drag_area, batch.mass, none, bent, self._shear_ratio
        )
        for k, branch in enumerate(twigs.branches.tolist()):
            loaded = self._loaded[branch]
            self._models[branch, 0, PLAIN_PAIRS, PLAIN_TURNS] = BranchModel(
                loaded.beam,
                loaded.drag_area,
                loaded.mass,
                one_of(shape, k, beam=loaded.beam),
                tuple(one_of(field, k, beam=loaded.beam) for field in fields),
                _NONE,
            )

    def enriched(self, choice: str) -> frozenset[int]:
        """
        Choose the branches that get further shapes and twists.

        Parameters
        ----------
        choice
            ``none``, the ``stem``, all ``carriers`` of others, ``all``, or those ``needed``: of a
            small tree all; of others the stem and the branches whose static fields miss most of
            the energy when they are shaken, until the others miss no more than `_LEFT` of the
            energy of all branches.

        """
        parent = self._tree.branch_parent
        if choice == 'needed' and self._is_small:
            choice = 'all'
        if choice != 'needed':
            chosen = {
                'none': (),
                'stem': (0,),
                'carriers': (0, *parent[1:].tolist()),
                'all': range(len(parent)),
            }
            return frozenset(chosen[choice])
        heavy = np.flatnonzero(self._sums.mass[1:] > _LIGHT * self._sums.mass[0]) + 1
        if len(heavy) == 0:
            return frozenset((0,))
        energies = np.array([self._shaken(branch) for branch in heavy.tolist()])
        order = np.argsort(-energies[:, 1], kind='stable')
        left = np.cumsum(energies[order[::-1], 1])[::-1]
        needed = heavy[order[left > _LEFT * energies[:, 0].sum()]]
        most = max(_FEW, len(parent) // _ONE_OF)
        return frozenset((0, *needed[:most].tolist()))

    def _shaken(self, branch: int) -> tuple[float, float]:
        loaded = self._loaded[branch]
        plain = self._model(branch, len(loaded.children), PLAIN_PAIRS, PLAIN_TURNS)
        subtrees = self._sums.select(loaded.children)
        return shaken_energies(loaded.beam, loaded.mass, subtrees, self._shear_ratio, plain.fields)

    def _model(self, branch: int, n_subtrees: int, n_pairs: int, n_turns: int) -> BranchModel:
        """Model a branch, or take the known model."""
        key = branch, n_subtrees, n_pairs, n_turns
        if key not in self._models:
            loaded = self._loaded[branch]
            beam = loaded.beam
            drag_area = loaded.drag_area
            mass = loaded.mass
            subtrees = self._sums.select(loaded.children[:n_subtrees])
            by_wind = self._curvatures(branch, n_subtrees)
            bent = bent_by_weight(beam, mass, subtrees, by_wind, self._shear_ratio, self._gravity)
            shape, fields = shape_fields(
                beam, drag_area, mass, subtrees, bent, self._shear_ratio, n_pairs, n_turns
            )
            model = BranchModel(beam, drag_area, mass, shape, fields, loaded.children)
            self._models[key] = model
        return self._models[key]

    def _richness(self, branch: int, enriched: frozenset[int]) -> tuple[int, int]:
        """Return the number of pairs of a branch, and of fields of rotation about its chord."""
        if branch not in enriched:
            return PLAIN_PAIRS, PLAIN_TURNS
        is_stem = self._tree.branch_parent[branch] < 0
        if self._is_small:
            return STEM_PAIRS_OF_SMALL if is_stem else BRANCH_PAIRS_OF_SMALL, BRANCH_TURNS
        return ENRICHED_PAIRS, STEM_TURNS if is_stem else BRANCH_TURNS


def _is_small(tree: Tree) -> bool:
    """Whether a tree has few branches, all of them slender beams."""
    slenderness = tree.branch_length / tree.base_diameter[tree.branch_first[:-1]]
    least, most = SLENDER_BEAMS
    is_slender = least <= slenderness.min() and slenderness.max() <= most
    return bool(tree.n_branches <= SMALL_TREE and is_slender)


def _square_frequency(beam: BranchBeam, shape: SlopeShape, mass: Floats) -> float:
    """Return Rayleigh's quotient of a shape for a modulus of 1, in [1/s^2]."""
    return shape.stiffness(1.0) / float(beam.integral(mass * shape.deflection**2))
