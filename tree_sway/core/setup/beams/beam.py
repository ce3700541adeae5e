# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One branch as a beam: quadrature along its segments, bending by a load, slope and displacement.

A segment is one panel, or more where children sit within it. Each panel carries five
Gauss-Legendre points, at which the diameter is known from the linear taper between the ends of the
segment. Integrals are taken on those points, so the result does not depend on how finely a branch
is cut; and as the load of a child makes a step or a kink at its base, no panel extends across one.

Branches with the same number of segments and children at the same places can share one beam,
field or shape, a batch: all arrays then have one more axis, the first, with an entry per branch.

Symbols: s arc length from the base [m]; V shear force, M bending moment per unit of load; kappa =
M / EI curvature; psi slope, the rotation of the branch at s per unit of key rotation [-].
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
import math
from typing import Any, TypeVar

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.legendre import leggauss

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.rotation import cross

N_POINTS = 5

_DIGITS = 9
"""
Decimals of places along a segment; bases that are closer to each other, or to a node, are merged.
"""

_ROOTS, _ROOT_WEIGHTS = leggauss(N_POINTS)
_POINTS = (_ROOTS + 1.0) / 2.0
_WEIGHTS = _ROOT_WEIGHTS / 2.0


def _integrals() -> Floats:
    """Integrate the Lagrange polynomials of the points from 0 to each point, and to 1."""
    primitives = []
    for i, node in enumerate(_POINTS):
        others = np.delete(_POINTS, i)
        polynomial = Polynomial.fromroots(others) / np.prod(node - others)
        primitives.append(polynomial.integ().coef)
    powers = _POINTS[:, None] ** np.arange(N_POINTS + 1)
    to_points = powers @ np.stack(primitives).T
    return np.vstack([to_points, _WEIGHTS])


_INTEGRALS = _integrals()
"""Weights w of the integral of f from 0 to each point, and to 1, ``w . f(points)``."""


@dataclass(frozen=True)
class Attachments:
    """
    Places of the children of a branch.

    Parameters
    ----------
    segment
        Segment within the branch, (c,).
    fraction
        Place along that segment in [0, 1], (c,).

    """

    segment: Ints
    fraction: Floats


class Batched:
    """
    One beam, shape or field, or several of branches that are alike.

    The arrays of several have one more axis, the first, with an entry per branch. `one_of` returns
    an element, whose arrays are views; `many_of` stacks elements.
    """

    origin: tuple[Batched, int] | None = None
    """Batch that this is a view of, and its place there."""


