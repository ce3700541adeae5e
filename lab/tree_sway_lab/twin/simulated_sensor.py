# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Motion sensors on a simulated tree: the definitions of their quantities, with faults."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.twin import GRAVITY


class SensedMotion(NamedTuple):
    """Times [s], (n,), specific force [m/s^2] and angular rate [rad/s], both (n, 3)."""

    time: Floats
    acceleration: Floats
    rate: Floats


@dataclass(frozen=True)
class SimulatedSensor:
    """
    How a sensor is mounted, and how well it measures.

    Parameters
    ----------
    mount
        Rotation from the sensor's frame to that of the segment.
    rate
        Samples per second in [Hz].
    noise, rate_noise
        Standard deviations of its acceleration [m/s^2] and of its angular rate [rad/s].
    has_gravity
        Whether gravity is in its acceleration.
    lateness
        Time in [s] by which its stamps are late.
    jitter
        Largest error of a stamp beyond that in [s].
    lost
        Share of the samples that are lost [-].
    bias
        Bias of its angular rate in [rad/s].
    tilt
        Bias of its acceleration, that of gravity by a sensor tilted by it, [rad].
    askew
        Rotation from the axes of its angular rate to those of its acceleration.

    """

    mount: Rotation = field(default_factory=Rotation.identity)
    rate: float = 60.0
    noise: float = 0.03
    rate_noise: float = 0.004
    has_gravity: bool = True
    lateness: float = 0.0
    jitter: float = 0.0
    lost: float = 0.0
    bias: float = 0.0
    tilt: float = 0.0
    askew: Rotation = field(default_factory=Rotation.identity)

    def measured(self, poses: Floats, dt: float, rng: np.random.Generator) -> SensedMotion:
        """
        Return what it measures at poses of its place after each step of dt [s], (n, 7).

        Stamps begin with the end of the first step, dt.
        """
        turn = Rotation.from_quat(poses[:, 3:]) * self.mount
        moved, spun = np.zeros((2, len(poses), 3))
        moved[1:-1] = np.diff(poses[:, :3], 2, axis=0) / dt**2
        spun[1:-1] = (turn[:-2].inv() * turn[2:]).as_rotvec() / (2.0 * dt)
        felt = turn.inv().apply(moved + np.array([0.0, 0.0, GRAVITY * self.has_gravity]))
        felt[:, 0] += GRAVITY * np.sin(self.tilt)
        spun = self.askew.inv().apply(spun)
        ends = dt * np.arange(1, len(poses) + 1)
        time = np.arange(dt, ends[-1] + 1e-9, 1.0 / self.rate)
        noisy = []
        for rows, deviation in ((felt, self.noise), (spun + self.bias, self.rate_noise)):
            read = np.stack([np.interp(time, ends, column) for column in rows.T], axis=1)
            noisy.append(read + deviation * rng.normal(size=read.shape))
        kept = rng.uniform(size=len(time)) >= self.lost
        stamps = time + self.lateness + self.jitter * rng.uniform(-1.0, 1.0, len(time))
        return SensedMotion(stamps[kept], noisy[0][kept], noisy[1][kept])
