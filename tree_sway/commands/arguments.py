# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Arguments that commands share: TREE, its wood and leaves, the wind, the model, the output."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path
import sys
from typing import Any

from tree_sway.commands.progress import waiting
from tree_sway.core.leaves.foliage import LeafClusters
from tree_sway.core.scene.scene import Scene
from tree_sway.core.simulator.season import LEAVES
from tree_sway.core.simulator.settings import model_of, Settings
from tree_sway.core.tree.species import Species, species_keys, species_named
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.files.export.tree_export import write_tree
from tree_sway.files.reader_options import reader_options
from tree_sway.files.trees.imported_tree import TreeFile
from tree_sway.files.trees.source import open_scene, open_tree
from tree_sway.files.wind.record import WindRecord
from tree_sway.files.wind.wind_file import read_wind
from tree_sway.page.wind_source import RecordedWind, SimulatedWind
from tree_sway.parameters.sway_parameters import SWAY

OUTPUT_HELP = 'file to write; its suffix names the format: .yaml, .glb'
_TREE = 'benjamina, goldcrest, broadleaf, or a file'
_DRAWN = 1500


def add_tree_arguments(
    parser: argparse.ArgumentParser, *, forests: bool = False, default: str | None = None
) -> None:
    """Add TREE, maybe a forest, and what its wood is; a default may not be left out."""
    add = parser.add_argument
    kind = f'{_TREE}{" of a tree or a forest" * forests}'
    if default is None:
        add('tree', metavar='TREE', help=kind)
    else:
        add('tree', metavar='TREE', nargs='?', default=default, help=f'{kind} (%(default)s)')
    add('--seed', type=int, default=0, help='seed of a built-in tree (%(default)s)')
    add(
        '--species',
        help=f"its wood, if not the tree's own: a file, or {', '.join(species_keys())}",
    )
    add('--modulus', type=float, metavar='PA', help="Young's modulus of green wood [Pa]")
    add('--density', type=float, metavar='RHO', help='green density [kg/m^3]')
    add(
        '--option',
        action='append',
        default=[],
        metavar='NAME=VALUE',
        help='how to read its file, for example twig_diameter=0.004; may be repeated '
        '(doc/trees.md)',
    )


def opened_tree(arguments: argparse.Namespace) -> TreeFile:
    """
    Open the tree that the arguments name, with the wood they give it.

    Raises a `TreeSwayError` for no such tree or species, a file that cannot be read, a modulus or
    density that is not positive.
    """
    with waiting(f'opening {arguments.tree}'):
        opened = open_tree(arguments.tree, arguments.seed, **_options(arguments))
    species = species_named(arguments.species) if arguments.species else opened.species
    return opened.of_species(dataclasses.replace(species, **_wood(arguments))).checked()


def opened_scene(arguments: argparse.Namespace) -> Scene:
    """
    Open the tree or the forest that the arguments name, with the wood they give it.

    Raises as `opened_tree`, and for values of one tree where there are several.
    """
    with waiting(f'opening {arguments.tree}'):
        scene = open_scene(arguments.tree, arguments.seed, **_options(arguments))
    wood = _wood(arguments)
    if wood and not scene.is_one_tree:
        raise ParameterError(
            'modulus or density for a whole forest',
            where=scene.source,
            cure='say --species, or give trees files with wood of their own',
        )
    if not wood and not arguments.species:
        return scene
    species = species_named(arguments.species) if arguments.species else scene.trees[0].species
    return scene.of_species(dataclasses.replace(species, **wood)).checked()


def _wood(arguments: argparse.Namespace) -> dict[str, Any]:
    """Values in place of those of the species."""
    given = {name: getattr(arguments, name) for name in ('modulus', 'density')}
    changed = {name: value for name, value in given.items() if value is not None}
    for name, value in changed.items():
        if not 0.0 < value < float('inf'):
            raise ParameterError(
                f'{value:g} is not positive', where=f'--{name}', cure='give an SI value'
            )
    return changed


def _options(arguments: argparse.Namespace) -> dict[str, Any]:
    try:
        return reader_options(arguments.option)
    except ParameterError as error:
        raise error.at('--option') from None


