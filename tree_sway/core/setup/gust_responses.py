# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Response of a tree to gusts: linear motion of its modes in turbulence, damped by the air.

Branches of similar frequency are driven together, and the air couples them, so that a few patterns
describe the motion of many modes. Static responses cover slower and faster winds
(`static_responses`).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.drag import drag_density, DragLaw
from tree_sway.core.setup.modes import Modes
from tree_sway.core.setup.static_responses import direction
from tree_sway.core.setup.tree_motion import base_motion, own_motion, projectors

_SPEEDS = (3.0, 12.0)
_AZIMUTHS = (0.3, 0.3 + np.pi / 2.0)
"""The opposite ones have the same slopes."""

_COUNT, _BEYOND = 20, 1.5
"""Number of frequencies, and their range beyond those of the modes."""


def gust_responses(
    branches: Records, modes: Modes, tips: Floats, damping_ratio: Floats, law: DragLaw
) -> Floats:
    """
    Find the response to turbulence of several speeds and directions, of unit motion of the tips.

    Parameters
    ----------
    branches
        Records of the branches.
    modes, tips, damping_ratio
        Natural modes, the motion of the tips by each, (any, m), and the damping ratio of the wood
        in each, (m,).
    law
        Drag law of the whole tree.

    Returns
    -------
    numpy.ndarray
        Amounts of the modes, (m, k): the real and imaginary parts at each frequency.

    """
    circular = modes.circular
    slowest = circular[0]
    fastest = circular[-1]
    identity = np.eye(len(circular))
    swept = np.geomspace(slowest / _BEYOND, _BEYOND * fastest, _COUNT)[:, None]
    # Root of the spectrum w^(-5/3) over bands of width w, constant below the slowest mode.
    gusts = np.maximum(swept, slowest) ** (-1.0 / 3.0)
    in_vacuum = circular**2 - swept**2 + 2j * damping_ratio * circular * swept
    undamped = in_vacuum[:, :, None] * identity
    found = []
    for load, air in gust_slopes(branches, modes.shapes, *direction(_AZIMUTHS, 0.0)):
        for speed in _SPEEDS:
            air_damping = drag_density(speed, *law) * speed * air
            system = 1j * swept[:, :, None] * air_damping + undamped
            per_gust = np.linalg.solve(system, load)
            responses = gusts[:, :, None] * per_gust
            parts = np.concatenate([responses.real, responses.imag])
            by_mode = parts.swapaxes(0, 1)
            amounts = by_mode.reshape(len(circular), -1)
            found.append(amounts / np.linalg.norm(tips @ amounts))
    return np.hstack(found)


def gust_slopes(
    branches: Records, shapes: Floats, *winds: Floats
) -> Iterator[tuple[Floats, Floats]]:
    """
    Slopes of the load on shapes (N, m) in each wind (3,) of 1 kg/m^3, the tree at rest.

    Yielded are slopes by the wind, (m, 3), and, with the opposite sign, by the rates of the
    shapes, (m, m).
    """
    n_shapes = shapes.shape[1]
    base = base_motion(branches, shapes)
    at_rest = base[:, :3] + branches['coupling'].swapaxes(1, 2) @ base[:, 3:]
    pushed = at_rest + own_motion(branches, 'load_mode', shapes)
    damped = at_rest + own_motion(branches, 'damping_mode', shapes)
    work = pushed.reshape(-1, n_shapes).T
    speed = branches['speed'][:, None, None]
    for ahead in winds:
        slope = drag_slopes(branches, ahead)
        by_wind = work @ (speed * slope).reshape(-1, 3)
        by_rates = work @ (slope @ damped).reshape(-1, n_shapes)
        yield by_wind, by_rates


def drag_slopes(branches: Records, ahead: Floats) -> Floats:
    """
    Slopes of drag by the velocity of the air in a wind u of 1 kg/m^3, (b, 3, 3).

    Of the force ``A |u| P u``, with ``|u|^2 = u . P u``, it is ``A (|u| P + P u (P u)^T / |u|)``.
    """
    projector = projectors(branches['projector'])
    across = projector @ ahead
    square = np.maximum(across @ ahead, 1e-12)
    speed = np.sqrt(square)[:, None, None]
    outer = across[:, :, None] * across[:, None, :]
    area = branches['area'] * branches['speed']
    slopes = speed * projector + outer / speed
    return np.asarray(area[:, None, None] * slopes)
