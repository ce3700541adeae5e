# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Arguments of the wind: a record or the speed of a simulated one."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

from tree_sway.commands import refuse_unused, say
from tree_sway.core.checks import within
from tree_sway.core.settings import GUSTS
from tree_sway.core.wind import shorter_than
from tree_sway.errors import ParameterError
from tree_sway.files import reader_options
from tree_sway.files.commands.arguments import (
    add_leaves_argument,
    add_model_argument,
    add_tree_arguments,
)
from tree_sway.files.commands.typed_names import wind_name
from tree_sway.files.wind import read_wind, WindRecord
from tree_sway.simulation import RecordedWind, SimulatedWind

_USUAL_SPEED = 6.0
"""Mean speed of the simulated wind where none is given [m/s]."""
_FASTEST = 40.0


def add_wind_arguments(
    parser: argparse.ArgumentParser, record: str = '', speed_of: str = f'{_USUAL_SPEED:g}'
) -> None:
    """
    Add a wind record, and the speed of a simulated one.

    ``record`` is help for the first, ``speed_of`` says which speed it is where none is given.
    """
    add = parser.add_argument_group('wind').add_argument
    what = record or 'wind recording; without it wind is simulated'
    add('--wind', type=wind_name, metavar='FILE', help=what)
    options = (
        'option of its reader, such as speed_unit=km/h, direction=270, topic=/mast/wind, '
        'yaw=1.57, direction_convention=from or rate=20; repeatable'
    )
    add('--wind-option', action='append', default=[], metavar='NAME=VALUE', help=options)
    speed = f'mean speed of the simulated wind [m/s] ({speed_of})'
    add('--speed', type=float, metavar='U', help=speed)


def add_distance_arguments(parser: argparse.ArgumentParser, gusts: str) -> None:
    """Add where the anemometer stands, and which gusts a tree apart from it meets by default."""
    add = parser.add_argument_group('anemometer').add_argument
    add(
        '--anemometer-distance',
        type=float,
        default=0.0,
        metavar='M',
        help='distance of the anemometer from the tree [m]; 0 if unknown (%(default)s)',
    )
    add(
        '--anemometer-bearing',
        type=float,
        metavar='DEG',
        help='where it stands from the tree, clockwise from north; without it, anywhere',
    )
    add(
        '--gust-seed',
        type=int,
        default=0,
        metavar='N',
        help='seed of a sample of gusts: the same one, the same gusts (%(default)s)',
    )
    add(
        '--gusts',
        choices=GUSTS,
        default=gusts,
        help='wind of a tree apart from it: of least error, one that may be, or as measured '
        '(%(default)s)',
    )


def distance_settings(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the fields of `Settings` that these arguments give."""
    bearing = arguments.anemometer_bearing
    return {
        'anemometer_distance': arguments.anemometer_distance,
        'anemometer_bearing': None if bearing is None else math.radians(bearing),
        'gusts': arguments.gusts,
        'gust_seed': arguments.gust_seed,
    }


def simulated_speed(
    arguments: argparse.Namespace, usual: float = _USUAL_SPEED, *, above: bool = False
) -> float:
    """Return the mean speed of the simulated wind in [m/s], from 0, or ``above`` it."""
    speed = usual if arguments.speed is None else float(arguments.speed)
    return within('--speed', speed, 0.0, _FASTEST, 'm/s', above=above)


def refuse_unused_wind(arguments: argparse.Namespace) -> None:
    """Refuse two winds of which one would be used, and options of a record without one."""
    names = ('sensor', 'wind', 'speed')
    winds = [name for name in names if getattr(arguments, name, None) is not None]
    if len(winds) > 1:
        raise ParameterError(f'both --{winds[0]} and --{winds[1]}', cure='give one of the two')
    if arguments.wind_option and arguments.wind is None:
        refuse_unused('--wind-option', '--wind FILE')


def opened_record(arguments: argparse.Namespace) -> WindRecord:
    """Read the record of the arguments; print assumptions and refused rows."""
    options: dict[str, Any] = {**reader_options(arguments.wind_option)}
    record = read_wind(arguments.wind, **options)
    refused = f'{record.refused} rows refused; {record.first_refused}' if record.refused else ''
    for note in filter(None, (*record.notes, refused)):
        say(note)
    return record


def opened_wind(arguments: argparse.Namespace) -> RecordedWind | SimulatedWind:
    """Open the record of the arguments, repeated, or simulated wind of their speed."""
    if arguments.wind is None:
        return SimulatedWind(simulated_speed(arguments))
    record = opened_record(arguments)
    if short := shorter_than(record.duration, getattr(arguments, 'seconds', None)):
        say(short)
    return RecordedWind(record.time, record.velocity, Path(arguments.wind).stem)


def add_sway_arguments(
    parser: argparse.ArgumentParser,
    record: str = '',
    leaves: str | None = 'on',
    speed_of: str = f'{_USUAL_SPEED:g}',
) -> None:
    """Add a scene, a wind, a model and leaves, which are drawn by default."""
    add_tree_arguments(parser, forests=True, default='benjamina')
    add_wind_arguments(parser, record, speed_of)
    add_model_argument(parser)
    add_leaves_argument(parser, leaves)
