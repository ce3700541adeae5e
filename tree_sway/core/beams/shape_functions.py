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
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.beams.beam import BranchBeam, cross, one_of, RotationField, SlopeShape

N_PAIRS = 3
"""Pairs of fields of an enriched branch: the static ones, then by inertia."""

N_TURNS, FEWER_TURNS = 3, 1
"""Further fields by rotation about the chord: of a stem, and of any other branch."""

SMALL, SLENDER, PAIRS_OF_SMALL, FEWER_PAIRS = 12, (40.0, 60.0), 8, 5
"""
Number of branches of a small tree, length of each over its diameter, for short waves need slender
beams and fling limp ones in a storm, and pairs of fields of its stem and of its others.

"""

_APART, _LEFT_APART, _MOST_APART, _MOST_IN_ALL = 24, 1e-4, 3, 12
"""
Cases of subtrees that swing against each other, the largest share of their energy that the fields
may miss, and the largest number of fields for them, or more up to a number of fields in all.

"""

MAX_COORDINATES = 2 * PAIRS_OF_SMALL + FEWER_TURNS + _MOST_APART
"""Largest number of fields of a branch."""

ROOMS = 2, _MOST_IN_ALL, MAX_COORDINATES
"""Numbers of fields that records have room for: of plain branches, of others, of small trees."""

_NEGLIGIBLE = 1e-4
"""Smallest share of a field that is orthogonal to those before."""

_LIMP, _BLOCKS, _BUCKLED = 0.1, 3, 0.05
"""
Weight over stiffness from which a branch is limp, its Krylov blocks by weight, and the smallest
share of its stiffness that weight leaves.

"""

_UPWARD = 0.3
_WIND_WEIGHTS = np.array([1.0, 1.0, _UPWARD])


