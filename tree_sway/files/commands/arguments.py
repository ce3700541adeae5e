# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Arguments that commands share: TREE, its wood and leaves, the model, the output."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable
import dataclasses
import math
from typing import Any, TypeVar

from tree_sway.commands import refuse_overwriting, say, waiting
from tree_sway.core.leaves import LeafClusters
from tree_sway.core.scene import Scene
from tree_sway.core.settings import model_of, Settings
from tree_sway.core.setup import LEAVES
from tree_sway.core.species import Species, species_named
from tree_sway.core.tree import Tree
from tree_sway.errors import inside, ParameterError, shown, SpeciesError
from tree_sway.files import reader_options, refuse_unwritable
from tree_sway.files.commands.typed_names import tree_name
from tree_sway.files.export import write_tree
from tree_sway.files.trees import open_scene, open_tree, TreeFile
from tree_sway.files.trees.tree_options import same, Wood
from tree_sway.files.trees.yaml.tree_yaml import is_species_file, read_species

T = TypeVar('T')

OUTPUT_HELP = 'output file; its suffix chooses the format: .yaml, .glb'
_TREE = 'a built-in tree (benjamina, goldcrest, broadleaf) or a tree file'
_DRAWN = 1500


def add_tree_arguments(
    parser: argparse.ArgumentParser, *, forests: bool = False, default: str | None = None
) -> None:
    """Add TREE, or a forest, and its wood; TREE is required unless there is a default."""
    parser.add_argument(
        'tree',
        type=tree_name,
        metavar='TREE',
        nargs='?' if default else None,
        default=default,
        help=_TREE + ', forest or inventory' * forests + ' (%(default)s)' * bool(default),
    )
    add = parser.add_argument_group('tree').add_argument
    add('--seed', type=int, default=0, help='random seed of a built-in tree (%(default)s)')
    add(
        '--species',
        help="species, if it is not the tree's own: a name of `tree-sway grow --help`, or a YAML "
        'file with a species and its wood',
    )
    add('--modulus', type=float, metavar='PA', help="Young's modulus of the green wood [Pa]")
    add('--density', type=float, metavar='RHO', help='density of the green wood [kg/m^3]')
    add(
        '--option',
        action='append',
        default=[],
        metavar='NAME=VALUE',
        help='option of the file reader, such as twig_diameter=0.004; repeatable (doc/trees.md)',
    )


def opened_tree(arguments: argparse.Namespace) -> TreeFile:
    """
    Open the tree of the arguments, with their wood.

    Raises a `TreeSwayError` for no such tree or species, a file that cannot be read, a modulus or
    density that is not finite and above 0.
    """
    opened = _opened(open_tree, arguments)
    say_warnings(opened.warnings)
    return opened


def opened_scene(arguments: argparse.Namespace, *, says: bool = True) -> Scene:
    """
    Open the tree or the forest of the arguments, with their wood, and print its warnings.

    Errors are those of `opened_tree`, and values of one tree for several. A command that shows the
    warnings in its own form has ``says=False``.
    """
    scene = _opened(open_scene, arguments, exact=getattr(arguments, 'exact', False))
    if says:
        say_warnings(scene.warnings)
    if _wood(arguments) and not scene.is_one_tree:
        raise ParameterError(
            'modulus or density for a whole forest',
            where=scene.source,
            cure='use --species, or files of trees with their own wood',
        )
    return scene


def _opened(opener: Callable[..., T], arguments: argparse.Namespace, **more: bool) -> T:
    wood = _wood_of(arguments)
    with inside('--option'):
        options = reader_options(arguments.option)
    with waiting(f'opening {arguments.tree}'):
        return opener(
            arguments.tree,
            arguments.seed,
            wood=wood,
            in_leaf=chosen_leaves(arguments),
            warn=False,
            **more,
            **options,
        )


def say_warnings(warnings: Iterable[str]) -> None:
    """Print what was changed in a tree, and what is odd about it, on lines of their own."""
    for warning in warnings:
        say(warning, 'warning')


