# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway lab score``: how well the measured sway of a tree follows from its wind and sensors.

A record has a wind, the displacement of one tip over time, east and north in [m], and any number
of motion sensors; or strains at several places, of which the first corrects and the last judges
(`strain_score`). Rows: ``U^2``, the square of the wind, low-passed at the first frequency, with
the gains that are best for this record; ``model``, the wind alone; ``live``, wind and sensors.
Columns: correlation at the best lag, that lag, error over motion, amplitude, and the power in four
bands of frequency, up to 0.5, 1.5, 4 and 10 times the first one, over the measured power.
"""

from __future__ import annotations

import argparse
from pathlib import Path
import sys
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.scene import make_simulator
from tree_sway.errors import nearest, ParameterError
from tree_sway.files.commands import (
    add_distance_arguments,
    add_leaves_argument,
    add_model_argument,
    add_tree_arguments,
    add_wind_arguments,
    chosen_leaves,
    distance_settings,
    opened_record,
    opened_tree,
)
from tree_sway.files.trees import TreeFile
from tree_sway.files.wind import read_csv_sway, WindRecord
from tree_sway.simulation import simulate
from tree_sway.twin.commands import add_motion_arguments, placed_motion
from tree_sway_lab.twin.strain_score import add_strain_arguments, strain_at_top
from tree_sway_lab.twin.sway_comparison import BANDS, compare_sway, low_passed, SwayComparison

_RATE = 60.0
_LEAST = 30.0
"""Least scored time in [s]."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_tree_arguments(parser)
    add_wind_arguments(parser)
    add_model_argument(parser)
    add_leaves_argument(parser)
    add = parser.add_argument
    add(
        '--sway', metavar='FILE',
        help='measured displacement of a tip: a table with time, x (east), y (north)',
    )  # fmt: skip
    add('--branch', metavar='NAME', help='branch of that tip; the highest tip if left out')
    add(
        '--sway-starts', type=float, default=0.0, metavar='S',
        help='time [s] by which that table begins after the wind (%(default)s)',
    )  # fmt: skip
    add(
        '--skip', type=float, default=40.0, metavar='S',
        help='time [s] at the start that is not scored, in which mountings are found '
        '(%(default)s)',
    )  # fmt: skip
    add_strain_arguments(parser)
    add_motion_arguments(parser)
    add_distance_arguments(parser, 'expected')


def run(arguments: argparse.Namespace) -> int:
    """Score wind alone, wind and sensors, and the square of the wind."""
    opened = opened_tree(arguments)
    names = opened.tree.branch_names
    if arguments.branch is not None and arguments.branch not in names:
        cure = nearest(arguments.branch, names) or f'such as {names[0]}'
        raise ParameterError(f"no branch '{arguments.branch}'", where='--branch', cure=cure)
    if (arguments.sway is None) == (arguments.strain is None):
        given = 'neither' if arguments.sway is None else 'both'
        raise ParameterError(f'{given} of --sway and --strain', cure='give one of the two')
    wind = opened_record(arguments)
    choice: dict[str, Any] = {
        'model': arguments.model,
        'in_leaf': chosen_leaves(arguments),
        **distance_settings(arguments),
    }
    frequency = float(make_simulator(opened, model=0, in_leaf=choice['in_leaf']).frequencies(1)[0])
    if arguments.strain is not None:
        return _score_strain(arguments, opened, wind, choice, frequency)
    motion = placed_motion(arguments, opened.tree, wind.epoch)
    time, measured = _measured_sway(arguments)
    choice['branches'] = None if arguments.branch is None else [names.index(arguments.branch)]
    alone = simulate(opened, wind, rate=_RATE, **choice)
    is_scored = (time >= arguments.skip) & (time <= alone.time[-1])
    if not is_scored.any() or np.ptp(time[is_scored]) < _LEAST:
        what = f'less than {_LEAST:.0f} s of sway after --skip {arguments.skip:g} s of wind'
        raise ParameterError(
            what, where='--sway', cure='give a longer record, or a smaller --skip'
        )
    time, measured = time[is_scored], measured[is_scored]
    rate = (len(time) - 1) / float(np.ptp(time))
    grid = time[0] + np.arange(len(time)) / rate
    measured = _at(grid, time, measured)
    squared = _at(grid, alone.time, low_passed(alone.wind, frequency, _RATE))
    computed = {'model': _at(grid, alone.time, alone.tips[:, 0, :2])}
    if motion:
        followed = simulate(opened, wind, rate=_RATE, motion=motion, **choice)
        computed['sensors'] = _at(grid, followed.time, followed.tips[:, 0, :2])
        for note in followed.notes:
            print(f'note: {note}', file=sys.stderr)
    _print_rows(squared, computed, measured, rate, frequency)
    return 0


def _score_strain(
    arguments: argparse.Namespace, opened: TreeFile, wind: WindRecord, choice: dict[str, Any],
    frequency: float,
) -> int:  # fmt: skip
    """Score the strain at the last place that is told, after the time that is not scored."""
    found = strain_at_top(arguments, opened, wind, _RATE, choice)
    rows = found.time >= found.time[0] + arguments.skip
    if np.count_nonzero(rows) < _LEAST * _RATE:
        what = f'less than {_LEAST:.0f} s of strain after --skip {arguments.skip:g} s'
        cure = 'give a longer record, or a smaller --skip'
        raise ParameterError(what, where='--strain', cure=cure)
    velocity = _at(found.time, wind.time - wind.time[0], wind.velocity)
    computed = {'model': found.alone[rows]}
    if found.followed is not None:
        computed['sensors'] = found.followed[rows]
    # On the north side and on the east side it is by the wind to the north and to the east.
    squared = low_passed(velocity, frequency, _RATE)[rows]
    _print_rows(squared, computed, found.measured[rows], _RATE, frequency)
    return 0


def _print_rows(
    squared: Floats, computed: dict[str, Floats], measured: Floats, rate: float, frequency: float
) -> None:
    """Print the score of the square of the wind, with its best gains, and of what was computed."""
    inputs = np.column_stack([np.ones(len(squared)), squared])
    fitted = inputs @ np.linalg.lstsq(inputs, measured, rcond=None)[0]
    heads = ['motion', 'r', 'lag', 'error', 'rms', *(f'to {high:g} f1' for _, high in BANDS)]
    print(','.join(heads))
    for name, motion in ({'U^2': fitted} | computed).items():
        _print(name, compare_sway(motion, measured, rate, frequency))


def _measured_sway(arguments: argparse.Namespace) -> tuple[Floats, Floats]:
    """Return times [s] after the start of the wind, (n,), and displacement (n, 2) in [m]."""
    record = read_csv_sway(Path(arguments.sway))
    if record.quantity != 'displacement' or record.motion.shape[1] < 2:
        what = f'{record.motion.shape[1]} columns of {record.quantity}'
        cure = 'give the displacement of a tip as x (east) and y (north)'
        raise ParameterError(what, where=arguments.sway, cure=cure)
    return record.time - record.time[0] + arguments.sway_starts, record.motion[:, :2]


def _at(times: Floats, known: Floats, values: Floats) -> Floats:
    """Interpolate columns at times, (n, k)."""
    return np.stack([np.interp(times, known, column) for column in values.T], axis=1)


def _print(name: str, score: SwayComparison) -> None:
    lag = f'{score.lag:.2f}'
    figures = [score.error, score.rms, *score.bands]
    print(','.join([name, f'{score.r:.3f}', lag, *(f'{each:.3f}' for each in figures)]))
