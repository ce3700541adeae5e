# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tree in DART: the bodies, hinges, springs and dampers of `MujocoTree` in another engine.

Wind and tips are found by MuJoCo's model in the state of DART's; neither is part of what is timed.
Needs ``pip install mujoco dartpy``.

"""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from tree_sway.commands import bar
from tree_sway.core.arrays import Floats
from tree_sway_lab.compare.mujoco_tree import FRAME, hinge_axes, MujocoTree


class DartTree:
    """
    A tree that DART steps.

    Parameters
    ----------
    twin
        The tree in MuJoCo, whose joints are all damped by dampers.
    dt
        Step in [s].

    """

    def __init__(self, twin: MujocoTree, dt: float = FRAME) -> None:
        import dartpy

        self.twin, bodies = twin, twin.bodies
        self._world, self._skeleton = dartpy.simulation.World(), dartpy.dynamics.Skeleton()
        self._world.setGravity([0.0, 0.0, 0.0])
        self._world.setTimeStep(dt)
        placed: list[Any] = []
        joints = []
        for i, carrier in enumerate(bodies.carrier):
            first = int(twin.model.body(f's{i}').jntadr[0])
            hinge = dartpy.dynamics.UniversalJointProperties()
            hinge.mAxis = list(hinge_axes(bodies.axis[i]))
            hinge.mSpringStiffnesses = twin.model.jnt_stiffness[first : first + 2]
            hinge.mDampingCoefficients = twin.model.dof_damping[first : first + 2]
            rest = dartpy.math.Isometry3()
            rest.set_translation(bodies.arm[i])
            hinge.mT_ParentBodyToJoint = rest
            joint, body = self._skeleton.createUniversalJointAndBodyNodePair(
                placed[carrier] if carrier >= 0 else None, hinge
            )
            tensor = bodies.inertia[i]
            body.setInertia(dartpy.dynamics.Inertia(bodies.mass[i], bodies.centre[i], tensor))
            body.setCollidable(False)
            placed.append(body)
            joints.append((joint.getIndexInSkeleton(0), first))
        self._world.addSkeleton(self._skeleton)
        # Where each of DART's degrees of freedom is among MuJoCo's.
        self._order = np.zeros(2 * len(placed), dtype=np.int64)
        for own, theirs in joints:
            self._order[own : own + 2] = theirs, theirs + 1

    def race(self, wind: Floats) -> tuple[Floats, float]:
        """Tips at each frame in [m], (t, b, 3), and the lowest tenth of a step's CPU times [s]."""
        tips = np.empty((len(wind), self.twin.tree.n_branches, 3))
        spent = np.empty(len(wind))
        self.twin.reset()
        for frame, blowing in enumerate(bar(list(wind), 'DART, one step per frame')):
            self._skeleton.setForces(self.twin.moments(blowing)[self._order])
            begun = time.process_time_ns()
            self._world.step()
            spent[frame] = time.process_time_ns() - begun
            q, v = np.empty((2, len(self._order)))
            q[self._order] = self._skeleton.getPositions()
            v[self._order] = self._skeleton.getVelocities()
            self.twin.take(q, v)
            tips[frame] = self.twin.tips()
        return tips, float(np.quantile(spent, 0.1)) * 1e-9