def add_leaves_argument(parser: argparse.ArgumentParser, default: str = 'auto') -> None:
    """Add the choice of leaves; ``--leaves`` alone is on."""
    parser.add_argument(
        '--leaves',
        nargs='?',
        choices=tuple(LEAVES),
        const='on',
        default=default,
        help='in leaf; auto is in leaf where the species is evergreen; of a forest, those trees '
        'of which its file does not say (%(default)s)',
    )


def chosen_leaves(arguments: argparse.Namespace) -> bool | None:
    """Whether trees bear leaves; None leaves it to their species."""
    return LEAVES[arguments.leaves]


def drawn_leaves(scene: Scene, arguments: argparse.Namespace) -> LeafClusters | None:
    """Clusters to draw, the same in every picture of a tree; None if there are none."""
    return scene.leaves(chosen_leaves(arguments), _DRAWN)


def add_wind_arguments(parser: argparse.ArgumentParser, record: str = '') -> None:
    """Add the record of a wind, and the speed of a simulated one; `record` is the first's help."""
    record = record or 'a wind record; simulated if left out'
    parser.add_argument('--wind', metavar='FILE', help=record)
    options = (
        'how to read it, such as topic=/mast/wind, yaw=1.57, direction_convention=from or rate=20'
    )
    parser.add_argument(
        '--wind-option', action='append', default=[], metavar='NAME=VALUE', help=options
    )
    speed = 'mean of the simulated wind [m/s] (%(default)s)'
    parser.add_argument('--speed', type=float, default=6.0, metavar='U', help=speed)


def opened_record(arguments: argparse.Namespace) -> WindRecord:
    """Read the record that the arguments name, as they say; print what was assumed or refused."""
    options: dict[str, Any] = {**reader_options(arguments.wind_option)}
    record = read_wind(arguments.wind, **options)
    refused = f'{record.refused} rows refused; {record.first_refused}' if record.refused else ''
    for note in filter(None, (*record.notes, refused)):
        print(f'note: {note}', file=sys.stderr)
    return record


def opened_wind(arguments: argparse.Namespace) -> RecordedWind | SimulatedWind:
    """Open the record that arguments name, over and over, or simulated wind of their speed."""
    if arguments.wind is not None:
        record = opened_record(arguments)
        return RecordedWind(record.time, record.velocity)
    return SimulatedWind(SWAY['mean_speed'].checked(arguments.speed))


def add_sway_arguments(parser: argparse.ArgumentParser, record: str = '') -> None:
    """Add a scene, a wind, a model and leaves, which what is drawn has unless they are off."""
    add_tree_arguments(parser, forests=True, default='benjamina')
    add_wind_arguments(parser, record)
    add_model_argument(parser)
    add_leaves_argument(parser, 'on')


def add_model_argument(parser: argparse.ArgumentParser) -> None:
    """Add the model of the sway, of all that there are."""
    parser.add_argument(
        '--model',
        type=model_of,
        default=Settings().model,
        metavar='MODEL',
        help='number of coordinates, auto, branch or full (%(default)s)',
    )


def add_output_arguments(parser: argparse.ArgumentParser, what: str) -> None:
    """Add ``--output`` and ``--force``; `what` is the help of the first."""
    parser.add_argument('-o', '--output', required=True, metavar='FILE', help=what)
    parser.add_argument('--force', action='store_true', help='write over a file that is there')


def output_path(arguments: argparse.Namespace) -> str:
    """File to write; a `ParameterError` if it is there already and ``--force`` is not given."""
    if not arguments.force:
        refuse_overwriting(arguments.output, '--output')
    return str(arguments.output)


def refuse_overwriting(path: str | Path, option: str) -> None:
    """Raise a `ParameterError` if a file that an option names is there already."""
    if Path(path).is_file():
        raise ParameterError(
            f"'{path}' is there already",
            where=option,
            cure='name another file, or write over it with --force',
        )


def write_tree_file(path: str, tree: Tree, species: Species | None) -> None:
    """Write a tree and say what was written."""
    write_tree(path, tree, species)
    print(what_was_written(path, tree))


def what_was_written(path: str, tree: Tree) -> str:
    """Return a line about a tree in a file."""
    size = f'{tree.n_branches} branches, {tree.n_segments} segments, {tree.height:.2f} m'
    return f'{path}: {tree.name}, {size}'
