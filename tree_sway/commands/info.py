# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway info``: what a tree is, and how it would sway."""

from __future__ import annotations

import argparse
from dataclasses import replace
from functools import partial
import json
import math
from typing import Any

import numpy as np

from tree_sway.commands.arguments import (
    add_leaves_argument,
    add_tree_arguments,
    opened_scene,
    told_leaves,
)
from tree_sway.commands.info_forest import forest_facts, forest_text
from tree_sway.commands.mode_table import mode_table, ModeRow
from tree_sway.commands.progress import waiting
from tree_sway.core.simulator.season import in_season
from tree_sway.core.simulator.settings import Settings
from tree_sway.core.tree.plausibility import sway_oddity
from tree_sway.core.tree.species import Species
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError, TreeError
from tree_sway.files.trees.imported_tree import TreeFile

_BREAST_HEIGHT, _GRAVITY = 1.3, 9.81


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add_tree_arguments(parser, forests=True)
    add_leaves_argument(parser)
    add('--gravity', choices=('on', 'off'), default='on', help='its own weight (%(default)s)')
    add(
        '--root-stiffness',
        type=float,
        metavar='K',
        help='of its roots against tilting [N m/rad], inf for rigid ones; its own if left out',
    )
    add('--count', type=int, default=10, metavar='N', help='how many frequencies (%(default)s)')
    add('--json', action='store_true', help='for programs, SI units')


def run(arguments: argparse.Namespace) -> int:
    """Print what a tree is."""
    if arguments.count < 1:
        raise ParameterError(
            f'{arguments.count} frequencies', where='--count', cure='ask for 1 or more'
        )
    scene = opened_scene(arguments)
    if not scene.is_one_tree:
        facts = forest_facts(scene, partial(_facts, arguments), told_leaves(arguments))
        print(json.dumps(facts, indent=2) if arguments.json else forest_text(facts))
        return 0
    one = TreeFile(scene.tree, scene.trees[0].species, scene.source, scene.notes)
    with waiting('working out the modes'):
        facts = _facts(arguments, one, told_leaves(arguments))
    print(json.dumps(facts, indent=2) if arguments.json else _text(facts, one))
    return 0


def _facts(
    arguments: argparse.Namespace, tree_file: TreeFile, in_leaf: bool | None
) -> dict[str, Any]:
    settings = Settings(
        gravity=_GRAVITY if arguments.gravity == 'on' else 0.0,
        root_stiffness=arguments.root_stiffness,
        in_leaf=in_leaf,
    )
    return _tree_facts(tree_file, settings, arguments.count)


def _tree_facts(tree_file: TreeFile, settings: Settings, count: int) -> dict[str, Any]:
    """Gather what there is to say about a tree, in SI units, fit for JSON."""
    tree, species = tree_file.tree, tree_file.species
    settings = in_season(tree, species, settings)
    notes = list(tree_file.notes)
    try:
        rows, mass = mode_table(tree, species, settings, count)
    except TreeError as error:
        if settings.gravity == 0.0:
            raise
        # A scan full of noise may not stand; its size is asked for all the same.
        settings = replace(settings, gravity=0.0)
        notes.append(f'modes without its own weight, as it cannot stand: {error}')
        rows, mass = mode_table(tree, species, settings, count)
    warnings = list(tree_file.warnings)
    if rows and (oddity := sway_oddity(tree, species, min(row.frequency for row in rows))):
        warnings.append(oddity)
    breast = _diameter_at(tree_file, _BREAST_HEIGHT)
    return {
        'name': tree.name,
        'source': tree_file.source,
        'notes': notes,
        'warnings': warnings,
        'branches': tree.n_branches,
        'segments': tree.n_segments,
        'height': tree.height,
        'length': float(tree.length.sum()),
        'volume': float(tree.volume.sum()),
        'base_diameter': float(tree.base_diameter[0]),
        'breast_height_diameter': breast,
        'form_factor': _form_factor(tree, breast),
        'measured_conifers': _measured_conifers(tree, species, breast),
        'species': species.key,
        'species_is_estimate': species.is_estimate,
        'modulus': species.modulus,
        'density': species.density,
        'mass': mass,
        'root_stiffness': _roots(species, settings),
        'stem_mass': float(species.density * tree.volume[tree.segments_of(0)].sum()),
        'gravity': settings.gravity,
        'in_leaf': settings.in_leaf,
        'frequencies': [row.frequency for row in rows],
        'modes': [_mode(row) for row in rows],
    }


