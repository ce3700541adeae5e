# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway info``: facts on the trees of a scene, and their sway."""

from __future__ import annotations

import argparse
import json
import math
from typing import Any

import numpy as np

from tree_sway.cache import MODELS
from tree_sway.commands import bar
from tree_sway.core.checks import within
from tree_sway.core.scene import Kind, make_simulator, PlacedTree, Scene
from tree_sway.core.settings import Settings
from tree_sway.core.setup import in_season, TreeReductions
from tree_sway.core.species import Species
from tree_sway.core.tree import oddities, Tree
from tree_sway.errors import LONGEST_NOTE, shown, TreeError
from tree_sway.files.commands import (
    add_exact_argument,
    add_leaves_argument,
    add_tree_arguments,
    chosen_leaves,
    opened_scene,
    simulated_speed,
)
from tree_sway.files.trees import sway_oddity
from tree_sway.growth import BREAST_HEIGHT, breast_height_diameter
from tree_sway.simulation import StrengthUse
from tree_sway.simulation.commands.exposure import (
    add_exposure_arguments,
    refuse_unused_exposure,
)
from tree_sway.simulation.commands.mode_table import mode_table
from tree_sway.simulation.commands.strength import tallest_of_kinds, used_strength
from tree_sway.twin import advised_places

_GRAVITY = 9.81
_SUMS = ('branches', 'segments', 'volume', 'mass')
_POWERS = {'height': 1, 'volume': 3, 'mass': 3}
"""Scaling of figures with the size of a tree."""
_MOST_LINES = 40
_LONGEST_NAME = 60


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add_tree_arguments(parser, forests=True)
    add_exact_argument(parser)
    add_leaves_argument(parser)
    add(
        '--gravity', choices=('on', 'off'), default='on', help='effect of the weight (%(default)s)'
    )
    add(
        '--count',
        type=int,
        default=10,
        metavar='N',
        help='number of natural frequencies (%(default)s)',
    )
    add(
        '--sensors',
        type=int,
        default=0,
        metavar='K',
        help='say where this many motion sensors tell most (1 to 8)',
    )
    strength = (
        'report the fraction of the strength used in the largest gust of ten minutes of this mean '
        'wind [m/s]'
    )
    add('--speed', type=float, metavar='U', help=strength)
    add_exposure_arguments(parser)
    add('--json', action='store_true', help='print JSON in SI units')


def run(arguments: argparse.Namespace) -> int:
    """Print the facts on the trees."""
    within('--count', arguments.count, 1, 1e6)
    within('--sensors', arguments.sensors, 0, 8)
    if arguments.speed is None:
        refuse_unused_exposure(arguments, '--speed U')
    else:
        simulated_speed(arguments)
    scene = opened_scene(arguments, says=False)
    kinds = scene.kinds
    if scene.is_one_tree:
        kinds = [kinds[0]._replace(tree=scene.tree)]
    tallest = tallest_of_kinds(scene)
    found = [
        _kind_facts(kind, tallest[number], arguments)
        for number, kind in enumerate(bar(kinds, 'computing the modes'))
    ]
    facts = {'name': scene.name, 'source': scene.source} | (
        found[0] if scene.is_one_tree else _sums(scene, found, tallest)
    )
    facts['notes'] = [*scene.notes, *facts['notes']]
    facts['warnings'] = [*scene.faults, *facts['warnings']]
    print(json.dumps(facts, indent=2) if arguments.json else _text(facts))
    return 0


