# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway plot``: wind and motion of the tip, a portrait, strength, or a study's table."""

from __future__ import annotations

import argparse
import csv
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tree_sway.commands import bar, counting
from tree_sway.core.checks import within
from tree_sway.core.scene import Scene, Simulator
from tree_sway.core.settings import Settings
from tree_sway.core.setup import is_in_leaf
from tree_sway.errors import FormatError, ParameterError
from tree_sway.files import is_file, path_of
from tree_sway.files.commands import (
    add_exact_argument,
    add_output_arguments,
    add_sway_arguments,
    at_moments,
    chosen_leaves,
    frame_times,
    opened_scene,
    opened_wind,
    output_path,
    refuse_unused_wind,
    simulated_speed,
)
from tree_sway.parameters import SWAY
from tree_sway.pictures import figure_in_wind, save_figure
from tree_sway.pictures.plots import (
    strength_over_wind,
    STUDY_COLUMNS,
    study_over_wind,
    wind_and_tip,
)
from tree_sway.pictures.plotting import checked_picture
from tree_sway.simulation import RecordedWind
from tree_sway.simulation.commands import (
    add_exposure_arguments,
    refuse_unused_exposure,
    tallest_of_kinds,
    used_strength,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SETTLING = 60.0
_SETTLING_STEP = 1.0 / 15.0
_RATE = 60.0
_LONGEST_HEADER = 4096
_LEAVES = 3000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_sway_arguments(
        parser, leaves=None, speed_of='6; 10 with --portrait, up to 30 with --strength'
    )
    add_exact_argument(parser)
    parser.add_argument(
        '--portrait',
        action='store_true',
        help='draw the tree in a steady west wind, with its shape at rest behind it',
    )
    strength = 'draw the fraction of the strength in use over wind speed, up to --speed (30 m/s)'
    parser.add_argument('--strength', action='store_true', help=strength)
    add_exposure_arguments(parser)
    parser.add_argument(
        '--seconds', type=float, default=60.0, metavar='N', help='duration [s] (%(default)s)'
    )
    add_output_arguments(parser, 'picture to write, .png or .pdf')


def run(arguments: argparse.Namespace) -> int:
    """Draw, and print the name of the picture."""
    within('--seconds', arguments.seconds, 0.0, 3600.0, 's', above=True)
    if not arguments.strength:
        refuse_unused_exposure(arguments, '--strength')
    if arguments.leaves is None:  # as `info` and `simulate`, so that figures of strength agree
        arguments.leaves = 'auto' if arguments.strength else 'on'
    refuse_unused_wind(arguments)
    if arguments.wind is not None and (arguments.strength or arguments.portrait):
        drawing = '--strength' if arguments.strength else '--portrait'
        cure = f'give --speed, or leave {drawing} out'
        raise ParameterError(f'{drawing} draws no recording', where='--wind', cure=cure)
    output = checked_picture(output_path(arguments))
    if rows := _rows_of_study(arguments.tree):
        try:
            figure = study_over_wind(rows)
        except (TypeError, ValueError) as error:
            raise FormatError(
                f'not the table of a study: {error}', where=arguments.tree
            ) from error
    else:
        draw = _strength if arguments.strength else _portrait if arguments.portrait else _motion
        figure = draw(opened_scene(arguments), arguments)
    print(save_figure(figure, output))
    return 0


def _rows_of_study(path: str) -> list[dict[str, str]]:
    """Rows of the table of a study; none of other files."""
    table = path_of(path)
    if table.suffix != '.csv' or not is_file(table):
        return []
    with table.open(encoding='utf-8', errors='replace', newline='') as lines:
        header = lines.readline(_LONGEST_HEADER)
        if not all(column in header for column in STUDY_COLUMNS):
            return []
        return list(csv.DictReader(lines, next(csv.reader([header]))))


def _portrait(scene: Scene, arguments: argparse.Namespace) -> Figure:
    simulator = _simulator(scene, arguments)
    wind = np.array([simulated_speed(arguments, 10.0), 0.0, 0.0])
    for _ in bar(range(round(_SETTLING / _SETTLING_STEP)), 'settling in the wind'):
        simulator.step(wind, _SETTLING_STEP)
    return figure_in_wind(
        [each.placed() for each in scene.trees],
        simulator.place(),
        wind,
        leaves=scene.leaves(chosen_leaves(arguments), _LEAVES),
    )


def _simulator(scene: Scene, arguments: argparse.Namespace) -> Simulator:
    with counting(len(scene.kinds), 'setting up the trees') as done:
        return scene.simulator(
            model=arguments.model, in_leaf=chosen_leaves(arguments), progress=done
        )


def _strength(scene: Scene, arguments: argparse.Namespace) -> Figure:
    """Draw the strength that the tallest tree of each kind uses over wind speed; print it."""
    tallest = tallest_of_kinds(scene)
    fastest = SWAY['mean_speed'].checked(simulated_speed(arguments, 30.0))
    speeds = np.linspace(0.0, fastest, 7)[1:]
    used = {}
    for each in bar(tallest.values(), 'computing the strength used'):
        settings = Settings(model=arguments.model, in_leaf=chosen_leaves(arguments))
        exposure, curve = used_strength(each, settings, arguments, speeds.tolist())
        for speed, use in zip(speeds, curve, strict=True):
            print(f'{each.name} {exposure}, of {speed:.3g} m/s: {use}')
        name = f'{each.name}, {exposure.place}, wind at {exposure.reference_height:.3g} m'
        used[name] = curve
    return strength_over_wind(speeds, used)


def _motion(scene: Scene, arguments: argparse.Namespace) -> Figure:
    wind = opened_wind(arguments)
    seconds = arguments.seconds
    if isinstance(wind, RecordedWind):
        source = Path(arguments.wind).name
        if seconds < wind.length:
            source += f', {seconds:g} of {wind.length:.6g} s'
        seconds = min(seconds, wind.length)
    else:
        source = f'simulated westerly, mean of ten minutes {simulated_speed(arguments):g} m/s'
    if seconds < 2.0 / _RATE:
        raise ParameterError('the wind is too short', where=source, cure='give a longer one')
    simulator = _simulator(scene, arguments)
    frames = at_moments(simulator, wind, frame_times(_RATE, seconds))
    shown = [(simulator.wind.copy(), simulator.tip_displacement.copy()) for _ in frames]
    winds, tips = np.swapaxes(shown, 0, 1)
    first = scene.trees[0]
    asked = chosen_leaves(arguments) if first.leaf_on is None else first.leaf_on
    season = 'in leaf' if is_in_leaf(first.species, asked) else 'bare'
    title = f'{scene.tree.name}, {season}, model {arguments.model}, {source}'
    return wind_and_tip(np.arange(1, len(tips) + 1) / _RATE, winds, tips, title)
