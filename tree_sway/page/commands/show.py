# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway show``: a tree in wind on a page of the browser, without ROS."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
import math
from pathlib import Path
import time
import webbrowser

import numpy as np

from tree_sway.commands import additions, counting, Ending
from tree_sway.core.checks import within
from tree_sway.core.scene import PlacedTree, Scene, Simulator
from tree_sway.core.settings import Settings, USUAL
from tree_sway.core.species import species_named
from tree_sway.core.tree import rooted
from tree_sway.errors import ParameterError
from tree_sway.files.commands import (
    add_distance_arguments,
    add_sway_arguments,
    chosen_leaves,
    distance_settings,
    opened_scene,
    opened_wind,
    refuse_unused_wind,
)
from tree_sway.files.trees import open_scene, scene_of_files, TreeFile
from tree_sway.growth import grow, stem_of_age
from tree_sway.live.commands import (
    add_sensor_argument,
    listening,
)
from tree_sway.page import Choices, PageServer, PageSettings, Session
from tree_sway.page.commands.addition import PageAddition
from tree_sway.page.commands.page_arguments import add_page_arguments, page_settings, print_address
from tree_sway.page.commands.page_controls import page_controls
from tree_sway.page.leaf_calendar import HALF_YEAR, is_bare, species_in_month, SUMMER
from tree_sway.simulation import WindSource
from tree_sway.stream import ControlPanel, Json, Value

_SPACING = 1.2
"""Distance of the trees of a stand over the greater of height and spread of one."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_sway_arguments(parser, 'wind recording, played in a loop; without it wind is simulated')
    parser.add_argument(
        '--stand',
        type=int,
        default=1,
        metavar='N',
        help='show this many trees as a stand (%(default)s)',
    )
    parser.add_argument(
        '--seconds', type=float, metavar='N', help='end after this time [s]; without it, at Ctrl-C'
    )
    what = 'seasons of a tree to grow are those south of the equator'
    parser.add_argument('--south', action='store_true', help=what)
    parser.add_argument('--read-only', action='store_true', help='viewers cannot change values')
    add_sensor_argument(parser)
    add_distance_arguments(parser, 'sample')
    for each in additions('show'):
        each.add_arguments(parser)
    add_page_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Serve the page until the time is over or Ctrl-C."""
    settings = page_settings(arguments)
    settings.required_token()  # a missing one is told before a tree is opened
    within('--stand', arguments.stand, 1, 1e5)
    if arguments.seconds is not None:
        within('--seconds', arguments.seconds, 0.0, 1e9, 's')
    refuse_unused_wind(arguments)
    added = [each(arguments) for each in additions('show')]
    with Ending(is_last=True) as ending, ExitStack() as stack:
        scene = opened_scene(arguments)  # a wrong file is told before a source is waited for
        for each in added:
            each.open(stack)
        if arguments.sensor is None:
            wind: WindSource = opened_wind(arguments)
        else:
            wind = stack.enter_context(listening(arguments))
        return _serve(arguments, settings, wind, added, ending, scene)
    return 0  # interrupted while it started


def _serve(
    arguments: argparse.Namespace,
    settings: PageSettings,
    wind: WindSource,
    added: Sequence[PageAddition],
    ending: Ending,
    scene: Scene,
) -> int:
    """Serve the page of a wind with the scene of the command, and with what is added to it."""
    choices = Choices(
        Path(arguments.tree).name,
        str(arguments.stand),
        str(arguments.model),
        month=SUMMER - HALF_YEAR if arguments.south else SUMMER,
        is_south=arguments.south,
        gusts=arguments.gusts,
        anemometer_distance=arguments.anemometer_distance,
    )
    own = [control for each in added for control in each.controls()]
    first = {each.name: each.value for each in own if each.name in vars(choices)}
    choices = replace(choices, **first)  # type: ignore[arg-type]
    motion = next((each.motion for each in added if each.motion is not None), None)
    told: dict[str, tuple[str, ...]] = {}
    session = Session(
        lambda wanted: build_scene(wanted, arguments, added, told, scene),
        choices,
        wind,
        motion=motion,
        warnings=told,
    )
    found = (each.critical_winds(session.names) for each in added)
    critical_winds = next((each for each in found if each is not None), None)

    def apply(name: str, value: Value) -> None:
        if not any(each.apply(name, value) for each in added):
            session.apply(name, value)

    def status() -> Json:
        facts = {'Gusts': session.simulator.wind_told}
        for each in added:
            facts |= each.facts(session.simulator)
        return {**session.status(), 'facts': facts}

    panel = ControlPanel()
    if not arguments.read_only:
        is_one_tree = session.status()['trees'] == arguments.stand
        controls = page_controls(choices, wind, is_one_tree=is_one_tree)
        panel = ControlPanel((*own, *controls), apply, session.pull)
        panel.update(session.values())
    pages = PageServer(
        settings, panel, status, session.written, critical_winds, motion.film if motion else None
    )
    with pages as server:
        session.serve(server)
        print_address(server, 'open')
        print('Ctrl-C ends', flush=True)
        if arguments.open:
            webbrowser.open(server.url)
        try:
            ending.look()
            end = math.inf if arguments.seconds is None else time.monotonic() + arguments.seconds
            while not ending.is_asked and session.failure is None and time.monotonic() < end:
                session.wait(min(0.1, end - time.monotonic()))
                _note(added, session.simulator)
        finally:
            session.stop()
            _note(added, session.simulator)
        for each in added:
            each.tell(session.simulator)
        if session.failure is not None:
            raise session.failure
    return 0