def _form_factor(tree: Tree, breast: float | None) -> float | None:
    """Volume of the stem over that of a cylinder of its height and breast-height diameter [-]."""
    if breast is None:
        return None
    return float(tree.volume[tree.segments_of(0)].sum() / (np.pi / 4.0 * breast**2 * tree.height))


def _measured_conifers(tree: Tree, species: Species, breast: float | None) -> float | None:
    """Sway of measured conifers of that size in needles in [Hz] (Moore & Maguire 2004)."""
    if breast is None or species.habit != 'conifer':
        return None
    return float(0.0766 + 312.19 * breast / tree.height**2)


def _roots(species: Species, settings: Settings) -> float | None:
    """Stiffness against tilting in [N m/rad], None for rigid roots."""
    given = settings.root_stiffness
    stiffness = species.root_stiffness if given is None else given
    return None if math.isinf(stiffness) else stiffness


def _mode(row: ModeRow) -> dict[str, Any]:
    return {
        'frequency': row.frequency,
        'damping_ratio': row.damping_ratio,
        'axis': [round(float(component), 6) for component in row.axis],
        'direction': row.direction,
        'branch': row.branch,
    }


def _diameter_at(tree_file: TreeFile, height: float) -> float | None:
    """Diameter of the stem at a height above the ground in [m]; None if it is not that high."""
    tree = tree_file.tree
    stem = tree.segments_of(0)
    level = np.concatenate([tree.start[stem, 2], tree.end[stem, 2][-1:]]) - tree.start[0, 2]
    thick = np.concatenate([tree.base_diameter[stem], tree.tip_diameter[stem][-1:]])
    above = np.flatnonzero(level >= height)
    if not len(above):
        return None
    at = int(above[0])
    return float(np.interp(height, level[at - 1 : at + 1], thick[at - 1 : at + 1]))


def _text(facts: dict[str, Any], tree_file: TreeFile) -> str:
    breast = facts['breast_height_diameter']
    estimate = ' (an estimate)' if facts['species_is_estimate'] else ''
    weight = 'with its own weight' if facts['gravity'] else 'without its own weight'
    lines = [
        f'{facts["name"]}, from {facts["source"]}',
        f'  size       {facts["branches"]} branches, {facts["segments"]} segments, '
        f'{facts["height"]:.2f} m high, {facts["volume"] * 1e3:.4g} l of wood',
        f'  diameter   {facts["base_diameter"] * 1e3:.1f} mm at the ground'
        + (f', {breast * 1e3:.1f} mm at {_BREAST_HEIGHT} m' if breast is not None else ''),
        f'  wood       {tree_file.species.title}{estimate}: {facts["modulus"] / 1e9:.3g} GPa, '
        f'{facts["density"]:.4g} kg/m^3',
        f'  mass       {facts["mass"]:.4g} kg '
        f'{"in leaf" if facts["in_leaf"] else "without leaves"}, '
        f'{facts["stem_mass"]:.4g} kg of it in the stem',
    ]
    roots, form = facts['root_stiffness'], facts['form_factor']
    lines.append(f'  roots      {"rigid" if roots is None else f"{roots:.3g} N m/rad"}')
    if form is not None:
        lines.append(f'  form       the stem fills {form:.2f} of its cylinder at breast height')
    if facts['measured_conifers'] is not None:
        lines.append(
            f'  compare    measured conifers of this size, in needles, sway at '
            f'{facts["measured_conifers"]:.3f} Hz'
        )
    lines += [f'  note       {note}' for note in facts['notes']]
    lines += [f'  warning    {oddity}' for oddity in facts['warnings']]
    if facts['modes']:
        lines.append(f'  natural modes, {weight}:')
        lines.append('       Hz   damping   sways along (east = 0, north = 90)   most in branch')
    for mode in facts['modes']:
        lines.append(
            f'  {mode["frequency"]:7.3f}   {mode["damping_ratio"]:7.3f}   '
            f'{mode["direction"]:35}  {mode["branch"]}'
        )
    return '\n'.join(lines)
