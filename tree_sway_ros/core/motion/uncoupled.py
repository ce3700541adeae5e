"""
Models 1 and 2 of the ladder: every branch an oscillator of its own, on two axes.

Model 1, `branch`, is the paper's: a branch feels its own wind and its own inertia. Model 2,
`subtree`, gives it the inertia of all it carries and the moment of all the wind on it, and lets it
ride on its parent; it still swings at a pace of its own.

The load is found once a step, at the state half a step on (exponential midpoint rule), and held
over the step; what depends on the branch's own angle is corrected once within the step
(`two_axis.step_branch`).

"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.kernel import fused
from tree_sway_ros.core.motion.records import LANES, SWAY, WORK
from tree_sway_ros.core.motion.tree_passes import carried, gather, press, refit, ride
from tree_sway_ros.core.oscillators.propagator import fill_propagator
from tree_sway_ros.core.oscillators.step_rules import DEFAULT, fill_steps
from tree_sway_ros.core.oscillators.two_axis import LOAD_MAX, fill_guards, step_branch, true_force
from tree_sway_ros.core.rotation import turned


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
        Whether branches carry their children (model 2) or are alone (model 1).
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
        self._pull = np.zeros(n)
        self._sway = np.zeros(-(-n // LANES), dtype=SWAY)
        block, lane = np.divmod(np.arange(n), LANES)
        for name, of in (
            ("centre", "centre"),
            ("flow", "flow"),
            ("lean", "turn"),
            ("push", "push"),
        ):
            values = branches[of] if name == "centre" else branches[of][:, :2]
            self._sway[name][block, ..., lane] = values
        self._sway["along"][block, :, lane] = branches["lever"][:, None] * branches["frame"][:, 0]

    def set_step(self, dt: float) -> None:
        """Refill what depends on the time step [s]."""
        n = len(self.branches)
        whole, half, guard = np.zeros((n, 8)), np.zeros((n, 8)), np.zeros((n, 3))
        fill_steps(self.integrator, self.inertia, self.damping, self.stiffness, dt, whole)
        fill_propagator(self.inertia, self.damping, self.stiffness, 0.5 * dt, half)
        fill_guards(self.inertia, self.stiffness, dt, LOAD_MAX, guard)
        held = half[:, [0, 1, 2, 4, 5, 6]]
        held[:, [2, 5]] += half[:, [3, 7]]
        block, lane = np.divmod(np.arange(n), LANES)
        for name, rows in (("whole", whole), ("half", held), ("guard", guard)):
            self._sway[name][block, :, lane] = rows
        self._sway["is_solved"][block, lane] = self.branches["source"] == np.arange(n)
        flow = np.square(self.branches["flow"][:, :2]).sum(axis=(1, 2)) / 2.0
        self.branches["compliance"] = flow * held[:, 5]
        refit(self._sway, self.branches)

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
                self.branches, self.work, self._sway, self.state, self._pull, self.carries,
                wx, wy, wz, per_speed_squared,
            )
        )  # fmt: skip

    def response(self, moments: Floats, circular: Floats) -> NDArray[np.complex128]:
        """
        Key rotations (N, k, f) under moments (N, k) [N m] that swing at w [rad/s], (f,), at rest
        geometry.

        """
        impedance = (
            self.stiffness[:, None]
            - self.inertia[:, None] * circular**2
            + 1j * self.damping[:, None] * circular
        )
        flexibility: NDArray[np.complex128] = np.repeat(1.0 / impedance, 2, axis=0)
        return moments[:, :, None] * flexibility[:, None, :]

    def memory(self) -> tuple[Floats, ...]:
        """Views of what is carried from one step to the next."""
        return self.x, self.v, self._sway["slip"], self._sway["load"]

    def rotations(self) -> Floats:
        """Key rotations in [rad], (2 b,)."""
        return self.x

    def reset(self) -> None:
        """Go back to rest."""
        self.state[:] = 0.0
        self.work[:] = np.zeros((), dtype=WORK)
        self._sway["slip"] = self._sway["load"] = 0.0


@fused
def _advance(
    branches: Any, work: Any, sway: Any, state: Floats, pull: Floats, carries: bool,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> int:  # fmt: skip
    x, v, moment, middle_x, middle_v = state[0], state[1], state[2], state[3], state[4]
    n = len(branches)
    for b in range(n):
        here, j = sway[b // LANES], b % LANES
        for k in range(2):
            here.x[k, j], here.v[k, j] = x[2 * b + k], v[2 * b + k]
    for block in range(len(sway)):
        _to_middle(sway[block])
    if carries:
        for b in range(n):
            here, j = sway[b // LANES], b % LANES
            for k in range(2):
                middle_x[2 * b + k], middle_v[2 * b + k] = here.middle_x[k, j], here.middle_v[k, j]
        ride(branches, work, middle_x, middle_v)
        for b in range(n):
            here, base, j = sway[b // LANES], work[b], b % LANES
            for k in range(6):
                here.velocity[k, j] = base.velocity[k]
            for k in range(3):
                here.base[k, j] = base.rotation[k]
    for block in range(len(sway)):
        _expose(sway[block])
        press(sway[block], wx, wy, wz, per_speed_squared)
    for b in range(n):
        here, j = sway[b // LANES], b % LANES
        if not here.is_solved[j]:
            _copy(here, j, sway, branches[b].source)
        for k in range(3):
            work[b].force[k] = here.force[k, j]
    for block in range(len(sway)):
        _meet(sway[block])
    for b in range(n):
        load, j = sway[b // LANES].load, b % LANES
        pull[b], moment[2 * b], moment[2 * b + 1] = load[0, j], load[1, j], load[2, j]
    if carries:
        gather(branches, work)
        carried(branches, work, moment, pull)
        for b in range(n):
            load, j = sway[b // LANES].load, b % LANES
            load[0, j], load[1, j], load[2, j] = pull[b], moment[2 * b], moment[2 * b + 1]
    held = 0
    for block in range(len(sway)):
        held += _step(sway[block])
    for b in range(n):
        here, j = sway[b // LANES], b % LANES
        if not here.is_solved[j]:
            here, j = sway[branches[b].source // LANES], branches[b].source % LANES
        for k in range(2):
            x[2 * b + k], v[2 * b + k] = here.x[k, j], here.v[k, j]
    return held


@fused
def _expose(sway: Any) -> None:
    """Set how the loads of sixteen branches move and are turned, half a step on."""
    velocity, centre, base, flow, lean = sway.velocity, sway.centre, sway.base, sway.flow, sway.lean
    x, v, motion, turn = sway.middle_x, sway.middle_v, sway.motion, sway.turn
    for j in range(LANES):
        cx, cy, cz = centre[0, j], centre[1, j], centre[2, j]
        rx, ry, rz = velocity[3, j], velocity[4, j], velocity[5, j]
        v0, v1, x0, x1 = v[0, j], v[1, j], x[0, j], x[1, j]
        motion[0, j] = velocity[0, j] + ry * cz - rz * cy + flow[0, 0, j] * v0 + flow[1, 0, j] * v1
        motion[1, j] = velocity[1, j] + rz * cx - rx * cz + flow[0, 1, j] * v0 + flow[1, 1, j] * v1
        motion[2, j] = velocity[2, j] + rx * cy - ry * cx + flow[0, 2, j] * v0 + flow[1, 2, j] * v1
        turn[0, j] = base[0, j] + lean[0, 0, j] * x0 + lean[1, 0, j] * x1
        turn[1, j] = base[1, j] + lean[0, 1, j] * x0 + lean[1, 1, j] * x1
        turn[2, j] = base[2, j] + lean[0, 2, j] * x0 + lean[1, 2, j] * x1


@fused
def _copy(here: Any, j: int, sway: Any, source: int) -> None:
    """Give a branch that copies the force on its source."""
    force, base, met = sway[source // LANES].force, here.base, here.met
    fx, fy, fz = force[0, source % LANES], force[1, source % LANES], force[2, source % LANES]
    here.force[0, j], here.force[1, j], here.force[2, j] = fx, fy, fz
    met[0, j], met[1, j], met[2, j] = turned(-base[0, j], -base[1, j], -base[2, j], fx, fy, fz)


@fused
def _meet(sway: Any) -> None:
    """Turn the wind's own forces on sixteen branches into loads, as `generalised`."""
    met, push, along, load = sway.met, sway.push, sway.along, sway.load
    for j in range(LANES):
        fx, fy, fz = met[0, j], met[1, j], met[2, j]
        load[0, j] = along[0, j] * fx + along[1, j] * fy + along[2, j] * fz
        load[1, j] = push[0, 0, j] * fx + push[0, 1, j] * fy + push[0, 2, j] * fz
        load[2, j] = push[1, 0, j] * fx + push[1, 1, j] * fy + push[1, 2, j] * fz


