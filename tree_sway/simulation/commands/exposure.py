# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where trees stand: arguments of the exposure."""

from __future__ import annotations

import argparse
from dataclasses import replace
import math

from tree_sway.commands import refuse_unused
from tree_sway.core.checks import within
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.files.commands import say_warnings
from tree_sway.growth import breast_height_diameter
from tree_sway.simulation import Exposure, exposure_of, EXPOSURES
from tree_sway.twin import LearnedTree

_SLENDER = 100.0
"""Height over stem diameter from which on trees have grown among others [-]."""


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
    add(
        '--stand-height', type=float, metavar='H',
        help='height of the stand [m], the same for each of its trees; that of the tree if left '
        'out',
    )  # fmt: skip


def chosen_exposure(arguments: argparse.Namespace, tree: Tree, species: Species) -> Exposure:
    """
    Return the exposure of the arguments for a tree, and ask of a slender one whether it fits.

    Raises a `ParameterError` for a spacing of no stand.
    """
    exposure = exposure_of(
        tree, species, arguments.exposure, spacing=arguments.spacing,
        anemometer_height=arguments.anemometer_height,
    )  # fmt: skip
    if arguments.stand_height is not None:
        within('--stand-height', arguments.stand_height, 0.1, 150.0, 'm')
        of_stand = exposure.scaled(arguments.stand_height)
        exposure = replace(of_stand, spacing=arguments.spacing or of_stand.spacing)
        if exposure.is_alone:
            refuse_spacing_in_the_open('--stand-height')
    if arguments.spacing is not None and exposure.is_alone:
        refuse_spacing_in_the_open()
    slenderness = tree.height / (breast_height_diameter(tree) or math.inf)
    if exposure.is_alone and slenderness > _SLENDER:
        asked = (
            f'its height is {slenderness:.0f} times its stem diameter, as of trees in a stand: '
            'did it stand in one? With --exposure stand others shelter its crown, it is damped '
            'more in leaf, and its roots hold 120 N m for each kg of the stem'
        )
        say_warnings([asked])
    return exposure


def touched_species(exposure: Exposure, species: Species, learned: LearnedTree | None) -> Species:
    """Return the species of a tree among its neighbours, by what motion sensors told as well."""
    return exposure.in_contact(species, 1.0 if learned is None else learned.damping)


def refuse_spacing_in_the_open(where: str = '--spacing') -> None:
    """Raise the `ParameterError` of a spacing or a stand where no tree has neighbours."""
    cure = 'add --exposure stand or --exposure edge'
    what = 'trees in the open or in a street have no spacing and no stand'
    raise ParameterError(what, where=where, cure=cure)


def refuse_unused_exposure(arguments: argparse.Namespace, needs: str) -> None:
    """Refuse arguments of the exposure without the one, ``needs``, that they belong to."""
    given = {
        '--exposure': arguments.exposure != 'open',
        '--spacing': arguments.spacing is not None,
        '--anemometer-height': arguments.anemometer_height is not None,
        '--stand-height': arguments.stand_height is not None,
    }
    for name, is_given in given.items():
        if is_given:
            refuse_unused(name, needs)
