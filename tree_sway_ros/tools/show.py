# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway show``: a tree in wind on a page of the browser, without ROS."""

from __future__ import annotations

import argparse
from dataclasses import replace
import math
import sys
import time
from typing import Any
import webbrowser

from tree_sway_ros.core.growth.builtin import BUILTIN_TREES
from tree_sway_ros.core.scene.stand import StandKind, StandTree
from tree_sway_ros.core.simulator.protocol import Simulator
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.files.stands.stand_file import stand_file, StandFile
from tree_sway_ros.files.trees.imported_tree import TreeFile
from tree_sway_ros.files.trees.source import open_scene
from tree_sway_ros.files.trees.yaml.forest_file import ForestFile
from tree_sway_ros.page.controls import Control, ControlPanel
from tree_sway_ros.page.server import PageServer
from tree_sway_ros.page.session import Choices, Session
from tree_sway_ros.page.wind_source import SimulatedWind, WindSource
from tree_sway_ros.ros.parameters.node_parameters import NODE_PARAMETERS
from tree_sway_ros.ros.parameters.parameter import Parameter
from tree_sway_ros.tools.arguments import (
    add_sway_arguments,
    opened_scene,
    opened_wind,
    told_leaves,
)
from tree_sway_ros.tools.page_arguments import add_page_arguments, page_settings

_SPACING = 1.2
"""Between the trees of a stand over the greater of height and spread of one."""

_BY_TABLE = ('auto', 'modes', 'wind_basis')
"""Models that a stand has one table per kind for, wherever its trees stand."""

_COUNTS = ('1', '9', '100')
_LABELS = {
    'mean_speed': 'Wind',
    'intensity': 'Gustiness',
    'bearing_to': 'Blows to',
    'fidelity': 'Model',
    'tolerance': 'Tolerance',
    'damping_ratio': 'Damping',
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_sway_arguments(parser, 'a wind record, played over and over; simulated if left out')
    parser.add_argument(
        '--stand', type=int, default=1, metavar='N', help='so many of the tree (%(default)s)'
    )
    parser.add_argument(
        '--seconds', type=float, metavar='N', help='end after so long; else by Ctrl-C'
    )
    parser.add_argument('--read-only', action='store_true', help='viewers may change nothing')
    add_page_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Serve the page until the time is over or Ctrl-C."""
    settings = page_settings(arguments)
    if arguments.stand < 1:
        raise ParameterError(f'a stand of {arguments.stand}', cure='ask for 1 tree or more')
    wind = opened_wind(arguments)
    print(f'{arguments.tree}: starting (the first start compiles, up to a minute)', flush=True)
    choices = Choices(arguments.tree, str(arguments.stand), arguments.model)
    session = Session(lambda wanted: build_scene(wanted, arguments), choices, wind)
    panel = ControlPanel()
    if not arguments.read_only:
        panel = ControlPanel(_controls(choices, wind), session.apply)
    with PageServer(settings, panel, session.status) as server:
        session.serve(server)
        print(f'open {server.url} (Ctrl-C ends)', flush=True)
        if arguments.open:
            webbrowser.open(server.url)
        try:
            end = math.inf if arguments.seconds is None else time.monotonic() + arguments.seconds
            while session.failure is None and time.monotonic() < end:
                session.wait(min(0.1, end - time.monotonic()))
        except KeyboardInterrupt:
            print('', file=sys.stderr)
        finally:
            session.stop()
        if session.failure is not None:
            raise session.failure
    return 0


def build_scene(choices: Choices, arguments: argparse.Namespace) -> Simulator:
    """Make the simulator of what was chosen."""
    is_first = choices.tree == arguments.tree
    scene = opened_scene(arguments) if is_first else open_scene(choices.tree)
    count = int(choices.count)
    if count > 1:
        if isinstance(scene, ForestFile):
            raise ParameterError('a stand of a forest', where='--stand', cure='name one tree')
        scene = stand(scene, count, choices.fidelity)
    damping, in_leaf = choices.damping_ratio or None, told_leaves(arguments)
    settings = replace(Settings(), damping_ratio=damping, in_leaf=in_leaf)
    return scene.simulator(settings, model=choices.fidelity)


def stand(scene: TreeFile, count: int, fidelity: str) -> StandFile:
    """Trees of one kind on a grid, each turned another way; on their table where they have one."""
    tree = scene.tree
    low, high = tree.start.min(axis=0), tree.end.max(axis=0)
    spacing = _SPACING * float(max(*(high - low)[:2], 0.5 * tree.height))
    across = math.ceil(math.sqrt(count))
    standing = tuple(
        StandTree(
            f'{tree.name}{i + 1}',
            tree.name,
            x=spacing * (i % across - 0.5 * (across - 1)),
            y=spacing * (i // across - 0.5 * (across - 1)),
            yaw=2.4 * i,
            fidelity='wind_basis' if fidelity in _BY_TABLE else fidelity,
        )
        for i in range(count)
    )
    kinds = {tree.name: StandKind(tree, scene.species)}
    return stand_file(f'{count} of {tree.name}', standing, kinds, source=scene.source)


def _controls(choices: Choices, wind: WindSource) -> tuple[Control, ...]:
    """Make what viewers may change, with the ranges of the nodes' parameters."""
    controls = []
    if isinstance(wind, SimulatedWind):
        for name in ('mean_speed', 'intensity', 'bearing_to'):
            controls.append(_control('anemometer', name, wind.values[name]))
    controls.append(_control('solver', 'fidelity', choices.fidelity))
    controls += [_control('solver', name) for name in ('tolerance', 'damping_ratio')]
    trees = (*BUILTIN_TREES, *(() if choices.tree in BUILTIN_TREES else (choices.tree,)))
    counts = tuple(dict.fromkeys((*_COUNTS, choices.count)))
    return (
        *controls,
        Control('tree', 'Tree', choices.tree, 'What stands there.', choices=trees),
        Control('count', 'Stand of', choices.count, 'How many of it.', choices=counts),
        Control('pause', 'Pause', False, 'Time stands still.'),
        Control('reset', 'Reset', None, 'Back to rest.', is_action=True),
    )


def _control(node: str, name: str, value: Any = None) -> Control:
    parameter = _parameter(node, name)
    return Control(
        name,
        _LABELS[name],
        parameter.default if value is None else value,
        parameter.description,
        parameter.unit,
        parameter.minimum,
        parameter.maximum,
        parameter.choices,
    )


def _parameter(node: str, name: str) -> Parameter:
    return next(p for p in NODE_PARAMETERS[node] if p.name == name)
