# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway chart``: speed against accuracy, as pictures and tables."""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path
from typing import Any

from tree_sway_ros.files.wind.wind_file import read_wind
from tree_sway_ros.tools.progress import waiting

_CHARTS = ("methods", "fidelity", "cost", "portraits", "habits")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "what",
        choices=(*_CHARTS, "validation", "slopes", "all"),
        help="methods: of integration; fidelity: models of a tree; cost: against its size; "
        "portraits: trees at rest and in wind, and a film; habits: grown species; "
        "slopes: of response spectra; "
        "all: every picture of the documentation",
    )
    parser.add_argument(
        "-o", "--output", default=".", metavar="FOLDER", help="for PNG and CSV (%(default)s)"
    )
    parser.add_argument(
        "--wind", metavar="FILE", help="fidelity: a wind record; simulated if left out"
    )


def run(arguments: argparse.Namespace) -> int:
    """Measure, draw, and name the files."""
    folder = Path(arguments.output)
    for what in _CHARTS if arguments.what == "all" else (arguments.what,):
        module = importlib.import_module(f"tree_sway_ros.study.chart.{what}")
        options: dict[str, Any] = {}
        if arguments.wind is not None and what in ("fidelity", "validation"):
            record = read_wind(arguments.wind)
            options["wind"] = (record.time, record.velocity)
            options["source"] = Path(record.source).name
        with waiting(f"drawing {what}"):
            getattr(module, f"chart_{what}")(folder, **options)
        print(f"{what}: drawn in {folder}")
    return 0
