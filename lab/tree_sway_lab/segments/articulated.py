# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tree as a chain of rigid segments, solved whole: the conventional method, slow and plain.

Every segment bends at one joint inside it (see `articulated_bodies`), the articulated-body
algorithm gives the accelerations in O(n) (`articulated_kernel`), springs and dampers are implicit
(`articulated_step`). It is the truth that reduced models are measured against.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import array_to_fill, one_of_each, refuse_time_step
from tree_sway.core.drag import AIR_DENSITY, STREAMLINING_FROM, STREAMLINING_TO
from tree_sway.core.tree import Tree
from tree_sway_lab.segments.articulated_bodies import articulated_bodies
from tree_sway_lab.segments.articulated_kernel import articulation_of, motion_of
from tree_sway_lab.segments.articulated_modes import (
    end_displacements,
    joint_modes,
    JointModes,
)
from tree_sway_lab.segments.articulated_pose import place_bodies, pose_block
from tree_sway_lab.segments.articulated_step import advance, Laws, scratch_of, State
from tree_sway_lab.segments.refinement import refined

RIGID_TWIST = 1e3
"""Stiffness in twist over that in bending by which joints hardly twist."""

LARGEST_TURN = 0.3
"""Most that a joint may turn in a step in [rad]: beyond it the springs follow no more."""

FASTEST_DECAY = 15.0
"""
Rate in [1/s] up to which modes are damped singly: that part is explicit and must suit steps of
1/60 s.

"""


