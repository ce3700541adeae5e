# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One branch as a beam: quadrature along its segments, bending by a load, slope and displacement.

Each segment carries five Gauss-Legendre points, at which the diameter is known from the linear
taper between its two ends. Integrals are taken on those points, so the result does not depend on
how finely a branch is cut.

Symbols: s arc length from the base [m]; V shear force, M bending moment per unit of load; kappa = M
/ EI curvature; psi slope, the rotation of the branch at s per unit of key rotation [-].

"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.legendre import leggauss

from tree_sway_ros.core.arrays import Floats, Ints

N_POINTS = 5


_ROOTS, _ROOT_WEIGHTS = leggauss(N_POINTS)
_POINTS = (_ROOTS + 1.0) / 2.0
_WEIGHTS = _ROOT_WEIGHTS / 2.0
_OTHERS = [(node, np.delete(_POINTS, i)) for i, node in enumerate(_POINTS)]
_LAGRANGE = [Polynomial.fromroots(rest) / np.prod(node - rest) for node, rest in _OTHERS]
_PRIMITIVES = {m: np.stack([basis.integ(m).coef for basis in _LAGRANGE]) for m in (1, 2)}


def _integration_rows(places: Floats, times: int = 1) -> Floats:
    """
    Weights w of the integral of f from 0 to each place in 0 .. 1, taken once or twice, ``w .
    f(points)``.

    """
    rows: Floats = places[:, None] ** np.arange(N_POINTS + times) @ _PRIMITIVES[times].T
    return rows


_TO_POINTS = _integration_rows(_POINTS)


@dataclass(frozen=True)
class Attachments:
    """
    Where the children of a branch sit, and what they carry.

    Parameters
    ----------
    segment
        Segment within the branch, (c,).
    fraction
        Place along that segment in [0, 1], (c,).

    """

    segment: Ints
    fraction: Floats


