# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway demo``: a tree sways in wind, all nodes in one process, over real DDS.

It prints statistics of a subscriber, not of the solver.
"""

from __future__ import annotations

import argparse
from contextlib import ExitStack
import math
from pathlib import Path
import tempfile
import webbrowser

from tree_sway.commands import Ending, say
from tree_sway.core.scene import Scene
from tree_sway.core.wind import shorter_than
from tree_sway.files.commands import (
    add_distance_arguments,
    add_sway_arguments,
    distance_settings,
    opened_scene,
    refuse_unused_wind,
    simulated_speed,
)
from tree_sway.files.export import write_tree
from tree_sway.live.commands import add_sensor_argument
from tree_sway.page.commands import add_page_arguments, page_settings, print_address
from tree_sway.parameters import Value
from tree_sway_ros.commands.duration import add_seconds, seconds_of
from tree_sway_ros.commands.monitor import StreamMonitor
from tree_sway_ros.commands.text import summary
from tree_sway_ros.commands.watch import watch
from tree_sway_ros.nodes.viewer import USUAL_OR_FREE
from tree_sway_ros.process.composition import Composition


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add_sway_arguments(parser)
    add(
        '--start',
        type=float,
        default=0.0,
        metavar='T',
        help='start at this time of the recording [s]',
    )
    add_sensor_argument(parser)
    add_distance_arguments(parser, 'sample')
    add_seconds(parser)
    add('--rate', type=float, default=60.0, help='poses per second [Hz] (%(default)s)')
    add(
        '--gravity', choices=('on', 'off'), default='on', help='effect of the weight (%(default)s)'
    )
    add('--no-page', action='store_true', help='do not serve the page')
    add_page_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the demo until its time is over, the record ends, or Ctrl-C."""
    seconds = seconds_of(arguments)
    refuse_unused_wind(arguments)
    scene = opened_scene(arguments)
    tree = scene.tree
    size = f'{tree.n_branches} branches, {tree.n_segments} segments'
    print(f'{tree.name}: {size}; starting', flush=True)
    with (
        Ending() as ending,
        Composition({}) as nodes,
        StreamMonitor(nodes.context, tree) as monitor,
        ExitStack() as files,
    ):

        def continues() -> bool:
            nodes.check()
            return not nodes.is_done

        monitor.expect_silence()
        for name, values in _nodes(arguments, _tree_of(scene, arguments, files)).items():
            node = nodes.add(name, values)
            if name == 'player' and (short := shorter_than(node.length, seconds)):
                say(short)
        if not arguments.no_page:
            _serve_page(nodes, arguments)
        ending.limit = Ending.LONGEST
        watch(monitor, seconds, continues)
        print(summary(monitor.totals, arguments.rate), flush=True)
    return 0


def _serve_page(nodes: Composition, arguments: argparse.Namespace) -> None:
    """Add the viewer, print the address of its page, and open it if requested."""
    values = {**vars(page_settings(arguments)), 'control': True}
    values['origins'] = ' '.join(values['origins'])
    del values['token']  # the node reads it from the file
    if values['port'] is None:
        values['port'] = USUAL_OR_FREE
    server = nodes.add('viewer', values).server
    print_address(server, 'page:')
    if arguments.open:
        webbrowser.open(server.url)


def _tree_of(scene: Scene, arguments: argparse.Namespace, files: ExitStack) -> str:
    """Return the tree for the solver: TREE, or a file of it with the given wood and options."""
    own = (arguments.seed, arguments.option, arguments.modulus, arguments.density)
    if not any(own) or not scene.is_one_tree:
        return str(arguments.tree)
    path = Path(files.enter_context(tempfile.TemporaryDirectory()), 'tree.yaml')
    write_tree(path, scene.tree, scene.species)
    return str(path)


def _nodes(arguments: argparse.Namespace, tree: str) -> dict[str, dict[str, Value]]:
    solver: dict[str, Value] = {
        'tree': tree,
        'species': '' if tree != arguments.tree else arguments.species or '',
        'rate': arguments.rate,
        'model': arguments.model,
        'leaves': arguments.leaves,
        **distance_settings(arguments),
    }
    bearing = solver['anemometer_bearing']
    solver['anemometer_bearing'] = -1.0 if bearing is None else bearing % math.tau
    if arguments.gravity == 'off':
        solver['gravity'] = 0.0
    if arguments.sensor is not None:
        return {'sensor': {'address': arguments.sensor}, 'wind': {}, 'solver': solver}
    if arguments.wind is None:
        anemometer: dict[str, Value] = {'mean_speed': simulated_speed(arguments)}
        return {'anemometer': anemometer, 'wind': {}, 'solver': solver}
    player = {
        'file': arguments.wind,
        'reader_options': ' '.join(arguments.wind_option),
        'start': arguments.start,
    }
    return {'player': player, 'wind': {}, 'solver': solver}
