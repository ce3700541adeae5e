"""
The uncoupled simulator once more in plain numpy: oracle of the compiled kernels, and baseline of
their speed.

It takes the same records and follows the same formulas, but whole levels of the tree at a time,
with sines and cosines in place of series, and with subtree sums as differences of one cumulative
sum. What it must agree on with `SwaySimulator` is everything but rounding.

"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.branch.shapes import N_SHAPES
from tree_sway_ros.core.motion.drag import pressure
from tree_sway_ros.core.motion.uncoupled import UncoupledBank
from tree_sway_ros.core.oscillators.propagator import propagator
from tree_sway_ros.core.oscillators.two_axis import LOAD_MAX, guards
from tree_sway_ros.core.simulator.assembly import build_bank
from tree_sway_ros.core.simulator.simulator import LOAD_HELD, SwaySimulator
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.study.bench.numpy_rotation import (
    cayley_turned,
    quaternion_product,
    quaternion_rotated,
    quaternions_of,
    two_axis_moment,
)

_BLEND_FROM, _BLEND_TO, _STRETCH_TO = np.deg2rad([30.0, 45.0, 90.0]) ** 2


class NumpyTwin:
    """
    Step and place a tree as a simulator does, in numpy.

    Parameters
    ----------
    sim
        The simulator to follow; its state is not touched, the twin starts at rest.

    """

    def __init__(self, sim: SwaySimulator) -> None:
        """Take over what the simulator knows of its tree."""
        tree = sim.tree
        bank = build_bank(tree, sim.species, sim.settings)
        self._drag_law = sim.species.drag_law(bool(sim.settings.in_leaf))
        self._oscillators = bank.oscillators
        branches, segments = bank.branches, bank.segments
        self._branch: dict[str, Any] = {n: branches[n].copy() for n in branches.dtype.names}
        self._owner = tree.branch_of_segment
        rank = np.arange(tree.n_segments) - branches["first"][self._owner]
        at, lane = branches["block"][self._owner] + rank, branches["lane"][self._owner]
        self._segment: dict[str, Any] = {
            name: segments[name][at, ..., lane] for name in ("slope", "tip_slope", "chord", "rest")
        }
        self._subtree_end = tree.subtree_end
        order = tree.branch_order
        self._levels = [np.flatnonzero(order == k) for k in range(1, int(order.max()) + 1)]
        self._origin = tree.start[0]
        # Coordinates are pairs that share a shape, then twists; those that are not there come last
        # and stand still.
        column, pairs = np.arange(branches["push"].shape[1]), branches["n_pairs"][:, None]
        self._is_there = column < branches["n_coordinates"][:, None]
        shape = np.where(column < 2 * pairs, column // 2, N_SHAPES + column - 2 * pairs)
        self._shape = np.where(self._is_there, shape, 0)
        self._column = np.where(self._is_there, branches["coordinate"][:, None] + column, 0)
        chord, e1, e2 = (branches["frame"][:, None, k] for k in range(3))
        bends = np.where((column % 2 == 0)[:, None], e2, -e1)
        self._axis = np.where((column < 2 * pairs)[..., None], bends, chord)
        self._dt = 0.0
        b = tree.n_branches
        self.x, self.v, self._moment = np.zeros((3, b, 2))
        self._force, self._slip = np.zeros((2, b, 3))
        self._pull = np.zeros(b)

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """
        Advance one step.

        Parameters
        ----------
        wind_mean
            Mean of the wind over the step, the way the air goes, in [m/s], (3,).
        dt
            Length of the step in [s].

        Returns
        -------
        int
            0, or `LOAD_HELD`, as `SwaySimulator.step`.

        Raises
        ------
        ParameterError
            A model other than ``branch`` and ``subtree``.

        """
        bank = self._oscillators
        if not isinstance(bank, UncoupledBank):
            raise ParameterError(
                "the numpy twin steps uncoupled branches only",
                where="model",
                cure="use 'branch' or 'subtree'",
            )
        if dt != self._dt:
            self._set_step(bank, dt)
        wind = np.asarray(wind_mean, dtype=np.float64)
        per_speed_squared = pressure(float(np.linalg.norm(wind)), *self._drag_law)
        c = self._half[:, :, None]
        load = np.hstack([self._pull[:, None], self._moment])
        moment = two_axis_moment(self.x, 0.0 * self.v, load, 0.0 * self._pull, np.inf)
        middle_x = c[:, 0] * self.x + c[:, 1] * self.v + (c[:, 2] + c[:, 3]) * moment
        middle_v = c[:, 4] * self.x + c[:, 5] * self.v + (c[:, 6] + c[:, 7]) * moment
        base = self._ride(middle_x, middle_v) if bank.carries else np.zeros((len(self.x), 9))
        self._blow(base, middle_x, middle_v, wind, per_speed_squared)
        self._pull = self._generalise(base[:, 6:], bank.carries)
        return LOAD_HELD if self._advance(self._pull) else 0

    def place(self, out: Floats | None = None, rotations: Floats | None = None) -> Floats:
        """
        Place every segment.

        Parameters
        ----------
        out
            Where to write, (n, 7); a new array if None.
        rotations
            Key rotations in [rad], (N,), of any model; the twin's own if None.

        Returns
        -------
        Floats
            Pose block as that of `SwaySimulator.place`.

        """
        branch, segment, owner = self._branch, self._segment, self._owner
        angles = self._angles(self.x.ravel() if rotations is None else rotations)
        t = np.square(angles[:, :2]).sum(axis=1)
        blend = np.clip((t - _BLEND_FROM) / (_BLEND_TO - _BLEND_FROM), 0.0, 1.0)
        stretch = 1.0 + np.minimum(t, _STRETCH_TO) * (
            branch["skew"] + blend * (branch["tip_skew"] - branch["skew"])
        )
        slope = np.take_along_axis(segment["slope"], self._shape[owner], axis=1)
        bent = slope[:, 0] + blend[owner] * (segment["tip_slope"] - slope[:, 0])
        slope[:, :2] = (stretch[owner] * bent)[:, None]
        bend = quaternions_of(np.einsum("jc,jc,jck->jk", slope, angles[owner], self._axis[owner]))

        seat_angles = angles.copy()
        seat_angles[:, :2] *= (1.0 + np.minimum(t, _STRETCH_TO) * branch["skew"])[:, None]
        base = np.zeros((len(t), 4))
        base[0, 0] = 1.0
        for level in self._levels:
            parent = branch["parent"][level]
            slope = np.take_along_axis(branch["base_slope"][level], self._shape[parent], axis=1)
            turn = np.einsum("bc,bck->bk", slope * seat_angles[parent], self._axis[parent])
            base[level] = quaternion_product(base[parent], quaternions_of(turn))
        turned = quaternion_product(base[owner], bend)
        pose = quaternion_product(turned, segment["rest"])

        ahead = quaternion_rotated(turned, segment["chord"])
        reached = np.vstack([np.zeros(3), np.cumsum(ahead, axis=0)])
        first = branch["first"]
        within = reached[:-1] - reached[first][owner]
        start = np.zeros((len(t), 3))
        start[0] = self._origin
        for level in self._levels:
            seat = branch["base_segment"][level]
            offset = quaternion_rotated(pose[seat], branch["offset"][level])
            start[level] = start[owner[seat]] + within[seat] + offset

        poses = np.empty((len(owner), 7)) if out is None else out
        poses[:, :3] = start[owner] + within
        poses[:, 3:] = pose[:, [1, 2, 3, 0]]
        return poses

    def _set_step(self, bank: UncoupledBank, dt: float) -> None:
        self._whole = propagator(bank.inertia, bank.damping, bank.stiffness, dt)
        self._half = propagator(bank.inertia, bank.damping, bank.stiffness, 0.5 * dt)
        self._guard = guards(bank.inertia, bank.stiffness, dt, LOAD_MAX)
        flow = np.square(self._branch["flow"][:, :2]).sum(axis=(1, 2)) / 2.0
        self._compliance = flow * (self._half[:, 6] + self._half[:, 7])
        self._dt = dt

    def _angles(self, rotations: Floats) -> Floats:
        """
        Key rotations of each branch side by side, zeros where it has fewer than others, (b, c).

        """
        angles: Floats = np.where(self._is_there, rotations[self._column], 0.0)
        return angles

    def _ride(self, x: Floats, v: Floats) -> Floats:
        """Velocity (v, w) and rotation of each base, (b, 9)."""
        base = np.zeros((len(x), 9))
        for level in self._levels:
            parent, twist = self._branch["parent"][level], self._branch["twist"][level, :2]
            base[level, :6] = base[parent, :6] + np.einsum("bc,bck->bk", v[parent], twist)
            base[level, 6:] = base[parent, 6:] + np.einsum("bc,bck->bk", x[parent], twist[..., 3:])
        return base

    def _blow(
        self, base: Floats, x: Floats, v: Floats, wind: Floats, per_speed_squared: float
    ) -> None:
        """Force of the wind on each branch: quadratic drag, implicit in the branch's own motion."""
        branch, beta = self._branch, self._compliance
        motion = base[:, :3] + np.cross(base[:, 3:6], branch["centre"])
        motion += np.einsum("bc,bck->bk", v, branch["flow"][:, :2])
        turn = base[:, 6:] + np.einsum("bc,bck->bk", x, branch["turn"][:, :2])
        free = cayley_turned(-turn, branch["speed"][:, None] * wind - motion)
        free += beta[:, None] * self._slip
        xx, yy, zz, xy, xz, yz = branch["projector"].T
        matrix = np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=1).reshape(-1, 3, 3)
        across = np.einsum("bij,bj->bi", matrix, free)
        speed = np.sqrt(np.maximum(np.einsum("bi,bi->b", free, across), 0.0))
        c = per_speed_squared * branch["area"]
        share = 2.0 / (1.0 + np.sqrt(1.0 + 4.0 * beta * c * speed))
        self._slip = (c * speed * share**2)[:, None] * free
        force = cayley_turned(turn, (c * speed * share**2)[:, None] * across)
        self._force = force[branch["source"]]

    def _generalise(self, rotation: Floats, carries: bool) -> Floats:
        """Moments on the key rotations, kept; returns the pull along each chord."""
        branch, force = self._branch, self._force
        chord = branch["frame"][:, 0]
        met = cayley_turned(-rotation, force)
        self._moment = np.einsum("bck,bk->bc", branch["push"][:, :2], met)
        pull: Floats = branch["lever"] * np.einsum("bk,bk->b", chord, met)
        if carries:
            wrench = np.hstack([force, np.cross(branch["centre"], force)])
            total = np.vstack([np.zeros(6), np.cumsum(wrench, axis=0)])
            wrench = (total[self._subtree_end] - total[:-1])[1:]
            parent = branch["parent"][1:]
            handed = np.einsum("bck,bk->bc", branch["twist"][1:, :2], wrench)
            np.add.at(self._moment, parent, handed)
            along = np.einsum("bk,bk->b", chord[parent], wrench[:, :3])
            np.add.at(pull, parent, branch["axial_lever"][1:] * along)
        return pull

    def _advance(self, pull: Floats) -> int:
        """Step every oscillator, predictor and corrector; returns how many loads were held."""
        gyro, load_limit, moment_limit = self._guard.T
        load = np.hstack([pull[:, None], self._moment])
        size = np.linalg.norm(load, axis=1)
        held = size > load_limit
        load[held] *= (load_limit[held] / size[held])[:, None]
        c = self._whole[:, :, None]
        now = two_axis_moment(self.x, self.v, load, gyro, moment_limit)
        x = c[:, 0] * self.x + c[:, 1] * self.v + c[:, 2] * now
        v = c[:, 4] * self.x + c[:, 5] * self.v + c[:, 6] * now
        then = two_axis_moment(x + c[:, 3] * now, v + c[:, 7] * now, load, gyro, moment_limit)
        source = self._branch["source"]
        self.x = (x + c[:, 3] * then)[source]
        self.v = (v + c[:, 7] * then)[source]
        return int(held[source == np.arange(len(source))].sum())