class BranchBeam(Batched):
    """
    A branch as a clamped beam.

    Parameters
    ----------
    start, end
        Nodes of the segments in [m], (m, 3).
    base_diameter, tip_diameter
        Diameters of the segments in [m], (m,).
    children
        Places of the children.
    root_compliance
        Young's modulus over the stiffness of the rotational spring at the base in [1/m^3]; 0 for a
        clamped base.

    """

    def __init__(
        self, start: Floats, end: Floats, base_diameter: Floats, tip_diameter: Floats,
        children: Attachments, root_compliance: float = 0.0,
    ) -> None:  # fmt: skip
        """Set the quadrature points along the branch."""
        step = end - start
        many = step.shape[:-2]
        n_segments = step.shape[-2]
        # Panels, and the points on them, are at the same places along the segments of a batch.
        seats = np.round(children.segment + children.fraction, _DIGITS)
        cuts = np.union1d(np.arange(n_segments + 1.0), seats)
        begin = cuts[:-1]
        on = begin.astype(np.int64)
        share = np.diff(cuts)
        along = (begin - on)[:, None] + share[:, None] * _POINTS
        foot = np.searchsorted(cuts, seats)
        self._feet = foot.tolist()
        first_panels = np.searchsorted(on, np.arange(n_segments))
        self._first_panels = first_panels.tolist()

        self.segment: Ints = np.broadcast_to(on, (*many, len(on)))
        """Segment of each panel, (p,)."""
        self.segment_length: Floats = np.linalg.norm(step, axis=-1)
        self.length = share * self.segment_length[..., on]
        """Length of each panel in [m], (p,)."""
        direction = step / self.segment_length[..., None]
        self.tangent = direction[..., on, :]
        self.node = np.zeros((*many, len(cuts)))
        np.cumsum(self.length, axis=-1, out=self.node[..., 1:])
        panel_start = self.node[..., :-1, None]
        panel_length = self.length[..., None]
        self.place = panel_start + panel_length * _POINTS
        self.weight = panel_length * _WEIGHTS
        whole_step = step[..., on, None, :]
        self.point = start[..., on, None, :] + whole_step * along[..., None]

        self.child_place = self.node[..., foot]
        whole_step = step[..., children.segment, :]
        on_segment = whole_step * children.fraction[:, None]
        self.child_point = start[..., children.segment, :] + on_segment

        first = start[..., 0, :]
        chord = end[..., -1, :] - first
        self.chord_length = np.linalg.norm(chord, axis=-1)
        length = self.chord_length[..., None]
        has_chord = length > 1e-9
        first_tangent = self.tangent[..., 0, :]
        self.chord = np.where(has_chord, chord, first_tangent)
        self.chord /= np.where(has_chord, length, 1.0)

        thinning = (tip_diameter - base_diameter)[..., on, None]
        self.diameter = base_diameter[..., on, None] + thinning * along
        self.second_moment = round_section(self.diameter)
        """
        Second moment of area at each point in [m^4], (p, 5); at the first, a twentieth up the
        first panel, with the spring in series.
        """
        if root_compliance > 0.0:
            own_compliance = 1.0 / self.second_moment[..., 0, 0]
            spring = root_compliance / self.weight[..., 0, 0]
            self.second_moment[..., 0, 0] = 1.0 / (own_compliance + spring)

    @property
    def area(self) -> Floats:
        """Cross-section at each point in [m^2], (p, 5)."""
        return np.pi / 4.0 * self.diameter**2

    def integral(self, values: Floats) -> Floats:
        """Integral over the branch of values at the points, (p, 5, ...)."""
        tail = values.shape[self.weight.ndim :]
        many = self.weight.shape[:-2]
        flat = values.reshape(*many, -1, math.prod(tail))
        weights = self.weight.reshape(*many, 1, -1)
        total: Floats = weights @ flat
        return total.reshape((*many, *tail))

    def from_base(self, values: Floats) -> tuple[Floats, Floats, Floats]:
        """
        Integrate from the base.

        Parameters
        ----------
        values
            Values at the points, (p, 5, ...).

        Returns
        -------
        tuple
            The integral up to each point (p, 5, ...), each node (p + 1, ...) and each child (c,
            ...).

        """
        tail = values.shape[self.weight.ndim :]
        flat = values.reshape(*self.weight.shape, math.prod(tail))
        within = (_INTEGRALS @ flat) * self.length[..., None, None]
        whole = within[..., N_POINTS, :]
        nodes = np.zeros((*self.node.shape, flat.shape[-1]))
        np.cumsum(whole, axis=-2, out=nodes[..., 1:, :])
        to_panel = nodes[..., :-1, None, :]
        points = to_panel + within[..., :N_POINTS, :]
        feet = nodes[..., self._feet, :]
        return (
            points.reshape(values.shape),
            nodes.reshape(*self.node.shape, *tail),
            feet.reshape(*self.child_place.shape, *tail),
        )

    def over_segments(self, values: Floats) -> Floats:
        """Mean over each segment of values at the points, (p, 5, ...), as (m, ...)."""
        tail = values.shape[self.weight.ndim :]
        flat = values.reshape(*self.weight.shape, -1)
        weighted = self.weight[..., None] * flat
        panels = weighted.sum(axis=-2)
        sums = np.add.reduceat(panels, self._first_panels, axis=-2)
        sums /= self.segment_length[..., None]
        return np.asarray(sums.reshape(*self.segment_length.shape, *tail))

    def bending_moment(self, load: Floats, force: Floats, moment: Floats) -> Floats:
        """
        Bending moment under a transverse load.

        Parameters
        ----------
        load
            Load per length at the points, (p, 5).
        force, moment
            Force and moment of each child on the branch, (c,).

        Returns
        -------
        Floats
            Bending moment at the points, (p, 5).

        """
        points, nodes, _ = self.from_base(load)
        shear = nodes[..., -1:, None] - points
        points, nodes, _ = self.from_base(shear)
        bending: Floats = nodes[..., -1:, None] - points
        if len(force) > 0:
            lever, within = self.child_lever
            bending += lever @ force + within @ moment
        return bending

    def moment_in_space(self, load: Floats, force: Floats, moment: Floats) -> Floats:
        """
        Compute the internal moment under loads from any side.

        Parameters
        ----------
        load
            Force per length at the points in [N/m] in each of some cases, (p, 5, k, 3).
        force, moment
            Force of each child on the branch, and its moment about the root of the tree, both (c,
            k, 3).

        Returns
        -------
        Floats
            Moment of the loads beyond each point, about that point, (p, 5, k, 3).

        """
        point = self.point[..., None, :]
        both = np.concatenate([load, cross(point, load)], axis=-1)
        points, nodes, _ = self.from_base(both)
        beyond = nodes[..., -1:, None, :, :] - points
        if len(force) > 0:
            _, is_beyond = self.child_lever
            handed = np.concatenate([force, moment], axis=-1)
            carried = is_beyond @ handed.reshape(len(force), -1)
            beyond += carried.reshape(beyond.shape)
        force_beyond = beyond[..., :3]
        moment_beyond = beyond[..., 3:]
        return np.asarray(moment_beyond - cross(point, force_beyond))

    def curvature_in_space(self, moment: Floats, shear_ratio: float) -> Floats:
        """Curvature by an internal moment, bending and twist, for a modulus of 1, (p, 5, k, 3)."""
        along = self.tangent[..., None, None, :]
        about_tangent = (moment * along).sum(axis=-1, keepdims=True)
        twist = about_tangent * along
        bent = moment + (0.5 / shear_ratio - 1.0) * twist
        return np.asarray(bent / self.second_moment[..., None, None])

    @property
    def child_lever(self) -> tuple[Floats, Floats]:
        """Lever [m] from each point to each child, and whether it is beyond, (p, 5, c)."""
        lever = np.maximum(self.child_place - self.place[..., None], 0.0)
        return lever, (lever > 0.0).astype(np.float64)

    def slope_shape(self, bending: Floats) -> SlopeShape:
        """
        Shape of the branch bent by a moment, in units of the chord's rotation.

        Parameters
        ----------
        bending
            Bending moment at the points, (p, 5), in any unit.

        """
        curvature = bending / self.second_moment
        slope, _, _ = self.from_base(curvature)
        along = (self.tangent @ self.chord[..., None])[..., 0]
        moved = (self.weight * slope).sum(axis=-1)
        along_chord = (moved * along).sum(axis=-1)
        chord_rotation = along_chord / np.maximum(self.chord_length, 1e-9)
        arc_rotation = self.integral(slope) / self.node[..., -1]
        is_chord = chord_rotation > 0.2 * np.abs(arc_rotation)
        scale = np.where(is_chord, chord_rotation, arc_rotation)
        return SlopeShape(self, curvature / scale[..., None, None])


