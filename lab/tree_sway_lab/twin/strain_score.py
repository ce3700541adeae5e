# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Score of a record of strain gauges: the first place that is told corrects, the last one judges.

Gauges drift: of all strains, measured and computed, the mean of ten minutes about each moment is
taken off (Jackson et al. 2021, Biogeosciences 18, 4059-4072).
"""

from __future__ import annotations

import argparse
from pathlib import Path
import sys
from typing import Any, NamedTuple

import numpy as np
from scipy.ndimage import uniform_filter1d

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import within
from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator
from tree_sway.errors import inside, ParameterError
from tree_sway.files.motion import read_strain
from tree_sway.files.trees import TreeFile
from tree_sway.files.wind import WindRecord
from tree_sway.twin import (
    as_orientation,
    bend_at,
    ObservedTree,
    place_on,
    sensor_reports,
    strain_of,
)

_DRIFT = 600.0
"""Time in [s] over which the mean of a gauge is its drift."""

_GAUGE = 'gauge'


class StrainAtTop(NamedTuple):
    """
    Strain on the north and east side at the place that judges [-], (n, 2) each, at equal times.

    ``followed`` is that of the tree that the lowest gauges correct; None without any.
    """

    time: Floats
    measured: Floats
    alone: Floats
    followed: Floats | None


def add_strain_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the record of strain gauges and their places."""
    add = parser.add_argument
    add(
        '--strain', metavar='FILE',
        help='measured strain, in place of --sway: a table with time, then two columns for each '
        'place, north side and east side',
    )  # fmt: skip
    add(
        '--gauges', metavar='PLACES',
        help="place of each two columns, as '1.3 19 30' (heights on the stem in m; - for those of "
        'other trees): the first one corrects, the last one judges',
    )  # fmt: skip


def strain_at_top(
    arguments: argparse.Namespace, opened: TreeFile, wind: WindRecord, rate: float,
    choice: dict[str, Any],
) -> StrainAtTop:  # fmt: skip
    """
    Compute the strain of a tree that gauges correct, and of the same without them.

    A `ParameterError` names places that are none, or of which there are too few or too many.
    """
    record = read_strain(Path(arguments.strain))
    for note in record.notes:
        print(f'note: {note}', file=sys.stderr)
    words = (arguments.gauges or '').split()
    pairs = record.strain.shape[1]
    if len(words) != pairs or set(words) == {'-'}:
        what = f'{len(words)} places for {pairs} pairs of columns'
        raise ParameterError(what, where='--gauges', cure="give one each, as '1.3 19', or -")
    with inside('--gauges'):
        places = [(f'{at} strain', k) for k, at in enumerate(words) if at != '-']
        judge = place_on(opened.tree, places[-1][0])
    starts = within('--sway-starts', arguments.sway_starts, -1e9, 1e9, 's')
    times = record.motion().times_after(wind.epoch, starts)
    grid = np.arange(max(times[0], 0.0), min(times[-1], wind.time[-1] - wind.time[0]), 1.0 / rate)
    if not len(grid):
        what = f'no strain within {wind.time[-1] - wind.time[0]:.0f} s of wind'
        raise ParameterError(what, where='--strain', cure='check the dates, or --sway-starts')
    steady = [_steady(grid, times, record.strain[:, k], rate) for _, k in places]
    winds = np.stack(
        [np.interp(np.arange(1.0 / rate, grid[-1] + 1.0 / rate, 1.0 / rate) - 0.5 / rate,
                   wind.time - wind.time[0], each) for each in wind.velocity.T], axis=1,
    )  # fmt: skip
    alone = make_simulator(opened, **choice)
    computed = [_strained(alone, winds, judge, rate)]
    if len(places) > 1:
        twin = ObservedTree(opened, at={_GAUGE: places[0][0]}, rate=rate, **choice)
        twin.replay(_GAUGE, grid, orientation=as_orientation(steady[0]))
        computed.append(_strained(twin, winds, judge, rate))
        for report in sensor_reports(twin):
            for note in filter(None, (report.problem, *report.notes)):
                print(f'note: {note}', file=sys.stderr)
    ends = np.arange(1, len(winds) + 1) / rate
    found = [_steady(grid, ends, each, rate) for each in computed]
    return StrainAtTop(grid, steady[-1], found[0], found[1] if len(found) > 1 else None)


def _steady(grid: Floats, times: Floats, strain: Floats, rate: float) -> Floats:
    """Strain (n, 2) at times of a grid without its drift; gaps are joined by lines."""
    columns = []
    for column in strain.T:
        known = np.isfinite(column) & np.isfinite(times)
        columns.append(np.interp(grid, times[known], column[known]))
    values = np.stack(columns, axis=1)
    drift = uniform_filter1d(values, min(round(_DRIFT * rate), len(values)), axis=0)
    return np.asarray(values - drift)


def _strained(sim: SwaySimulator, winds: Floats, place: Any, rate: float) -> Floats:
    """Strain at a place after each step in winds (n, 3), (n, 2)."""
    found, poses = np.empty((len(winds), 2)), np.empty((sim.tree.n_segments, 7))
    for k, wind in enumerate(winds):
        sim.step(wind, 1.0 / rate)
        found[k] = strain_of(bend_at(sim.tree, sim.place(poses), place))
    return found