class ArticulatedTree:
    """
    A tree of rigid segments on springs.

    Parameters
    ----------
    tree
        The tree.
    modulus, density
        Young's modulus in [Pa], also of each segment, (n,), and density in [kg/m^3] of the green
        wood.
    damping_ratio
        Of each of the lowest `damped_modes` in [-]; above them the ratio grows with the frequency,
        as by dampers in proportion to the springs. Not used where `rayleigh` is given.
    drag_coefficient, drag_exponent, steady_drag
        C, N and C0 of Cd = C U^-N + C0.
    gravity
        In [m/s^2]; the springs hold the rest shape against it.
    subdivisions
        Rigid pieces per segment.
    twist_ratio
        Stiffness of the joints in twist over that in bending, GJ/EI; by default they hardly twist.
    damped_modes
        How many modes get the same damping ratio, fewer where they would decay faster than
        `FASTEST_DECAY`.
    rayleigh
        Coefficients of damping by mass in [1/s] and by stiffness in [s].
    wind_factor
        Wind at each segment over the wind given to `step`, (n,); 1 if None.
    leaf_mass, leaf_area
        Leaves of each branch in [kg] and [m^2], (b,), spread evenly along it; none if None.
    root_stiffness
        Stiffness of the spring at the root in [N m/rad].

    """

    def __init__(
        self,
        tree: Tree,
        modulus: float | Floats,
        density: float,
        damping_ratio: float = 0.05,
        drag_coefficient: float = 1.2,
        *,
        drag_exponent: float = 0.0,
        steady_drag: float = 0.0,
        air_density: float = AIR_DENSITY,
        gravity: float = 0.0,
        subdivisions: int = 1,
        twist_ratio: float = RIGID_TWIST,
        damped_modes: int = 40,
        rayleigh: tuple[float, float] | None = None,
        wind_factor: ArrayLike | None = None,
        leaf_mass: Floats | None = None,
        leaf_area: Floats | None = None,
        root_stiffness: float = math.inf,
    ) -> None:
        self.tree = tree
        self.subdivisions = subdivisions
        cut = refined(tree, subdivisions)
        leaves = (self._along(leaf_mass), self._along(leaf_area))
        moduli = np.repeat(np.broadcast_to(modulus, tree.n_segments), subdivisions)
        self.bodies = articulated_bodies(
            cut, moduli, density, gravity, twist_ratio, *leaves, root_stiffness
        )
        n = cut.n_segments
        self.state = State(np.zeros((n, 4)), np.zeros((n, 3)))
        self._motion, self._articulation, self._scratch = (
            motion_of(n),
            articulation_of(n),
            scratch_of(n),
        )
        self._rotation, self._nodes = np.zeros((n, 3, 3)), np.zeros((3, n, 3))
        self._rest = tree.rest_frame
        self._wind = np.zeros((n, 3))
        factor = np.ones(tree.n_segments) if wind_factor is None else np.asarray(wind_factor)
        self._wind_factor = np.repeat(factor, subdivisions)[:, None]
        self._gravity, self._damped_modes = gravity, damped_modes
        none = np.zeros((0, n, 3))
        if rayleigh is None:
            damping = self._even_damping(damping_ratio, damped_modes)
        else:
            by_mass, by_stiffness = float(rayleigh[0]), float(rayleigh[1])
            damping = by_mass, by_stiffness, np.zeros(0), np.zeros(0), none, none
        self.laws = Laws(
            gravity,
            *damping,
            0.5 * air_density * drag_coefficient,
            drag_exponent,
            STREAMLINING_FROM,
            STREAMLINING_TO,
            0.5 * air_density * steady_drag,
        )
        self.reset()

    def _along(self, leaves: Floats | None) -> Floats:
        """Spread what leaves add to a branch over its length: that per metre of each piece."""
        tree = self.tree
        if leaves is None:
            return np.zeros(tree.n_segments * self.subdivisions)
        each = one_of_each('leaves', leaves, tree.n_branches, 'branch')
        return np.repeat((each / tree.branch_length)[tree.branch_of_segment], self.subdivisions)

    def reset(self) -> None:
        """Go back to rest."""
        self.state.turn[:] = [1.0, 0.0, 0.0, 0.0]
        self.state.rate[:] = 0.0

    def step(self, wind: ArrayLike, dt: float) -> bool:
        """
        Advance by dt in [s] under a wind in [m/s], (3,), or one per segment, (n, 3).

        Where a joint would turn by more than `LARGEST_TURN`, as that of a twig does in a gale, the
        step is taken in finer pieces. Returns whether that helped; if not the tree is at rest
        again.
        """
        refuse_time_step(dt, math.inf)  # it is taken in finer pieces where it fails
        wind = np.asarray(wind, dtype=np.float64)
        if wind.ndim == 2:
            wind = np.repeat(wind, self.subdivisions, axis=0)
        np.multiply(self._wind_factor, wind, out=self._wind)
        scratch = self._motion, self._articulation, self._scratch
        before = self.state.turn.copy(), self.state.rate.copy()
        for pieces in (1, 4, 16, 64, 256):
            for _ in range(pieces):
                advance(self.bodies, self.laws, self.state, self._wind, dt / pieces, *scratch)
                if not np.abs(self.state.rate).max() * dt / pieces <= LARGEST_TURN:
                    break
            else:
                return True
            self.state.turn[:], self.state.rate[:] = before
        self.reset()
        return False

    @property
    def node_positions(self) -> Floats:
        """End node of each segment in [m], (n, 3)."""
        self._place_bodies()
        return self._nodes[2, self.subdivisions - 1 :: self.subdivisions].copy()

    def place(self, out: Floats | None = None) -> Floats:
        """Pose of each segment at its start node, ``x y z qx qy qz qw``, (n, 7)."""
        shape = (self.tree.n_segments, 7)
        out = np.empty(shape) if out is None else array_to_fill('out', out, shape)
        self._place_bodies()
        _, start, end = self._nodes
        pose_block(
            self.bodies,
            self.state.turn,
            self._rest,
            self._rotation,
            start,
            end,
            self.subdivisions,
            out,
        )
        return out

    def linear_modes(self, count: int) -> tuple[Floats, Floats]:
        """
        Natural frequencies [Hz], lowest first, (count,), and the end nodes' shapes, (count, n, 3).

        The shapes have unit modal mass.
        """
        modes = joint_modes(self.bodies, self._gravity, count)
        shapes = end_displacements(self.bodies, modes.turn)
        return modes.frequency, shapes[:, self.subdivisions - 1 :: self.subdivisions]

    def _even_damping(
        self, ratio: float, count: int
    ) -> tuple[float, float, Floats, Floats, Floats, Floats]:
        """Damping of `Laws` at one ratio, by stiffness for the last mode; others add their own."""
        modes = joint_modes(self.bodies, self._gravity, count)
        circular = 2.0 * math.pi * modes.frequency
        slow = max(1, int(np.sum(ratio * circular <= FASTEST_DECAY)))
        modes, circular = JointModes(*(part[:slow] for part in modes)), circular[:slow]
        by_stiffness = 2.0 * ratio / float(circular[-1])
        by_mode = 2.0 * ratio * circular - by_stiffness * circular**2
        return 0.0, by_stiffness, by_mode, circular**2, modes.turn, modes.momentum

    def _place_bodies(self) -> None:
        place_bodies(self.bodies, self.state.turn, self._rotation, *self._nodes)
