# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Response to winds of the model `branch`, whose branches swing as if their bases were at rest."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model.drag_law import drag_density, DragLaw
from tree_sway.core.model.state_basis import StateBasis
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.oscillators.numpy_two_axis import two_axis_moment, within_guard
from tree_sway.core.setup.gust_responses import drag_slopes
from tree_sway.core.setup.numpy_branch_loads import Bases, NumpyPasses
from tree_sway.core.setup.one_thread import one_thread
from tree_sway.core.setup.stream_basis import basis_of_responses

_SPEEDS = (3.0, 9.0, 20.0, 36.0)
_AZIMUTHS = np.arange(16) * np.pi / 8.0
_EVERY = 3
"""Azimuths of steady winds from one with gusts to the next."""

_TURNS, _SHARE = 30, 0.4
"""Iterations for an equilibrium, and the share of the way that each goes."""
_COUNT, _BEYOND = 10, 1.5
"""Number of frequencies, and their range beyond those of the branches."""

_STEADY = 4.0
"""Weight of steady over gust responses, root mean square, as in `stream_basis`."""


@one_thread()
def basis_of_isolated(model: SwayModel, branches: Records) -> StateBasis:
    """Find the basis in which the motion of isolated branches is streamed."""
    oscillators = model.inertia, model.own_damping, model.stiffness
    responses = uncoupled_responses(branches, *oscillators, model.drag_law)
    return basis_of_responses(branches, *responses)


def uncoupled_responses(
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
    circular = np.sqrt(stiffness / inertia)
    swept = np.geomspace(circular.min() / _BEYOND, _BEYOND * circular.max(), _COUNT)
    spectrum = np.maximum(swept, circular.min()) ** (-1.0 / 3.0)
    passes = NumpyPasses(branches)
    ways = np.stack([np.cos(_AZIMUTHS), np.sin(_AZIMUTHS), np.zeros(len(_AZIMUTHS))], axis=1)
    load_mode, damping_mode = branches['load_mode'][:, :2], branches['damping_mode'][:, :2]
    steady, gusts = np.zeros((2, 0, 2 * len(branches)))
    for speed in _SPEEDS:
        per_speed = drag_density(speed, *law)
        still, swings = [], []
        for ahead in ways:
            still.append(_equilibrium(passes, stiffness, speed * ahead, per_speed))
        for ahead in ways[: len(ways) // 2 : _EVERY]:  # the opposite ones have the same slopes
            slope = drag_slopes(branches, ahead)
            # By the wind at the anemometer, in each of its components.
            by_wind = per_speed * speed * branches['speed'][:, None, None] * (load_mode @ slope)
            own = np.einsum('bck,bkl,bcl->bc', load_mode, slope, damping_mode)
            air = damping[:, None] + per_speed * speed * own
            free = stiffness - np.square(swept)[:, None] * inertia
            system = free[:, :, None] + 1j * swept[:, None, None] * air
            response = spectrum[:, None, None, None] * by_wind / system[..., None]
            rows = np.moveaxis(response, 3, 1).reshape(-1, 2 * len(branches))
            swings += [rows.real, rows.imag]
        steady = np.vstack([steady, _of_size(np.array(still), _STEADY)])
        gusts = np.vstack([gusts, _of_size(np.vstack(swings), 1.0)])
    return np.vstack([steady, gusts]).T, np.array(still).T


def _equilibrium(passes: NumpyPasses, stiffness: Floats, wind: Floats, density: float) -> Floats:
    """Find the key rotations (2 b,) of branches at rest in a wind [m/s], (3,)."""
    n = len(stiffness)
    x, still, at_rest = np.zeros((n, 2)), np.zeros((n, 2)), Bases.at_rest(n)
    for _ in range(_TURNS):
        impulse = np.zeros((n, 3))
        force = passes.wind_forces(at_rest, x, still, wind, density, np.zeros(n), impulse)
        load = passes.own_loads(passes.at_bases(x, force))
        moment = two_axis_moment(x, still, load, np.zeros(n), np.inf)
        x = within_guard(x + _SHARE * (moment / stiffness[:, None] - x))
    return np.asarray(x.ravel())


def _of_size(rows: Floats, size: float) -> Floats:
    """Scale rows to a root of the sum of their squares."""
    return np.asarray(size / max(float(np.linalg.norm(rows)), 1e-300) * rows)
