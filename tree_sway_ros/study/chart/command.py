"""``tree-sway chart``: speed against accuracy, as pictures and tables."""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path

from tree_sway_ros.files.wind.wind_file import read_wind

_CHARTS = ("methods", "fidelity", "cost")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "what",
        choices=_CHARTS,
        help="methods: of integration; fidelity: models of a tree; cost: against its size",
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
    module = importlib.import_module(f"tree_sway_ros.study.chart.{arguments.what}")
    options = {}
    if arguments.wind is not None and arguments.what == "fidelity":
        record = read_wind(arguments.wind)
        options["wind"] = (record.time, record.velocity)
    getattr(module, f"chart_{arguments.what}")(folder, **options)
    for path in sorted(folder.glob(f"{arguments.what}*.*")):
        print(path)
    return 0
