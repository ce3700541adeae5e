# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Arguments for records of motion sensors on the real tree."""

from __future__ import annotations

import argparse
from pathlib import Path

from tree_sway.commands import say
from tree_sway.core.checks import within
from tree_sway.core.tree import Tree
from tree_sway.errors import inside
from tree_sway.files.motion import MotionRecord, read_motion, read_strain
from tree_sway.live.commands import add_place_argument, sensors_and_places
from tree_sway.simulation import PlacedMotion
from tree_sway.twin import place_on


def add_motion_arguments(parser: argparse.ArgumentParser) -> None:
    """Add ``--motion``, ``--at`` and ``--motion-starts``."""
    add = parser.add_argument
    add(
        '--motion', action='append', default=[], metavar='FILE',
        help='recording of a motion sensor on the real tree: CSV, or a bag with '
        'sensor_msgs/Imu, of several as BAG?topic=/tree/imu; or a film, camera:FILE.mp4 '
        '(doc/camera.md); repeatable',
    )  # fmt: skip
    add_place_argument(parser)
    add(
        '--motion-starts', type=float, default=0.0, metavar='S',
        help='time [s] by which recordings of motion begin after that of the wind, added to '
        'their times (%(default)s)',
    )  # fmt: skip


def placed_motion(
    arguments: argparse.Namespace, tree: Tree, epoch: float | None
) -> list[PlacedMotion]:
    """
    Read the recordings of motion sensors, and print what their readers chose.

    Parameters
    ----------
    arguments
        Arguments of `add_motion_arguments`.
    tree
        The tree that they are on.
    epoch
        Time of the first sample of the wind in seconds after 1970; None without dates.

    """
    starts = within('--motion-starts', arguments.motion_starts, -1e9, 1e9, 's')
    found = []
    for number, (path, at) in enumerate(sensors_and_places(arguments), 1):
        with inside('--at'):
            is_strain = place_on(tree, at).is_strain
        record = read_strain(Path(path)).motion() if is_strain else read_motion(path)
        for note in (*record.notes, *_clock_note(record, epoch, starts)):
            say(note)
        found.append(
            PlacedMotion(
                f'sensor {number} at {at}',
                at,
                record.times_after(epoch, starts),
                record.acceleration,
                record.rate,
                record.orientation,
            )
        )
    return found


def _clock_note(record: MotionRecord, epoch: float | None, starts: float) -> tuple[str, ...]:
    """Say when a record begins, if no dates tell it and the user did not."""
    if starts or (epoch is not None and record.epoch is not None):
        return ()
    if epoch is not None:
        which = 'it has'
    elif record.epoch is not None:
        which = 'the wind has'
    else:
        which = 'it and the wind have'
    return (
        f'{Path(record.source).name}: as {which} no dates, it is taken to begin with the wind; '
        '--motion-starts shifts it',
    )
