# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway bench``: what a step costs, against a stated baseline in the same run."""

from __future__ import annotations

import argparse
import json
import platform
from dataclasses import asdict
from pathlib import Path

from tree_sway_ros.errors import ParameterError
from tree_sway_ros.study.bench.bench_tree import bench_tree
from tree_sway_ros.study.bench.cut import cut_table
from tree_sway_ros.study.bench.forest import forest_table
from tree_sway_ros.study.bench.setup_time import setup_table
from tree_sway_ros.study.bench.step import StepTiming, time_steps


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "what",
        choices=("step", "cut", "forest", "setup"),
        help="step: solve and place one step of a tree of 121 branches; cut: solve it cut in 3 "
        "to 24 segments a "
        "branch; forest: 20 trees of 10,200 segments at 60 Hz; setup: set trees of 121 and 1,021 "
        "branches up",
    )
    parser.add_argument("--rounds", type=int, default=20, help="of 200 steps each (%(default)s)")
    parser.add_argument("--segments", type=int, default=6, help="a branch, for step (%(default)s)")
    parser.add_argument("--json", action="store_true", help="for programs, in seconds; for step")


def run(arguments: argparse.Namespace) -> int:
    """Time steps and print what they cost."""
    for name, low, high in (("rounds", 1, 10_000), ("segments", 1, 200)):
        if not low <= getattr(arguments, name) <= high:
            value = getattr(arguments, name)
            raise ParameterError(f"{value}", where=f"--{name}", cure=f"give {low} to {high}")
    if arguments.what != "step":
        print(f"one thread on {core_name()}")
        if arguments.what == "cut":
            print(cut_table(10 * arguments.rounds))
        else:
            print(forest_table() if arguments.what == "forest" else setup_table())
        return 0
    tree = bench_tree(arguments.segments)
    timings = [
        time_steps(tree, model, arguments.rounds) for model in ("branch", "subtree", "modes")
    ]
    if arguments.json:
        rows = [{**asdict(timing), "ratio": timing.ratio} for timing in timings]
        print(
            json.dumps(
                {"core": core_name(), "segments": tree.n_segments, "timings": rows}, indent=2
            )
        )
        return 0
    print(f"{tree.n_branches} branches, {tree.n_segments} segments; one thread on {core_name()}")
    print(
        "solve and place [us]   median      min   numpy twin: median      min   ratio   largest "
        "difference"
    )
    for timing in timings:
        print(_row(timing))
    return 0


def core_name() -> str:
    """Name of the processor, as it says itself."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def _row(timing: StepTiming) -> str:
    own = f"  {timing.model:19} {1e6 * timing.median:7.1f}  {1e6 * timing.minimum:7.1f}"
    twin = f"{1e6 * timing.twin_median:9.0f}  {1e6 * timing.twin_minimum:7.0f}"
    return f"{own}            {twin} {timing.ratio:7.1f}   {timing.difference:.1e}"
