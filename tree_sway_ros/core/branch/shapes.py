# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The ways a branch bends and twists: its static shape, and for an enriched branch the shapes that
follow from it.

The first shape is the static one under the wind. Each further one is bent by the inertia of the one
before it, with all that the branch carries (load-dependent Ritz vectors: Wilson, Yuan & Dickens,
1982), and made orthogonal in bending energy to those before; so do the twists, from the torque of
what it carries when it turns as one. Three and three bring the slowest modes of a crown within
about a percent of the beam frame's, where one shape alone misses the twist of the stem altogether.

"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.branch.beam import BranchBeam, RotationField, SlopeShape, cross_matrix

N_SHAPES = 3
"""Bending shapes of an enriched stem, each about two axes."""

N_TWISTS = 3
"""Twists of an enriched branch: of a stem one by the wind, of any other two."""

FEWER = 2
"""Shapes of any other enriched branch: a third gains 0.5 % of the motion and costs a half more."""

MAX_COORDINATES = 2 * N_SHAPES + N_TWISTS

_NEGLIGIBLE = 1e-8

_NO_TWIST = 1e-6
"""Share of the wind's bending energy below which a branch counts as straight."""


@dataclass(frozen=True)
class Coordinate:
    """
    One way for a branch to move.

    Parameters
    ----------
    shape
        Slope along the branch per unit of the coordinate, as it is drawn.
    axis
        Direction of its rotation vector, (3,).
    field
        How it moves in space; a crooked branch that bends also twists.
    is_twist
        Whether it turns the branch about its chord.

    """

    shape: SlopeShape
    axis: Floats
    field: RotationField
    is_twist: bool = False


@dataclass(frozen=True)
class Carried:
    """
    What each child of a branch hands down: sums over its subtree, about the root of the tree.

    Parameters
    ----------
    area, area_moment
        Drag area in [m^2], (c,), and its first moment in [m^3], (c, 3).
    force, moment
        Force of winds along x, y and z, as of `wind_load`, and its moment about the root of the
        tree, both (c, 3, 3), the wind first.
    mass, mass_moment, mass_second
        Mass in [kg], (c,), its first moment in [kg m], (c, 3), and second in [kg m^2], (c, 3, 3).

    """

    area: Floats
    area_moment: Floats
    force: Floats
    moment: Floats
    mass: Floats
    mass_moment: Floats
    mass_second: Floats

    def __getitem__(self, children: Ints) -> Carried:
        """Pick some of the subtrees."""
        return Carried(
            self.area[children],
            self.area_moment[children],
            self.force[children],
            self.moment[children],
            self.mass[children],
            self.mass_moment[children],
            self.mass_second[children],
        )

    def spin(self, places: Floats, axis: Floats) -> Floats:
        """Moment of inertia about an axis through each place (c, 3), in [kg m^2], (c,)."""
        cross = places[:, :, None] * self.mass_moment[:, None, :]
        second = self.mass_second - cross - cross.transpose(0, 2, 1)
        second += (self.mass[:, None] * places)[:, :, None] * places[:, None, :]
        spin: Floats = np.trace(second, axis1=1, axis2=2) - second @ axis @ axis
        return spin


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
    return e1, cross_matrix(chord) @ e1


def ways_to_move(
    beam: BranchBeam,
    drag_area: Floats,
    mass: Floats,
    carried: Carried,
    shear_ratio: float,
    n_shapes: int = 1,
    n_twists: int = 0,
    n_by_wind: int = 0,
) -> tuple[Coordinate, ...]:
    """
    Find the coordinates of a branch.

    Parameters
    ----------
    beam
        The branch.
    drag_area, mass
        Per length at its points in [m] and [kg/m], (m, 5).
    carried
        What its children hand down; none for a branch that is taken alone.
    shear_ratio
        Shear modulus over Young's in [-].
    n_shapes, n_twists
        Shapes it bends in, each about two axes, and twists; fewer where there are no more.
    n_by_wind
        How many of the twists are those by the wind.

    Returns
    -------
    tuple of Coordinate
        The key rotation x, y; further pairs; twists.

    """
    e1, e2 = across(beam.chord)
    moments = [
        beam.moment_in_space(
            wind_load(beam, drag_area, wind), carried.force[:, i], carried.moment[:, i]
        )
        for i, wind in enumerate(np.eye(3))
    ]
    curvatures = np.stack([beam.curvature_in_space(m, shear_ratio) for m in moments])
    first, fields = _static_pair(beam, curvatures, e1, e2)
    if first is None:
        first = _static_shape(beam, drag_area, carried)
    shapes, twists = [first], list[SlopeShape]()
    if n_shapes > 1:
        inertia = 0.5 * (carried.spin(beam.child_point, e1) + carried.spin(beam.child_point, e2))
        while len(shapes) < n_shapes:
            bending = _inertia_moment(beam, mass, carried, inertia, shapes[-1])
            if not _extend(shapes, beam, bending / beam.second_moment):
                break
    if n_twists > 0:
        twists = _twists(beam, carried, curvatures[:2], n_twists, n_by_wind)
    if len(shapes) > 1 or twists or fields is None or len(beam.child_place):
        fields = [RotationField.about(first, e2), RotationField.about(first, -e1)]
    ways = [Coordinate(first, axis, one) for axis, one in zip((e2, -e1), fields, strict=True)]
    for shape in shapes[1:]:
        ways += [Coordinate(shape, axis, RotationField.about(shape, axis)) for axis in (e2, -e1)]
    for twist in twists:
        ways.append(Coordinate(twist, beam.chord, RotationField.about(twist, beam.chord), True))
    return tuple(ways)


