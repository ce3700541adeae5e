# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The drag on all panels of a branch, fitted by a few numbers.

They are the centre of the load, the projector across the branch, and the mean displacements that
the load works on and damps. Symmetric matrices are stored as xx, yy, zz, xy, xz, yz.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.rotation import cross, cross_matrix
from tree_sway.core.setup.beams.beam import stacked
from tree_sway.core.setup.beams.branch_model import BranchModel
from tree_sway.core.setup.beams.wind_on_branch import exposure
from tree_sway.core.setup.slanting_winds import SlantingWinds
from tree_sway.core.setup.tree_motion import projectors

_STRAIGHT = 0.03
"""Smallest share of the wind along a branch that is distinguished from 0."""

_CROOKED = 1e-9
"""Largest deviation of the cosine between panels from 1 of a branch that is straight."""

_ROWS, _COLUMNS = [0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]
"""Places of the six numbers of a symmetric matrix."""


class _Panels(NamedTuple):
    """Panels of k branches that all have p panels, g points in each, and n fields."""

    point: Floats
    """Points from the base, (k, p, g, 3)."""
    tangent: Floats
    """Direction of each panel, (k, p, 3)."""
    area: Floats
    """Drag area of each branch in [m^2], (k,)."""
    share: Floats
    """Fraction of that area at each point, (k, p, g)."""
    displacement: Floats
    """Displacement of each point per unit of each coordinate, (k, n, p, g, 3)."""
    rotation: Floats
    """Rotation vector there, likewise."""
    tip: Floats
    """Displacement of the tip, (k, n, 3)."""

    @property
    def panel_share(self) -> Floats:
        """Fraction of the area of the branch in each panel, (k, p)."""
        return np.asarray(self.share.sum(axis=2))


def _panels_of(models: list[BranchModel]) -> _Panels:
    """Stack the panels of branches."""
    beams = [model.beam for model in models]
    weight = np.array([model.drag_area for model in models]) * stacked(beams, 'weight')
    area = weight.sum(axis=(1, 2))
    # Coordinate by coordinate, the fields of all branches.
    by_coordinate = list(zip(*(model.fields for model in models), strict=True))

    def of_fields(name: str) -> Floats:
        return np.stack([stacked(fields, name) for fields in by_coordinate], axis=1)

    return _Panels(
        point=stacked(beams, 'point'),
        tangent=stacked(beams, 'tangent'),
        area=area,
        share=weight / area[:, None, None],
        displacement=of_fields('points'),
        rotation=of_fields('slope'),
        tip=of_fields('nodes')[:, :, -1],
    )


def fill_loads(
    models: list[BranchModel], speed_profile: Floats, rows: Ints, records: Records
) -> None:
    """
    Fill the fields of the wind load of branches that all have p panels and n fields.

    Parameters
    ----------
    models
        The k branches.
    speed_profile
        Wind speed at their panels over that at the anemometer, (k, p).
    rows
        Rows of the branches in the records, (k,).
    records
        Records of `Branch`, written.

    """
    panels = _panels_of(models)
    n_fields = panels.tip.shape[1]
    records['tip_mode'][rows, :n_fields] = panels.tip
    _fill_area(panels, speed_profile, rows, records)
    projector = _fill_projector(panels, rows, records)
    mean = _mean_across(panels)
    records['load_mode'][rows, :n_fields] = mean @ _inverse_of(projector)
    squares = _squares_across(panels)
    records['load_rotation'][rows, :n_fields] = _mean_rotation(panels, squares)
    for k in np.flatnonzero(_is_crooked(panels.tangent)):
        _fit_crooked(models[k], panels.share[k], records[rows[k]])
    _fill_damping(panels, squares, mean, rows, records)


def _is_crooked(tangent: Floats) -> Floats:
    """Whether panels of branches have other directions than the first, (k,)."""
    cosine = (tangent * tangent[:, :1]).sum(axis=2)
    return np.asarray(np.abs(cosine - 1.0).max(axis=1) > _CROOKED)


def _fill_area(panels: _Panels, speed_profile: Floats, rows: Ints, records: Records) -> None:
    """Fill where the wind acts on branches, its speed there, and on how much area."""
    centre = np.einsum('ksg,ksgi->ki', panels.share, panels.point)
    speed = (panels.panel_share * speed_profile).sum(axis=1)
    still = np.zeros_like(speed)
    records['centre'][rows] = centre
    records['coupling'][rows] = cross_matrix(centre)
    records['speed'][rows] = speed
    records['area'][rows] = np.divide(panels.area, speed**2, out=still, where=speed > 0.0)


def _fill_projector(panels: _Panels, rows: Ints, records: Records) -> Floats:
    """Fill the mean of ``1 - t t^T`` over the panels, tangents t; return it, (k, 3, 3)."""
    weighted = panels.panel_share[:, None] * panels.tangent.swapaxes(1, 2)
    projector = np.eye(3) - weighted @ panels.tangent
    records['projector'][rows] = projector[:, _ROWS, _COLUMNS]
    return np.asarray(projector)


def _inverse_of(projector: Floats) -> Floats:
    """
    Invert projectors (k, 3, 3) across the branches.

    The wind along a straight branch exerts no force on it, and that direction is left out.
    """
    amounts, axes = np.linalg.eigh(projector)
    is_across = amounts > _STRAIGHT * amounts[:, -1:]
    inverse = np.divide(1.0, amounts, out=np.zeros_like(amounts), where=is_across)
    return np.asarray((axes * inverse[:, None]) @ axes.swapaxes(1, 2))


