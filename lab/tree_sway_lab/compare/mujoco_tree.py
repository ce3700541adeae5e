# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tree in MuJoCo: the same bodies, springs and drag in an independent engine.

The bodies are those of the articulated reference: each piece of a segment bends at one place, on
two hinges of stiffness ``1 / integral(ds / EI)`` across it, and twists on a third along it. Joints
thus placed are a little stiff (1 to 2 % at six segments per branch), so all springs are scaled by
one factor, the one that gives the beam's static sway of the stem's tip in a steady wind; the first
frequency then is within 0.5 % of the beam's (`agreement` measures both). Needs ``pip install
mujoco``.

"""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
from scipy import linalg
from scipy.sparse.linalg import eigsh, LinearOperator

from tree_sway.commands import bar
from tree_sway.core.arrays import Floats
from tree_sway.core.drag import AIR_DENSITY, STREAMLINING_FROM, STREAMLINING_TO
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.errors import MissingDependencyError
from tree_sway_lab.frame.frame import frame_model
from tree_sway_lab.segments.articulated_bodies import articulated_bodies, Bodies
from tree_sway_lab.segments.refinement import refined

_WARNINGS: list[str] = []
NO_TWIST = 500.0
"""Shear modulus over Young's from which on wood counts as not twisting at all."""

FRAME = 1.0 / 60.0
_TINY = 1e-6


def mujoco_module() -> Any:
    """
    Import MuJoCo.

    Raises
    ------
    MissingDependencyError
        If it is not installed.

    """
    try:
        import mujoco
    except ModuleNotFoundError as error:
        raise MissingDependencyError(
            'MuJoCo is not installed', cure='pip install mujoco'
        ) from error
    mujoco.set_mju_user_warning(_WARNINGS.append)  # else it writes a log into the current folder
    return mujoco


def take_warnings() -> list[str]:
    """Return what MuJoCo has warned of since this was last asked, each warning once."""
    taken = list(dict.fromkeys(_WARNINGS))
    _WARNINGS.clear()
    return taken


