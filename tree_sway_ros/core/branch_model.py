"""
Every branch as a bending body: its axes, its mass and load along it, the ways it bends and twists.

A branch turns about two fixed axes across its chord. Its coordinates are the components of a rotation vector,
``x e2 - y e1``: a positive x moves the tip along e1, a positive y along e2. What a branch carries loads it and
shapes it: the shear force and the moment of each child's subtree enter at the child's place.

The first shape is the static one. An enriched branch has a second one, bent by the inertia of the first (a load-dependent
Ritz vector: Wilson, Yuan & Dickens, 1982), and twists about its chord by the inertia of what it carries.

Symbols: b chord direction, e1, e2 across it; psi slope shape; c drag area per length [m]; mu mass per length
[kg/m].

"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway_ros.core.branch_beam import Attachments, BranchBeam, SlopeShape
from tree_sway_ros.core.tree import Floats, Ints, Tree


@dataclass(frozen=True)
class Coordinate:
    """
    One way for a branch to move.

    Parameters
    ----------
    shape
        Slope along the branch per unit of the coordinate.
    axis
        Direction of its rotation vector, (3,).
    is_twist
        Whether it is resisted by torsion, not by bending.

    """

    shape: SlopeShape
    axis: Floats
    is_twist: bool = False

    def stiffness(self, modulus: float, shear_modulus: float) -> float:
        """Elastic stiffness in [N m/rad]: E I of bending, G J of twist with J = 2 I."""
        return self.shape.stiffness(self.shape, 2.0 * shear_modulus if self.is_twist else modulus)


@dataclass(frozen=True)
class BranchModel:
    """
    One branch, ready to be reduced.

    Parameters
    ----------
    beam
        Its quadrature and bending.
    drag_area
        Area that the wind meets per length at each point in [m], (m, 5).
    mass
        Mass per length at each point in [kg/m], (m, 5).
    coordinates
        Its key rotation x, y; an enriched branch has a second x, y and a twist after it.
    children
        The branches it carries, in the order of ``beam.children``.

    """

    beam: BranchBeam
    drag_area: Floats
    mass: Floats
    coordinates: tuple[Coordinate, ...]
    children: Ints

    @property
    def inertia_share(self) -> float:
        """
        Inertia that gives the branch alone its beam's first frequency, over that of its static shape [-].

        Inverse iteration from the static shape: each turn bends the branch by its own inertia.

        """
        beam, shape = self.beam, self.coordinates[0].shape
        static = _square_frequency(beam, shape, self.mass)
        none = np.zeros(0)
        for _ in range(4):
            bending = beam.bending_moment(self.mass * shape.deflection, none, none)
            shape = SlopeShape(beam, bending / bending.max() / beam.second_moment)
        return static / _square_frequency(beam, shape, self.mass)


@dataclass
class _Carried:
    """What a subtree hands to the branch below: sums over it, about the root of the tree."""

    area: float
    area_moment: Floats
    mass: float
    mass_moment: Floats
    mass_second: Floats


def across(chord: Floats) -> tuple[Floats, Floats]:
    """
    Two unit vectors across a chord: e1 in the vertical plane, or along x for an upright one.

    Parameters
    ----------
    chord
        Unit vector, (3,).

    Returns
    -------
    tuple
        e1 and e2 such that (b, e1, e2) is right-handed.

    """
    reference = np.array([1.0, 0.0, 0.0]) if abs(chord[2]) > 0.9 else np.array([0.0, 0.0, 1.0])
    e1 = reference - (reference @ chord) * chord
    e1 /= np.linalg.norm(e1)
    return e1, np.cross(chord, e1)


def branch_models(
    tree: Tree,
    density: float,
    *,
    carries: bool,
    enriched: frozenset[int] = frozenset(),
    speed_profile: Floats | None = None,
    leaf_mass: Floats | None = None,
    leaf_area: Floats | None = None,
) -> list[BranchModel]:
    """
    Model each branch of a tree.

    Parameters
    ----------
    tree
        The tree.
    density
        Of green wood in [kg/m^3].
    carries
        Whether children load and shape their parents; if not, every branch is alone (the paper).
    enriched
        Branches that get a second shape and a twist.
    speed_profile
        Wind speed over that at the anemometer at each segment's middle [-], (n,); 1 if None.
    leaf_mass, leaf_area
        Leaves of each branch in [kg] and [m^2], (b,), spread evenly along it; none if None.

    Returns
    -------
    list of BranchModel
        In the order of the tree's branches.

    """
    models: list[BranchModel | None] = [None] * tree.n_branches
    carried: list[_Carried | None] = [None] * tree.n_branches
    origin = tree.start[0]
    children_of: list[list[int]] = [[] for _ in range(tree.n_branches)]
    for branch in range(1, tree.n_branches):
        children_of[tree.branch_parent[branch]].append(branch)
    for branch in range(tree.n_branches - 1, -1, -1):
        here = tree.segments_of(branch)
        children = np.array(children_of[branch], dtype=np.int64)
        beam = BranchBeam(
            tree.start[here] - origin,
            tree.end[here] - origin,
            tree.base_diameter[here],
            tree.tip_diameter[here],
            _places(tree, branch, children),
        )
        length = float(beam.node[-1])
        mass = density * beam.area
        drag_area = beam.diameter.copy()
        if leaf_mass is not None:
            mass += leaf_mass[branch] / length
        if leaf_area is not None:
            drag_area += leaf_area[branch] / length
        if speed_profile is not None:
            drag_area *= (speed_profile[here] ** 2)[:, None]
        loads = [carried[child] for child in children]
        below = [load for load in loads if load is not None]
        ways = _coordinates(beam, drag_area, mass, below if carries else [], branch in enriched)
        models[branch] = BranchModel(beam, drag_area, mass, ways, children)
        carried[branch] = _sum_up(beam, drag_area, mass, below)
    return [model for model in models if model is not None]


def _places(tree: Tree, branch: int, children: Ints) -> Attachments:
    """Where children sit: the foot of the perpendicular from their start onto the parent's segment."""
    if len(children) == 0:
        return Attachments(np.zeros(0, dtype=np.int64), np.zeros(0))
    first = tree.branch_first[children]
    seat = tree.segment_parent[first]
    step = tree.end[seat] - tree.start[seat]
    along = (
        np.einsum("ij,ij->i", tree.start[first] - tree.start[seat], step) / tree.length[seat] ** 2
    )
    return Attachments(seat - tree.branch_first[branch], np.clip(along, 0.0, 1.0))


