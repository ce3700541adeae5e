# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Matrices of tapered Euler-Bernoulli elements in 3D, by Gauss quadrature.

Twelve coordinates an element: displacement and rotation ``(u, v, w, phi, theta_y, theta_z)`` at
its start and at its end, x along its axis. Cubic Hermite bending, linear stretch and twist
(Przemieniecki 1968, chapters 5 and 11). The integrands are polynomials in the taper, so five
points integrate them exactly.

Symbols: E modulus [Pa], G shear modulus [Pa], rho density [kg/m^3], I second moment [m^4], L
length [m].

"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway.core.arrays import Floats

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(5)
POINTS: Floats = 0.5 * (_POINTS + 1.0)
WEIGHTS: Floats = 0.5 * _WEIGHTS


@dataclass(frozen=True)
class ElementShapes:
    """
    Rows that map the twelve local coordinates to fields at the Gauss points, each (m, 5, 12).

    Parameters
    ----------
    displacement
        Displacement along and across the axis, three rows.
    rotation
        Rotation vector of the cross-section, three rows.
    curvature
        Derivative of the rotation vector along the axis, three rows.
    stretch
        Derivative of the displacement along the axis.

    """

    displacement: tuple[Floats, Floats, Floats]
    rotation: tuple[Floats, Floats, Floats]
    curvature: tuple[Floats, Floats, Floats]
    stretch: Floats


def element_shapes(length: Floats) -> ElementShapes:
    """Evaluate the shape functions of elements of these lengths in [m], (m,)."""
    x = POINTS[None, :]
    span = length[:, None]
    one = np.ones((len(length), len(POINTS)))
    hermite = (1 - 3 * x**2 + 2 * x**3, x - 2 * x**2 + x**3, 3 * x**2 - 2 * x**3, x**3 - x**2)
    slope = (6 * x**2 - 6 * x, 1 - 4 * x + 3 * x**2, 6 * x - 6 * x**2, 3 * x**2 - 2 * x)
    second = (12 * x - 6, 6 * x - 4, 6 - 12 * x, 6 * x - 2)

    def row(*entries: tuple[int, Floats]) -> Floats:
        out = np.zeros((len(length), len(POINTS), 12))
        for column, value in entries:
            out[:, :, column] = value * one
        return out

    def across(
        columns: tuple[int, int, int, int], sign: float, f: tuple[Floats, ...], p: int
    ) -> Floats:
        # The slope coordinates are rotations: one more power of the length than the displacements.
        scale = span**-p
        a, b, c, d = columns
        return row(
            (a, f[0] * scale),
            (b, sign * f[1] * scale * span),
            (c, f[2] * scale),
            (d, sign * f[3] * scale * span),
        )

    in_y, in_z = (1, 5, 7, 11), (2, 4, 8, 10)
    return ElementShapes(
        displacement=(
            row((0, 1 - x), (6, x)),
            across(in_y, 1.0, hermite, 0),
            across(in_z, -1.0, hermite, 0),
        ),
        rotation=(
            row((3, 1 - x), (9, x)),
            -across(in_z, -1.0, slope, 1),
            across(in_y, 1.0, slope, 1),
        ),
        curvature=(
            row((3, -1 / span), (9, 1 / span)),
            -across(in_z, -1.0, second, 2),
            across(in_y, 1.0, second, 2),
        ),
        stretch=row((0, -1 / span), (6, 1 / span)),
    )


def elastic_stiffness(
    shapes: ElementShapes, length: Floats, diameter: Floats, modulus: float, shear_modulus: float
) -> Floats:
    """
    Stiffness of stretch, twist and bending, (m, 12, 12).

    Parameters
    ----------
    shapes
        From `element_shapes`.
    length
        Length of each element in [m], (m,).
    diameter
        Diameter at the Gauss points in [m], (m, 5).
    modulus, shear_modulus
        E and G in [Pa].

    """
    area = np.pi / 4.0 * diameter**2
    second_moment = np.pi / 64.0 * diameter**4
    twist, bend_y, bend_z = shapes.curvature
    return (
        _integral(length, modulus * area, shapes.stretch, shapes.stretch)
        + _integral(length, 2.0 * shear_modulus * second_moment, twist, twist)
        + _integral(length, modulus * second_moment, bend_y, bend_y)
        + _integral(length, modulus * second_moment, bend_z, bend_z)
    )


def consistent_mass(
    shapes: ElementShapes, length: Floats, diameter: Floats, density: float
) -> Floats:
    """Mass, (m, 12, 12); as Euler and Bernoulli, without the rotary inertia of bending."""
    line_mass = density * np.pi / 4.0 * diameter**2
    twist = shapes.rotation[0]
    total = _integral(length, density * np.pi / 32.0 * diameter**4, twist, twist)
    for rows in shapes.displacement:
        total = total + _integral(length, line_mass, rows, rows)
    return total


def geometric_stiffness(
    shapes: ElementShapes, length: Floats, force: Floats, moment: Floats
) -> Floats:
    """
    Stiffness by the internal force and moment that the rest shape carries already, (m, 12, 12).

    With F and M the internal force and moment that the tip's side exerts, N = F_x, theta the
    rotation vector and phi its part about the axis, the second variation of the potential is

        N |u'|^2 - phi F_perp . theta_perp - M . (theta x theta').

    For an upright stem only the first term is there: a column under its own weight (Greenhill
    1881). The others are what lets a leaning branch twist sideways.

    Parameters
    ----------
    shapes, length
        As above.
    force, moment
        Internal force in [N] and moment in [N m] at the Gauss points in local axes, (m, 5, 3).

    """
    twist, bend_y, bend_z = shapes.rotation
    total = _integral(length, force[..., 0], bend_y, bend_y)
    total = total + _integral(length, force[..., 0], bend_z, bend_z)
    for k in (1, 2):
        total = total - _symmetric(length, force[..., k], twist, shapes.rotation[k])
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        total = total - _symmetric(length, moment[..., i], shapes.rotation[j], shapes.curvature[k])
        total = total + _symmetric(length, moment[..., i], shapes.rotation[k], shapes.curvature[j])
    return total


def load_rows(shapes: ElementShapes, length: Floats, share: Floats) -> Floats:
    """Nodal loads by a unit force spread with this density, (m, 12, 3), local axes."""
    columns = [
        np.einsum('g,mg,mga->ma', WEIGHTS, share * length[:, None], rows)
        for rows in shapes.displacement
    ]
    return np.stack(columns, axis=2)


def _integral(length: Floats, density: Floats, left: Floats, right: Floats) -> Floats:
    out: Floats = np.einsum('g,mg,mga,mgb->mab', WEIGHTS, density * length[:, None], left, right)
    return out


def _symmetric(length: Floats, density: Floats, left: Floats, right: Floats) -> Floats:
    half = 0.5 * _integral(length, density, left, right)
    return half + half.transpose(0, 2, 1)