def wind_load(beam: BranchBeam, drag_area: Floats, wind: Floats) -> Floats:
    """
    Force per length on the branch at rest, of winds from all sides along the ground, as far as it
    is linear in the wind: per m/s of a wind (3,) and kg/m^3 in winds of 1 m/s, (m, 5, 3).

    """
    across = wind - (beam.tangent @ wind)[:, None] * beam.tangent
    load: Floats = (drag_area * exposure(beam)[:, None])[..., None] * across[:, None, :]
    return load


def exposure(beam: BranchBeam) -> Floats:
    """Mean over winds from all sides of the share of the wind that goes across, (m,)."""
    level = 1.0 - beam.tangent[:, 2:] ** 2
    share: Floats = np.sqrt(1.0 - level * _ALL_SIDES).mean(axis=1)
    return share


_ALL_SIDES = np.cos((np.arange(8) + 0.5) * np.pi / 16.0) ** 2


def _static_pair(
    beam: BranchBeam, curvatures: Floats, e1: Floats, e2: Floats
) -> tuple[SlopeShape | None, list[RotationField] | None]:
    """
    Fields that turn the chord by 1 about e2 and about -e1 as winds along x, y and z do.

    Of all fields that do, these come nearest to what the three winds make of the branch (least
    squares). A single slope about both axes, for drawing, is their mean; None for a branch whose
    chord no wind turns.

    """
    fields = [RotationField(beam, each) for each in curvatures]
    turns = np.array([[f.nodes[-1] @ e1, f.nodes[-1] @ e2] for f in fields]) / beam.chord_length
    largest = np.linalg.svd(turns, compute_uv=False)
    if not largest[-1] > 0.02 * largest[0]:
        return None, None
    pair = np.einsum("cw,wsgk->csgk", np.linalg.pinv(turns), curvatures)
    return _drawn(beam, 0.5 * (pair[0] @ e2 - pair[1] @ e1)), [RotationField(beam, k) for k in pair]


def _drawn(beam: BranchBeam, curvature: Floats) -> SlopeShape:
    """Slope shape of a curvature, scaled to turn the chord by 1."""
    return beam.slope_shape(curvature * beam.second_moment)


def _twists(
    beam: BranchBeam, carried: Carried, curvatures: Floats, n_twists: int, n_by_wind: int
) -> list[SlopeShape]:
    """
    Twists by what it carries turning as one, then by the wind on a crooked branch, then by what
    the one before carries.

    """
    twists: list[SlopeShape] = []
    spin = carried.spin(beam.child_point, beam.chord)
    turn = np.ones(len(spin))
    if len(spin):
        _extend(twists, beam, beam.child_lever[1] @ (spin * turn) / beam.second_moment)
    along = np.einsum("wsgk,sk->wsg", curvatures, beam.tangent)
    along *= (beam.tangent @ beam.chord)[:, None]
    left = [_rest(twists, beam, each) for each in along]
    gram = np.array([[one.stiffness(other, 1.0) for other in left] for one in left])
    whole = float(beam.integral(beam.second_moment * np.square(curvatures).sum(axis=(0, -1))))
    energies, mixes = np.linalg.eigh(gram)
    for energy, mix in zip(energies[::-1], mixes.T[::-1], strict=True):
        if len(twists) < n_twists and n_by_wind > 0 and energy > _NO_TWIST * whole:
            n_by_wind -= _extend(twists, beam, np.einsum("w,wsg->sg", mix, along))
    while 0 < len(twists) < n_twists and len(spin):
        turn = twists[-1].child_slope
        if not _extend(twists, beam, beam.child_lever[1] @ (spin * turn) / beam.second_moment):
            break
    return twists


def _static_shape(beam: BranchBeam, drag_area: Floats, carried: Carried) -> SlopeShape:
    """Bent by an even wind on the branch and on all it carries."""
    places = beam.child_point[: len(carried.area)]
    lever = (carried.area_moment - carried.area[:, None] * places) @ beam.chord
    bending = beam.bending_moment(drag_area, carried.area, np.maximum(lever, 0.0))
    return beam.slope_shape(bending)


def _inertia_moment(
    beam: BranchBeam, mass: Floats, carried: Carried, inertia: Floats, shape: SlopeShape
) -> Floats:
    """
    Bending moment of the masses that ride on a moving shape, per unit of acceleration, (m, 5).

    """
    lever = (carried.mass_moment - carried.mass[:, None] * beam.child_point) @ beam.chord
    lift, turn = shape.child_deflection, shape.child_slope
    return beam.bending_moment(
        mass * shape.deflection, carried.mass * lift + lever * turn, lever * lift + inertia * turn
    )


def _rest(shapes: list[SlopeShape], beam: BranchBeam, curvature: Floats) -> SlopeShape:
    """What a curvature has that the shapes have not, in bending energy."""
    raw = SlopeShape(beam, curvature)
    for shape in shapes:
        share = raw.stiffness(shape, 1.0) / shape.stiffness(shape, 1.0)
        raw = SlopeShape(beam, raw.curvature - share * shape.curvature)
    return raw


def _extend(shapes: list[SlopeShape], beam: BranchBeam, curvature: Floats) -> bool:
    """Add what a curvature has that the shapes have not; tell whether there was any."""
    whole = SlopeShape(beam, curvature)
    rest = _rest(shapes, beam, curvature)
    if not rest.stiffness(rest, 1.0) > _NEGLIGIBLE * whole.stiffness(whole, 1.0):
        return False
    shapes.append(beam.unit_shape(rest.curvature))
    return True
