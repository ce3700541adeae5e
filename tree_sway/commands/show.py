# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway show``: a tree in wind on a page of the browser, without ROS."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
import math
from pathlib import Path
import sys
import time
import webbrowser

import numpy as np

from tree_sway.commands.arguments import chosen_leaves, opened_scene
from tree_sway.commands.ending import Ending
from tree_sway.commands.learn_argument import (
    add_learn_argument,
    check_learn_argument,
    Learning,
)
from tree_sway.commands.live_motion_arguments import add_live_motion_arguments, sensing
from tree_sway.commands.page_arguments import add_page_arguments, page_settings, print_address
from tree_sway.commands.page_controls import page_controls, sensor_place
from tree_sway.commands.sensor_arguments import add_sensor_argument, listening
from tree_sway.commands.wind_arguments import (
    add_distance_arguments,
    add_sway_arguments,
    distance_settings,
    opened_wind,
    refuse_unused_wind,
)
from tree_sway.core.checks import within
from tree_sway.core.leaves.calendar import is_bare, species_in_month
from tree_sway.core.model.settings import model_of, Settings, USUAL
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.scene.scene_simulator import Simulator
from tree_sway.core.tree.grown_tree import rooted
from tree_sway.core.tree.species import species_named
from tree_sway.errors import FormatError, inside, ParameterError
from tree_sway.files.motion.tree_history import refuse_no_history, TreeHistory
from tree_sway.files.scenes.critical_winds import read_critical_winds
from tree_sway.files.trees.imported_tree import TreeFile
from tree_sway.files.trees.source import open_scene, scene_of_files
from tree_sway.growth.grow import grow
from tree_sway.growth.stem_by_age import stem_of_age
from tree_sway.live.motion.motion_feed import MotionFeed
from tree_sway.page.page_settings import PageSettings
from tree_sway.page.server import PageServer
from tree_sway.page.session import Choices, RATE, Session
from tree_sway.page.wind_source import WindSource
from tree_sway.stream.controls import ControlPanel
from tree_sway.twin.observed_scene import observed_scene
from tree_sway.twin.observed_tree import ObservedTree
from tree_sway.worker import submit_beside

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
        '--risk',
        metavar='FILE',
        help='table of tree-sway risk of the inventory: a slider of the storm colours the trees',
    )
    parser.add_argument(
        '--seconds', type=float, metavar='N', help='end after this time [s]; without it, at Ctrl-C'
    )
    parser.add_argument('--read-only', action='store_true', help='viewers cannot change values')
    add_sensor_argument(parser)
    add_distance_arguments(parser, 'sample')
    add_live_motion_arguments(parser)
    add_learn_argument(parser)
    parser.add_argument(
        '--history', metavar='FILE',
        help='table (.csv) to which a row is added every ten minutes: wind, residuals, the band, '
        'and what the sensors have told',
    )  # fmt: skip
    add_page_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Serve the page until the time is over or Ctrl-C."""
    settings = page_settings(arguments)
    within('--stand', arguments.stand, 1, 1e5)
    refuse_unused_wind(arguments)
    check_learn_argument(arguments)
    if arguments.risk is not None:
        read_critical_winds(arguments.risk)  # what is wrong with it is said before all else
    if arguments.motion and arguments.stand > 1:
        what = f'motion sensors on a stand of {arguments.stand} trees'
        raise ParameterError(what, where='--motion', cure='leave --stand out')
    with Ending(is_last=True) as ending, sensing(arguments) as motion:
        if arguments.history is not None:
            with inside('--history'):
                refuse_no_history(arguments.history, list(motion.places))
        if arguments.sensor is None:
            return _serve(arguments, settings, opened_wind(arguments), motion, ending)
        with listening(arguments) as wind:
            return _serve(arguments, settings, wind, motion, ending)
    return 0  # interrupted while it started


def _serve(
    arguments: argparse.Namespace,
    settings: PageSettings,
    wind: WindSource,
    motion: MotionFeed,
    ending: Ending,
) -> int:
    """Serve the page of a wind and of the sensors on the tree."""
    print(f'{arguments.tree}: starting (the first start compiles, up to a minute)', flush=True)
    choices = Choices(Path(arguments.tree).name, str(arguments.stand), str(arguments.model))
    if len(motion.places) == 1:
        choices = replace(choices, sensor_at=next(iter(motion.places.values())))
    learning = Learning(arguments.learn)
    history = TreeHistory(arguments.history, list(motion.places)) if arguments.history else None
    told: dict[str, tuple[str, ...]] = {}
    session = Session(
        lambda wanted: build_scene(wanted, arguments, motion.places, learning, told),
        choices,
        wind,
        motion=motion,
        warnings=told,
    )
    critical_winds = _critical_winds(arguments.risk, session.names)
    panel = ControlPanel()
    if not arguments.read_only:
        is_one_tree = session.status()['trees'] == arguments.stand
        controls = page_controls(choices, wind, is_one_tree=is_one_tree)
        if len(motion.places) == 1:
            controls = (sensor_place(choices), *controls)
        panel = ControlPanel(controls, session.apply, session.pull)
        panel.update(session.values())
    pages = PageServer(settings, panel, session.status, session.written, critical_winds)
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
                learning.keep(session.simulator)
                _note_history(history, session.simulator)
        finally:
            session.stop()
            learning.keep(session.simulator)
        learning.tell(session.simulator)
        if session.failure is not None:
            raise session.failure
    return 0


def _note_history(history: TreeHistory | None, simulator: Simulator) -> None:
    """Note the state of an observed tree; say if its row cannot be written."""
    if history is None or not isinstance(simulator, ObservedTree):
        return
    try:
        history.note(simulator, time.monotonic())
    except FormatError as error:
        print(f'warning: {error}', file=sys.stderr)


def _critical_winds(
    risk: str | None, names: tuple[str, ...]
) -> dict[str, tuple[float, float]] | None:
    """Critical winds of the trees of a page, from a table; None without one."""
    if risk is None:
        return None
    winds = read_critical_winds(risk)
    found = {name: winds[name] for name in names if name in winds}
    if not found:
        what = f"no tree is called as one of the table, such as '{next(iter(winds), '')}'"
        cure = 'name the inventory of which tree-sway risk wrote the table'
        raise ParameterError(what, where='--risk', cure=cure)
    return found


def build_scene(
    choices: Choices,
    arguments: argparse.Namespace,
    places: Mapping[str, str] | None = None,
    learning: Learning | None = None,
    told: dict[str, tuple[str, ...]] | None = None,
) -> Simulator:
    """
    Make the simulator of some choices, with the warnings of its tree in ``told``.

    The tree that the command names follows the sensors at the places, and learns; others have
    none.
    """
    is_first = choices.tree == Path(arguments.tree).name
    if is_first:
        scene = opened_scene(arguments)
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
    if not is_first and choices.is_grown and is_bare(species_named(choices.tree), choices.month):
        in_leaf = False
    far = distance_settings(arguments) if is_first and count == 1 else {}
    settings = Settings(damping_ratio=damping, in_leaf=in_leaf, **far)
    if places and is_first and count == 1:
        if choices.sensor_at:
            places = dict.fromkeys(places, choices.sensor_at)
        settings = replace(settings, model=model_of(choices.model))
        file = learning.file_of(scene, in_leaf) if learning else None
        if file is not None:
            scene = scene.of_species(file.opened.species)
        twin = observed_scene(
            scene, settings, at=places, rate=RATE, has_band=True, submit=submit_beside
        )
        if learning and file is not None:
            learning.follow(twin, file)
        return twin
    return scene.simulator(settings, model=choices.model)


def _grown(choices: Choices) -> Scene:
    """Grow a tree of a species, of the height, age, individual and month that a viewer wants."""
    rng = np.random.default_rng(int(choices.individual))
    diameter = stem_of_age(choices.tree, choices.age) if choices.age else None
    tree = grow(choices.tree, choices.height, diameter, rng=rng)
    species = species_in_month(rooted(tree, species_named(choices.tree)), tree, choices.month)
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
