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
from tree_sway_ros.core.branch.beam import BranchBeam, SlopeShape, cross_matrix

N_SHAPES = 3
"""Bending shapes of an enriched stem, each about two axes."""

N_TWISTS = 3
"""Twists of an enriched stem."""

FEWER = 2
"""
Shapes, and twists, of any other enriched branch: a third gains 0.5 % of the motion and costs a half
more.

"""

MAX_COORDINATES = 2 * N_SHAPES + N_TWISTS

_NEGLIGIBLE = 1e-8


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
class Carried:
    """
    What each child of a branch hands down: sums over its subtree, about the root of the tree.

    Parameters
    ----------
    area, area_moment
        Drag area in [m^2], (c,), and its first moment in [m^3], (c, 3).
    mass, mass_moment, mass_second
        Mass in [kg], (c,), its first moment in [kg m], (c, 3), and second in [kg m^2], (c, 3, 3).

    """

    area: Floats
    area_moment: Floats
    mass: Floats
    mass_moment: Floats
    mass_second: Floats

    def __getitem__(self, children: Ints) -> Carried:
        """Pick some of the subtrees."""
        return Carried(
            self.area[children],
            self.area_moment[children],
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
    n_shapes: int = 1,
    n_twists: int = 0,
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
    n_shapes, n_twists
        Shapes it bends in, each about two axes, and twists; fewer where there are no more.

    Returns
    -------
    tuple of Coordinate
        The key rotation x, y; further pairs; twists.

    """
    e1, e2 = across(beam.chord)
    shapes = [_static_shape(beam, drag_area, carried)]
    twists: list[SlopeShape] = []
    if n_shapes > 1:
        inertia = 0.5 * (carried.spin(beam.child_point, e1) + carried.spin(beam.child_point, e2))
        while len(shapes) < n_shapes:
            bending = _inertia_moment(beam, mass, carried, inertia, shapes[-1])
            if not _extend(shapes, beam, bending / beam.second_moment):
                break
    if n_twists > 0:
        spin = carried.spin(beam.child_point, beam.chord)
        turn = np.ones(len(spin))
        while len(twists) < n_twists and len(spin):
            torque = beam.child_lever[1] @ (spin * turn)
            if not _extend(twists, beam, torque / beam.second_moment):
                break
            turn = twists[-1].child_slope
    ways = [Coordinate(shape, axis) for shape in shapes for axis in (e2, -e1)]
    return (*ways, *(Coordinate(twist, beam.chord, is_twist=True) for twist in twists))


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


def _extend(shapes: list[SlopeShape], beam: BranchBeam, curvature: Floats) -> bool:
    """Add what a curvature has that the shapes have not; tell whether there was any."""
    raw = SlopeShape(beam, curvature)
    energy = raw.stiffness(raw, 1.0)
    for shape in shapes:
        share = raw.stiffness(shape, 1.0) / shape.stiffness(shape, 1.0)
        raw = SlopeShape(beam, raw.curvature - share * shape.curvature)
    if not raw.stiffness(raw, 1.0) > _NEGLIGIBLE * energy:
        return False
    shapes.append(beam.unit_shape(raw.curvature))
    return True
