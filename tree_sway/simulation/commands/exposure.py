# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where trees stand: arguments of the exposure, and the wind of a mean speed there."""

from __future__ import annotations

import argparse
from typing import Any

from tree_sway.commands import refuse_unused
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.simulation import Exposure, exposure_of, EXPOSURES
from tree_sway.twin import LearnedTree


def add_exposure_arguments(
    parser: argparse.ArgumentParser, *, with_anemometer: bool = True
) -> None:
    """Add where the trees stand, and at which height the mean wind is."""
    add = parser.add_argument_group('exposure').add_argument
    add(
        '--exposure', choices=EXPOSURES, default='open',
        help='where the trees stand: in the open, in a street, at the edge of a stand or inside '
        'it; it sets the wind over the height (%(default)s)',
    )  # fmt: skip
    add(
        '--spacing', type=float, metavar='D',
        help='mean distance between the trees of a stand [m]; 0.18 of their height if left out',
    )  # fmt: skip
    if not with_anemometer:
        return
    add(
        '--anemometer-height', type=float, metavar='Z',
        help='height of the mean wind above the ground [m]; if left out, that of the top of the '
        'tree, in the open at most 10 m',
    )  # fmt: skip


def chosen_exposure(arguments: argparse.Namespace, tree: Tree, species: Species) -> Exposure:
    """Return the exposure of the arguments for a tree; refuse a spacing of no stand."""
    exposure = exposure_of(
        tree, species, arguments.exposure, spacing=arguments.spacing,
        anemometer_height=arguments.anemometer_height,
    )  # fmt: skip
    if arguments.spacing is not None and exposure.is_alone:
        refuse_spacing_in_the_open()
    return exposure


def touched_species(exposure: Exposure, species: Species, learned: LearnedTree | None) -> Species:
    """Return the species of a tree among its neighbours, by what motion sensors told as well."""
    return exposure.in_contact(species, 1.0 if learned is None else learned.damping)


def refuse_spacing_in_the_open() -> None:
    """Raise the `ParameterError` of a spacing where no tree has neighbours."""
    cure = 'add --exposure stand or --exposure edge'
    what = 'trees in the open or in a street have no spacing'
    raise ParameterError(what, where='--spacing', cure=cure)


def refuse_unused_exposure(arguments: argparse.Namespace, needs: str) -> None:
    """Refuse arguments of the exposure without the one, ``needs``, that they belong to."""
    given = {
        '--exposure': arguments.exposure != 'open',
        '--spacing': arguments.spacing is not None,
        '--anemometer-height': arguments.anemometer_height is not None,
    }
    for name, is_given in given.items():
        if is_given:
            refuse_unused(name, needs)


def turbulence_of(exposure: Exposure) -> dict[str, Any]:
    """Height and intensity of simulated turbulence."""
    return {'height': exposure.turbulence_height, 'intensity': exposure.intensity}