class SlopeShape(Batched):
    """
    A shape in which a branch bends: slope psi(s) per unit of its coordinate.

    Parameters
    ----------
    beam
        Beam of the branch.
    curvature
        d psi / d s at the points in [1/m], (p, 5).

    """

    def __init__(self, beam: BranchBeam, curvature: Floats) -> None:
        """Integrate curvature to slope and slope to displacement."""
        self.beam = beam
        self.curvature = curvature
        self.slope, self.node_slope, self.child_slope = beam.from_base(curvature)
        self.segment_slope = beam.over_segments(self.slope)
        self.deflection, self.node_deflection, self.child_deflection = beam.from_base(self.slope)

    def stiffness(self, modulus: float) -> float:
        """Return twice the bending energy, the integral of E I kappa^2, in [N m/rad]."""
        rigidity = modulus * self.beam.second_moment
        energy = rigidity * self.curvature * self.curvature
        return float(self.beam.integral(energy))


class RotationField(Batched):
    """
    Field by which a branch bends and twists in space: rotation phi(s) per unit of coordinate.

    Parameters
    ----------
    beam
        Beam of the branch.
    curvature
        d phi / d s at the points in [1/m], (p, 5, 3).

    """

    def __init__(self, beam: BranchBeam, curvature: Floats) -> None:
        """Integrate curvature to rotation and rotation to displacement."""
        self.beam = beam
        self.curvature = curvature
        self.slope, _, self.child_slope = beam.from_base(curvature)
        self.points, self.nodes, self.children = beam.from_base(
            cross(self.slope, beam.tangent[..., None, :])
        )
        """Displacement in [m/rad]: points (p, 5, 3), nodes (p + 1, 3), children (c, 3)."""

    @classmethod
    def about(cls, shape: SlopeShape, axis: Floats) -> RotationField:
        """Make the field of rotations about one axis, (3,), by the slope of a shape."""
        amount = shape.curvature[..., None]
        return cls(shape.beam, amount * axis[..., None, None, :])


