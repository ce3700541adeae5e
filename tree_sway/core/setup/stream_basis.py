# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The basis in which the motion of a tree is streamed: its principal components.

The coordinates of a solver are orthogonal in mass and stiffness, so that far trees take the first
ones. A stream wants few numbers instead: a constant rotation R of the coordinates, (m, k), whose
columns are the proper orthogonal decomposition of the motion of the tips (Holmes et al. 2012,
*Turbulence, Coherent Structures, Dynamical Systems and Symmetry*, 3.1)::

    c = P q,  q ~ R c,  R^T G R = 1,  P = R^T G

q are coordinates, ``q^T G q`` is the squared motion of the tips of all branches. The covariance of
q is that of the responses to steady winds and gusts from all sides, calm to storm; no tree is run.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model import MARGIN, rounded, StateBasis
from tree_sway.core.setup.leaning_responses import Leaning
from tree_sway.core.setup.tree_motion import tip_moments, tip_motion

COUNTS = (16, 20, 24, 28, 32, 36)
"""Numbers of coordinates that are tried; a frame of 36 has 100 bytes."""

LEFT_OUT = 0.0015
"""Share of the motion of the tips by the responses that may be left out, root mean square."""

WEIGHTS = {3.0: 2.5, 8.0: 1.2, 13.0: 1.0, 20.0: 1.0, 36.0: 0.7}
"""Weight of the responses in each steady wind [m/s]; all have the same size otherwise."""

_REACH = 13.0
"""Steady wind [m/s] whose gusts set the scale of the coordinates, and the error."""

_STEADY = 4.0
"""Weight of equilibria over gusts, root mean square: least errors of trees of five kinds."""

_GUST = 3.0
"""Largest gust over the root mean square of gusts."""

_MOMENTS = 20
"""Moments of the gusts of an azimuth at which the error is found."""

_BETWEEN = 0.1
"""Motion between base and tip by a unit of a coordinate, over the length of its branch in [1]."""

_LEAST_SCALE = 1e-4
"""Smallest value of a coordinate that is within its scale, over the size of the tree."""

_STILL = 1e-12
"""Motion of all tips in [m], root of the sum of squares, that is none."""

_TINY = np.finfo(np.float64).tiny


def stream_arrays(
    branches: Records, shapes: Floats, responses: Iterable[Leaning]
) -> dict[str, Floats]:
    """
    Find the basis of a tree on its table, as arrays that can be stored.

    Parameters
    ----------
    branches
        Records of the branches.
    shapes
        Key rotations per unit of each coordinate, (N, m).
    responses
        Responses in the winds of `WEIGHTS`.

    Returns
    -------
    dict
        Arrays of a `SwayModel` of the group stream: R, (m, k), P, (k, m), and the rest.

    """
    moved = _moved(branches, shapes)
    inner = moved.T @ moved
    found = {each.speed: each for each in responses}
    motions = np.hstack([_weighted(inner, found[speed]) for speed in WEIGHTS])
    basis, projection = principal_components(inner, motions)
    scale = _scale(branches, _largest(found[_REACH], projection))
    poses = _gusty_poses(found[_REACH])
    missed = _missed(poses, basis, projection, scale)
    tips, _ = np.split(moved, [3 * len(branches)])
    error = _largest_motion(tips @ missed)
    return arrays_of_stream(StateBasis(basis, projection, scale, error))


def arrays_of_stream(basis: StateBasis) -> dict[str, Floats]:
    """Return a basis of coordinates as the arrays of a `SwayModel`."""
    return {
        'stream_shapes': basis.matrix,
        'stream_projection': basis.projection,
        'stream_scale': basis.scale,
        'stream_error': np.array([basis.error]),
    }


def basis_of_responses(branches: Records, responses: Floats, greatest: Floats) -> StateBasis:
    """
    Find the basis of a tree without a table, by its responses as key rotations.

    Parameters
    ----------
    branches
        Records of the branches.
    responses
        Key rotations by winds, multiplied by their weights, (N, c).
    greatest
        Poses in strong winds as key rotations in [rad], (N, p).

    """
    n_branches = len(branches)
    of_responses = _moved(branches, responses)
    inner = of_responses.T @ of_responses
    mixes, _ = principal_components(inner, np.eye(len(inner)))
    of_basis = of_responses @ mixes
    tips, between = np.split(of_basis, [3 * n_branches])
    moments = tip_moments(branches, tips.reshape(n_branches, 3, -1))
    moments += _between(branches) * between
    basis = responses @ mixes
    projection = moments.T
    amounts = projection @ greatest
    reach = np.abs(amounts).max(axis=1, initial=0.0)
    scale = _scale(branches, reach)
    missed = _missed(greatest, basis, projection, scale)
    error = _largest_motion(tip_motion(branches, missed))
    return StateBasis(basis, projection, scale, error)


def _scale(branches: Records, reach: Floats) -> Floats:
    """Return the full scale of coordinates by their largest values, (k,)."""
    return MARGIN * np.maximum(reach, _LEAST_SCALE * _size(branches))


