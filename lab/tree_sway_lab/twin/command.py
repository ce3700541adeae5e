# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway lab twin``: how far sensors bring the model to a tree of other wood, damping and gusts.

The true tree is made up: every segment a rigid body in a field of gusts, beside a mast, its wood,
damping and drag drawn by the seed (`gusty_truth`). Without a tree there are six kinds. With
``--easy`` it is the model with all coordinates, its wood softer by a fifth, its damping higher by
half, and gusts that reach limb after limb with a copy of the measured wind: kinder than a tree
outdoors, as what shakes the crown is in the measured wind.

Each row has one number of sensors: dynamic error of all tips and roughness, the correlation of the
stem's tip, the share of the time that the band of 80 % holds the tips, the time of a step, median
and 99th percentile, and the time per step of the thread that finds gains, mountings and fits
beside the steps.
``sensor r`` is the correlation at the first sensor, then follow the times at which it was first
in use, and first out of use after that. ``--fault`` adds faults of the sensors (`sensor_faults`),
those that begin later from 90 s on; ``late`` is a record of a wrong clock, ``live`` one that comes
in time, ``first`` the fault of one of several sensors. The model knows how far the mast is.
The part of the record in which mountings are found is not scored. Rows beside them: ``model``, the
simulator as it is without sensors, and ``U^2``, the square of the wind, low-passed at the first
frequency of the model, with the gains that are best for each tip (outdoors at the frequency that
is best too; fitted to what it is scored on, it is below the bound where the record is short, so
that ``U^2 (gains of the model)`` has those of the model in the same wind, which need no truth).

Outdoors, ``expected`` and ``sample`` are the simulator that knows where the mast stands, the last
columns the power of all tips over the true one in four bands. ``(known tree)`` has the wood,
damping and drag of the true one, and ``bound`` the wind too that all of the mast's record tells by
the true law: no estimate from the mast's wind alone errs less, but by chance.

``1 linear`` is a linear filter of what that number of sensors measure, fitted to the true tips
(`linear_filter`): about the least error that such sensors leave.

One tree of one wood tells little about a band: what the model errs in its lean stays for the whole
record, so that a band of 80 % holds it always or never. ``--drawn`` draws wood, damping and drag
of several true trees from the spreads that the band assumes; the rows are means over them.

``tree-sway lab twin RECORD`` scores a record of a real tree instead, as `record_score` says.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from itertools import product
import sys
from typing import Any

import numpy as np

from tree_sway.commands import Ending
from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.twin import advised_places
from tree_sway_lab.twin.gusty_truth import (
    gusty_motion,
    kinds_of,
    known_tree,
    mast_of,
    Outside,
    told_wind,
)
from tree_sway_lab.twin.read_record import is_tree_record, read_tree_record
from tree_sway_lab.twin.record_score import score_record
from tree_sway_lab.twin.sensor_faults import FAULTS
from tree_sway_lab.twin.sway_comparison import BANDS
from tree_sway_lab.twin.trial import (
    linear_score,
    mean_score,
    plain_score,
    Score,
    squared_score,
    swayed,
    twin_score,
)
from tree_sway_lab.twin.true_tree import (
    Circumstances,
    drawn,
    sensor_places,
    tree_called,
    true_motion,
    TrueMotion,
)

_HEAD = (
    'tree',
    'sensors',
    'error',
    'rough',
    'stem r',
    'held',
    'us/step',
    'us 99 %',
    'us beside',
    'sensor r',
    'found at s',
    'left at s',
    *(f'to {high:g} f1' for _, high in BANDS),
    'notes',
)
CUTOFFS = (1.0, 0.5, 0.25, 0.12, 0.06, 0.03)
"""Frequencies over the first one at which the square of the wind is low-passed."""

