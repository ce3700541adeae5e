# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway grow``: a plausible tree of a species and a size, written as a file."""

from __future__ import annotations

import argparse

import numpy as np

from tree_sway.commands import say, waiting
from tree_sway.core.checks import within
from tree_sway.core.settings import Settings
from tree_sway.core.setup import TreeReductions
from tree_sway.core.species import species_keys, species_named
from tree_sway.core.tree import rooted
from tree_sway.errors import ParameterError, TreeError
from tree_sway.files.commands import (
    add_output_arguments,
    OUTPUT_HELP,
    output_path,
    write_tree_file,
)
from tree_sway.files.trees import TreeFile
from tree_sway.growth import grow, stem_growth, stem_of_age


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add('kind', metavar='SPECIES', nargs='?', help=f'one of {", ".join(species_keys())}')
    add('--species', metavar='SPECIES', help='the species as an option')
    add('--height', type=float, required=True, metavar='M', help='height of the tree [m]')
    stem = parser.add_mutually_exclusive_group()
    stem.add_argument(
        '--diameter',
        type=float,
        metavar='M',
        help='stem diameter at breast height [m]; without it, typical for the height',
    )
    stem.add_argument(
        '--age',
        type=float,
        metavar='YEARS',
        help='years since planting, for the diameter that a street tree then has',
    )
    add('--seed', type=int, default=0, help='random seed (%(default)s)')
    add_output_arguments(parser, OUTPUT_HELP)


def run(arguments: argparse.Namespace) -> int:
    """Grow a tree and write it."""
    within('--seed', arguments.seed, 0, 2**63)
    output = output_path(arguments)
    species = species_named(_chosen(arguments))
    diameter = arguments.diameter
    if arguments.age is not None:
        diameter = stem_of_age(species.key, arguments.age)
        curve = stem_growth()[species.key]
        whose = f'{curve.measured} along streets ({curve.region}, USA)'
        say(f'a stem of {diameter:.2f} m, as {whose}')
    rng = np.random.default_rng(arguments.seed)
    with waiting(f'growing {species.key}'):
        tree = grow(species.key, arguments.height, diameter, rng=rng)
    species = rooted(tree, species)
    grown = TreeFile(tree, species, tree.name).checked()
    for oddity in grown.warnings:
        say(oddity, 'warning')
    try:
        TreeReductions(tree, species, Settings(in_leaf=True)).natural_frequencies(1)
    except TreeError as error:
        say(f'it buckles in leaf: {error}', 'warning')
    write_tree_file(output, tree, species)
    return 0


def _chosen(arguments: argparse.Namespace) -> str:
    """Return the species, which is given once, as an argument or as an option."""
    given = [name for name in (arguments.kind, arguments.species) if name is not None]
    if len(given) != 1:
        what = f'two species, {given[0]} and {given[1]}' if given else 'no species'
        raise ParameterError(what, cure='give one, as in tree-sway grow oak --height 12')
    return str(given[0])