def _note(added: Sequence[PageAddition], simulator: Simulator) -> None:
    for each in added:
        each.note(simulator)


def build_scene(
    choices: Choices,
    arguments: argparse.Namespace,
    added: Sequence[PageAddition] = (),
    told: dict[str, tuple[str, ...]] | None = None,
    own: Scene | None = None,
) -> Simulator:
    """
    Make the simulator of some choices, with the warnings of its tree in ``told``.

    What is added may make that of the tree that the command names, whose scene is ``own`` if it is
    open.
    """
    is_first = choices.tree == Path(arguments.tree).name
    if is_first:
        scene = own or opened_scene(arguments)
    else:
        scene = _grown(choices) if choices.is_grown else open_scene(choices.tree, warn=False)
    if told is not None:
        told[choices.tree] = scene.warnings
    count = int(choices.count)
    if count > 1:
        if not scene.is_one_tree:
            raise ParameterError('a stand of a forest', where='--stand', cure='name one tree')
        scene = stand(scene, count, choices.model)
    damping = choices.damping_ratio or None
    in_leaf = chosen_leaves(arguments)
    if (
        not is_first
        and choices.is_grown
        and is_bare(species_named(choices.tree), choices.northern_month)
    ):
        in_leaf = False
    far = distance_settings(arguments)
    far |= {'gusts': choices.gusts, 'anemometer_distance': choices.anemometer_distance}
    settings = Settings(damping_ratio=damping, in_leaf=in_leaf, **far)
    with counting(len(scene.kinds), f'setting {choices.tree} up') as done:
        for each in added if is_first else ():
            simulator = each.simulator(scene, settings, choices)
            if simulator is not None:
                return simulator
        return scene.simulator(settings, model=choices.model, progress=done)


def _grown(choices: Choices) -> Scene:
    """Grow a tree of a species, of the height, age, individual and month that a viewer wants."""
    rng = np.random.default_rng(int(choices.individual))
    diameter = stem_of_age(choices.tree, choices.age) if choices.age else None
    tree = grow(choices.tree, choices.height, diameter, rng=rng)
    wood = rooted(tree, species_named(choices.tree))
    species = species_in_month(wood, tree, choices.northern_month)
    return scene_of_files([TreeFile(tree, species, tree.name).checked()])


def stand(scene: Scene, count: int, model: str) -> Scene:
    """Trees of one kind on a grid, with different yaws; on their table if they have one."""
    tree = scene.tree
    one = scene.trees[0]
    low = tree.start.min(axis=0)
    high = tree.end.max(axis=0)
    spacing = _SPACING * float(max(*(high - low)[:2], 0.5 * tree.height))
    across = math.ceil(math.sqrt(count))
    trees = [
        PlacedTree(
            f'{tree.name}{i + 1}',
            tree,
            x=spacing * (i % across - 0.5 * (across - 1)),
            y=spacing * (i // across - 0.5 * (across - 1)),
            yaw=2.4 * i,
            species=one.species,
            model=USUAL if model == 'auto' else model,
        )
        for i in range(count)
    ]
    return Scene(trees, f'{count} of {tree.name}', scene.source)
