# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The argument ``--seconds`` of commands that go on until Ctrl-C."""

from __future__ import annotations

import argparse
import math

from tree_sway.core.checks import within


def add_seconds(parser: argparse.ArgumentParser) -> None:
    """Add the duration of a command."""
    text = 'end after this time [s]; without it, at Ctrl-C'
    parser.add_argument('--seconds', type=float, default=math.inf, metavar='N', help=text)


def seconds_of(arguments: argparse.Namespace) -> float:
    """Return the duration of a command in [s]; a `ParameterError` for an impossible one."""
    return within('--seconds', arguments.seconds, 0.0, math.inf, 's', above=True)
