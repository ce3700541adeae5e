# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Closed-form calibration of one tapered branch: its key segment in four numbers.

A branch of length L has diameter d(s) = d0 (1 - tau s / L), so EI(s) = EI0 (1 - tau s / L)^4, and a
wind load per length that is proportional to d(s). Its key segment turns by theta, the angle of the
chord from root to tip, so that the tip moves by L theta. The constants below make the static tip
and the first natural frequency those of the Euler-Bernoulli beam, within 0.1 % for tau up to 0.9.

Symbols: L length [m], tau taper [-], EI0 bending stiffness at the base [N m^2], rho density
[kg/m^3], A0 cross-section at the base [m^2].

The tree itself is calibrated by quadrature over its real segments (`branch_beam`); these forms are
its check, and the way to calibrate a branch of which only length and taper are known.

"""

from __future__ import annotations

import math

from tree_sway_ros.errors import ParameterError

FIRST_ROOT_UNIFORM = 3.5160152685
"""First root of the uniform clamped beam, w1 sqrt(rho A L^4 / EI) [-] (Blevins, 1979)."""


def second_moment(diameter: float) -> float:
    """Second moment of area of a round section of that diameter [m], in [m^4]."""
    return math.pi / 64.0 * diameter**4


def key_stiffness(length: float, taper: float, bending_stiffness: float) -> float:
    """
    Moment per chord angle under the wind's distributed load.

    Parameters
    ----------
    length
        L in [m].
    taper
        tau in [-], 0 to 0.9.
    bending_stiffness
        EI at the base in [N m^2].

    Returns
    -------
    float
        k1 in [N m/rad].

    """
    _check_taper(taper)
    cubic = 4.0007 - 2.9596 * taper + 0.1307 * taper**2 - 0.1175 * taper**3
    return cubic * bending_stiffness / length


def key_stiffness_tip_load(length: float, taper: float, bending_stiffness: float) -> float:
    """Moment per chord angle under a load at the tip, ``3 (1 - tau) EI0 / L`` in [N m/rad]."""
    _check_taper(taper)
    return 3.0 * (1.0 - taper) * bending_stiffness / length


def key_inertia(length: float, taper: float, density: float, base_area: float) -> float:
    """
    Moment of inertia that gives the beam's first natural frequency with `key_stiffness`.

    Parameters
    ----------
    length
        L in [m].
    taper
        tau in [-], 0 to 0.9.
    density
        rho in [kg/m^3].
    base_area
        A0 in [m^2].

    Returns
    -------
    float
        I in [kg m^2].

    """
    _check_taper(taper)
    cubic = 0.32355 - 0.50827 * taper + 0.19575 * taper**2 + 0.00197 * taper**3
    return cubic * density * base_area * length**3


def rigid_inertia(length: float, taper: float, density: float, base_area: float) -> float:
    """Moment of inertia of the stiff tapered rod about its base in [kg m^2]; 1/3 if uniform."""
    _check_taper(taper)
    return (1.0 / 3.0 - taper / 2.0 + taper**2 / 5.0) * density * base_area * length**3


def load_lever(length: float, taper: float) -> float:
    """Distance from the base to the centre of a load proportional to diameter, in [m]."""
    _check_taper(taper)
    return (0.5 - taper / 3.0) / (1.0 - taper / 2.0) * length


def greenhill_length(bending_stiffness: float, weight_per_length: float) -> float:
    """
    Length at which an upright uniform stem buckles under its own weight.

    Parameters
    ----------
    bending_stiffness
        EI in [N m^2].
    weight_per_length
        rho A g in [N/m].

    Returns
    -------
    float
        ``(7.8373 EI / (rho A g))^(1/3)`` in [m] (Greenhill, 1881).

    """
    return math.pow(7.8373 * bending_stiffness / weight_per_length, 1.0 / 3.0)


def volume_rule_stiffness(volume: float, parent_volume: float, constant: float) -> float:
    """
    Stiffness the paper's way, from the volumes of the branch and of its parent.

    Kanda & Ohya (3.2) name the two volumes and leave the rule open; it is read here as their
    geometric mean.

    Parameters
    ----------
    volume, parent_volume
        In [m^3]; a stem is its own parent.
    constant
        Stiffness per volume in [N m/rad/m^3].

    Returns
    -------
    float
        k1 in [N m/rad].

    """
    return constant * math.sqrt(volume * parent_volume)


def _check_taper(taper: float) -> None:
    if not 0.0 <= taper <= 0.9:
        raise ParameterError(
            f"taper {taper} is outside 0 .. .9",
            where="beam calibration",
            cure="calibrate by quadrature over the segments",
        )
