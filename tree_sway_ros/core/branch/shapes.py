# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The ways a branch bends and twists: its static fields, and for an enriched branch further shapes.

A plain branch moves as winds bend and twist it in space, with all that it carries: two fields, one
per way that its chord can turn. An enriched branch has shapes, each about two axes across its
chord, and twists about it. They are those that best hold the static fields and what inertia bends
these into (load-dependent Ritz vectors: Wilson, Yuan & Dickens, 1982): the principal components of
their curvatures, in bending energy.

"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.branch.beam import (
    BranchBeam,
    RotationField,
    SlopeShape,
    cross,
    cross_matrix,
)

N_SHAPES = 3
"""Bending shapes of an enriched branch, each about two axes."""

N_TWISTS = 3
"""Its twists."""

MAX_COORDINATES = 2 * N_SHAPES + N_TWISTS

N_WANTED = 9
"""Fields in space that those of an enriched branch are chosen to hold."""

INERTIAL = 0.1
"""Weight of the fields by inertia over that of the static ones."""

_NEGLIGIBLE = 1e-6


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
    *,
    is_enriched: bool = False,
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
    is_enriched
        Whether it gets further shapes and twists, or its key rotation alone.

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
    if first is None or fields is None:
        first = _static_shape(beam, drag_area, carried)
        fields = [RotationField.about(first, e2), RotationField.about(first, -e1)]
    if not is_enriched:
        return tuple(
            Coordinate(first, axis, one) for axis, one in zip((e2, -e1), fields, strict=True)
        )
    wanted = _wanted(beam, mass, carried, fields, shear_ratio)
    bends = np.concatenate([wanted @ e1, wanted @ e2])
    shapes = [first, *_leading(beam, bends, N_SHAPES - 1, first)]
    twists = _leading(beam, wanted @ beam.chord, N_TWISTS)
    ways = [
        Coordinate(shape, axis, RotationField.about(shape, axis))
        for shape in shapes
        for axis in (e2, -e1)
    ]
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
    squares, an upward wind weighted by `_UPWARD`): where winds along the ground turn the chord both
    ways, what they do is theirs exactly, and so is the static sway of a tree. A single slope about
    both axes, for drawing, is their mean; None for a branch whose chord no wind turns.

    """
    ends = np.stack([RotationField(beam, each).nodes[-1] for each in curvatures])
    turns = _WEIGHTS[:, None] * (ends @ np.stack([e1, e2], axis=1)) / beam.chord_length
    largest = np.linalg.svd(turns, compute_uv=False)
    if not largest[-1] > 0.02 * largest[0]:
        return None, None
    pair = np.einsum("cw,wsgk->csgk", np.linalg.pinv(turns) * _WEIGHTS, curvatures)
    return _drawn(beam, 0.5 * (pair[0] @ e2 - pair[1] @ e1)), [RotationField(beam, k) for k in pair]


_UPWARD = 0.3
_WEIGHTS = np.array([1.0, 1.0, _UPWARD])


def _drawn(beam: BranchBeam, curvature: Floats) -> SlopeShape:
    """Slope shape of a curvature, scaled to turn the chord by 1."""
    return beam.slope_shape(curvature * beam.second_moment)


def _wanted(
    beam: BranchBeam,
    mass: Floats,
    carried: Carried,
    static: list[RotationField],
    shear_ratio: float,
) -> Floats:
    """
    Curvatures that an enriched branch should be able to take on, weighted by how much they matter,
    (k, m, 5, 3).

    The static ones come first, then what the inertia of these and of a turn of all it carries about
    its chord bends it into, and so on (block Krylov space, orthogonal in energy).

    """
    along = beam.tangent[:, None, :]
    measure = np.sqrt(beam.weight * beam.second_moment)[..., None]

    def scaled(curvature: Floats, twist: float) -> Floats:
        about = (curvature * along).sum(axis=-1, keepdims=True) * along
        out: Floats = curvature + (twist - 1.0) * about
        return out

    stiff = math.sqrt(2.0 * shear_ratio)
    basis: list[Floats] = []
    fields: list[RotationField | None] = []
    due: list[Floats] = [one.curvature for one in static]
    number = 0
    while len(basis) < N_WANTED:
        if not due:
            if number > len(fields):
                break
            source = fields[number - 1] if number > 0 else None
            moment = inertial_moment(beam, mass, carried, source)
            due.append(beam.curvature_in_space(moment, shear_ratio))
            number += 1
        vector = (measure * scaled(due.pop(0), stiff)).ravel()
        whole = float(np.linalg.norm(vector))
        for _ in range(2):
            for other in basis:
                vector = vector - (other @ vector) * other
        size = float(np.linalg.norm(vector))
        if not size > _NEGLIGIBLE * whole:
            continue
        basis.append(vector / size)
        shape = (*beam.place.shape, 3)
        fields.append(RotationField(beam, scaled(basis[-1].reshape(shape) / measure, 1.0 / stiff)))
    weights = np.where(np.arange(len(fields)) < len(static), 1.0, INERTIAL)
    curvatures = np.stack([one.curvature for one in fields if one is not None])
    return np.asarray(weights[:, None, None, None] * curvatures)


def _leading(
    beam: BranchBeam, curvatures: Floats, count: int, first: SlopeShape | None = None
) -> list[SlopeShape]:
    """
    Shapes that hold the most bending energy of some curvatures, (k, m, 5), beyond the first shape.

    """
    measure = np.sqrt(beam.weight * beam.second_moment)
    rows = (measure * curvatures).reshape(len(curvatures), -1)
    if first is not None:
        known = (measure * first.curvature).ravel()
        known = known / np.linalg.norm(known)
        rows = rows - np.outer(rows @ known, known)
    _, sizes, vectors = np.linalg.svd(rows, full_matrices=False)
    held = sizes[:count] > _NEGLIGIBLE * sizes[0]
    return [
        beam.unit_shape(vector.reshape(measure.shape) / measure) for vector in vectors[:count][held]
    ]


def inertial_moment(
    beam: BranchBeam, mass: Floats, carried: Carried, field: RotationField | None
) -> Floats:
    """
    Internal moment by the inertia of a field and of all that rides on it, (m, 5, 3); of all that is
    carried turning about the chord as one where there is no field.

    """
    places = beam.child_point[: len(carried.area)]
    if field is None:
        load = np.zeros((*mass.shape, 3))
        turn = np.broadcast_to(beam.chord, places.shape)
        moved = np.zeros(places.shape)
    else:
        load = mass[..., None] * field.points
        turn, moved = field.child_slope[: len(places)], field.children[: len(places)]
    at_root = moved - cross(turn, places)
    force = carried.mass[:, None] * at_root + cross(turn, carried.mass_moment)
    trace = np.trace(carried.mass_second, axis1=1, axis2=2)[:, None]
    spin = trace * turn - np.einsum("cij,cj->ci", carried.mass_second, turn)
    return beam.moment_in_space(load, force, cross(carried.mass_moment, at_root) + spin)


def _static_shape(beam: BranchBeam, drag_area: Floats, carried: Carried) -> SlopeShape:
    """Bent by an even wind on the branch and on all it carries."""
    places = beam.child_point[: len(carried.area)]
    lever = (carried.area_moment - carried.area[:, None] * places) @ beam.chord
    bending = beam.bending_moment(drag_area, carried.area, np.maximum(lever, 0.0))
    return beam.slope_shape(bending)
