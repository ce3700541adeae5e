"""
The TREE of a command and its wood: the same arguments in every command.

"""

from __future__ import annotations

import argparse
import dataclasses

from tree_sway_ros.core.species import species_keys, species_named
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.importers.imported_tree import TreeFile
from tree_sway_ros.importers.tree_source import open_tree


def add_tree_arguments(parser: argparse.ArgumentParser) -> None:
    """Add TREE and what can be said of its wood."""
    parser.add_argument("tree", metavar="TREE", help="benjamina, goldcrest, broadleaf, or a file")
    add_wood_arguments(parser)


def add_wood_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what can be said of the wood of a tree."""
    parser.add_argument("--seed", type=int, default=0, help="seed of a built-in tree (%(default)s)")
    parser.add_argument("--species", help=f"its wood, if not the tree's own: {', '.join(species_keys())}")
    parser.add_argument("--modulus", type=float, metavar="PA", help="Young's modulus of green wood [Pa]")
    parser.add_argument("--density", type=float, metavar="RHO", help="green density [kg/m^3]")


def opened_tree(arguments: argparse.Namespace) -> TreeFile:
    """
    Open the tree that the arguments name, with the wood they give it.

    Raises
    ------
    TreeSwayError
        No such tree or species, a file that cannot be read, a modulus or density that is not positive.

    """
    tree_file = open_tree(arguments.tree, arguments.seed)
    species = species_named(arguments.species) if arguments.species else tree_file.species
    given = {name: getattr(arguments, name) for name in ("modulus", "density")}
    changed = {name: value for name, value in given.items() if value is not None}
    for name, value in changed.items():
        if not 0.0 < value < float("inf"):
            raise ParameterError(f"{value:g} is not positive", where=f"--{name}", cure="give an SI value")
    return dataclasses.replace(tree_file, species=dataclasses.replace(species, **changed))