class BranchBeam:
    """
    A branch as a clamped beam.

    Parameters
    ----------
    start, end
        Nodes of its segments in [m], (m, 3).
    base_diameter, tip_diameter
        In [m], (m,).
    children
        Places of its children.
    root_compliance
        Young's modulus over the stiffness of a spring that holds its base in [1/m^3]; 0 if it is
        clamped.

    """

    def __init__(
        self,
        start: Floats,
        end: Floats,
        base_diameter: Floats,
        tip_diameter: Floats,
        children: Attachments,
        root_compliance: float = 0.0,
    ) -> None:
        """Set the quadrature points along the branch."""
        step = end - start
        self.length = np.linalg.norm(step, axis=1)
        self.tangent = step / self.length[:, None]
        self.children = children
        self.node = np.concatenate([[0.0], np.cumsum(self.length)])
        self.place = self.node[:-1, None] + self.length[:, None] * _POINTS
        self.weight = self.length[:, None] * _WEIGHTS
        self.diameter = base_diameter[:, None] + (tip_diameter - base_diameter)[:, None] * _POINTS
        self.point = start[:, None, :] + step[:, None, :] * _POINTS[:, None]
        self.child_place = (
            self.node[children.segment] + children.fraction * self.length[children.segment]
        )
        self.child_point = (
            start[children.segment] + children.fraction[:, None] * step[children.segment]
        )
        self._child_rows = _integration_rows(children.fraction)
        chord = end[-1] - start[0]
        self.chord_length = float(np.linalg.norm(chord))
        self.chord = chord / self.chord_length if self.chord_length > 1e-9 else self.tangent[0]
        self.second_moment = np.pi / 64.0 * self.diameter**4
        """
        Second moment of area at each point in [m^4], (m, 5); at the first, a twentieth up the first
        segment, with the spring in series.
        """
        if root_compliance > 0.0:
            own = 1.0 / self.second_moment[0, 0] + root_compliance / self.weight[0, 0]
            self.second_moment[0, 0] = 1.0 / own

    @property
    def area(self) -> Floats:
        """Cross-section at each point in [m^2], (m, 5)."""
        return np.pi / 4.0 * self.diameter**2

    def integral(self, values: Floats) -> Floats:
        """Integral over the branch of values at the points, (m, 5, ...)."""
        total: Floats = self.weight.ravel() @ values.reshape(self.weight.size, -1)
        return total.reshape(values.shape[2:])

    def from_base(self, values: Floats) -> tuple[Floats, Floats, Floats]:
        """
        Integrate from the base.

        Parameters
        ----------
        values
            At the points, (m, 5, ...).

        Returns
        -------
        tuple
            The integral up to each point (m, 5, ...), each node (m + 1, ...) and each child (c,
            ...).

        """
        tail = values.shape[2:]
        flat = values.reshape(*values.shape[:2], -1)
        nodes = np.zeros((len(flat) + 1, flat.shape[2]))
        np.cumsum((self.weight[:, None, :] @ flat)[:, 0], axis=0, out=nodes[1:])
        points = nodes[:-1, None] + self.length[:, None, None] * (_TO_POINTS @ flat)
        segment = self.children.segment
        if len(segment) == 0:
            none = np.zeros((0, *tail))
            return points.reshape(values.shape), nodes.reshape(-1, *tail), none
        within = (self._child_rows[:, None, :] @ flat[segment])[:, 0]
        children = nodes[segment] + self.length[segment, None] * within
        return points.reshape(values.shape), nodes.reshape(-1, *tail), children.reshape(-1, *tail)

    def bending_moment(self, load: Floats, force: Floats, moment: Floats) -> Floats:
        """
        Bending moment under a transverse load.

        Parameters
        ----------
        load
            Load per length at the points, (m, 5).
        force, moment
            Force and moment that each child hands over, (c,).

        Returns
        -------
        Floats
            At the points, (m, 5).

        """
        points, nodes, _ = self.from_base(load)
        shear = nodes[-1] - points
        points, nodes, _ = self.from_base(shear)
        bending: Floats = nodes[-1] - points
        if len(force) > 0:
            lever, within = self.child_lever
            bending += lever @ force + within @ moment
        return bending

    def moment_in_space(self, load: Floats, force: Floats, moment: Floats) -> Floats:
        """
        Internal moment under loads from any side.

        Parameters
        ----------
        load
            Force per length at the points in [N/m] in each of some cases, (m, 5, k, 3).
        force, moment
            Force that each child hands over, and its moment about the root of the tree, both (c, k,
            3).

        Returns
        -------
        Floats
            Of all that acts beyond each point, about that point, (m, 5, k, 3).

        """
        point = self.point[:, :, None]
        both = np.concatenate([load, cross(point, load)], axis=-1)
        points, nodes, _ = self.from_base(both)
        beyond = nodes[-1] - points
        if len(force) > 0:
            handed = np.concatenate([force, moment], axis=-1).reshape(len(force), -1)
            beyond += (self.child_lever[1] @ handed).reshape(beyond.shape)
        out: Floats = beyond[..., 3:] - cross(point, beyond[..., :3])
        return out

    def curvature_in_space(self, moment: Floats, shear_ratio: float) -> Floats:
        """
        Curvature by an internal moment, for a modulus of 1: bent by what acts across the branch,
        twisted by what acts about it, both (m, 5, k, 3).

        """
        along = self.tangent[:, None, None, :]
        twist = (moment * along).sum(axis=-1, keepdims=True) * along
        bent = moment + (0.5 / shear_ratio - 1.0) * twist
        out: Floats = bent / self.second_moment[..., None, None]
        return out

    @cached_property
    def child_lever(self) -> tuple[Floats, Floats]:
        """
        Way from each point to each child beyond it in [m], and whether it lies beyond [-], both (m,
        5, c).

        In the segment that a child sits on, the one has a kink and the other a step. There both are
        projected on the polynomials that the points carry, so that a segment bends as if it were
        cut at the child.

        """
        carrying, each = self.children.segment, np.arange(len(self.children.segment))
        lever = np.maximum(self.child_place - self.place[..., None], 0.0)
        within = (lever > 0.0).astype(np.float64)
        twice = _integration_rows(self.children.fraction, times=2)
        lever[carrying, :, each] = self.length[carrying, None] * twice / _WEIGHTS
        within[carrying, :, each] = self._child_rows / _WEIGHTS
        return lever, within

    def slope_shape(self, bending: Floats) -> SlopeShape:
        """
        Shape of the branch bent by a moment, in units of the chord's rotation.

        Parameters
        ----------
        bending
            Bending moment at the points, (m, 5), in any unit.

        """
        curvature = bending / self.second_moment
        slope, _, _ = self.from_base(curvature)
        along = self.tangent @ self.chord
        chord_rotation = float((self.weight * slope).sum(axis=1) @ along) / max(
            self.chord_length, 1e-9
        )
        arc_rotation = float(self.integral(slope)) / float(self.node[-1])
        scale = chord_rotation if chord_rotation > 0.2 * abs(arc_rotation) else arc_rotation
        return SlopeShape(self, curvature / scale)


