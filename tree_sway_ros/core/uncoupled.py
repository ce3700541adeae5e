"""
Rungs 1 and 2 of the ladder: every branch an oscillator of its own, on two axes.

Rung 1, `branch`, is the paper's: a branch feels its own wind and its own inertia. Rung 2, `subtree`, gives it the inertia of all it
carries and the moment of all the wind on it, and lets it ride on its parent; it still swings at a pace of its own.

The load is found once a step, at the state half a step on (exponential midpoint rule), and held over the step; what
depends on the branch's own angle is corrected once within the step (`two_axis.step_branch`).

"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.integrators.registry import DEFAULT, fill_steps
from tree_sway_ros.core.kernel import fused
from tree_sway_ros.core.layout import WORK
from tree_sway_ros.core.loads import blow, gather, generalised, ride
from tree_sway_ros.core.oscillators import fill_propagator
from tree_sway_ros.core.tree import Floats
from tree_sway_ros.core.two_axis import LOAD_MAX, fill_guards, step_branch, true_force


class UncoupledBank:
    """
    Oscillators of all branches.

    Parameters
    ----------
    branches
        Records of `BRANCH`, (b,); their compliance is set with the time step.
    inertia, damping, stiffness
        In [kg m^2], [N m s/rad] and [N m/rad], (b,).
    carries
        Whether branches carry their children (rung 2) or are alone (rung 1).
    integrator
        Method of the oscillators, one of `REAL_TIME`.

    """

    def __init__(
        self,
        branches: Any,
        inertia: Floats,
        damping: Floats,
        stiffness: Floats,
        carries: bool,
        integrator: str = DEFAULT,
    ) -> None:
        """Make room for the coefficients and the state."""
        n = len(branches)
        self.branches = branches
        self.inertia, self.damping, self.stiffness = inertia, damping, stiffness
        self.carries, self.integrator = carries, integrator
        self.work = np.zeros(n, dtype=WORK)
        self.state = np.zeros((5, 2 * n))
        self.x, self.v, self.moment, _, _ = self.state
        self._whole, self._half = np.zeros((2, n, 8))
        self._guard, self._pull = np.zeros((n, 3)), np.zeros(n)

    def set_step(self, dt: float) -> None:
        """Refill what depends on the time step [s]."""
        fill_steps(self.integrator, self.inertia, self.damping, self.stiffness, dt, self._whole)
        fill_propagator(self.inertia, self.damping, self.stiffness, 0.5 * dt, self._half)
        fill_guards(self.inertia, self.stiffness, dt, LOAD_MAX, self._guard)
        flow = np.square(self.branches["flow"][:, :2]).sum(axis=(1, 2)) / 2.0
        self.branches["compliance"] = flow * (self._half[:, 6] + self._half[:, 7])

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """
        Advance one step.

        Parameters
        ----------
        wx, wy, wz
            Mean wind over the step in [m/s].
        per_speed_squared
            `wind_load.pressure` in [kg/m^3].

        Returns
        -------
        int
            How many loads were held at their limit.

        """
        return int(
            _advance(
                self.branches, self.work, self.state, self._whole, self._half, self._guard, self._pull,
                self.carries, wx, wy, wz, per_speed_squared,
            )
        )  # fmt: skip

    def response(self, moments: Floats, circular: Floats) -> NDArray[np.complex128]:
        """Key rotations (N, k, f) under moments (N, k) [N m] that swing at w [rad/s], (f,), at rest geometry."""
        impedance = (
            self.stiffness[:, None]
            - self.inertia[:, None] * circular**2
            + 1j * self.damping[:, None] * circular
        )
        flexibility: NDArray[np.complex128] = np.repeat(1.0 / impedance, 2, axis=0)
        return moments[:, :, None] * flexibility[:, None, :]

    def rotations(self) -> Floats:
        """Key rotations in [rad], (2 b,)."""
        return self.x

    def reset(self) -> None:
        """Go back to rest."""
        self.state[:] = 0.0
        self.work[:] = np.zeros((), dtype=WORK)
        self._pull[:] = 0.0


@fused
def _advance(
    branches: Any, work: Any, state: Floats, whole: Floats, half: Floats, guard: Floats, pull: Floats,
    carries: bool, wx: float, wy: float, wz: float, per_speed_squared: float,
) -> int:  # fmt: skip
    x, v, moment, middle_x, middle_v = state[0], state[1], state[2], state[3], state[4]
    for b in range(len(branches)):
        h, i = half[b], 2 * b
        m = true_force(x[i], x[i + 1], pull[b], moment[i], moment[i + 1])
        for k in range(2):
            middle_x[i + k] = h[0] * x[i + k] + h[1] * v[i + k] + (h[2] + h[3]) * m[k]
            middle_v[i + k] = h[4] * x[i + k] + h[5] * v[i + k] + (h[6] + h[7]) * m[k]
    if carries:
        ride(branches, work, middle_x, middle_v)
    blow(branches, work, middle_x, middle_v, wx, wy, wz, per_speed_squared)
    if carries:
        gather(branches, work)
    generalised(branches, work, carries, moment, pull)
    held = 0
    for b in range(len(branches)):
        i, source = 2 * b, branches[b].source
        if source == b:
            c, g = whole[b], guard[b]
            x[i], x[i + 1], v[i], v[i + 1], over = step_branch(
                x[i], x[i + 1], v[i], v[i + 1], pull[b], moment[i], moment[i + 1],
                c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], g[0], g[1], g[2],
            )  # fmt: skip
            held += over
        else:
            for k in range(2):
                x[i + k], v[i + k] = x[2 * source + k], v[2 * source + k]
    return held
