# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway lab bench``: what a step costs, against a stated baseline in the same run."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
import json
from pathlib import Path
import platform
from typing import Any

from tree_sway.core.scene import SceneSimulator
from tree_sway.core.settings import Settings
from tree_sway.errors import ParameterError
from tree_sway.files.trees import open_scene, open_tree
from tree_sway_lab.bench.bench_tree import bench_tree, SEGMENTS_A_BRANCH
from tree_sway_lab.bench.cut import cut_table
from tree_sway_lab.bench.engines import race_engines
from tree_sway_lab.bench.forest import forest_table
from tree_sway_lab.bench.latency import time_latency
from tree_sway_lab.bench.measured import as_json, draw, Measured, read_baseline, table
from tree_sway_lab.bench.page import time_page
from tree_sway_lab.bench.risk import N_TREES, time_risk
from tree_sway_lab.bench.setup_time import setup_table
from tree_sway_lab.bench.shards import time_shards
from tree_sway_lab.bench.sizes import time_sizes
from tree_sway_lab.bench.stand import time_stand
from tree_sway_lab.bench.step import StepTiming, time_steps
from tree_sway_lab.bench.stream import time_stream
from tree_sway_lab.bench.vane_to_leaf import time_long_line, time_vane_to_leaf


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        'what',
        choices=('step', 'cut', 'forest', 'setup', *_FIGURES),
        help='step: solve and place one step of a tree of 121 branches; cut: solve it cut in 3 '
        'to 24 segments per branch; forest: 20 trees of 10,200 segments at 60 Hz; setup: set '
        'trees of 121 and 1,021 branches up; sizes: the default model on trees of 121 to 10,105 '
        'branches, its cost and its error; stand: 1,000 trees of 1,000 segments; stream: 10,000 '
        'poses at 60 Hz to another process; latency: from a start to its first pose, from the '
        'stamp of a wind to its pose, from the vane through all nodes to a page; engines: beside '
        'MuJoCo, DART and Newton; '
        'shards: a stand on two hosts, cut apart and with a shard killed; page: frames per second '
        'of the page without a graphics unit, and its memory; risk: critical winds of 1,000 and '
        '20,000 street trees, time and memory',
    )
    parser.add_argument('--rounds', type=int, default=20, help='of 200 steps each (%(default)s)')
    parser.add_argument('--segments', type=int, default=6, help='a branch, for step (%(default)s)')
    parser.add_argument('--json', action='store_true', help='for programs; not for cut to setup')
    parser.add_argument(
        '--tree',
        metavar='TREE',
        help="instead of the benchmark's own: a tree for sizes, latency and engines, many "
        'trees for stand, any for page',
    )
    parser.add_argument(
        '--size',
        type=int,
        metavar='N',
        help='trees of stand, shards, page and risk, poses of stream, segments of engines, about',
    )
    parser.add_argument(
        '--seconds', type=float, metavar='S', help='how long stream, latency, engines and page run'
    )
    parser.add_argument('--baseline', metavar='FILE', help='what --json wrote before: show ratios')
    parser.add_argument('--chart', metavar='FILE', help='draw the figures as PNG, SVG or PDF')


def run(arguments: argparse.Namespace) -> int:
    """Time steps and print what they cost."""
    for name, low, high in (('rounds', 1, 10_000), ('segments', 1, 200)):
        if not low <= getattr(arguments, name) <= high:
            value = getattr(arguments, name)
            raise ParameterError(f'{value}', where=f'--{name}', cure=f'give {low} to {high}')
    if arguments.what in _FIGURES:
        return _measure(arguments)
    if arguments.what != 'step':
        print(f'one thread on {core_name()}')
        if arguments.what == 'cut':
            print(cut_table(10 * arguments.rounds))
        else:
            print(forest_table() if arguments.what == 'forest' else setup_table())
        return 0
    tree = bench_tree(arguments.segments)
    timings = [time_steps(tree, model, arguments.rounds) for model in ('branch', 60, 'full')]
    if arguments.json:
        rows = [asdict(timing) for timing in timings]
        print(
            json.dumps(
                {'core': core_name(), 'segments': tree.n_segments, 'timings': rows}, indent=2
            )
        )
        return 0
    print(f'{tree.n_branches} branches, {tree.n_segments} segments; one thread on {core_name()}')
    print('solve and place [us]   median      min')
    for timing in timings:
        print(_row(timing))
    return 0