def _kind_facts(kind: Kind, tallest: PlacedTree, arguments: argparse.Namespace) -> dict[str, Any]:
    """Collect the facts on a kind of trees, in SI units, for JSON; strength is of its tallest."""
    tree = kind.tree
    species = kind.species
    count = arguments.count
    settings = Settings(
        gravity=_GRAVITY if arguments.gravity == 'on' else 0.0,
        in_leaf=chosen_leaves(arguments) if kind.leaf_on is None else kind.leaf_on,
    )
    settings = in_season(tree, species, settings)
    notes = []
    modes = list[dict[str, Any]]()
    try:
        whole = TreeReductions(tree, species, settings)
        modes, mass = mode_table(whole, count)
        limp_doubt = _limp_doubt(whole)
    except TreeError as error:
        if settings.gravity == 0.0:
            raise
        # Its size is still of interest.
        leaf_mass = 0.0 if settings.leaf_mass is None else float(settings.leaf_mass.sum())
        mass = species.density * float(tree.volume.sum()) + leaf_mass
        doubts = [f'no modes: {error}']
    else:
        odd = sway_oddity(tree, species, min(mode['frequency'] for mode in modes))
        doubts = [*filter(None, [odd, limp_doubt])]
        if arguments.sensors:
            notes.append(_sensor_advice(tree, species, settings, arguments.sensors))
    used = published = None
    if arguments.speed is not None:
        placed = tallest.placed()
        chosen = Settings(gravity=settings.gravity, in_leaf=settings.in_leaf)
        exposure, (used,) = used_strength(tallest, chosen, arguments, [arguments.speed])
        notes.append(
            f'{exposure}, of {arguments.speed:g} m/s: {used}; in brackets, where 80 % of such '
            'trees are; rot and wet soil are not included'
        )
        at_top = float(exposure.profile().over_anemometer(np.array(exposure.height)))
        published = _published_moment(placed, species, at_top * arguments.speed)
        if published is not None:
            notes.append(_moment_note(used, published, exposure.kind))
    frequencies = [mode['frequency'] for mode in modes]
    return {
        'name': tree.name, 'notes': notes,
        'warnings': [*oddities(tree, species), *doubts],
        'branches': tree.n_branches, 'segments': tree.n_segments, 'height': tree.height,
        'length': float(tree.length.sum()),
        'volume': float(tree.volume.sum()), 'base_diameter': float(tree.base_diameter[0]),
        'breast_height_diameter': breast_height_diameter(tree), 'species': species.key,
        'wood': f'{species.title}{" (an estimate)" if species.is_estimate else ""}',
        'modulus': species.modulus, 'density': species.density, 'mass': mass,
        'root_stiffness': None if math.isinf(species.root_stiffness) else species.root_stiffness,
        'gravity': settings.gravity, 'in_leaf': settings.in_leaf,
        'strength': used and used.plain(), 'published_moment': published,
        'frequencies': frequencies, 'modes': modes,
    }  # fmt: skip


def _limp_doubt(whole: TreeReductions) -> str:
    """Return what makes the motion of a limp tree doubtful, as `simulate` says it."""
    if not whole.is_limp:
        return ''
    simulator = make_simulator(whole.tree, whole.species, whole.settings, cache=MODELS)
    return simulator.banks[0].doubt


def _sensor_advice(tree: Tree, species: Species, settings: Settings, count: int) -> str:
    """Say where motion sensors tell most, and what they leave unknown."""
    simulator = make_simulator(tree, species, settings, cache=MODELS)
    places = [f'{each.at} ({each.left:.0%} left)' for each in advised_places(simulator, count)]
    return (
        f'motion sensors tell most, each with those before it, at {", ".join(places)} of the '
        'sway that the wind does not tell (--at)'
    )


def _published_moment(tree: Tree, species: Species, speed: float) -> float | None:
    """
    Largest moment in an hour at the base of a conifer in a stand in [N m].

    Hale et al. (2012), European Journal of Forest Research 131, 203-217: 111.7 d^2 h U^2, d at
    breast height, U the mean at the top of the stand. None for others and below 1.3 m.
    """
    diameter = breast_height_diameter(tree)
    if species.habit != 'conifer' or diameter is None:
        return None
    return 111.7 * diameter**2 * tree.height * speed**2


def _moment_note(used: StrengthUse, published: float, exposure: str) -> str:
    """Say the largest moment at the base with its band, and where the published one lies."""
    low, high = (each / 1e3 for each in used.moment_band)
    if low <= published / 1e3 <= high:
        where = 'within that band'
    elif exposure == 'stand' or published / 1e3 > high:
        where = 'outside that band: one of the two is wrong for this tree'
    else:
        where = (
            'outside that band, as such trees shelter each other and their crowns are cut short: '
            'with --exposure stand the tree is one of them'
        )
    return (
        f'largest moment at the base {used.base_moment / 1e3:.3g} kN m ({low:.3g} to {high:.3g} '
        f'kN m); the published one of conifers in stands is {published / 1e3:.3g} kN m, {where} '
        '(112 d^2 h U^2 with the hourly mean at the top of the stand: Hale et al. 2012)'
    )


