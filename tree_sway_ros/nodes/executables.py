# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The executables that ``ros2 run tree_sway_ros`` starts; they can be imported without ROS.

The argument of each is a command line without the program's name (by default that of the process),
the result the exit code. ``--help`` and what ROS would ignore raise a `SystemExit` of 0 and of 2.
"""

from __future__ import annotations

import argparse
import ast
from collections.abc import Sequence
from functools import partial
from itertools import takewhile
from pathlib import Path
import sys

from tree_sway_ros.process.composition import NODES, place_of
from tree_sway_ros.process.spin import run

_USAGE = """
Parameters are given as --ros-args -p name:=value, or in a file by --ros-args --params-file FILE;
doc/reference.md lists them. The node runs until Ctrl-C."""


def _start(node: str, args: Sequence[str] | None = None) -> int:
    given = sys.argv[1:] if args is None else args
    source = Path(__file__).with_name(f'{node}.py').read_text(encoding='utf-8')
    about = f'{ast.get_docstring(ast.parse(source))}{_USAGE}'
    parser = argparse.ArgumentParser(node, '%(prog)s [--ros-args -p NAME:=VALUE ...]', about)
    parser.parse_args([*takewhile('--ros-args'.__ne__, given)])
    return run(*place_of(node), args)


anemometer, wind, solver, player, sensor, viewer = (partial(_start, name) for name in NODES)