def _mean_across(panels: _Panels) -> Floats:
    """Find the mean displacement across the panels, weighted by their exposure, (k, n, 3)."""
    tangent = panels.tangent[:, None]
    exposed = exposure(panels.tangent)
    exposed /= (panels.panel_share * exposed).sum(axis=1, keepdims=True)
    of_points = panels.share[:, None, ..., None] * panels.displacement
    of_panels = exposed[:, None, :, None] * of_points.sum(axis=3)
    along = (of_panels * tangent).sum(axis=-1, keepdims=True)
    across = of_panels - along * tangent
    return np.asarray(across.sum(axis=2))


def _squares_across(panels: _Panels) -> Floats:
    """Sum the squared displacements of points across their panels by both axes, (k, p, g)."""
    by_keys = panels.displacement[:, :2]
    tangent = panels.tangent[:, None, :, None]
    along = (by_keys * tangent).sum(axis=-1)
    whole_squares = np.square(by_keys).sum(axis=-1)
    across_squares = whole_squares - np.square(along)
    return np.asarray(across_squares.sum(axis=1))


def _mean_rotation(panels: _Panels, squares: Floats) -> Floats:
    """
    Return the rotation of a branch where the wind works on it, (k, n, 3).

    Points that move most do most work, and are rotated most: their displacements across, of
    `_squares_across`, are the weights.
    """
    n_branches, n_fields = panels.rotation.shape[:2]
    distance = np.sqrt(np.maximum(squares, 0.0))
    moved = panels.share * distance
    weight = moved.reshape(n_branches, 1, 1, -1)
    whole = weight.sum(axis=-1, keepdims=True)
    weight /= np.where(whole > 0.0, whole, 1.0)
    rotation = panels.rotation.reshape(n_branches, n_fields, -1, 3)
    mean = weight @ rotation
    return np.asarray(mean[:, :, 0])


def _fit_crooked(model: BranchModel, share: Floats, record: np.void) -> None:
    """
    Fit projector, coupling and load mode of a crooked branch to its drag (least squares).

    Of a projector P and a wind u the force is ``sqrt(u . P u) P u``. P is fitted to the drag of
    the panels in `SlantingWinds`, then what a unit of that force exerts as a moment (the coupling)
    and on each coordinate (the load mode). ``share`` is the fraction of the area at each point,
    (p, g).
    """
    tangent = model.beam.tangent
    slanting = SlantingWinds(model.beam.chord)
    winds = slanting.winds
    record['projector'] = _nearest_projector(slanting, tangent, share)
    projector = projectors(record['projector'])
    across = winds @ projector
    square = (winds * across).sum(axis=1)
    speed = np.sqrt(np.maximum(square, 0.0))
    force = speed[:, None] * across
    per_force = np.linalg.pinv(force, rcond=_STRAIGHT)

    along = (winds @ tangent.T)[..., None] * tangent
    panel_force = winds[:, None] - along
    panel_force *= np.linalg.norm(panel_force, axis=-1, keepdims=True)
    of_points = share[..., None]
    point = (of_points * model.beam.point).sum(axis=1)
    moment = cross(point, panel_force).sum(axis=1)
    missing_moment = moment - force @ record['coupling'].T
    record['coupling'] += (per_force @ missing_moment).T

    load_mode = record['load_mode'][: len(model.fields)]
    moved = np.stack([(of_points * field.points).sum(axis=1) for field in model.fields])
    work = np.einsum('dsk,csk->dc', panel_force, moved)
    missing_work = work - force @ load_mode.T
    load_mode += (per_force @ missing_work).T


def _nearest_projector(slanting: SlantingWinds, tangent: Floats, share: Floats) -> Floats:
    """Fit a projector, (6,), to the mean of ``|P u|^3`` over panels of tangents (p, 3)."""
    of_panels = np.eye(3) - tangent[:, :, None] * tangent[:, None, :]
    squares = slanting.squares(of_panels[:, _ROWS, _COLUMNS])
    mean_cubes = squares**1.5 @ share.sum(axis=1)
    return slanting.nearest(mean_cubes ** (2.0 / 3.0))


def _fill_damping(
    panels: _Panels, squares: Floats, mean: Floats, rows: Ints, records: Records
) -> None:
    """
    Scale the mean displacement (k, n, 3) to the one whose drag damping is that of the mean square.

    Both axes of the first shape count as one, so that it does not matter how they are laid.

    In wind its damping is that of the points. In still air that is the mean cube of their speed:
    the spread is the missing part of the speed of mean cube over mean square.
    """
    # As if both axes were alike.
    cubes = 2.0 * np.maximum(0.5 * squares, 0.0) ** 1.5
    mean_square = (panels.share * squares).sum(axis=(1, 2))
    mean_cube = (panels.share * cubes).sum(axis=(1, 2))
    square_of_mean = np.square(mean[:, :2]).sum(axis=(1, 2))
    ratio = np.divide(
        mean_square, square_of_mean, out=np.ones_like(mean_square), where=square_of_mean > 0.0
    )
    in_still_air = np.divide(
        mean_cube, mean_square, out=np.zeros_like(mean_square), where=mean_square > 0.0
    )
    mode = mean.copy()
    mode[:, :2] *= ratio[:, None, None]
    records['damping_mode'][rows, : mean.shape[1]] = mode
    missing = in_still_air**2 - 0.5 * ratio**2 * square_of_mean
    records['spread'][rows] = np.maximum(missing, 0.0)
    records['lever'][rows] = np.sqrt(0.5 * square_of_mean)