def _sums(
    scene: Scene, kinds: list[dict[str, Any]], tallest: dict[int, PlacedTree]
) -> dict[str, Any]:
    """
    Collect the facts on several trees, each scaled from its kind as in the solver.

    Warnings are of the first tree of a kind, notes on strength of its tallest.
    """
    trees = []
    for each, number in zip(scene.trees, scene.kind_numbers.tolist(), strict=True):
        facts = kinds[number]
        k = each.scale
        tree = {name: facts[name] for name in ('branches', 'segments', 'species', 'in_leaf')}
        tree |= {name: facts[name] * k**power for name, power in _POWERS.items()}
        place = {'x': each.x, 'y': each.y, 'z': each.z, 'yaw': each.yaw}
        sways = [frequency / k for frequency in facts['frequencies']]
        trees.append(
            {'name': each.name, 'kind': number, 'place': place, 'frequencies': sways, **tree}
        )
    named = {
        'notes': {number: tree.name for number, tree in tallest.items()},
        'warnings': {tree['kind']: tree['name'] for tree in reversed(trees)},
    }
    sentences = {
        what: [f'{names[n]}: {each}' for n, kind in enumerate(kinds) for each in kind[what]]
        for what, names in named.items()
    }
    return {
        **sentences,
        **{name: sum(tree[name] for tree in trees) for name in _SUMS},
        'height': max(tree['place']['z'] + tree['height'] for tree in trees),
        'trees': trees,
        'kinds': kinds,
    }


def _text(facts: dict[str, Any]) -> str:
    """Format the facts as text."""
    lines = [f'{_short(facts["name"])}, from {facts["source"]}']
    lines += _forest_lines(facts) if 'trees' in facts else _tree_lines(facts)
    lines += [f'  note       {note}' for note in facts['notes']]
    lines += [f'  warning    {oddity}' for oddity in facts['warnings']]
    if modes := facts.get('modes'):
        weight = 'with its own weight' if facts['gravity'] else 'without its own weight'
        lines.append(f'  natural modes, {weight}:')
        lines.append('       Hz   damping   most in branch')
        lines += [
            f'  {mode["frequency"]:7.3f}   {mode["damping_ratio"]:7.3f}   {mode["branch"]}'
            for mode in modes
        ]
    return '\n'.join(shown(line, LONGEST_NOTE) for line in lines)


def _short(name: str) -> str:
    """Return a name of at most a line; `--json` has it whole."""
    return name if len(name) <= _LONGEST_NAME else f'{name[: _LONGEST_NAME - 3]}...'


def _tree_lines(facts: dict[str, Any]) -> list[str]:
    breast = facts['breast_height_diameter']
    roots = facts['root_stiffness']
    high = '' if breast is None else f', {breast * 1e3:.1f} mm at {BREAST_HEIGHT} m'
    return [
        f'  size       {facts["branches"]} branches, {facts["segments"]} segments, '
        f'{facts["height"]:.2f} m high, {facts["volume"] * 1e3:.4g} l of wood',
        f'  diameter   {facts["base_diameter"] * 1e3:.1f} mm at the ground{high}',
        f'  wood       {facts["wood"]}: {facts["modulus"] / 1e9:.3g} GPa, '
        f'{facts["density"]:.4g} kg/m^3',
        f'  mass       {facts["mass"]:.4g} kg, {"in leaf" if facts["in_leaf"] else "leafless"}',
        f'  roots      {"do not turn" if roots is None else f"turn by {roots:.3g} N m/rad"}',
    ]


def _forest_lines(facts: dict[str, Any]) -> list[str]:
    trees = facts['trees']
    shown = trees[:_MOST_LINES]
    wide = max(4, *(len(_short(tree['name'])) for tree in shown))
    lines = [
        f'  size       {len(trees)} trees of {len(facts["kinds"])} kinds, {facts["branches"]} '
        f'branches, {facts["segments"]} segments, {facts["volume"] * 1e3:.4g} l of wood, '
        f'{facts["mass"]:.4g} kg',
        f'  {"tree":{wide}}   species       east    north     height       mass       sways',
    ]
    for tree in shown:
        place = tree['place']
        slowest = tree['frequencies']
        sways = f'{slowest[0]:6.3f} Hz' if slowest else '        -'
        lines.append(
            f'  {_short(tree["name"]):{wide}}   {tree["species"]:11} {place["x"]:6.2f}'
            f'   {place["y"]:6.2f}   {tree["height"]:6.2f} m {tree["mass"]:7.4g} kg   {sways}'
            f'{"   in leaf" if tree["in_leaf"] else ""}'
        )
    if len(trees) > len(shown):
        lines.append(f'  and {len(trees) - len(shown)} more: --json lists them all')
    return lines
