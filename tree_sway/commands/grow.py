# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway grow``: a plausible tree of a species and a size, written as a file."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
import sys

import numpy as np

from tree_sway.commands.arguments import (
    add_output_arguments,
    OUTPUT_HELP,
    output_path,
    write_tree_file,
)
from tree_sway.core.growth.grow import grow
from tree_sway.core.simulator.assembly import CalibratedTree
from tree_sway.core.simulator.settings import Settings
from tree_sway.core.tree.grown_tree import rooted
from tree_sway.core.tree.species import Species, species_keys
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError, TreeError
from tree_sway.files.trees.imported_tree import TreeFile
from tree_sway.files.trees.yaml.species_yaml import open_species


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add('--species', required=True, help=f'{", ".join(species_keys())}, or a species file')
    add('--height', type=float, required=True, metavar='M', help='height [m]')
    add(
        '--diameter',
        type=float,
        metavar='M',
        help='at breast height [m]; from the height if left out',
    )
    add('--seed', type=int, default=0, help='another seed, another tree (%(default)s)')
    add_output_arguments(parser, OUTPUT_HELP)


def run(arguments: argparse.Namespace) -> int:
    """Grow a tree and write it."""
    if arguments.seed < 0:
        raise ParameterError(
            f'{arguments.seed} is negative', where='--seed', cure='give 0 or more'
        )
    output = output_path(arguments)
    species = open_species(arguments.species)
    tree = grow(
        species.key,
        arguments.height,
        arguments.diameter,
        rng=np.random.default_rng(arguments.seed),
    )
    species = rooted(tree, species)
    grown = TreeFile(tree, species, tree.name).checked()
    for oddity in (*grown.warnings, *_crown_oddities(tree, species)):
        print(f'warning: {oddity}', file=sys.stderr)
    write_tree_file(output, tree, species)
    return 0


def _crown_oddities(tree: Tree, species: Species) -> Iterator[str]:
    """Say if the crown in leaf is near to what bends the stem over."""
    bare, leafy = (_slowest(tree, species, in_leaf) for in_leaf in (False, True))
    if leafy == 0.0 or leafy < bare / 3.0:
        found = f'sways at {leafy:.2g} Hz, without leaves at {bare:.2g} Hz: it is near to bending'
        if leafy == 0.0:
            found = 'cannot stand: it bends'
        yield f'in leaf it {found} over under its crown; give a thicker stem (--diameter)'


def _slowest(tree: Tree, species: Species, in_leaf: bool) -> float:
    """Slowest sway in [Hz]; 0 of a tree that cannot stand."""
    try:
        whole = CalibratedTree(tree, species, Settings(in_leaf=in_leaf))
        return float(whole.natural_frequencies(1)[0])
    except TreeError:
        return 0.0
