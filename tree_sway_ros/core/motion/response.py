# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How far tips go in a wind that swings at one pace: linear response of every model, before a step is
taken.

Loads are split as turbulence is: along the mean wind, where the load goes with the square of the
speed, and across it. The gain of a model is the motion of the tips of all branches, joined from the
root, per unit of load at each frequency. Gains of two models can be set against each other; that is
how the error of the lesser one is known without running the greater.

"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.motion.numpy_passes import even_wind_moments

Complexes = NDArray[np.complex128]


class Responding(Protocol):
    """Oscillators whose steady answer to a swinging moment is known."""

    branches: Any
    carries: bool
    is_tabled: bool

    def response(self, moments: Floats, circular: Floats) -> Complexes:
        """Key rotations (N, k, f) under moments (N, k) that swing at w [rad/s], (f,)."""


def key_response(oscillators: Responding, n_coordinates: int, frequencies: Floats) -> Complexes:
    """
    Key rotations under an even wind load of 1 N/m^2 drag pressure that swings.

    Parameters
    ----------
    oscillators
        A model of a tree.
    n_coordinates
        N.
    frequencies
        In [Hz], (f,); 0 is the static answer.

    Returns
    -------
    Complexes
        Per unit of load along x and along y, (N, 2, f), in [m^2/N].

    """
    branches = oscillators.branches
    moments = even_wind_moments(branches, n_coordinates, carries=oscillators.carries)
    return oscillators.response(moments, 2.0 * np.pi * np.asarray(frequencies))


def tip_response(oscillators: Responding, n_coordinates: int, frequencies: Floats) -> Complexes:
    """
    Displacement of every tip under that load, (b, 3, 2, f), in [m^3/N]; arguments as of
    `key_response`.

    """
    return tip_motion(oscillators.branches, key_response(oscillators, n_coordinates, frequencies))


def tip_motion(branches: Any, rotations: NDArray[Any]) -> NDArray[Any]:
    """
    Join small rotations from the root to motions of the tips.

    Parameters
    ----------
    branches
        Records of `BRANCH`, (b,).
    rotations
        On the coordinates, (N, ...).

    Returns
    -------
    ndarray
        Displacement of the tip of each branch, (b, 3, ...).

    """
    base = base_motion(branches, rotations)
    tips = carried_to(base, branches["tip"])
    for tip, branch in zip(tips, branches, strict=True):
        k = int(branch["n_coordinates"])
        own = rotations[branch["coordinate"] : branch["coordinate"] + k]
        tip += np.tensordot(branch["reach"][:k], own, axes=(0, 0))
    return tips


def base_motion(branches: Any, rotations: NDArray[Any]) -> NDArray[Any]:
    """
    Motion (v, w) of the base of each branch about the root under small rotations (N, ...), (b, 6,
    ...).

    """
    base = np.zeros((len(branches), 6, *rotations.shape[1:]), dtype=rotations.dtype)
    for b, branch in enumerate(branches):
        if branch["parent"] >= 0:
            parent = branches[branch["parent"]]
            k = int(parent["n_coordinates"])
            moved = rotations[parent["coordinate"] : parent["coordinate"] + k]
            base[b] = base[branch["parent"]] + np.tensordot(branch["twist"][:k], moved, axes=(0, 0))
    return base


def carried_to(motion: NDArray[Any], points: Floats) -> NDArray[Any]:
    """
    Displacement of points (p, 3) that ride on bodies moving by (v, w) about the root, (p, 6, ...),
    (p, 3, ...).

    """
    x, y, z = points.T.reshape(3, -1, *(1,) * (motion.ndim - 2))
    wx, wy, wz = motion[:, 3], motion[:, 4], motion[:, 5]
    moved = motion[:, :3].copy()
    moved[:, 0] += wy * z - wz * y
    moved[:, 1] += wz * x - wx * z
    moved[:, 2] += wx * y - wy * x
    return moved
