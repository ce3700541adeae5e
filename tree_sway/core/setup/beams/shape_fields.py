# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The fields of rotation by which a branch bends and twists in space.

A plain branch has two: the static responses to winds on it and its subtree in which its chord
rotates about one axis or the other. An enriched branch has further ones: the responses to the
inertia of these, and so on; and the twist by the rotation of its subtree about the chord
(load-dependent Ritz vectors: Wilson, Yuan & Dickens, 1982; a block Krylov space of its flexibility
and inertia). They are orthogonal in bending energy. A crooked branch bends and twists in the same
fields: twist has no separate coordinate.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.model import MOST_IN_ALL
from tree_sway.core.rotation import cross
from tree_sway.core.setup.beams.beam import BranchBeam, RotationField, SlopeShape
from tree_sway.core.setup.beams.energy_basis import energy_vector, EnergyBasis
from tree_sway.core.setup.beams.field_counts import (
    MOST_OPPOSED,
    PLAIN_PAIRS,
    PLAIN_TURNS,
)
from tree_sway.core.setup.beams.opposed_limbs import missed_curvatures
from tree_sway.core.setup.beams.subtree_sums import SubtreeSums

_UPWARD = 0.3
_WIND_WEIGHTS = np.array([1.0, 1.0, _UPWARD])
"""Weight of winds along x, y and z in the fit of a static field."""

_TURNED = 0.02
"""Smallest rotation of the chord about one axis over that about the other."""

_NO_LENGTH = 1e-9
"""Length of a chord [m] below which a branch has none."""


