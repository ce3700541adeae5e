# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Response to winds of the model `branch`, whose branches swing as if their bases were at rest."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.drag import drag_density, DragLaw
from tree_sway.core.model import BranchBlocks, StateBasis, SwayModel
from tree_sway.core.setup.gust_responses import drag_slopes
from tree_sway.core.setup.stream_basis import basis_of_responses
from tree_sway.core.setup.threads import one_thread

_SPEEDS = (3.0, 9.0, 20.0, 36.0)
_AZIMUTHS = np.arange(16) * np.pi / 8.0
_EVERY = 3
"""Azimuths of steady winds from one with gusts to the next."""

_COUNT = 10
"""Number of frequencies of gusts."""

_BEYOND = 1.5
"""Range of these frequencies beyond those of the branches."""

_STEADY = 4.0
"""Weight of steady over gust responses, root mean square, as in `stream_basis`."""


@one_thread()
def basis_of_isolated(model: SwayModel, branches: Records) -> StateBasis:
    """Find the basis in which the motion of isolated branches is streamed."""
    oscillators = model.inertia, model.own_damping, model.stiffness
    responses = _uncoupled_responses(branches, *oscillators, model.drag_law)
    return basis_of_responses(branches, *responses)


def _uncoupled_responses(
    branches: Records, inertia: Floats, damping: Floats, stiffness: Floats, law: DragLaw
) -> tuple[Floats, Floats]:
    """
    Find the responses of isolated branches to steady winds and gusts from all sides.

    Parameters
    ----------
    branches
        Records of isolated branches, with two key rotations each.
    inertia, damping, stiffness
        Oscillators of the branches in [kg m^2], [N m s] and [N m], (b,).
    law
        Drag law of the tree.

    Returns
    -------
    responses, strongest
        Key rotations, (2 b, c), multiplied by their weights, and those in the strongest of these
        steady winds in [rad], (2 b, any).

    """
    blocks = BranchBlocks(branches)
    oscillators = _Oscillators(inertia, damping, stiffness)
    ways = np.zeros((len(_AZIMUTHS), 3))
    ways[:, 0] = np.cos(_AZIMUTHS)
    ways[:, 1] = np.sin(_AZIMUTHS)
    with_gusts = ways[: len(ways) // 2 : _EVERY]  # the opposite ones have the same slopes
    all_steady = []
    all_gusts = []
    for speed in _SPEEDS:
        density = drag_density(speed, *law)
        steady = np.array([blocks.equilibrium(stiffness, speed * way, density) for way in ways])
        gusts = np.vstack(
            [_gust_response(branches, oscillators, way, density * speed) for way in with_gusts]
        )
        all_steady.append(_of_size(steady, _STEADY))
        all_gusts.append(_of_size(gusts, 1.0))
    responses = np.vstack(all_steady + all_gusts)
    return responses.T, steady.T


class _Oscillators(NamedTuple):
    """Inertia [kg m^2], damping [N m s] and stiffness [N m] of isolated branches, (b,)."""

    inertia: Floats
    damping: Floats
    stiffness: Floats


def _gust_response(
    branches: Records, oscillators: _Oscillators, ahead: Floats, density_speed: float
) -> Floats:
    """
    Find how branches swing in the gusts of a wind.

    At each frequency w it is ``g (k - w^2 I + i w (d + d_air))^-1 dM/dU``, with the root g of the
    spectrum ``w^(-5/3)`` over bands of width w, constant below the slowest branch.

    Parameters
    ----------
    branches, oscillators
        The branches.
    ahead
        Direction of the wind, (3,).
    density_speed
        `drag_density` times the speed, in [kg/m^2/s].

    Returns
    -------
    Floats
        Key rotations per speed of the gusts along each axis, (6 f, 2 b): the real parts of all f
        frequencies, then the imaginary ones.

    """
    inertia, damping, stiffness = oscillators
    circular = np.sqrt(stiffness / inertia)
    slowest = circular.min()
    swept = np.geomspace(slowest / _BEYOND, _BEYOND * circular.max(), _COUNT)
    gusts = np.maximum(swept, slowest) ** (-1.0 / 3.0)
    load_mode = branches['load_mode'][:, :2]
    damping_mode = branches['damping_mode'][:, :2]
    slope = drag_slopes(branches, ahead)
    by_wind = density_speed * branches['speed'][:, None, None] * (load_mode @ slope)
    by_rate = density_speed * np.einsum('bck,bkl,bcl->bc', load_mode, slope, damping_mode)
    air = damping[:, None] + by_rate
    free = stiffness - np.square(swept)[:, None] * inertia
    system = free[:, :, None] + 1j * swept[:, None, None] * air
    response = gusts[:, None, None, None] * by_wind / system[..., None]
    rows = np.moveaxis(response, 3, 1).reshape(-1, 2 * len(branches))
    return np.vstack([rows.real, rows.imag])


def _of_size(rows: Floats, size: float) -> Floats:
    """Scale rows to a root of the sum of their squares."""
    norm = max(float(np.linalg.norm(rows)), 1e-300)
    return np.asarray(size / norm * rows)