def energies(fields: Sequence[RotationField], modulus: float, shear_modulus: float) -> Floats:
    """
    Energy between fields of one branch in [N m/rad], (k, k).

    Bending has E I, across the branch in space, and twist about it G J, J = 2 I.
    """
    beam = fields[0].beam
    curvature = np.stack([one.curvature for one in fields], axis=-4)
    along = curvature * beam.tangent[..., None, :, None, :]
    twisting = along.sum(axis=-1)
    weight = beam.weight * beam.second_moment
    measure = weight[..., None, :, :]
    whole = products(measure[..., None] * curvature, curvature, 3)
    twist = products(measure * twisting, twisting, 2)
    return np.asarray(modulus * (whole - twist) + 2.0 * shear_modulus * twist)


def products(a: Floats, b: Floats, n_axes: int) -> Floats:
    """Sum the products of each of some arrays and each of others, (..., k, last axes)."""
    flat_a = _flat(a, n_axes)
    flat_b = _flat(b, n_axes)
    return np.asarray(flat_a @ flat_b.swapaxes(-1, -2))


def _flat(arrays: Floats, n_axes: int) -> Floats:
    """Make the last axes of some arrays one."""
    n_before = arrays.ndim - n_axes
    return arrays.reshape(*arrays.shape[:n_before], -1)


_Kind = TypeVar('_Kind', bound=Batched)


def one_of(many: _Kind, number: int, **others: Any) -> _Kind:
    """Return an element of a batch, with views of its arrays; `others` replace attributes."""
    one = object.__new__(type(many))
    for name, value in vars(many).items():
        setattr(one, name, value[number] if isinstance(value, np.ndarray) else value)
    for name, value in others.items():
        setattr(one, name, value)
    one.origin = many, number
    return one


def stacked(ones: Sequence[Batched], name: str) -> Any:
    """Stack an array of beams, shapes or fields that are alike."""
    first = ones[0].origin
    if first is not None:
        batch = first[0]
        origins = [one.origin for one in ones if one.origin is not None]
        numbers = [number for of_batch, number in origins if of_batch is batch]
        if len(numbers) == len(ones):
            return getattr(batch, name)[numbers]
    return np.array([getattr(one, name) for one in ones])


def many_of(ones: Sequence[_Kind], **others: Any) -> _Kind:
    """Stack beams, shapes or fields that are alike to a batch; `others` replace attributes."""
    many = object.__new__(type(ones[0]))
    for name, value in vars(ones[0]).items():
        if name in others or name == 'origin':
            continue
        is_stacked = isinstance(value, np.ndarray | float)
        setattr(many, name, stacked(ones, name) if is_stacked else value)
    for name, value in others.items():
        setattr(many, name, value)
    return many


def round_section(diameter: Floats) -> Floats:
    """Second moment of area of a round section [m^4] by its diameter [m]."""
    return np.asarray(np.pi / 64.0 * diameter**4)
