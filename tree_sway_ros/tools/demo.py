"""
``tree-sway demo``: a tree sways in wind, all nodes in one process, over real DDS.

What it prints is what a subscriber receives, not what the solver believes to have sent.

"""

from __future__ import annotations

import argparse

from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.files.trees.source import open_scene
from tree_sway_ros.ros.parameters.node_parameters import NODE_PARAMETERS
from tree_sway_ros.ros.parameters.parameter import Value
from tree_sway_ros.ros.process.composition import Composition
from tree_sway_ros.tools.leaves_argument import add_leaves_argument
from tree_sway_ros.tools.stream_monitor import StreamMonitor
from tree_sway_ros.tools.stream_text import summary
from tree_sway_ros.tools.stream_watch import checked_seconds, interrupted_once, watch


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "--tree",
        default="benjamina",
        help="benjamina, goldcrest, broadleaf, or a file of a tree or a forest (%(default)s)",
    )
    parser.add_argument(
        "--wind", metavar="FILE", help="a wind record to play; simulated if left out"
    )
    parser.add_argument(
        "--speed",
        type=float,
        default=6.0,
        metavar="U",
        help="mean of the simulated wind [m/s] (%(default)s)",
    )
    parser.add_argument(
        "--seconds", type=float, metavar="N", help="end after so long; else by Ctrl-C"
    )
    parser.add_argument(
        "--rate", type=float, default=60.0, help="poses a second [Hz] (%(default)s)"
    )
    fidelity = next(p for p in NODE_PARAMETERS["solver"] if p.name == "fidelity")
    parser.add_argument(
        "--fidelity",
        choices=fidelity.choices,
        default=fidelity.default,
        help="model of the sway (%(default)s)",
    )
    add_leaves_argument(parser)
    parser.add_argument(
        "--gravity", choices=("on", "off"), default="on", help="its own weight (%(default)s)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the demo until its time is over, the record ends, or Ctrl-C."""
    seconds = checked_seconds(arguments.seconds)
    tree = open_scene(arguments.tree).tree
    print(
        f"{tree.name}: {size_of(tree)}; starting (the first start compiles, up to a minute)",
        flush=True,
    )
    try:
        with interrupted_once(), Composition({}) as nodes:
            monitor = StreamMonitor(nodes.context, tree)

            def goes_on() -> bool:
                nodes.check()
                return not nodes.is_done

            try:
                monitor.expect_silence()
                for name, values in _nodes(arguments).items():
                    nodes.add(name, values)
                begin = watch(monitor, seconds, goes_on)
            finally:
                monitor.close()
    except KeyboardInterrupt:
        return 0
    print(summary(monitor.record.since(begin), arguments.rate))
    return 0


def size_of(tree: Tree) -> str:
    """Number of branches and segments, of trees if there are more, and height, for people."""
    n_trees = int((tree.branch_parent < 0).sum())
    trees = f"{n_trees} trees, " if n_trees > 1 else ""
    return f"{trees}{tree.n_branches} branches, {tree.n_segments} segments, {tree.height:.2f} m"


def _nodes(arguments: argparse.Namespace) -> dict[str, dict[str, Value]]:
    solver: dict[str, Value] = {
        "tree": arguments.tree,
        "rate": arguments.rate,
        "fidelity": arguments.fidelity,
    }
    solver["leaves"] = arguments.leaves
    if arguments.gravity == "off":
        solver["gravity"] = 0.0
    if arguments.wind is None:
        return {"anemometer": {"mean_speed": arguments.speed}, "wind": {}, "solver": solver}
    return {"player": {"file": arguments.wind}, "wind": {}, "solver": solver}