@fused
def _to_middle(sway: Any) -> None:
    """State of sixteen branches half a step on, under the last step's load."""
    x, v, load, h = sway.x, sway.v, sway.load, sway.half
    middle_x, middle_v = sway.middle_x, sway.middle_v
    for j in range(LANES):
        mx, my = true_force(x[0, j], x[1, j], load[0, j], load[1, j], load[2, j])
        middle_x[0, j] = h[0, j] * x[0, j] + h[1, j] * v[0, j] + h[2, j] * mx
        middle_x[1, j] = h[0, j] * x[1, j] + h[1, j] * v[1, j] + h[2, j] * my
        middle_v[0, j] = h[3, j] * x[0, j] + h[4, j] * v[0, j] + h[5, j] * mx
        middle_v[1, j] = h[3, j] * x[1, j] + h[4, j] * v[1, j] + h[5, j] * my


@fused
def _step(sway: Any) -> int:
    """Step sixteen branches; return how many loads were held."""
    x, v, load, c, g, is_solved = sway.x, sway.v, sway.load, sway.whole, sway.guard, sway.is_solved
    held = 0
    for j in range(LANES):
        x[0, j], x[1, j], v[0, j], v[1, j], over = step_branch(
            x[0, j], x[1, j], v[0, j], v[1, j], load[0, j], load[1, j], load[2, j],
            c[0, j], c[1, j], c[2, j], c[3, j], c[4, j], c[5, j], c[6, j], c[7, j],
            g[0, j], g[1, j], g[2, j],
        )  # fmt: skip
        held += over * is_solved[j]
    return held
