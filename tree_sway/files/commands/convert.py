# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway convert``: any tree that this package reads, written for other programs."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

from tree_sway.commands import counting, refuse_unused, say, waiting
from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator, Scene, Simulator, solved
from tree_sway.core.settings import Settings
from tree_sway.core.setup import prepare
from tree_sway.errors import FormatError, ParameterError
from tree_sway.files import write_text_whole
from tree_sway.files.commands.arguments import (
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
from tree_sway.files.commands.moments import at_moments, moments_of, numbered_paths
from tree_sway.files.commands.wind_arguments import (
    add_wind_arguments,
    opened_wind,
    refuse_unused_wind,
    simulated_speed,
)
from tree_sway.files.export import mjcf_of_tree, morphing_tree, write_tree
from tree_sway.files.export.breeze import SECONDS
from tree_sway.files.export.hinged_tree_writing import sdf_of_tree
from tree_sway.files.export.obj_scene import ObjScene
from tree_sway.files.export.tree_export import SUFFIXES, write_gltf
from tree_sway.files.export.usd_writing import write_usd
from tree_sway.files.models import write_model
from tree_sway.files.models.model_file import SUFFIX as MODEL_SUFFIX
from tree_sway.files.models.model_writer import NATIVE_SUFFIX, write_native_model
from tree_sway.files.trees import TreeFile


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_tree_arguments(parser, forests=True)
    add_exact_argument(parser)
    add_leaves_argument(parser, None, 'on in .glb, .usda, .usdz and .html, else auto')
    add_model_argument(parser)
    add_wind_arguments(parser, 'wind recording that trees sway in until --at')
    add_output_arguments(
        parser, f'{OUTPUT_HELP}, .npz, .sway, .html, .usda, .usdz, .xml (MJCF), .sdf, .obj'
    )
    parser.add_argument(
        '--at',
        metavar='SECONDS',
        help='.obj of a tree or a forest in wind: at a time, or from, to and every, such as '
        '-o scene_%%03d.obj --at 0:10:0.1; at rest without it',
    )
    parser.add_argument(
        '--sway',
        nargs='?',
        choices=('skin', 'morph', 'floats'),
        const='skin',
        help='motion of a .glb: by a joint per segment, set from segment_poses, or '
        "by some 20 weights, set from the tree's state, with 20 s of a breeze, in small integers "
        'or, as Godot needs it, in floats (morph for one tree, skin for a forest)',
    )


def run(arguments: argparse.Namespace) -> int:
    """Read a tree and write it."""
    output = output_path(arguments)
    suffix = Path(output).suffix.lower()
    if suffix not in _FORMATS:
        names = ', '.join(_FORMATS).replace('.xml', '.xml (MJCF)')
        what = f"cannot write '{Path(output).suffix}'" if suffix else 'a name without a suffix'
        raise FormatError(what, where=output, cure=f'use {names}')
    if arguments.at is not None and suffix != '.obj':
        raise ParameterError(f"'{output}' is of no moment", where='--at', cure='write .obj files')
    refuse_unused_wind(arguments)
    if arguments.sway is not None and suffix != '.glb':
        raise ParameterError(f"'{output}' cannot sway", where='--sway', cure='write a .glb file')
    if arguments.leaves is None:
        arguments.leaves = 'on' if suffix in _DRAWN else 'auto'
    moments = [] if arguments.at is None else moments_of(arguments.at)
    count = max(1, len(moments))
    paths = numbered_paths(output, count, may_overwrite=arguments.force)
    scene = opened_scene(arguments)
    # A single tree has a breeze and weights in a .glb, unless a skin is asked for.
    way = arguments.sway or ('morph' if scene.is_one_tree else 'skin')
    sways = suffix in _USD or (suffix == '.glb' and way != 'skin')
    if arguments.at is None:
        needs = '--at SECONDS, for .obj files'
        if arguments.wind is not None:
            refuse_unused('--wind', needs)
        if arguments.speed is not None and not sways:
            refuse_unused('--speed', needs)
    for note in scene.notes:
        say(note)
    if suffix == '.obj':
        _write_moments(scene, arguments, moments, paths)
    elif suffix == '.html':
        from tree_sway.page import page_of_scene

        simulator = _simulator(scene, arguments, 'finding what sways')
        write_text_whole(output, page_of_scene(simulator))
    elif sways or suffix in (*_HINGED, *_PREPARED):
        _write_swaying(scene, arguments, suffix)
    elif suffix != '.glb' and scene.is_one_tree:
        one = scene.trees[0]
        write_tree(output, TreeFile(scene.tree, one.species, scene.source, learned=one.learned))
    else:
        leaves = drawn_leaves(scene, arguments) if suffix == '.glb' else None
        write_tree(output, scene.tree, leaves=leaves)
    written = f'{paths[0]} to {paths[-1].name}, {count} moments' if count > 1 else paths[0]
    told = f'{sum(path.stat().st_size for path in paths) / 1e6:.2g} MB'
    if suffix in _DRAWN:
        told += f', leaves {arguments.leaves}'
    if sways:
        told += f', {SECONDS[suffix]:g} s of wind'
    print(f'{what_was_written(str(written), scene.tree)}; {told}')
    return 0


_HINGED: dict[str, Callable[[SwaySimulator], str]] = {'.xml': mjcf_of_tree, '.sdf': sdf_of_tree}
_PREPARED = {MODEL_SUFFIX: write_model, NATIVE_SUFFIX: write_native_model}
_USD = ('.usda', '.usdz')
_DRAWN = ('.glb', '.html', *_USD)
"""Formats to look at, in leaf if nothing else is asked for."""

_FORMATS = (*SUFFIXES, *_PREPARED, '.html', *_USD, *_HINGED, '.obj')


def _write_moments(
    scene: Scene, arguments: argparse.Namespace, moments: list[float], paths: list[Path]
) -> None:
    """Write the triangles of a scene at rest, or of each moment in wind to its file."""
    files = ObjScene(scene.tree, drawn_leaves(scene, arguments))
    name = scene.name
    axes = 'metres, x east, y north, z up'
    if not moments:
        write_text_whole(paths[0], files.text(scene.tree.rest_poses, f'{name} at rest; {axes}'))
        return
    wind = opened_wind(arguments)
    simulator = _simulator(scene, arguments, 'setting up the trees')
    for number, time in at_moments(simulator, wind, moments):
        comment = f'{name} at {time:.4f} s; {axes}'
        write_text_whole(paths[number], files.text(simulator.place(), comment))


def _simulator(scene: Scene, arguments: argparse.Namespace, what: str) -> Simulator:
    """Set up all trees of a scene, with the progress of it under a label."""
    with counting(len(scene.kinds), what) as done:
        return scene.simulator(
            in_leaf=chosen_leaves(arguments), model=arguments.model, progress=done
        )


def _write_swaying(scene: Scene, arguments: argparse.Namespace, suffix: str) -> None:
    """Write one tree for swaying in a different program."""
    if not scene.is_one_tree:
        raise ParameterError(
            f'{len(scene.trees)} trees, where one is expected',
            where=arguments.output,
            cure='convert the file of one of them; .html, .obj and .glb with a skin take all',
        )
    settings = Settings(model=arguments.model, in_leaf=chosen_leaves(arguments))
    if suffix in _PREPARED:
        with waiting('preparing the tree'):
            model = prepare(scene.tree, scene.species, solved(settings))
        _PREPARED[suffix](arguments.output, model)
        return
    speed = simulated_speed(arguments)
    with waiting('finding what sways'):
        simulator = make_simulator(scene.tree, scene.species, settings)
        leaves = drawn_leaves(scene, arguments)
        if suffix == '.glb':
            small = arguments.sway != 'floats'
            document = morphing_tree(simulator, leaves, small=small, speed=speed)
            write_gltf(arguments.output, document)
        elif suffix in _USD:
            write_usd(arguments.output, simulator, leaves, speed)
        else:
            write_text_whole(arguments.output, _HINGED[suffix](simulator))
