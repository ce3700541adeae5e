# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The TREE of a command and its wood: the same arguments in every command.

"""

from __future__ import annotations

import argparse
import dataclasses
from typing import Any

from tree_sway_ros.core.tree.species import species_keys
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.files.trees.imported_tree import TreeFile
from tree_sway_ros.files.trees.source import open_scene, open_tree
from tree_sway_ros.files.trees.yaml.forest_file import ForestFile
from tree_sway_ros.files.trees.yaml.species_yaml import open_species

_TREE = "benjamina, goldcrest, broadleaf, or a file"


def add_tree_arguments(
    parser: argparse.ArgumentParser, *, forests: bool = False, default: str | None = None
) -> None:
    """
    Add TREE and what can be said of its wood.

    Parameters
    ----------
    parser
        Of the command.
    forests
        TREE may be a forest.
    default
        TREE where it is left out; it may not be if None.

    """
    kind = f"{_TREE}{' of a tree or a forest' * forests}"
    if default is None:
        parser.add_argument("tree", metavar="TREE", help=kind)
    else:
        parser.add_argument(
            "tree", metavar="TREE", nargs="?", default=default, help=f"{kind} (%(default)s)"
        )
    parser.add_argument("--seed", type=int, default=0, help="seed of a built-in tree (%(default)s)")
    parser.add_argument(
        "--species", help=f"its wood, if not the tree's own: a file, or {', '.join(species_keys())}"
    )
    parser.add_argument(
        "--modulus", type=float, metavar="PA", help="Young's modulus of green wood [Pa]"
    )
    parser.add_argument("--density", type=float, metavar="RHO", help="green density [kg/m^3]")
    parser.add_argument(
        "--option",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="how to read its file, for example twig_diameter=0.004; may be repeated "
        "(doc/trees.md)",
    )


def opened_tree(arguments: argparse.Namespace) -> TreeFile:
    """
    Open the tree that the arguments name, with the wood they give it.

    Raises
    ------
    TreeSwayError
        No such tree or species, a file that cannot be read, a modulus or density that is not
        positive.

    """
    return _of_wood(
        open_tree(arguments.tree, arguments.seed, **_options(arguments.option)), arguments
    )


def opened_scene(arguments: argparse.Namespace) -> TreeFile | ForestFile:
    """
    Open the tree or the forest that the arguments name, with the wood they give it.

    Raises
    ------
    TreeSwayError
        As `opened_tree`; values for one tree where there are several.

    """
    scene = open_scene(arguments.tree, arguments.seed, **_options(arguments.option))
    if isinstance(scene, TreeFile):
        return _of_wood(scene, arguments)
    if _wood(arguments):
        raise ParameterError(
            "modulus or density for a whole forest",
            where=scene.source,
            cure="say --species, or give trees files with wood of their own",
        )
    if not arguments.species:
        return scene
    return scene.of_species(open_species(arguments.species)).checked()


def _of_wood(tree_file: TreeFile, arguments: argparse.Namespace) -> TreeFile:
    species = open_species(arguments.species) if arguments.species else tree_file.species
    return tree_file.of_species(dataclasses.replace(species, **_wood(arguments))).checked()


def _wood(arguments: argparse.Namespace) -> dict[str, Any]:
    """Values in place of those of the species."""
    given = {name: getattr(arguments, name) for name in ("modulus", "density")}
    changed = {name: value for name, value in given.items() if value is not None}
    for name, value in changed.items():
        if not 0.0 < value < float("inf"):
            raise ParameterError(
                f"{value:g} is not positive", where=f"--{name}", cure="give an SI value"
            )
    return changed


def _options(given: list[str]) -> dict[str, Any]:
    """Options of the reader: numbers and truths as such, all else as text."""
    options: dict[str, Any] = {}
    for each in given:
        name, equals, text = each.partition("=")
        if not (name and equals and text):
            raise ParameterError(f"'{each}'", where="--option", cure="write NAME=VALUE")
        options[name.strip().replace("-", "_")] = _value(text.strip())
    return options


def _value(text: str) -> Any:
    if text in ("true", "false"):
        return text == "true"
    try:
        return float(text)
    except ValueError:
        return text