class MujocoTree:
    """
    A tree that MuJoCo steps.

    Parameters
    ----------
    tree, species
        The tree and its wood.
    damping_ratio
        In [-]: of each of the lowest 40 modes if `even`, else of the first, by dampers in
        proportion to the springs.
    even
        Whether the modes above the first get the same ratio. That takes a step of 1/500 s or less,
        as the dampers then no longer hold the stiff joints at long steps.
    match_beam
        Whether the springs are scaled to the beam's static sway; if not, they are the articulated
        reference's.
    gravity
        In [m/s^2]; constant moments on the joints hold the rest shape against it.
    pieces
        Rigid pieces per segment.

    """

    def __init__(
        self,
        tree: Tree,
        species: Species,
        damping_ratio: float,
        *,
        even: bool = True,
        match_beam: bool = True,
        gravity: float = 0.0,
        pieces: int = 1,
    ) -> None:
        mujoco = mujoco_module()
        tree = refined(tree, pieces)
        self.tree, self.species = tree, species
        self.bodies = articulated_bodies(
            tree, species.modulus, species.density, 0.0, 2.0 * species.shear_ratio
        )
        is_twisting = species.shear_ratio < NO_TWIST
        self.model = mujoco.MjModel.from_xml_string(_mjcf(self.bodies, is_twisting))
        self.model.opt.gravity[:] = 0.0, 0.0, -gravity
        self.data = mujoco.MjData(self.model)
        # The engine numbers its bodies as they nest; here they stand as segments do, the ground
        # first.
        names = ['world', *(f's{i}' for i in range(tree.n_segments))]
        self._body = np.array([self.model.body(name).id for name in names])
        self._step, self._forward = mujoco.mj_step, mujoco.mj_forward
        self._forward(self.model, self.data)
        self._holding = np.array(self.data.qfrc_bias)
        self._stem_tip = int(tree.branch_first[1]) - 1
        self._beam = frame_model(
            tree, species.modulus, species.density, subdivisions=4, shear_ratio=species.shear_ratio
        )
        self._momentum, self._gain = np.zeros((0, self.model.nv)), np.zeros(0)
        self._stiffness = np.array(self.model.jnt_stiffness)
        self._expected = self._beam_sway()
        self.spring_scale = self._sway() / self._expected if match_beam else 1.0
        self._stiffness *= self.spring_scale
        self.model.jnt_stiffness[:] = self._stiffness
        weight = self._stiffness_of_weight() if gravity else 0.0
        self._momentum, self._gain = self._set_damping(damping_ratio, 40 if even else 1, weight)

    def reset(self) -> None:
        """Go back to rest."""
        self.data.qpos[:] = 0.0
        self.data.qvel[:] = 0.0
        self._forward(self.model, self.data)

    def take(self, q: Floats, v: Floats) -> None:
        """Go to joint angles in [rad] and rates in [rad/s], in the engine's order."""
        self.data.qpos[:], self.data.qvel[:] = q, v
        self._forward(self.model, self.data)

    def moments(self, wind: Floats) -> Floats:
        """Moments of a wind in [m/s], (3,), on the joints as they are in [N m]."""
        self.blow(wind)
        return self._generalised() + np.asarray(self.data.qfrc_applied)

    def step(self, wind: Floats, dt: float) -> None:
        """Advance by dt in [s] under a wind in [m/s], (3,)."""
        self.blow(wind)
        self.advance(dt)

    def advance(self, dt: float) -> None:
        """Let MuJoCo step by dt in [s] under the forces as they stand."""
        self.model.opt.timestep = dt
        self._step(self.model, self.data)

    def race(self, wind: Floats) -> tuple[Floats, float]:
        """Tips (t, b, 3) in [m] at a step per frame, and the lowest tenth of CPU times in [s]."""
        tips, spent = np.empty((len(wind), self.tree.n_branches, 3)), np.empty(len(wind))
        self.reset()
        for frame, blowing in enumerate(bar(wind, 'MuJoCo, one step per frame')):
            self.blow(blowing)
            begun = time.process_time_ns()
            self.advance(FRAME)
            spent[frame] = time.process_time_ns() - begun
            tips[frame] = self.tips()
        return tips, float(np.quantile(spent, 0.1)) * 1e-9

    def blow(self, wind: Floats) -> None:
        """Set the forces of the wind in [m/s], (3,), and of what damping the joints do not do."""
        data = self.data
        data.xfrc_applied[self._body] = wind_wrenches(
            self.bodies, self.species, wind, *self._motion(), data.xipos[self._body]
        )
        rate = self._gain * (self._momentum @ data.qvel)
        data.qfrc_applied[:] = self._holding - self._momentum.T @ rate

    def tips(self) -> Floats:
        """Tip of each branch in [m], (b, 3)."""
        last = self.tree.branch_first[1:] - 1
        body = self._body[1 + last]
        turn = self.data.xmat.reshape(-1, 3, 3)[body]
        ahead = self.bodies.reach[last, 1:] * self.bodies.axis[last]
        tips: Floats = self.data.xpos[body] + np.einsum('nij,nj->ni', turn, ahead)
        return tips

    def agreement(self) -> tuple[float, float]:
        """First frequency, and static sway of the stem's tip in wind, over the beam model's."""
        lowest = float(self._beam.frequencies(1)[0])
        return float(self.frequencies[0]) / lowest, self._sway() / self._expected

    @property
    def frequencies(self) -> Floats:
        """Natural frequencies of its slowest modes at rest in [Hz], lowest first."""
        return self._circular / (2.0 * math.pi)

    def _beam_sway(self) -> float:
        """Sway of the stem's tip by the beam model, for a unit of wind pressure along x."""
        axis = self.bodies.axis
        across = np.array([1.0, 0.0, 0.0]) - axis[:, :1] * axis
        force = self.bodies.area.sum(axis=1) * np.linalg.norm(across, axis=1)
        moved = self._beam.static(force[:, None] * across)
        return float(moved[self._beam.end_node[self._stem_tip], 0])

    def _sway(self) -> float:
        """Sway of the stem's tip by the engine's own Jacobians, per unit of pressure along x."""
        tiny = 1e-3
        self.reset()
        self.blow(np.array([1.0, 0.0, 0.0]))
        coefficient, exponent = self.species.drag_law(in_leaf=False)
        pressure = 0.5 * AIR_DENSITY * coefficient * STREAMLINING_FROM**-exponent
        self.data.qpos[:] = tiny / pressure * self._generalised() / self._stiffness
        self._forward(self.model, self.data)
        sway = float(self.tips()[0, 0] - self.tree.end[self._stem_tip, 0]) / tiny
        self.reset()
        return sway

    def _generalised(self) -> Floats:
        mujoco = mujoco_module()
        out = np.zeros(self.model.nv)
        for body in range(1, self.model.nbody):
            wrench = self.data.xfrc_applied[body]
            mujoco.mj_applyFT(
                self.model, self.data, wrench[:3], wrench[3:], self.data.xipos[body], body, out
            )
        return out

    def _motion(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Joint, rotation, joint velocity, angular velocity of each body, the ground's first."""
        data = self.data
        centre = data.subtree_com[self.model.body_rootid]
        spin = data.cvel[:, :3]
        velocity = data.cvel[:, 3:] + np.cross(spin, data.xpos - centre)
        turn = data.xmat.reshape(-1, 3, 3)
        return data.xpos[self._body], turn[self._body], velocity[self._body], spin[self._body]

    def _momenta(self, rates: Floats) -> Floats:
        """Momenta of the joints by their rates, both (nv, k): the mass matrix times these."""
        out = np.empty(rates.T.shape)
        # One by one: the call for the whole matrix differs between versions.
        for momentum, rate in zip(out, np.ascontiguousarray(rates.T), strict=True):
            mujoco_module().mj_mulM(self.model, self.data, momentum, rate)
        return out.T

    def _stiffness_of_weight(self) -> Floats:
        """How the moments of the weight about the joints change with their angles, (nv, nv)."""
        out = np.empty((self.model.nv, self.model.nv))
        for joint in range(self.model.nv):
            self.data.qpos[:] = 0.0
            self.data.qpos[joint] = _TINY
            self._forward(self.model, self.data)
            out[joint] = (self.data.qfrc_bias - self._holding) / _TINY
        self.reset()
        return 0.5 * (out + out.T)

    @property
    def damping_time(self) -> float:
        """Damping of the joints over their stiffness in [s]."""
        return float(self.model.dof_damping[0] / self._stiffness[0])

    def _set_damping(
        self, ratio: float, count: int, weight: Floats | float
    ) -> tuple[Floats, Floats]:
        """Set dampers to the ratio of the last mode; modal forces give those below the rest."""
        root = np.sqrt(self._stiffness)
        n = len(root)
        if np.ndim(weight) > 0 or n <= 2 * count:
            by_springs = np.outer(root, root)
            inverse_square, vectors = linalg.eigh(
                self._momenta(np.eye(n)) / by_springs, np.eye(n) + weight / by_springs,
                subset_by_index=(max(n - count, 0), n - 1),
            )  # fmt: skip
        else:  # the whole mass matrix takes time with the cube of its size
            inverse_square, vectors = eigsh(
                LinearOperator(
                    (n, n), lambda x: self._momenta(x.reshape(n, 1) / root[:, None])[:, 0] / root
                ),
                count, which='LA', v0=np.ones(n),
            )  # fmt: skip
        self._circular: Floats = 1.0 / np.sqrt(inverse_square[::-1])
        modes = vectors[:, ::-1] / root[:, None] * self._circular
        by_stiffness = 2.0 * ratio / self._circular[-1]
        self.model.dof_damping[:] = by_stiffness * self._stiffness
        gain = 2.0 * ratio * self._circular - by_stiffness * self._circular**2
        return self._momenta(modes).T, gain


def wind_wrenches(
    bodies: Bodies,
    species: Species,
    wind: Floats,
    joint: Floats,
    turn: Floats,
    velocity: Floats,
    spin: Floats,
    centre: Floats,
) -> Floats:
    """
    Return forces in [N] and moments about centres of mass in [N m] of the wind, (n + 1, 6).

    Parameters
    ----------
    bodies, species
        The bodies and their wood.
    wind
        In [m/s], (3,).
    joint, turn, velocity, spin, centre
        For each body, the ground first: place of its joint in [m], rotation, velocity of the joint
        in [m/s], angular velocity in [rad/s] and centre of mass in [m].

    """
    carrier = bodies.carrier + 1
    root_side = np.einsum('nij,nj->ni', turn[carrier], bodies.axis) * bodies.reach[:, :1]
    tip_side = np.einsum('nij,nj->ni', turn[1:], bodies.axis) * bodies.reach[:, 1:]
    chord = root_side + tip_side
    chord /= np.linalg.norm(chord, axis=1)[:, None]
    middle = velocity[1:] + 0.5 * np.cross(spin[1:], tip_side)
    middle -= 0.5 * np.cross(spin[carrier], root_side)
    air = wind - middle
    across = air - np.einsum('ni,ni->n', air, chord)[:, None] * chord
    speed = float(np.clip(np.linalg.norm(wind), STREAMLINING_FROM, STREAMLINING_TO))
    coefficient, exponent = species.drag_law(in_leaf=False)
    pressure = 0.5 * AIR_DENSITY * coefficient * speed**-exponent
    force = pressure * np.linalg.norm(across, axis=1)[:, None] * across
    wrench = np.zeros((len(joint), 6))
    tip_force, root_force = bodies.area[:, 1:] * force, bodies.area[:, :1] * force
    _push(wrench, np.arange(1, len(joint)), joint[1:] + 0.5 * tip_side, tip_force, centre)
    _push(wrench, carrier, joint[1:] - 0.5 * root_side, root_force, centre)
    wrench[0] = 0.0
    return wrench


def _push(wrench: Floats, body: Any, place: Floats, force: Floats, centre: Floats) -> None:
    np.add.at(wrench, body, np.hstack([force, np.cross(place - centre[body], force)]))


def _mjcf(bodies: Bodies, is_twisting: bool) -> str:
    """Write the model: a body a segment, with its frame at its joint and its axes the world's."""
    children: list[list[int]] = [[] for _ in range(len(bodies.mass) + 1)]
    for i, carrier in enumerate(bodies.carrier):
        children[carrier + 1].append(i)
    lines = [
        '<mujoco><compiler angle="radian"/><option gravity="0 0 0" integrator="implicitfast">',
        '<flag contact="disable"/></option><size memory="256M"/><worldbody>',
    ]
    stack = [(i, False) for i in reversed(children[0])]
    while stack:
        i, is_done = stack.pop()
        if is_done:
            lines.append('</body>')
            continue
        lines.append(_body(bodies, i, is_twisting))
        stack.append((i, True))
        stack += [(k, False) for k in reversed(children[i + 1])]
    lines.append('</worldbody></mujoco>')
    return '\n'.join(lines)


def hinge_axes(along: Floats) -> tuple[Floats, Floats]:
    """Axes of the two hinges of a segment that points along a unit vector."""
    aside = np.array([0.0, 0.0, 1.0]) if abs(along[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
    first = np.cross(along, aside)
    first /= np.linalg.norm(first)
    return first, np.cross(along, first)


def _body(bodies: Bodies, i: int, is_twisting: bool) -> str:
    springs = [(axis, bodies.bend[i]) for axis in hinge_axes(bodies.axis[i])]
    if is_twisting:
        springs.append((bodies.axis[i], bodies.twist[i]))
    hinges = ''.join(
        f'<joint type="hinge" axis="{_text(axis)}" stiffness="{stiffness:.17g}"/>'
        for axis, stiffness in springs
    )
    J = bodies.inertia[i]
    inertia = _text(J[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]])
    return (
        f'<body name="s{i}" pos="{_text(bodies.arm[i])}">{hinges}<inertial '
        f'pos="{_text(bodies.centre[i])}" mass="{bodies.mass[i]:.17g}" fullinertia="{inertia}"/>'
    )


def _text(values: Floats) -> str:
    return ' '.join(f'{v:.17g}' for v in values)
