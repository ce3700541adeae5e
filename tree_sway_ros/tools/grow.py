# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway grow``: a plausible tree of a species and a size, written as a file."""

from __future__ import annotations

import argparse
from dataclasses import replace
import math
import sys

import numpy as np

from tree_sway_ros.core.growth.grow import grow, HABITS
from tree_sway_ros.core.tree.species import species_keys, typical_root_stiffness
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.files.trees.imported_tree import TreeFile
from tree_sway_ros.files.trees.yaml.species_yaml import open_species
from tree_sway_ros.tools.arguments import (
    add_output_arguments,
    OUTPUT_HELP,
    output_path,
    write_tree_file,
)


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
    add('--habit', choices=HABITS, help="the species' own if left out")
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
        arguments.habit,
        rng=np.random.default_rng(arguments.seed),
    )
    if species.habit != 'pot' and math.isinf(species.root_stiffness):
        stem = species.density * float(tree.volume[tree.segments_of(0)].sum())
        # Three figures are more than is known of any soil.
        roots = float(f'{typical_root_stiffness(stem):.3g}')
        species = replace(species, root_stiffness=roots)
    grown = TreeFile(tree, species, tree.name).checked()
    for doubt in grown.warnings:
        print(f'warning: {doubt}', file=sys.stderr)
    write_tree_file(output, tree, species)
    return 0
