"""``tree-sway convert``: any tree this package reads, written in a format that others read."""

from __future__ import annotations

import argparse
import sys

from tree_sway_ros.files.trees.imported_tree import TreeFile
from tree_sway_ros.tools.tree_argument import add_tree_arguments, opened_scene
from tree_sway_ros.tools.tree_output import (
    OUTPUT_HELP,
    add_output_arguments,
    output_path,
    write_tree_file,
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_tree_arguments(parser, forests=True)
    add_output_arguments(parser, OUTPUT_HELP)


def run(arguments: argparse.Namespace) -> int:
    """Read a tree and write it."""
    output = output_path(arguments)
    scene = opened_scene(arguments)
    for note in scene.notes:
        print(f"note: {note}", file=sys.stderr)
    for doubt in scene.warnings:
        print(f"warning: {doubt}", file=sys.stderr)
    species = scene.species if isinstance(scene, TreeFile) else None
    write_tree_file(output, scene.tree, species)
    return 0