def _wood_of(arguments: argparse.Namespace) -> Wood:
    """Return the species of the arguments, of the table or of a file, for that of a tree."""
    name = arguments.species
    changed = _wood(arguments)
    if name is None:
        return (lambda found: dataclasses.replace(found, **changed)) if changed else same
    try:
        given = read_species(name) if is_species_file(name) else species_named(name)
    except SpeciesError as error:
        raise error.inside('--species') from None
    return lambda _: dataclasses.replace(given, **changed)


def _wood(arguments: argparse.Namespace) -> dict[str, Any]:
    """Values that replace those of the species."""
    names = ('modulus', 'density')
    changed = {name: value for name in names if (value := getattr(arguments, name)) is not None}
    for name, value in changed.items():
        if not 0.0 < value < math.inf:
            raise ParameterError(
                f'{value:g} is not a finite number above 0',
                where=f'--{name}',
                cure='give an SI value',
            )
    return changed


def add_exact_argument(parser: argparse.ArgumentParser) -> None:
    """Add the choice to grow each tree of an inventory."""
    what = 'grow every tree of an inventory individually, instead of scaling a few'
    parser.add_argument('--exact', action='store_true', help=what)


def add_leaves_argument(
    parser: argparse.ArgumentParser,
    default: str | None = 'auto',
    shown: str = 'on; auto with --strength',
) -> None:
    """
    Add the choice of leaves; ``--leaves`` without a value is on.

    A default of None is for a command that chooses between on and auto, as is shown.
    """
    shown = default or shown
    parser.add_argument(
        '--leaves',
        nargs='?',
        choices=tuple(LEAVES),
        const='on',
        default=default,
        help='whether trees bear leaves; auto: evergreen species do; a forest file may decide '
        f'for its trees ({shown})',
    )


def chosen_leaves(arguments: argparse.Namespace) -> bool | None:
    """Whether trees bear leaves; None, as for a command without the choice, is by species."""
    return LEAVES[getattr(arguments, 'leaves', 'auto')]


def drawn_leaves(scene: Scene, arguments: argparse.Namespace) -> LeafClusters | None:
    """Return clusters to draw, the same in every picture of a tree; None if there are none."""
    return scene.leaves(chosen_leaves(arguments), _DRAWN)


def add_model_argument(parser: argparse.ArgumentParser) -> None:
    """Add the model of the sway."""
    parser.add_argument(
        '--model',
        type=model_of,
        default=Settings().model,
        metavar='MODEL',
        help='number of coordinates, or auto, branch or full (doc/models.md) (%(default)s)',
    )


def add_output_arguments(parser: argparse.ArgumentParser, what: str) -> None:
    """Add ``--output``, which may be the last word alone, and ``--force``; `what` is its help."""
    parser.add_argument('-o', '--output', metavar='FILE', help=f'{what}; or the last word alone')
    parser.add_argument('--force', action='store_true', help='overwrite an existing file')


def output_path(arguments: argparse.Namespace) -> str:
    """
    File to write.

    Raises a `ParameterError` if it exists and ``--force`` is not given, and a `FormatError` if it
    cannot be written, before any work for it.
    """
    if arguments.output is None:
        raise ParameterError('no file to write', where='--output', cure='name it last')
    if not arguments.force:
        refuse_overwriting(arguments.output, '--output')
    refuse_unwritable(arguments.output)
    return str(arguments.output)


def write_tree_file(path: str, tree: Tree, species: Species | None) -> None:
    """Write a tree and print its file."""
    write_tree(path, tree, species)
    print(what_was_written(path, tree))


def what_was_written(path: str, tree: Tree) -> str:
    """Return a line about a tree in a file."""
    size = f'{tree.n_branches} branches, {tree.n_segments} segments, {tree.height:.2f} m'
    return f'{path}: {shown(tree.name)}, {size}'