_RECORD_HEAD = (
    *('record', 'held out', 'quantity', 'motion', 'r', 'lag', 'error', 'rms'),
    *(f'to {high:g} f1' for _, high in BANDS),
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add, default = parser.add_argument, Circumstances()
    add(
        'tree',
        nargs='*',
        help='kind of the laboratory, or species, height and seed, as "oak 9 4"; or the folder of '
        'a record of wind and motion, as tree-sway record writes it; without it, six kinds of '
        '--seed',
    )
    add('--easy', action='store_true', help='a truth that has the measured wind in its crown')
    add(
        '--mast',
        type=float,
        nargs=3,
        default=Outside.mast,
        metavar=('X', 'Y', 'Z'),
        help='place of the anemometer from the top of the tree in [m], x along the wind, without '
        '--easy (%(default)s)',
    )
    add(
        '--other-gusts',
        type=float,
        metavar='HEADING',
        help='gusts by another law than the one that the model assumes, in a wind with a profile '
        'that goes to a heading [deg] from east to north, without --easy',
    )
    add('--in-leaf', action='store_true', help='in leaf; bare without it')
    add('--sensors', type=int, nargs='+', default=[0, 1, 2, 4], help='numbers (%(default)s)')
    add(
        '--drawn',
        type=int,
        default=0,
        help='number of true trees whose wood, damping and drag are drawn from their spreads '
        '(one; with --easy one of --wood and --damping)',
    )
    add('--model', default='full', help='model of the true tree of --easy (%(default)s)')
    add('--without-band', action='store_true', help='us/step is that of the sensors alone')
    add('--advised', action='store_true', help='sensors where tree-sway info --sensors advises')
    add('--known', action='store_true', help='the model has the wood and damping of the true tree')
    add(
        '--tell-upwind',
        action='store_true',
        help='the model knows --upwind where it has no sensor',
    )
    add('--only-sensors', action='store_true', help='without the rows beside them')
    add('--faulty', action='store_true', help='late, lossy, biased sensors of 25 Hz, askew')
    add(
        '--fault',
        nargs='+',
        default=['none'],
        choices=tuple(FAULTS),
        help='faults of the sensors, a row for each (%(default)s)',
    )
    for name, what in (
        ('wood', 'modulus of the true tree over the model'),
        ('damping', 'damping ratio of the true tree over the model'),
        ('coherence', 'share of a gust that reaches the whole crown at once'),
        ('upwind', 'distance of the anemometer upwind [m]'),
        ('speed', 'mean wind [m/s]'),
        ('seconds', 'length of the record [s]'),
    ):
        add(f'--{name}', type=float, default=getattr(default, name), help=f'{what} (%(default)s)')
    add('--seed', type=int, default=default.seed, help='of the wind (%(default)s)')


def run(arguments: argparse.Namespace) -> int:
    """Score every tree with every number of sensors."""
    names = ('wood', 'damping', 'coherence', 'upwind', 'speed', 'seconds', 'seed')
    around = Circumstances(**{name: getattr(arguments, name) for name in names})
    records = [name for name in arguments.tree if is_tree_record(name)]
    made_up = [name for name in arguments.tree if name not in records]
    if not arguments.tree:
        made_up = ['straight', 'spruce 8'] if arguments.easy else kinds_of(around.seed)
    with Ending():
        if records:
            print(','.join(_RECORD_HEAD))
        for name in records:
            _print_record(name)
        if made_up:
            print(','.join(_HEAD))
        for name in made_up:
            _try(name, around, arguments)
    return 0


def _print_record(name: str) -> None:
    record = read_tree_record(name)
    for held in score_record(record):
        if held.problem:
            print(f'note: {name}, {held.at}: {held.problem}', file=sys.stderr)
        for motion, score in held.rows.items():
            figures = [score.error, score.rms, *score.bands]
            row = [
                record.folder.name,
                held.at,
                held.quantity,
                motion,
                f'{score.r:.3f}',
                f'{score.lag:.2f}',
            ]
            print(','.join([*row, *(f'{each:.3f}' for each in figures)]))
        sys.stdout.flush()
    if record.sway:
        print(f'note: {name}: its sway is scored by tree-sway lab score', file=sys.stderr)


def _try(name: str, around: Circumstances, arguments: argparse.Namespace) -> None:
    tree, species = tree_called(name)
    in_leaf = arguments.in_leaf
    known = make_simulator(tree, species, in_leaf=in_leaf)
    places = sensor_places(tree, max(arguments.sensors))
    if arguments.advised:
        advised = advised_places(known, max(arguments.sensors), arguments.speed)
        places = [each.at for each in advised]
    model = int(arguments.model) if arguments.model.isdecimal() else arguments.model
    trees = [around]
    if arguments.drawn:
        trees = drawn(around, arguments.drawn, in_leaf=in_leaf)
    frequency = float(known.frequencies(1)[0])
    scores: dict[str, list[Score]] = {}
    other: dict[str, Any] = {}
    if arguments.other_gusts is not None:
        other = {'is_other': True, 'heading': float(np.deg2rad(arguments.other_gusts))}
    for each in trees:
        apart: dict[str, Any] = {}
        if arguments.easy:
            true = true_motion(tree, species, places, each, in_leaf=in_leaf, model=model)
            scores.setdefault('U^2', []).append(squared_score(true, frequency))
        else:
            outside = Outside(
                mast=tuple(arguments.mast),
                speed=each.speed,
                seconds=each.seconds,
                seed=each.seed,
                **other,
            ).drawn(tree)
            factors = each if arguments.drawn else outside
            wood, damping, drag = factors.wood, factors.damping, factors.drag
            outside = replace(outside, wood=wood, damping=damping, drag=drag)
            each = replace(each, wood=wood, damping=damping, drag=drag, upwind=0.0)
            true = gusty_motion(tree, species, places, outside, in_leaf=in_leaf)
            distance, bearing = mast_of(outside)
            apart |= {'anemometer_distance': distance, 'anemometer_bearing': bearing}
            if not arguments.only_sensors:
                beside = _scored_beside(tree, species, true, outside, known, apart)
                for row, score in beside.items():
                    scores.setdefault(row, []).append(score)
        if not arguments.only_sensors:
            known.reset()
            scores.setdefault('model', []).append(plain_score(known, true))
            for count in filter(None, arguments.sensors):
                linear = linear_score(true, places[:count])
                scores.setdefault(f'{count} linear', []).append(linear)
        for count, fault in product(arguments.sensors, arguments.fault):
            score = twin_score(
                tree,
                species,
                true,
                places[:count],
                in_leaf=in_leaf,
                faulty=arguments.faulty,
                has_band=not arguments.without_band,
                known=each if arguments.known else None,
                upwind=each.upwind if arguments.tell_upwind else 0.0,
                **apart,
                fault=fault,
            )
            named = str(count) if fault == 'none' else f'{count} {fault}'
            scores.setdefault(named, []).append(score)
    for sensors, found in scores.items():
        _print(name, sensors, mean_score(found))


def _scored_beside(
    tree: Tree,
    species: Species,
    true: TrueMotion,
    outside: Outside,
    known: SwaySimulator,
    apart: Mapping[str, Any],
) -> dict[str, Score]:
    """Score what needs no sensor on a tree outside, by its rows."""
    in_leaf = bool(known.settings.in_leaf)
    frequency = float(known.frequencies(1)[0])
    known.reset()
    model, _ = swayed(known, true.wind)
    found: dict[str, Score] = {}
    for row, like in (('U^2', None), ('U^2 (gains of the model)', model)):
        passed = [squared_score(true, share * frequency, like) for share in CUTOFFS]
        found[row] = min(passed, key=lambda score: score.error)
    for gusts in ('expected', 'sample'):
        far = make_simulator(tree, species, in_leaf=in_leaf, gusts=gusts, **apart)
        found[gusts] = plain_score(far, true)
    true_one = known_tree(tree, species, outside, in_leaf=in_leaf)
    told = true._replace(wind=told_wind(tree, outside, true.wind))
    found['bound'] = plain_score(true_one, told)
    for gusts in ('expected', 'sample'):
        far = known_tree(tree, species, outside, in_leaf=in_leaf, gusts=gusts, **apart)
        found[f'{gusts} (known tree)'] = plain_score(far, true)
    return found


def _print(name: str, sensors: str, score: Score) -> None:
    figures = score.error, score.roughness, score.stem, score.held
    row = [
        name,
        sensors,
        *(f'{each:.3f}' for each in figures),
        f'{score.cost:.0f}',
        f'{score.worst:.0f}',
        f'{score.beside:.0f}',
        f'{score.at:.3f}',
        f'{score.found:.0f}',
        f'{score.told:.1f}',
        *(f'{each:.2f}' for each in score.bands or [np.nan] * len(BANDS)),
    ]
    print(','.join([*row, '; '.join(score.notes)]))
    sys.stdout.flush()