def across(chord: Floats) -> tuple[Floats, Floats]:
    """
    Return unit vectors across chords (..., 3): e1 in the vertical plane, along x for an upright.

    (b, e1, e2) is right-handed.
    """
    is_upright = np.abs(chord[..., 2:]) > 0.9
    reference = np.where(is_upright, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    along = (reference * chord).sum(axis=-1, keepdims=True)
    e1 = reference - along * chord
    e1 /= np.linalg.norm(e1, axis=-1, keepdims=True)
    return e1, cross(chord, e1)


def shape_fields(
    beam: BranchBeam,
    drag_area: Floats,
    mass: Floats,
    subtrees: SubtreeSums,
    curvatures: Floats,
    shear_ratio: float,
    n_pairs: int = PLAIN_PAIRS,
    n_turns: int = PLAIN_TURNS,
) -> tuple[SlopeShape, tuple[RotationField, ...]]:
    """
    Find the fields by which a branch moves.

    Parameters
    ----------
    beam
        The branch.
    drag_area, mass
        Drag area and mass per length at the points in [m] and [kg/m], (p, 5).
    subtrees
        Sums over the subtrees of the children; none for an isolated branch.
    curvatures
        Curvatures of the branch by `wind_loads` on it and its subtrees, for a modulus of 1, (p, 5,
        3, 3).
    shear_ratio
        Shear modulus over Young's in [-].
    n_pairs, n_turns
        Largest number of fields of either kind.

    Returns
    -------
    tuple
        Slope of a plain branch as it is drawn, and the fields per unit of each coordinate: key
        rotation x, y, then further ones.

    """
    e1, e2 = across(beam.chord)
    pair, is_turned = _static_pair(beam, curvatures, e1, e2)
    if not is_turned.all():
        uniform = _shape_by_uniform_wind(beam, drag_area, subtrees)
        about = [RotationField.about(uniform, axis).curvature for axis in (e2, -e1)]
        pair = np.where(is_turned[..., None, None, None], pair, np.stack(about))
    about_e2 = (pair[0] @ e2[..., None, :, None])[..., 0]
    about_e1 = (pair[1] @ e1[..., None, :, None])[..., 0]
    bending = 0.5 * (about_e2 - about_e1) * beam.second_moment
    drawn = beam.slope_shape(bending)
    fields = [RotationField(beam, each) for each in pair]
    if n_pairs > PLAIN_PAIRS or n_turns > PLAIN_TURNS:
        fields += _further(beam, mass, subtrees, shear_ratio, fields, n_pairs, n_turns)
    return drawn, tuple(fields)


def _inertial_moment(
    beam: BranchBeam, mass: Floats, subtrees: SubtreeSums, field: RotationField | None
) -> Floats:
    """
    Return the internal moment by the inertia of a field and its subtrees, (p, 5, 3).

    Without a field all subtrees rotate about the chord as one body.
    """
    base = beam.child_point[: len(subtrees.area)]
    if field is None:
        load = np.zeros((*mass.shape, 3))
        turn = np.broadcast_to(beam.chord, base.shape)
        moved = np.zeros(base.shape)
    else:
        load = mass[..., None] * field.points
        turn = field.child_slope[: len(base)]
        moved = field.children[: len(base)]
    force, moment = subtrees.inertial_wrench(base, turn[:, None], moved[:, None])
    return beam.moment_in_space(load[:, :, None], force, moment)[:, :, 0]


def shaken_energies(
    beam: BranchBeam,
    mass: Floats,
    subtrees: SubtreeSums,
    shear_ratio: float,
    fields: Sequence[RotationField],
) -> tuple[float, float]:
    """
    Compute the energy of a branch whose base is shaken, and the part that its fields miss.

    Parameters
    ----------
    beam, mass, subtrees, shear_ratio
        Beam, mass, subtrees and shear ratio, as in `shape_fields`.
    fields
        Fields of the branch.

    Returns
    -------
    tuple of float
        Twice the sum of the energies of bending and twist by an acceleration of 1 m/s^2 of the
        branch and its subtrees along x, y and z, for a modulus of 1 Pa; and the part orthogonal to
        the fields.

    """
    axes = np.eye(3)
    load = mass[..., None, None] * axes
    force = subtrees.mass[:, None, None] * axes
    moment = cross(subtrees.mass_moment[:, None], axes)
    moments = beam.moment_in_space(load, force, moment)
    by_shaking = np.moveaxis(beam.curvature_in_space(moments, shear_ratio), 2, 0)
    shaken = energy_vector(beam, by_shaking, shear_ratio)
    of_fields = np.array([field.curvature for field in fields])
    spanned = energy_vector(beam, of_fields, shear_ratio)
    basis = np.linalg.qr(spanned.T)[0]
    missed = shaken - shaken @ basis @ basis.T
    return float(np.square(shaken).sum()), float(np.square(missed).sum())


def _static_pair(
    beam: BranchBeam, curvatures: Floats, e1: Floats, e2: Floats
) -> tuple[Floats, NDArray[np.bool_]]:
    """
    Curvatures, (2, p, 5, 3), by winds, scaled to rotate the chord by 1 about e2 and about -e1.

    They are the best fit to the curvatures by winds along x, y and z, (p, 5, 3, 3) (least squares,
    an upward wind weighted by `_UPWARD`). Where horizontal winds rotate the chord about both axes,
    their curvatures are exact, and so is the static sway of a tree. The second result is false for
    a branch whose chord no wind rotates.
    """
    slopes, _, _ = beam.from_base(curvatures)
    ends = beam.integral(cross(slopes, beam.tangent[..., None, None, :]))
    axes = np.stack([e1, e2], axis=-1)
    turns = _WIND_WEIGHTS[:, None] * (ends @ axes)
    length = np.maximum(beam.chord_length, _NO_LENGTH)
    turns /= length[..., None, None]
    # The pseudoinverse of the turns by three winds: how much of each wind turns by 1.
    sides, largest, winds = np.linalg.svd(turns, full_matrices=False)
    is_turned = largest[..., -1] > _TURNED * largest[..., 0]
    is_turned &= beam.chord_length > _NO_LENGTH
    divisor = np.where(is_turned[..., None], largest, 1.0)
    per_turn = winds.swapaxes(-1, -2) / divisor[..., None, :]
    mix = per_turn @ sides.swapaxes(-1, -2) * _WIND_WEIGHTS
    mixed = mix[..., None, None, :, :] @ curvatures
    pair = np.moveaxis(mixed, -2, 0)
    return np.ascontiguousarray(pair), is_turned


def _shape_by_uniform_wind(
    beam: BranchBeam, drag_area: Floats, subtrees: SubtreeSums
) -> SlopeShape:
    """Return the shape by a uniform wind on the branch and its subtrees."""
    base = beam.child_point[: len(subtrees.area)]
    if not len(base):  # perhaps several twigs that are alike
        return beam.slope_shape(beam.bending_moment(drag_area, subtrees.area, subtrees.area))
    lever = (subtrees.area_moment - subtrees.area[:, None] * base) @ beam.chord
    bending = beam.bending_moment(drag_area, subtrees.area, np.maximum(lever, 0.0))
    return beam.slope_shape(bending)


def _further(
    beam: BranchBeam,
    mass: Floats,
    subtrees: SubtreeSums,
    shear_ratio: float,
    pair: list[RotationField],
    n_pairs: int,
    n_turns: int,
) -> list[RotationField]:
    """
    Find fields beyond the static ones, orthogonal in energy.

    Block after block, each field is the response to the inertia of a field of the block before
    (load-dependent Ritz vectors). The blocks begin with the static pair and, for a branch with
    subtrees, with their rotation about its chord (None).
    """

    def responses(fields: Iterable[RotationField | None]) -> Iterator[Floats]:
        for field in fields:
            moment = _inertial_moment(beam, mass, subtrees, field)
            yield beam.curvature_in_space(moment[:, :, None], shear_ratio)[:, :, 0]

    basis = EnergyBasis(beam, shear_ratio)
    basis.add_all(field.curvature for field in pair)
    found: list[RotationField] = []
    by_pair: Sequence[RotationField] = pair
    by_turn: Sequence[RotationField | None] = [None] if len(subtrees.area) else []
    for block in range(1, max(n_pairs, n_turns + 1)):
        by_pair = basis.add_all(responses(by_pair)) if block < n_pairs else []
        by_turn = basis.add_all(responses(by_turn)) if block <= n_turns else []
        found += [*by_pair, *by_turn]
    if len(subtrees.area) > 1:
        most = max(MOST_IN_ALL - len(pair) - len(found), MOST_OPPOSED)
        found += basis.add_all(missed_curvatures(basis, subtrees, most))
    return found
