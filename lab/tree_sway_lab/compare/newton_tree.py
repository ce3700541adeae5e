# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tree in Newton: the bodies of `MujocoTree` on rod joints, stepped by VBD on the processor.

A rod of Newton has one radius, and a tree has none: so every body is a link of its own and every
joint a rod joint with the bending and twisting stiffness of its segment. What holds the links
together is softer than wood, as the solver falls over where stretch is as stiff: `STRETCH`.
Newton knows no wind; forces are ours, found from its poses, and not part of what is timed. Needs
``pip install newton``.

"""

from __future__ import annotations

import importlib
import time
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.commands import bar
from tree_sway.core.arrays import Floats
from tree_sway_lab.compare.mujoco_tree import FRAME, MujocoTree, wind_wrenches
from tree_sway_lab.segments.articulated_bodies import articulated_bodies

SUBSTEPS, ITERATIONS = 20, 5
"""Substeps of VBD per frame, and iterations per substep."""

STRETCH = 1e5
"""Stiffness of the joints in stretch and shear in [N/m]."""


class NewtonTree:
    """
    A tree that Newton steps.

    Parameters
    ----------
    twin
        The tree in MuJoCo, whose joints are all damped by dampers.
    gravity
        In [m/s^2]; the springs hold the rest shape against it.

    """

    def __init__(self, twin: MujocoTree, gravity: float = 0.0) -> None:
        newton: Any = importlib.import_module('newton')
        warp: Any = importlib.import_module('warp')

        warp.config.quiet = True
        self.twin, self._warp = twin, warp
        bodies, scale = twin.bodies, twin.spring_scale
        moments = articulated_bodies(
            twin.tree, twin.species.modulus, twin.species.density, gravity, 1.0
        ).rest_torque
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, -gravity))
        place = np.zeros((len(bodies.mass) + 1, 3))
        links: list[int] = []
        joints: list[int] = []
        for i, carrier in enumerate(bodies.carrier.tolist()):
            place[i + 1] = place[carrier + 1] + bodies.arm[i]
            links.append(
                builder.add_link(
                    xform=warp.transform(place[i + 1], warp.quat_identity()),
                    com=warp.vec3(bodies.centre[i]),
                    inertia=warp.mat33(bodies.inertia[i]),
                    mass=float(bodies.mass[i]),
                )
            )
            axis = bodies.axis[i]
            bend, twist = scale * float(bodies.bend[i]), scale * float(bodies.twist[i])
            along = Rotation.align_vectors([axis], [[0.0, 0.0, 1.0]])[0]
            # The spring rests where the moment it bears against the weight has turned it back.
            about = (moments[i] @ axis) * axis
            unloaded = along.inv().apply((moments[i] - about) / bend + about / twist)
            frame = warp.quat(*along.as_quat())
            joints.append(
                builder.add_joint_rod(
                    parent=links[carrier] if carrier >= 0 else -1,
                    child=links[i],
                    parent_xform=warp.transform(bodies.arm[i], frame),
                    child_xform=warp.transform(np.zeros(3), frame),
                    rest_rotation=warp.quat(*Rotation.from_rotvec(unloaded).as_quat()),
                    stretch_stiffness=STRETCH,
                    bend_stiffness=bend,
                    bend_damping=twin.damping_time * bend,
                    twist_stiffness=twist,
                    twist_damping=twin.damping_time * twist,
                )
            )
        builder.add_articulation(joints)
        builder.color()
        self._model = builder.finalize(device='cpu')
        self._solver = newton.solvers.SolverVBD(self._model, iterations=ITERATIONS)
        self._states = self._model.state(), self._model.state()
        self._control = self._model.control()

    def race(self, wind: Floats) -> tuple[Floats, float]:
        """Tips (t, b, 3) in [m] after each frame, and the lowest tenth of CPU times in [s]."""
        tips = np.empty((len(wind), self.twin.tree.n_branches, 3))
        spent = np.empty(len(wind))
        for frame, blowing in enumerate(bar(list(wind), f'Newton, {SUBSTEPS} steps per frame')):
            wrench = self._wrenches(blowing)
            begun = time.process_time_ns()
            self._advance(wrench)
            spent[frame] = time.process_time_ns() - begun
            tips[frame] = self.tips()
        return tips, float(np.quantile(spent, 0.1)) * 1e-9

    def tips(self) -> Floats:
        """Tip of each branch in [m], (b, 3)."""
        bodies, last = self.twin.bodies, self.twin.tree.branch_first[1:] - 1
        pose = self._states[0].body_q.numpy()[last]
        ahead = bodies.reach[last, 1:] * bodies.axis[last]
        out: Floats = pose[:, :3] + Rotation.from_quat(pose[:, 3:]).apply(ahead)
        return out

    def _advance(self, wrench: Any) -> None:
        before, after = self._states
        for _ in range(SUBSTEPS):
            before.body_f.assign(wrench)
            self._solver.step(before, after, self._control, None, FRAME / SUBSTEPS)
            before, after = after, before
        self._states = before, after

    def _wrenches(self, wind: Floats) -> Any:
        """Return forces and moments on the bodies, (n, 6)."""
        bodies, state = self.twin.bodies, self._states[0]
        pose = np.vstack([[[0, 0, 0, 0, 0, 0, 1.0]], state.body_q.numpy()])
        moving = np.vstack([np.zeros((1, 6)), state.body_qd.numpy()])
        turn = Rotation.from_quat(pose[:, 3:]).as_matrix()
        centre = np.vstack([np.zeros(3), bodies.centre])
        arm = np.einsum('nij,nj->ni', turn, centre)
        velocity = moving[:, :3] - np.cross(moving[:, 3:], arm)
        wrench = wind_wrenches(
            bodies, self.twin.species, wind, pose[:, :3], turn, velocity, moving[:, 3:],
            pose[:, :3] + arm,
        )  # fmt: skip
        return self._warp.array(wrench[1:], dtype=self._warp.spatial_vector, device='cpu')