def _missed(poses: Floats, basis: Floats, projection: Floats, scale: Floats) -> Floats:
    """Return what a stream in a basis leaves out of poses (m, p), and loses by rounding."""
    amounts = projection @ poses
    streamed = rounded(amounts.T, scale)
    return poses - basis @ streamed.T


def principal_components(inner: Floats, motions: Floats) -> tuple[Floats, Floats]:
    """
    Find the shapes that cover most of some motions, and the projection on them.

    Parameters
    ----------
    inner
        Inner products of the coordinates: G, (m, m).
    motions
        Motions, (m, any).

    Returns
    -------
    shapes, projection
        R, (m, k), and P, (k, m): the smallest number of `COUNTS` that suffices.

    """
    own_squares, axes = np.linalg.eigh(motions @ motions.T)
    factor = axes * np.sqrt(np.maximum(own_squares, 0.0))
    ascending, mixes = np.linalg.eigh(factor.T @ inner @ factor)
    squares = np.maximum(ascending[::-1], 0.0)
    count = _count_needed(squares)
    largest_first = mixes[:, ::-1]
    kept = largest_first[:, :count]
    shapes = factor @ (kept / np.sqrt(squares[:count]))
    # The largest number of each shape is positive.
    if count > 0:
        rows = np.abs(shapes).argmax(axis=0)
        largest = shapes[rows, np.arange(count)]
        shapes = shapes * np.sign(largest)
    return shapes, shapes.T @ inner


def _count_needed(squares: Floats) -> int:
    """Return the smallest of `COUNTS` that covers motions, by descending squares of shapes."""
    # Below rounding a shape is none.
    most = int((squares > 1e-14 * squares.max(initial=0.0)).sum())
    total = max(float(squares.sum()), _TINY)
    left_out = 1.0 - np.cumsum(squares) / total
    for count in COUNTS:
        if count >= most or left_out[count - 1] <= LEFT_OUT**2:
            return min(most, count)
    return min(most, COUNTS[-1])


def _moved(branches: Records, rotations: Floats) -> Floats:
    """Motion of the tips, and between bases and tips, in [m] by key rotations, (3 b + N, c)."""
    tips = tip_motion(branches, rotations).reshape(3 * len(branches), -1)
    return np.vstack([tips, _between(branches) * rotations])


def _between(branches: Records) -> Floats:
    """Motion between base and tip per unit of each key rotation in [m], (N, 1)."""
    length = np.linalg.norm(branches['tip'] - branches['base'], axis=1)
    of_coordinates = np.repeat(length, branches['n_coordinates'])
    return _BETWEEN * of_coordinates[:, None]


def _size(branches: Records) -> float:
    """Return the distance of all tips from the root node, as a motion of all tips, in [m]."""
    return float(np.linalg.norm(branches['tip'] - branches['base'][0]))


def _weighted(inner: Floats, response: Leaning) -> Floats:
    """Motions in a steady wind, (m, any), of the same size in every wind but for its weight."""
    by_coordinate = np.moveaxis(response.gusts, 2, 0)
    waves = by_coordinate.reshape(len(inner), -1)
    both_parts = np.hstack([waves.real, waves.imag])
    gusts = _of_size(1.0, both_parts, inner)
    steady = _of_size(_STEADY, response.poses.T, inner)
    return WEIGHTS[response.speed] * np.hstack([steady, gusts])


def _of_size(size: float, motions: Floats, inner: Floats) -> Floats:
    """Scale motions (m, any) to a root of the sum of their squares; zeros where they are still."""
    own_size = np.sqrt(np.einsum('mi,mi->', motions, inner @ motions))
    if not own_size > _STILL:
        return np.zeros_like(motions)
    return np.asarray(size / own_size * motions)


def _largest(response: Leaning, projection: Floats) -> Floats:
    """Find the largest value of each streamed coordinate in a steady wind and its gusts, (k,)."""
    still = np.abs(response.poses @ projection.T)
    swung = np.einsum('km,afmi->afki', projection, response.gusts)
    variance = np.square(np.abs(swung)).sum(axis=(1, 3))
    largest = still + _GUST * np.sqrt(variance)
    return np.asarray(largest.max(axis=0, initial=0.0))


def _gusty_poses(response: Leaning) -> Floats:
    """Return poses at some moments of the gusts of every azimuth, of seeded phases, (m, any)."""
    n_azimuths, n_frequencies, m, n_components = response.gusts.shape
    rng = np.random.default_rng(0)
    shape = _MOMENTS, n_azimuths, n_frequencies, n_components
    phases = rng.uniform(0.0, 2.0 * np.pi, shape)
    swings = np.einsum('afmi,tafi->tam', response.gusts, np.exp(1j * phases)).real
    poses = response.poses + np.sqrt(2.0) * swings
    return np.asarray(poses.reshape(-1, m).T)


def _largest_motion(tips: Floats) -> float:
    """Find the largest displacement of a tip by those of all tips in some poses, in [m]."""
    displacement = tips.reshape(-1, 3, tips.shape[-1])
    squares = np.square(displacement).sum(axis=1)
    return float(np.sqrt(squares.max(initial=0.0)))
