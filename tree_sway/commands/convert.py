# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway convert``: any tree that this package reads, written for other programs."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
import sys

from tree_sway.commands.arguments import (
    add_exact_argument,
    add_leaves_argument,
    add_model_argument,
    add_output_arguments,
    add_tree_arguments,
    chosen_leaves,
    drawn_leaves,
    opened_scene,
    OUTPUT_HELP,
    output_path,
    what_was_written,
)
from tree_sway.commands.progress import waiting
from tree_sway.core.leaves.foliage import LeafClusters
from tree_sway.core.model.settings import Settings
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.make import make_simulator, solved
from tree_sway.core.scene.scene import Scene
from tree_sway.core.setup.prepare import prepare
from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.export.gltf_tree import morphing_tree
from tree_sway.files.export.hinged_tree_writing import mjcf_of_tree, sdf_of_tree
from tree_sway.files.export.tree_export import SUFFIXES, write_gltf, write_tree
from tree_sway.files.export.usd_tree import usd_of_tree
from tree_sway.files.models.model_file import SUFFIX as MODEL_SUFFIX
from tree_sway.files.models.model_file import write_model
from tree_sway.files.whole_file import write_text_whole


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_tree_arguments(parser, forests=True)
    add_exact_argument(parser)
    add_leaves_argument(parser)
    add_model_argument(parser)
    add_output_arguments(parser, f'{OUTPUT_HELP}, .npz, .html, .usda, .xml (MJCF), .sdf')
    parser.add_argument(
        '--sway',
        nargs='?',
        choices=('skin', 'morph'),
        const='skin',
        help='motion of a .glb: by a joint per segment, set from segment_poses, or '
        "by some 20 weights, set from the tree's state (skin)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Read a tree and write it."""
    output = output_path(arguments)
    suffix = Path(output).suffix.lower()
    if suffix not in _FORMATS:
        names = ', '.join('.xml (MJCF)' if each == '.xml' else each for each in _FORMATS)
        what = f"cannot write '{Path(output).suffix}'"
        raise FormatError(what, where=output, cure=f'use {names}')
    if arguments.sway is not None and suffix != '.glb':
        raise ParameterError(f"'{output}' cannot sway", where='--sway', cure='write a .glb file')
    scene = opened_scene(arguments)
    for note in scene.notes:
        print(f'note: {note}', file=sys.stderr)
    for oddity in scene.warnings:
        print(f'warning: {oddity}', file=sys.stderr)
    if suffix == '.html':
        _write_page(scene, arguments)
    elif suffix in _OF_ONE_TREE or suffix == MODEL_SUFFIX or arguments.sway == 'morph':
        _write_swaying(scene, arguments, suffix)
    else:
        species = scene.species if scene.is_one_tree else None
        leaves = drawn_leaves(scene, arguments) if suffix == '.glb' else None
        write_tree(output, scene.tree, species, leaves)
    print(what_was_written(output, scene.tree))
    return 0


_OF_ONE_TREE: dict[str, Callable[[SwaySimulator, LeafClusters | None], str]] = {
    '.usda': usd_of_tree,
    '.xml': lambda simulator, _leaves: mjcf_of_tree(simulator),
    '.sdf': lambda simulator, _leaves: sdf_of_tree(simulator),
}


_FORMATS = (*SUFFIXES, MODEL_SUFFIX, '.html', *_OF_ONE_TREE)


def _write_page(scene: Scene, arguments: argparse.Namespace) -> None:
    """Write a page that sways by itself, in leaf unless leaves are off."""
    from tree_sway.page.one_file import page_of_scene

    settings = Settings(in_leaf=chosen_leaves(arguments) is not False)
    with waiting('finding what sways'):
        simulator = scene.simulator(settings, model=arguments.model)
        page = page_of_scene(simulator)
    write_text_whole(arguments.output, page)


def _write_swaying(scene: Scene, arguments: argparse.Namespace, suffix: str) -> None:
    """Write one tree for swaying in a different program."""
    if not scene.is_one_tree:
        raise ParameterError(
            'a forest for a different program',
            where=arguments.output,
            cure='convert its trees one by one',
        )
    settings = Settings(model=arguments.model, in_leaf=chosen_leaves(arguments))
    if suffix == MODEL_SUFFIX:
        with waiting('preparing the tree'):
            write_model(arguments.output, prepare(scene.tree, scene.species, solved(settings)))
        return
    with waiting('finding what sways'):
        simulator = make_simulator(scene.tree, scene.species, settings)
        leaves = drawn_leaves(scene, arguments)
        if suffix == '.glb':
            write_gltf(arguments.output, morphing_tree(simulator, leaves))
        else:
            write_text_whole(arguments.output, _OF_ONE_TREE[suffix](simulator, leaves))
