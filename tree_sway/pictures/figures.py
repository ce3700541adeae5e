# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Figures of trees and records, as `tree_sway.drawn.Drawn.plot` gives them."""

from __future__ import annotations

import base64
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tree_sway.core.tree import Tree
from tree_sway.drawn import Drawn
from tree_sway.errors import MissingDependencyError
from tree_sway.files.motion import MotionRecord
from tree_sway.files.trees import TreeFile
from tree_sway.files.wind import WindRecord
from tree_sway.pictures.pictures import figure_in_wind
from tree_sway.pictures.plots import labelled, wind_and_tip
from tree_sway.pictures.plotting import new_figure
from tree_sway.simulation import SwayRecord

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SIZE = 8.0, 3.6


def of_tree(tree: Tree | TreeFile) -> Figure:
    """Draw a tree at rest."""
    bare = tree.tree if isinstance(tree, TreeFile) else tree
    return figure_in_wind([bare], bare.rest_poses, np.zeros(3))


def of_wind(record: WindRecord) -> Figure:
    """Draw the speed of a wind and where it comes from, over time."""
    figure = new_figure(*_SIZE)
    speed, bearing = figure.subplots(2, 1, sharex=True)
    east, north, _ = record.velocity.T
    horizontal = np.hypot(east, north)
    speed.plot(record.time, horizontal, label='speed')
    if record.gust is not None:
        speed.plot(record.time, record.gust, label='gust')
    speed.set(ylabel='wind [m/s]', ylim=(0.0, None))
    comes_from = np.degrees(np.arctan2(-east, -north)) % 360.0
    comes_from[horizontal == 0.0] = np.nan  # calm
    bearing.plot(record.time, comes_from, '.', ms=2.0, label='comes from')
    bearing.set(xlabel='time [s]', ylabel='from north [deg]', ylim=(0.0, 360.0))
    return labelled(figure, Path(record.source).name)


def of_sway(record: SwayRecord) -> Figure:
    """Draw the wind and the motion of the first tip of a record."""
    name, *_ = record.branch_names or ('',)
    tip = record.tips[:, 0] if name else np.zeros_like(record.wind)
    title = f'{record.tree}, {record.strength.season}, model {record.model}, tip of {name}'
    return wind_and_tip(record.time, record.wind, tip, title)


def of_motion(record: MotionRecord) -> Figure:
    """Draw what a motion sensor measured."""
    rows = {
        'acceleration [m/s$^2$]': (record.acceleration, 'xyz'),
        'angular rate [rad/s]': (record.rate, 'xyz'),
        'orientation': (record.orientation, 'xyzw'),
    }
    measured = {name: (v, columns) for name, (v, columns) in rows.items() if v is not None}
    figure = new_figure(*_SIZE)
    every = figure.subplots(len(measured), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (name, (values, columns)) in zip(every, measured.items(), strict=True):
        for k, column in enumerate(columns):
            axes.plot(record.time, values[:, k], lw=0.8, label=column)
        axes.set(ylabel=name)
    every[-1].set(xlabel='time [s]')
    return labelled(figure, Path(record.source).name)


def as_html(drawn: Drawn) -> str | None:
    """Return the line of text of an object above its picture; None without matplotlib."""
    try:
        figure = drawn.plot()
    except MissingDependencyError:
        return None
    data = base64.b64encode(figure._repr_png_()).decode()
    return f'{escape(repr(drawn))}<br><img src="data:image/png;base64,{data}">'
