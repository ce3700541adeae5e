"""
How far tips go in a wind that swings at one pace: linear response of every rung, before a step is taken.

Loads are split as turbulence is: along the mean wind, where the load goes with the square of the speed, and across it. The gain of a
rung is the motion of the tips of all branches, joined from the root, per unit of load at each frequency. Gains of two rungs can be
set against each other; that is how the error of the lesser one is known without running the greater.

"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.loads import even_wind_moments
from tree_sway_ros.core.tree import Floats

Complexes = NDArray[np.complex128]


class Responding(Protocol):
    """Oscillators whose steady answer to a swinging moment is known."""

    branches: Any
    carries: bool

    def response(self, moments: Floats, circular: Floats) -> Complexes:
        """Key rotations (N, k, f) under moments (N, k) that swing at w [rad/s], (f,)."""


def tip_response(oscillators: Responding, n_coordinates: int, frequencies: Floats) -> Complexes:
    """
    Motion of every tip under an even wind load of 1 N/m^2 drag pressure that swings.

    Parameters
    ----------
    oscillators
        A rung of a tree.
    n_coordinates
        N.
    frequencies
        In [Hz], (f,); 0 is the static answer.

    Returns
    -------
    Complexes
        Displacement of the tips per unit of load along x and along y, (b, 3, 2, f), in [m^3/N].

    """
    branches = oscillators.branches
    moments = even_wind_moments(branches, n_coordinates, carries=oscillators.carries)
    rotations = oscillators.response(moments, 2.0 * np.pi * np.asarray(frequencies))
    return tip_motion(branches, rotations)


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
    trailing = rotations.shape[1:]
    base = np.zeros((len(branches), 6, *trailing), dtype=rotations.dtype)
    tips = np.zeros((len(branches), 3, *trailing), dtype=rotations.dtype)
    for b, branch in enumerate(branches):
        if branch["parent"] >= 0:
            parent = branches[branch["parent"]]
            k = int(parent["n_coordinates"])
            ways = rotations[parent["coordinate"] : parent["coordinate"] + k]
            base[b] = base[branch["parent"]] + np.tensordot(branch["twist"][:k], ways, axes=(0, 0))
        k = int(branch["n_coordinates"])
        own = rotations[branch["coordinate"] : branch["coordinate"] + k]
        x, y, z = branch["tip"]
        vx, vy, vz, wx, wy, wz = base[b]
        tips[b] = np.tensordot(branch["reach"][:k], own, axes=(0, 0))
        tips[b, 0] += vx + wy * z - wz * y
        tips[b, 1] += vy + wz * x - wx * z
        tips[b, 2] += vz + wx * y - wy * x
    return tips
