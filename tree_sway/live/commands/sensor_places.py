# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where motion sensors sit: an ``--at`` for each ``--motion``."""

from __future__ import annotations

import argparse

from tree_sway.errors import ParameterError


def add_place_argument(parser: argparse.ArgumentParser) -> None:
    """Add ``--at``, the place of each sensor."""
    parser.add_argument(
        '--at', action='append', default=[], metavar='PLACE',
        help='where that sensor sits: a height on the stem [m], as 3.2, or BRANCH:SHARE, as '
        'b12:0.5; of a camera the points that were clicked, or a file with them; once for each '
        '--motion',
    )  # fmt: skip


def sensors_and_places(arguments: argparse.Namespace) -> list[tuple[str, str]]:
    """Pair each ``--motion`` with its ``--at``; a `ParameterError` if one has no other."""
    n_sensors = len(arguments.motion)
    n_places = len(arguments.at)
    if n_sensors != n_places:
        raise ParameterError(
            f'{n_sensors} --motion and {n_places} --at',
            cure='give the place of each sensor: --motion SENSOR --at 3.2',
        )
    return list(zip(arguments.motion, arguments.at, strict=True))