class SubtreeSums(NamedTuple):
    """
    Sums over the subtree of each child of a branch, about the root of the tree.

    Parameters
    ----------
    area, area_moment
        Drag area in [m^2], (c,), and its first moment in [m^3], (c, 3).
    force, moment
        Force of winds along x, y and z, as in `wind_loads`, and its moment about the root of the
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

    @classmethod
    def zeros(cls, count: int) -> SubtreeSums:
        """Return zero sums over a number of subtrees."""
        shapes: tuple[tuple[int, ...], ...] = (), (3,), (3, 3), (3, 3), (), (3,), (3, 3)
        return cls(*(np.zeros((count, *shape)) for shape in shapes))

    def select(self, children: Ints) -> SubtreeSums:
        """Select some of the subtrees."""
        return SubtreeSums(*(sums[children] for sums in self))


def across(chord: Floats) -> tuple[Floats, Floats]:
    """
    Return unit vectors across chords (..., 3): e1 in the vertical plane, along x for an upright.

    (b, e1, e2) is right-handed.
    """
    reference = np.where(np.abs(chord[..., 2:]) > 0.9, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    e1 = reference - (reference * chord).sum(axis=-1, keepdims=True) * chord
    e1 /= np.linalg.norm(e1, axis=-1, keepdims=True)
    return e1, cross(chord, e1)


def shape_fields(
    beam: BranchBeam, drag_area: Floats, mass: Floats, subtrees: SubtreeSums, curvatures: Floats,
    shear_ratio: float, n_pairs: int = 1, n_turns: int = 0,
) -> tuple[SlopeShape, tuple[RotationField, ...]]:  # fmt: skip
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
        drawn = _static_shape(beam, drag_area, subtrees)
        about = [RotationField.about(drawn, axis).curvature for axis in (e2, -e1)]
        pair = np.where(is_turned[..., None, None, None], pair, np.stack(about))
    x, y = ((one @ e[..., None, :, None])[..., 0] for one, e in zip(pair, (e2, e1), strict=True))
    drawn = beam.slope_shape(0.5 * (x - y) * beam.second_moment)
    fields = [RotationField(beam, each) for each in pair]
    if n_pairs > 1 or n_turns > 0:
        fields += _further(beam, mass, subtrees, shear_ratio, fields, n_pairs, n_turns)
    return drawn, tuple(fields)


def wind_loads(beam: BranchBeam, drag_area: Floats) -> Floats:
    """
    Force per length on the branch at rest, of winds from all sides, (p, 5, 3, 3), the wind first.

    It is linear in the wind: per m/s of winds along x, y and z, in air of 1 kg/m^3 and winds along
    the ground of 1 m/s.
    """
    tangent = beam.tangent
    across = np.eye(3) - tangent[..., :, None] * tangent[..., None, :]
    exposed = (drag_area * exposure(tangent)[..., None])[..., None, None]
    return np.asarray(exposed * across[..., None, :, :])


def bent_by_weight(
    beam: BranchBeam, mass: Floats, subtrees: SubtreeSums, curvatures: Floats,
    shear_ratio: float, gravity: float,
) -> Floats:  # fmt: skip
    """
    Find how far loads bend a branch whose weight moves with it.

    Weight that is moved sideways bends and twists a limp branch further; it straightens a hanging
    one (second-order theory: Timoshenko & Gere, 1961). The response is a Galerkin solution in the
    block Krylov space of the curvatures by the loads and the response to weight.

    Parameters
    ----------
    beam, mass, subtrees, shear_ratio
        The same as in `shape_fields`.
    curvatures
        Curvatures by the loads without weight, (p, 5, k, 3).
    gravity
        Gravity over Young's modulus in [m/s^2/Pa].

    Returns
    -------
    Floats
        Curvatures (p, 5, k, 3), unchanged where weight matters little or would buckle the branch.

    """
    before, nodes, _ = beam.from_base(mass)
    beyond = nodes[..., -1:, None] - before
    if len(subtrees.mass):
        beyond += beam.child_lever[1] @ subtrees.mass
    is_limp = gravity * beam.integral(beyond / beam.second_moment) * beam.node[..., -1] >= _LIMP
    if not is_limp.any():
        return curvatures
    if is_limp.ndim:
        bent = curvatures.copy()
        for k in np.flatnonzero(is_limp).tolist():
            bent[k] = bent_by_weight(
                one_of(beam, k), mass[k], subtrees, curvatures[k], shear_ratio, gravity
            )
        return bent

    def by_weight(vectors: Floats) -> Floats:
        bent = np.moveaxis(_curvature_of(beam, vectors, shear_ratio), 0, 2)
        moments = gravity * _moment_of_weight(beam, mass, subtrees, bent, beyond)
        response = beam.curvature_in_space(moments, shear_ratio)
        return _energy_vector(beam, np.moveaxis(response, 2, 0), shear_ratio)

    loads = _energy_vector(beam, np.moveaxis(curvatures, 2, 0), shear_ratio)
    blocks = [loads]
    for _ in range(_BLOCKS):
        block = by_weight(blocks[-1])
        blocks.append(block / max(float(np.linalg.norm(block)), 1e-300))
    basis = np.linalg.qr(np.vstack(blocks).T)[0]
    stiffness = np.eye(basis.shape[1]) - basis.T @ by_weight(basis.T).T
    if np.linalg.eigvalsh(stiffness + stiffness.T)[0] < 2.0 * _BUCKLED:
        return curvatures
    amounts = np.linalg.solve(stiffness, basis.T @ loads.T)
    return np.moveaxis(_curvature_of(beam, (basis @ amounts).T, shear_ratio), 0, 2)


def _moment_of_weight(
    beam: BranchBeam, mass: Floats, subtrees: SubtreeSums, curvature: Floats, beyond: Floats
) -> Floats:
    """
    Return the change of the internal moment by weight as a branch bends, for a gravity of 1.

    The moment is in the frame of the cross-section, which rotates from that at rest. Curvatures
    are (p, 5, k, 3); the mass beyond each point is in [kg], (p, 5).
    """
    slope, _, child_slope = beam.from_base(curvature)
    moved, _, child_moved = beam.from_base(cross(slope, beam.tangent[:, None, None]))
    places = np.concatenate([moved, beam.point[:, :, None]], axis=2)
    before, nodes, _ = beam.from_base(places * mass[..., None, None])
    first = nodes[-1] - before
    if len(subtrees.mass):
        feet = beam.child_point[: len(subtrees.mass)]
        lever = subtrees.mass_moment - subtrees.mass[:, None] * feet
        weighed = subtrees.mass[:, None, None] * child_moved + cross(child_slope, lever[:, None])
        sums = np.concatenate([weighed, subtrees.mass_moment[:, None]], axis=1)
        first += np.tensordot(beam.child_lever[1], sums, axes=1)
    moments = cross(first - beyond[..., None, None] * places, np.array([0.0, 0.0, -1.0]))
    return np.asarray(moments[:, :, :-1] - cross(slope, moments[:, :, -1:]))


def exposure(tangent: Floats) -> Floats:
    """Return the share of the wind across each panel, averaged over winds from all sides, (m,)."""
    level = 1.0 - tangent[..., 2:] ** 2
    return np.asarray(np.sqrt(1.0 - level * _ALL_SIDES).mean(axis=-1))


_ALL_SIDES = np.cos((np.arange(8) + 0.5) * np.pi / 16.0) ** 2


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
    ends = beam.integral(cross(beam.from_base(curvatures)[0], beam.tangent[..., None, None, :]))
    turns = _WIND_WEIGHTS[:, None] * (ends @ np.stack([e1, e2], axis=-1))
    turns /= np.maximum(beam.chord_length, 1e-9)[..., None, None]
    sides, largest, winds = np.linalg.svd(turns, full_matrices=False)
    is_turned = (largest[..., -1] > 0.02 * largest[..., 0]) & (beam.chord_length > 1e-9)
    largest = np.where(is_turned[..., None], largest, 1.0)[..., None, :]
    mix = (winds.swapaxes(-1, -2) / largest) @ sides.swapaxes(-1, -2) * _WIND_WEIGHTS
    pair = np.moveaxis(mix[..., None, None, :, :] @ curvatures, -2, 0)
    return np.ascontiguousarray(pair), is_turned


class _EnergyBasis:
    """Fields of one branch that are orthogonal in bending energy, added one by one."""

    def __init__(self, beam: BranchBeam, shear_ratio: float) -> None:
        self.beam, self.shear_ratio = beam, shear_ratio
        self.vectors: list[Floats] = []
        """Orthonormal `_energy_vector` of each field."""

    def add(self, curvature: Floats) -> RotationField | None:
        """
        Add the part of a curvature, (p, 5, 3), that is orthogonal to the fields before.

        Returns it as a field whose largest rotation, or displacement, is 1; None where the part is
        negligible.
        """
        vector = _energy_vector(self.beam, curvature, self.shear_ratio)
        whole = float(np.linalg.norm(vector))
        for _ in range(2):  # twice, as rounding spoils the first pass of Gram and Schmidt
            for other in self.vectors:
                vector = vector - (other @ vector) * other
        size = float(np.linalg.norm(vector))
        if not size > _NEGLIGIBLE * whole:
            return None
        self.vectors.append(vector / size)
        rest = _curvature_of(self.beam, vector, self.shear_ratio)
        slope, nodes, _ = self.beam.from_base(rest)
        return RotationField(self.beam, rest / max(np.abs(slope).max(), np.abs(nodes).max()))

    def add_all(self, curvatures: Iterable[Floats]) -> list[RotationField]:
        """Add curvatures one by one; return the fields of those that are not negligible."""
        found = (self.add(curvature) for curvature in curvatures)
        return [field for field in found if field is not None]


def _further(
    beam: BranchBeam, mass: Floats, subtrees: SubtreeSums, shear_ratio: float,
    pair: list[RotationField], n_pairs: int, n_turns: int,
) -> list[RotationField]:  # fmt: skip
    """
    Find fields beyond the static ones, orthogonal in energy.

    Block after block, each field is the response to the inertia of a field of the block before
    (load-dependent Ritz vectors). The blocks begin with the static pair and, for a branch with
    subtrees, with their rotation about its chord (None).
    """

    def responses(fields: Iterable[RotationField | None]) -> Iterator[Floats]:
        for field in fields:
            moment = inertial_moment(beam, mass, subtrees, field)
            yield beam.curvature_in_space(moment[:, :, None], shear_ratio)[:, :, 0]

    basis = _EnergyBasis(beam, shear_ratio)
    basis.add_all(field.curvature for field in pair)
    found: list[RotationField] = []
    by_pair: Sequence[RotationField] = pair
    by_turn: Sequence[RotationField | None] = [None] if len(subtrees.area) else []
    for block in range(1, max(n_pairs, n_turns + 1)):
        by_pair = basis.add_all(responses(by_pair)) if block < n_pairs else []
        by_turn = basis.add_all(responses(by_turn)) if block <= n_turns else []
        found += [*by_pair, *by_turn]
    if len(subtrees.area) > 1:
        most = max(_MOST_IN_ALL - len(pair) - len(found), _MOST_APART)
        found += basis.add_all(_missed_apart(basis, subtrees, most))
    return found


def _missed_apart(basis: _EnergyBasis, subtrees: SubtreeSums, most: int) -> Iterator[Floats]:
    """Yield the curvatures by which limbs in antiphase bend the branch most beyond a basis."""
    beam, shear_ratio = basis.beam, basis.shear_ratio
    curvatures = beam.curvature_in_space(_apart(beam, subtrees), shear_ratio)
    cases = np.moveaxis(curvatures, 2, 0)
    missed = np.array([_energy_vector(beam, each, shear_ratio) for each in cases])
    whole = float(np.square(missed).sum())
    vectors = np.array(basis.vectors)
    for _ in range(2):
        missed -= (missed @ vectors.T) @ vectors
    sizes, directions = np.linalg.svd(missed, full_matrices=False)[1:]
    # Energy that is still missed if this direction and all weaker ones are left out.
    left_out = np.cumsum(np.square(sizes[::-1]))[::-1]
    for direction in directions[left_out > _LEFT_APART * whole][:most]:
        yield _curvature_of(beam, direction, shear_ratio)


def _apart(beam: BranchBeam, subtrees: SubtreeSums) -> Floats:
    """
    Return internal moments as subtrees swing against each other, (p, 5, k, 3).

    Limbs that swing against each other bend and twist a stem between their bases, unlike any
    motion of the whole crown. Few swing one after the other, many at random (random vectors find
    what matters: Halko, Martinsson & Tropp 2011, SIAM Review 53(2), 217-288).
    """
    places = beam.child_point[: len(subtrees.area)]
    n, rng = len(places), np.random.default_rng(0)
    cases = np.eye(6 * n) if 6 * n <= _APART else rng.choice((-1.0, 1.0), (_APART, 6 * n))
    moved, turn = np.moveaxis(cases.reshape(-1, 2, n, 3), 0, 2)
    hung = subtrees.mass_moment - subtrees.mass[:, None] * places
    trace = np.trace(subtrees.mass_second, axis1=1, axis2=2)
    square = trace - (places * (hung + subtrees.mass_moment)).sum(axis=1)
    radius = np.sqrt(np.maximum(square, 1e-12) / np.maximum(subtrees.mass, 1e-300))
    load = np.zeros((*beam.weight.shape, len(cases), 3))
    turn = turn / radius[:, None, None]
    return beam.moment_in_space(load, *_inertial_wrench(places, subtrees, turn, moved))


def _inertial_wrench(
    places: Floats, subtrees: SubtreeSums, turn: Floats, moved: Floats
) -> tuple[Floats, Floats]:
    """
    Return force and moment by the inertia of subtrees, about the root of the tree, (c, k, 3).

    Each subtree rotates about its base (c, 3) and moves with it, in k cases, both (c, k, 3).
    """
    at_root = moved - cross(turn, places[:, None])
    force = subtrees.mass[:, None, None] * at_root + cross(turn, subtrees.mass_moment[:, None])
    trace = np.trace(subtrees.mass_second, axis1=1, axis2=2)[:, None, None]
    spin = trace * turn - np.einsum('cij,ckj->cki', subtrees.mass_second, turn)
    return force, cross(subtrees.mass_moment[:, None], at_root) + spin


def _energy_vector(beam: BranchBeam, curvature: Floats, shear_ratio: float) -> Floats:
    """Return curvatures (..., p, 5, 3) as vectors, squares twice the energy by modulus."""
    measure = np.sqrt(beam.weight * beam.second_moment)[..., None]
    vector: Floats = measure * _twisted(beam, curvature, math.sqrt(2.0 * shear_ratio))
    return vector.reshape(*curvature.shape[:-3], -1)


def _curvature_of(beam: BranchBeam, vector: Floats, shear_ratio: float) -> Floats:
    """Return the curvature (..., p, 5, 3) of an `_energy_vector`."""
    measure = np.sqrt(beam.weight * beam.second_moment)[..., None]
    curvature = vector.reshape(*vector.shape[:-1], *beam.weight.shape, 3) / measure
    return _twisted(beam, curvature, 1.0 / math.sqrt(2.0 * shear_ratio))


def _twisted(beam: BranchBeam, curvature: Floats, scale: float) -> Floats:
    """Curvature, (..., p, 5, 3), with its twist scaled by a factor."""
    along = beam.tangent[:, None, :]
    about = (curvature * along).sum(axis=-1, keepdims=True) * along
    return np.asarray(curvature + (scale - 1.0) * about)


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
    force = subtrees.mass[:, None, None] * np.eye(3)
    moment = cross(subtrees.mass_moment[:, None], np.eye(3))
    moments = beam.moment_in_space(mass[..., None, None] * np.eye(3), force, moment)
    curvatures = beam.curvature_in_space(moments, shear_ratio)
    kinds = [*np.moveaxis(curvatures, 2, 0), *(field.curvature for field in fields)]
    vectors = np.array([_energy_vector(beam, each, shear_ratio) for each in kinds])
    basis = np.linalg.qr(vectors[3:].T)[0]
    left = vectors[:3] - vectors[:3] @ basis @ basis.T
    return float(np.square(vectors[:3]).sum()), float(np.square(left).sum())


def inertial_moment(
    beam: BranchBeam, mass: Floats, subtrees: SubtreeSums, field: RotationField | None
) -> Floats:
    """
    Return the internal moment by the inertia of a field and its subtrees, (p, 5, 3).

    Without a field all subtrees rotate about the chord as one body.
    """
    places = beam.child_point[: len(subtrees.area)]
    if field is None:
        load = np.zeros((*mass.shape, 3))
        turn, moved = np.broadcast_to(beam.chord, places.shape), np.zeros(places.shape)
    else:
        load = mass[..., None] * field.points
        turn, moved = field.child_slope[: len(places)], field.children[: len(places)]
    wrench = _inertial_wrench(places, subtrees, turn[:, None], moved[:, None])
    return beam.moment_in_space(load[:, :, None], *wrench)[:, :, 0]


def _static_shape(beam: BranchBeam, drag_area: Floats, subtrees: SubtreeSums) -> SlopeShape:
    """Return the shape by a uniform wind on the branch and its subtrees."""
    places = beam.child_point[: len(subtrees.area)]
    if not len(places):  # perhaps several twigs that are alike
        return beam.slope_shape(beam.bending_moment(drag_area, subtrees.area, subtrees.area))
    lever = (subtrees.area_moment - subtrees.area[:, None] * places) @ beam.chord
    bending = beam.bending_moment(drag_area, subtrees.area, np.maximum(lever, 0.0))
    return beam.slope_shape(bending)
