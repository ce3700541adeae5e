# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How leaves flutter: an angle about their stalk from the speed of the air that passes them.

In light to moderate wind the rms speed of a leaf of size D is ``U_leaf = (U / 740)^2 D / nu``,
measured on oak, olive, magnolia, camphor and grass, whatever carries the leaf (Goldshmid et al.
2025, arXiv:2504.10584). A leaf that turns about its stalk by torsional galloping does so near its
own frequency f (Tadrist et al. 2015, on *Ficus benjamina*), its edge at D/2 from the stalk. Speed
over ``2 pi f D/2`` is then the angle, and the size drops out: amplitude ``a = sqrt(2) / (740^2 nu
pi f) U^2``. In strong wind leaves fold together and flutter does not grow (Tadrist et al. 2018):
the amplitude levels off at `LARGEST_ANGLE`, which is an estimate.

The law has two constants, so that it can be computed where leaves are drawn.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves.foliage import LeafClusters

AIR_VISCOSITY = 1.48e-5
"""Kinematic viscosity of air at 15 degrees C in [m^2/s]."""

FLUTTER_GAIN = float(np.sqrt(2.0) / (740.0**2 * AIR_VISCOSITY * np.pi))
"""Amplitude times frequency over the square of the wind speed in [rad Hz s^2/m^2]."""

LARGEST_ANGLE = 0.7
"""Amplitude at which flutter levels off in [rad]."""


def flutter_amplitude(speed: ArrayLike, frequency: ArrayLike) -> Floats:
    """Amplitude of the flutter [rad] in air at a speed [m/s], for a stalk's frequency [Hz]."""
    u = np.asarray(speed, dtype=np.float64)
    free = FLUTTER_GAIN * u * u / np.asarray(frequency, dtype=np.float64)
    return np.asarray(LARGEST_ANGLE * np.tanh(free / LARGEST_ANGLE))


def flutter_angle(clusters: LeafClusters, speed: ArrayLike, time: float) -> Floats:
    """Angle of each cluster about its stalk [rad], at a time [s] in air past each [m/s], (m,)."""
    swing = np.sin(2.0 * np.pi * clusters.frequency * time + clusters.phase)
    return np.asarray(flutter_amplitude(speed, clusters.frequency) * swing)


def leaf_poses(clusters: LeafClusters, poses: Floats, angle: ArrayLike = 0.0) -> Floats:
    """Pose block (m, 7) of the clusters, from the segments' (n, 7) and angles [rad], (m,)."""
    from scipy.spatial.transform import (
        Rotation,  # it takes long to load, and only drawing needs it
    )

    carrier = poses[clusters.segment]
    turn = Rotation.from_quat(carrier[:, 3:])
    flutter = np.zeros((len(clusters.segment), 3))
    flutter[:, 0] = angle
    own = Rotation.from_quat(clusters.orientation[:, [1, 2, 3, 0]])
    block = np.empty((len(clusters.segment), 7))
    block[:, :3] = carrier[:, :3] + turn.apply(clusters.offset)
    block[:, 3:] = (turn * own * Rotation.from_rotvec(flutter)).as_quat()
    return block


def leaf_list(clusters: LeafClusters) -> dict[str, object]:
    """
    Describe the leaves as plain numbers and lists, all that a viewer needs to draw them.

    A list per field of `LeafClusters`, rounded to 0.1 mm and 1e-4, and ``flutter`` with the law
    and its two constants.
    """
    columns = {name: np.round(values, 4).tolist() for name, values in vars(clusters).items()}
    law = 'largest_angle tanh(gain U^2 / (frequency largest_angle)) sin(2 pi frequency t + phase)'
    flutter = {'law': law, 'gain': FLUTTER_GAIN, 'largest_angle': LARGEST_ANGLE}
    return {**columns, 'flutter': flutter}