class SlopeShape:
    """
    A way for a branch to bend: slope psi(s) per unit of its coordinate.

    Parameters
    ----------
    beam
        The branch.
    curvature
        d psi / d s at the points in [1/m], (m, 5).

    """

    def __init__(self, beam: BranchBeam, curvature: Floats) -> None:
        """Integrate curvature to slope and slope to displacement."""
        self.beam = beam
        self.curvature = curvature
        self.slope, self.node_slope, self.child_slope = beam.from_base(curvature)
        whole = (beam.weight * self.slope).sum(axis=1)
        self.segment_slope = whole / beam.length
        self.deflection, self.node_deflection, self.child_deflection = beam.from_base(self.slope)

    def stiffness(self, other: SlopeShape, modulus: float) -> float:
        """Bending energy between two shapes, the integral of E I kappa kappa', in [N m/rad]."""
        return float(
            self.beam.integral(modulus * self.beam.second_moment * self.curvature * other.curvature)
        )

    def displacement(self, rotation: Floats) -> tuple[Floats, Floats, Floats]:
        """
        Displacement for a unit of the coordinate about a rotation axis.

        Parameters
        ----------
        rotation
            Unit rotation vector, (3,).

        Returns
        -------
        tuple
            At the points (m, 5, 3), nodes (m + 1, 3) and children (c, 3), in [m/rad].

        """
        about = cross_matrix(rotation).T
        points, nodes, children = self._reach
        return points @ about, nodes @ about, children @ about

    @cached_property
    def _reach(self) -> tuple[Floats, Floats, Floats]:
        """
        Integral of the slope along the branch: its cross product with a rotation is the
        displacement.

        """
        return self.beam.from_base(self.slope[..., None] * self.beam.tangent[:, None, :])


class RotationField:
    """
    A way for a branch to bend and twist in space: rotation phi(s) per unit of its coordinate.

    Parameters
    ----------
    beam
        The branch.
    curvature
        d phi / d s at the points in [1/m], (m, 5, 3).

    """

    def __init__(self, beam: BranchBeam, curvature: Floats) -> None:
        """Integrate curvature to rotation and rotation to displacement."""
        self.beam = beam
        self.curvature = curvature
        self.slope, _, self.child_slope = beam.from_base(curvature)
        self.points, self.nodes, self.children = beam.from_base(
            cross(self.slope, beam.tangent[:, None, :])
        )
        """Displacement in [m/rad]: points (m, 5, 3), nodes (m + 1, 3), children (c, 3)."""

    @classmethod
    def about(cls, shape: SlopeShape, axis: Floats) -> RotationField:
        """Turn about one axis, (3,), by the slope of a shape."""
        return cls(shape.beam, shape.curvature[..., None] * axis)


def energies(fields: Sequence[RotationField], modulus: float, shear_modulus: float) -> Floats:
    """
    Energy between fields of one branch in [N m/rad], (k, k): E I of bending, across the branch as
    it runs in space, and G J of twist about it, J = 2 I.

    """
    beam, n = fields[0].beam, len(fields)
    curvature = np.stack([one.curvature for one in fields])
    twisting = (curvature * beam.tangent[:, None, :]).sum(axis=-1)
    measure = beam.weight * beam.second_moment
    whole = (measure[..., None] * curvature).reshape(n, -1) @ curvature.reshape(n, -1).T
    twist = (measure * twisting).reshape(n, -1) @ twisting.reshape(n, -1).T
    energy: Floats = modulus * (whole - twist) + 2.0 * shear_modulus * twist
    return energy


def cross(a: Floats, b: Floats) -> Floats:
    """Cross product along the last axis, (..., 3); numpy's own costs eight times as much."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    out: Floats = np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)
    return out


def cross_matrix(v: Floats) -> Floats:
    """Matrix whose product with a vector is the cross product of v with it, (3, 3)."""
    x, y, z = v
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
