# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway simulate``: a tree in a wind from rest, and a table of its motion."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from tree_sway.commands import counting, say, waiting
from tree_sway.core.wind import simulate_turbulence
from tree_sway.errors import nearest, ParameterError
from tree_sway.files.commands import (
    add_distance_arguments,
    add_leaves_argument,
    add_model_argument,
    add_output_arguments,
    add_tree_arguments,
    add_wind_arguments,
    chosen_leaves,
    distance_settings,
    opened_record,
    opened_tree,
    output_path,
    refuse_unused_wind,
    simulated_speed,
)
from tree_sway.files.export import refuse_no_table, write_columns
from tree_sway.files.trees import LearnedFile
from tree_sway.live.commands import add_sensor_argument, live_record
from tree_sway.simulation import Exposure, refuse_too_many_steps, simulate, WindSamples
from tree_sway.simulation.commands.exposure import (
    add_exposure_arguments,
    chosen_exposure,
    touched_species,
)
from tree_sway.twin.camera import FilmedMotion
from tree_sway.twin.commands import (
    add_learn_argument,
    add_motion_arguments,
    check_learn_argument,
    filmed_motion,
    placed_motion,
    write_learned,
)

_STEPS = 1000
"""Steps of the bar."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add_tree_arguments(parser)
    add_wind_arguments(parser)
    add_sensor_argument(parser)
    add_distance_arguments(parser, 'expected')
    add_exposure_arguments(parser)
    add_model_argument(parser)
    add_leaves_argument(parser)
    which = 'branch whose tip is written, repeatable; without it, the highest tip'
    add('--branch', action='append', default=[], metavar='NAME', help=which)
    add('--rate', type=float, default=60.0, metavar='HZ', help='rows per second (%(default)s)')
    add(
        '--seconds',
        type=float,
        metavar='N',
        help='duration [s]; without it, all of a recording, or 60 s',
    )
    add_motion_arguments(parser)
    add(
        '--band', action='store_true',
        help='also write within which bounds the tips and the moment of the real tree are for '
        '80 %% of the time, by the spreads of wood, damping, drag, leaves and gusts',
    )  # fmt: skip
    add_learn_argument(parser)
    add_output_arguments(parser, 'table to write: .csv, .parquet or .json')


def run(arguments: argparse.Namespace) -> int:
    """Simulate the tree and write its motion."""
    output = Path(output_path(arguments))
    refuse_no_table(output)
    check_learn_argument(arguments)
    refuse_unused_wind(arguments)
    opened = opened_tree(arguments)
    learned_file: LearnedFile | None = None
    if arguments.learn is not None:
        learned_file = LearnedFile(arguments.learn, opened, chosen_leaves(arguments))
        opened = learned_file.opened
    exposure = chosen_exposure(arguments, opened.tree, opened.species)
    touched = touched_species(exposure, opened.species, opened.learned)
    tree_file = replace(opened, species=touched)
    names = tree_file.tree.branch_names
    for name in arguments.branch:
        if name not in names:
            cure = nearest(name, names) or f'such as {names[0]}'
            raise ParameterError(f"no branch '{name}'", where='--branch', cure=cure)
    ground = float(tree_file.tree.start[0, 2])
    film = filmed_motion(arguments, tree_file.tree)
    wind = _wind(arguments, exposure, film)
    motion = placed_motion(arguments, tree_file.tree, getattr(wind, 'epoch', None))
    with counting(_STEPS, 'simulating') as shown:
        record = simulate(
            tree_file, wind, rate=arguments.rate, seconds=arguments.seconds,
            branches=[names.index(name) for name in arguments.branch] or None,
            model=arguments.model, in_leaf=chosen_leaves(arguments),
            profile=exposure.profile(ground), motion=motion, film=film,
            band=arguments.band, progress=lambda share: shown(round(_STEPS * share)),
            **distance_settings(arguments),
        )  # fmt: skip
    with waiting(f'writing {output}'):
        write_columns({name: each.tolist() for name, each in record.columns().items()}, output)
    for note in record.notes:
        if note not in getattr(wind, 'notes', ()):  # those of a record were told before
            say(note)
    if learned_file is not None:
        write_learned(learned_file, record.learned)
    print(f'{output}: {record}')
    print(exposure)
    print(record.strength)
    return 0


def _wind(
    arguments: argparse.Namespace, exposure: Exposure, film: FilmedMotion | None
) -> WindSamples | np.ndarray:
    """Return the given record, the wind of a live source from now on, or simulated wind."""
    if arguments.sensor is not None:
        return live_record(arguments, arguments.seconds or 60.0)
    if film is not None and arguments.wind is None and arguments.speed is None:
        # The film alone tells how the tree moves.
        seconds = arguments.seconds or film.seconds
        refuse_too_many_steps(seconds * arguments.rate, arguments.rate)
        return np.zeros((max(round(seconds * arguments.rate), 1), 3))
    if arguments.wind is None:
        rng = np.random.default_rng(0)
        seconds = arguments.seconds or 60.0
        refuse_too_many_steps(seconds * arguments.rate, arguments.rate)
        return simulate_turbulence(
            simulated_speed(arguments, above=True), rate=arguments.rate, duration=seconds,
            rng=rng, **exposure.turbulence,
        )  # fmt: skip
    with waiting(f'reading {arguments.wind}'):
        return opened_record(arguments)