def _coordinates(
    beam: BranchBeam, drag_area: Floats, mass: Floats, below: list[_Carried], enrich: bool
) -> tuple[Coordinate, ...]:
    e1, e2 = across(beam.chord)
    places = beam.child_point[: len(below)]
    area = np.array([load.area for load in below])
    lever = np.array(
        [
            (load.area_moment - load.area * at) @ beam.chord
            for load, at in zip(below, places, strict=True)
        ]
    )
    first = beam.slope_shape(beam.bending_moment(drag_area, area, np.maximum(lever, 0.0)))
    ways = [Coordinate(first, e2), Coordinate(first, -e1)]
    if enrich:
        inertia = beam.bending_moment(mass * first.deflection, *_inertia_forces(beam, first, below))
        second = SlopeShape(beam, inertia / beam.second_moment)
        share = second.stiffness(first, 1.0) / first.stiffness(first, 1.0)
        second = beam.unit_shape(second.curvature - share * first.curvature)
        ways += [Coordinate(second, e2), Coordinate(second, -e1)]
    if enrich and below:
        spin = np.array(
            [_spin(load, at, beam.chord) for load, at in zip(below, places, strict=True)]
        )
        torque = (beam.child_place > beam.place[..., None]) @ spin
        twist = beam.unit_shape(torque / beam.second_moment)
        ways.append(Coordinate(twist, beam.chord, is_twist=True))
    return tuple(ways)


def _square_frequency(beam: BranchBeam, shape: SlopeShape, mass: Floats) -> float:
    """Rayleigh's quotient of a shape for a modulus of 1, in [1/s^2]."""
    return shape.stiffness(shape, 1.0) / float(beam.integral(mass * shape.deflection**2))


def _inertia_forces(
    beam: BranchBeam, shape: SlopeShape, below: list[_Carried]
) -> tuple[Floats, Floats]:
    """Force and moment of the carried masses that ride on a moving shape, per unit of acceleration."""
    if not below:
        return np.zeros(0), np.zeros(0)
    lift = np.interp(beam.child_place, beam.node, shape.node_deflection)
    turn, places = shape.child_slope, beam.child_point
    mass = np.array([load.mass for load in below])
    lever = np.array(
        [
            (load.mass_moment - load.mass * at) @ beam.chord
            for load, at in zip(below, places, strict=True)
        ]
    )
    second = np.array(
        [_second_along(load, at, beam.chord) for load, at in zip(below, places, strict=True)]
    )
    return mass * lift + lever * turn, lever * lift + second * turn


def _second_along(load: _Carried, place: Floats, direction: Floats) -> float:
    """Second moment of a carried mass along a direction about a place, in [kg m^2]."""
    at = float(place @ direction)
    first = float(load.mass_moment @ direction)
    return float(direction @ load.mass_second @ direction) - 2.0 * at * first + load.mass * at * at


def _spin(load: _Carried, place: Floats, axis: Floats) -> float:
    """Moment of inertia of a carried mass about an axis through a place, in [kg m^2]."""
    second = (
        load.mass_second - np.outer(place, load.mass_moment) - np.outer(load.mass_moment, place)
    )
    second += load.mass * np.outer(place, place)
    return float(np.trace(second) - axis @ second @ axis)


def _sum_up(beam: BranchBeam, drag_area: Floats, mass: Floats, below: list[_Carried]) -> _Carried:
    point = beam.point
    return _Carried(
        area=float(beam.integral(drag_area)) + sum(load.area for load in below),
        area_moment=beam.integral(drag_area[..., None] * point)
        + sum(load.area_moment for load in below),
        mass=float(beam.integral(mass)) + sum(load.mass for load in below),
        mass_moment=beam.integral(mass[..., None] * point)
        + sum(load.mass_moment for load in below),
        mass_second=beam.integral(mass[..., None, None] * point[..., :, None] * point[..., None, :])
        + sum(load.mass_second for load in below),
    )