def _measure(arguments: argparse.Namespace) -> int:
    """Run a benchmark that gives figures, and report them in the ways that are asked for."""
    if arguments.size is not None and not 1 <= arguments.size <= 200_000:
        raise ParameterError(f'{arguments.size}', where='--size', cure='give 1 to 200000')
    if arguments.seconds is not None and not 0.5 <= arguments.seconds <= 3600.0:
        raise ParameterError(
            f'{arguments.seconds:g} s', where='--seconds', cure='give 0.5 to 3600'
        )
    baseline = None if arguments.baseline is None else read_baseline(arguments.baseline)
    rows = _FIGURES[arguments.what](arguments)
    title = f'{arguments.what}, on {core_name()}'
    if arguments.json:
        print(as_json(rows, what=arguments.what, core=core_name()), end='')
    else:
        print(f'{title}\n{table(rows, baseline)}')
    if arguments.chart is not None:
        draw(rows, arguments.chart, title)
    return 0


def _given(**options: Any) -> dict[str, Any]:
    """Options that are given."""
    return {name: value for name, value in options.items() if value is not None}


def _sizes(arguments: argparse.Namespace) -> list[Measured]:
    return time_sizes([open_tree(arguments.tree).tree] if arguments.tree else ())


def _stand(arguments: argparse.Namespace) -> list[Measured]:
    if arguments.tree is None:
        return time_stand(**_given(n_trees=arguments.size))
    scene = open_scene(arguments.tree)
    if scene.is_one_tree:
        raise ParameterError(
            f"'{arguments.tree}' is no stand", where='--tree', cure='give config/stand.yaml'
        )
    return time_stand(partial(SceneSimulator, scene, Settings()))


def _stream(arguments: argparse.Namespace) -> list[Measured]:
    return time_stream(**_given(n_poses=arguments.size, seconds=arguments.seconds))


def _latency(arguments: argparse.Namespace) -> list[Measured]:
    given = _given(tree=arguments.tree, seconds=arguments.seconds)
    return [*time_latency(**given), *time_vane_to_leaf(**given), *time_long_line(**given)]


def _page(arguments: argparse.Namespace) -> list[Measured]:
    return time_page(**_given(tree=arguments.tree, size=arguments.size, seconds=arguments.seconds))


def _engines(arguments: argparse.Namespace) -> list[Measured]:
    tree = open_tree(arguments.tree).tree if arguments.tree else None
    if tree is None and arguments.size is not None:
        each = max(1, round((arguments.size / (12 * SEGMENTS_A_BRANCH)) ** 0.5))
        tree = bench_tree(children=(12, each, each))
    return race_engines(tree, **_given(seconds=arguments.seconds))


_FIGURES: dict[str, Callable[[argparse.Namespace], list[Measured]]] = {
    'sizes': _sizes,
    'stand': _stand,
    'stream': _stream,
    'latency': _latency,
    'engines': _engines,
    'page': _page,
    'risk': lambda arguments: time_risk([arguments.size] if arguments.size else N_TREES),
    'shards': lambda arguments: time_shards(**_given(n_trees=arguments.size)),
}


def core_name() -> str:
    """Name of the processor, as the system reports it."""
    try:
        lines = Path('/proc/cpuinfo').read_text(encoding='utf-8').splitlines()
    except OSError:
        lines = []
    names = [line.split(':', 1)[1].strip() for line in lines if line.startswith('model name')]
    return names[0] if names else platform.processor() or platform.machine()


def _row(timing: StepTiming) -> str:
    return f'  {timing.model:19} {1e6 * timing.median:7.1f}  {1e6 * timing.minimum:7.1f}'
