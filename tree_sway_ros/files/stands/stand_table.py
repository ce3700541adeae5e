# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A stand from an inventory, a table with columns ``x``, ``y``, ``species``, ``height`` in metres.

Trees of one species are scaled from few that are grown: heights of a species within a factor of
three share one kind. Further columns may be ``name``, ``z``, ``yaw`` [rad] and ``fidelity``; a
tree without a name is called after its row, one without a yaw is turned at random.
"""

from __future__ import annotations

from collections.abc import Mapping
import math
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.growth.grow import grow
from tree_sway_ros.core.scene.stand import LARGEST, SMALLEST, StandKind, StandTree
from tree_sway_ros.core.simulator.settings import FIDELITIES
from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.errors import FormatError, ParameterError, TreeSwayError
from tree_sway_ros.files.file_format import has_columns
from tree_sway_ros.files.stands.stand_file import stand_file, StandFile
from tree_sway_ros.files.table_file import parse_table, TextTable
from tree_sway_ros.files.text_file import read_head, read_lines
from tree_sway_ros.files.trees.yaml.forest_file import refuse_same_names

COLUMNS = ('x', 'y', 'species', 'height')
"""Columns that a stand has."""

_CLASS = 3.0


def is_stand_table(path: Path) -> bool:
    """Whether a file is a table with the columns of a stand."""
    return path.is_file() and has_columns(*COLUMNS)(read_head(path))


def read_stand_table(
    path: Path, kinds: Mapping[str, StandKind] | None = None, *, seed: int = 0, **told: Any
) -> StandFile:
    """
    Read a stand from a table; where no kind stands for a species, its trees are grown.

    The seed is that of the trees that are grown, and of how trees are turned; further arguments
    are those of `ForestFile`.

    Raises
    ------
    FormatError
        No tree, a missing column, a cell that is no finite number, a height that no tree has, two
        trees of one name; with the line.
    SpeciesError
        A species that no table knows; with the line.

    """
    table = parse_table(read_lines(path), str(path))
    x, y, height = table.strict(['x', 'y', 'height']).T
    species = _texts(table, 'species')
    names = _texts(table, 'name') or [f'tree{row + 1}' for row in range(len(x))]
    refuse_same_names(names, table.where)
    given = dict(kinds or {})
    classes = _height_classes(species, height)
    standing, made = [], dict[str, StandKind]()
    rng = np.random.default_rng(seed)
    z = _numbers(table, 'z', np.zeros(len(x)))
    yaw = _numbers(table, 'yaw', rng.uniform(0.0, 2.0 * np.pi, len(x)))
    fidelity = _texts(table, 'fidelity') or ['wind_basis'] * len(x)
    for row, kind in enumerate(species):
        where = table.where(row)
        if not height[row] > 0.0:
            raise FormatError(f'a height of {height[row]:g} m', where=where, cure='above 0')
        if fidelity[row] not in FIDELITIES:
            raise FormatError(
                f"unknown fidelity '{fidelity[row]}'",
                where=where,
                cure=f'use one of: {", ".join(FIDELITIES)}',
            )
        try:
            if kind in given:
                called, of_kind = kind, given[kind]
            else:
                size = classes[row]
                called = f'{kind} {size:.3g} m'
                of_kind = made.get(called) or _grown(kind, float(size), seed)
            made[called] = of_kind
            scale = height[row] / float(np.ptp(of_kind.tree.end[:, 2]))
            if not SMALLEST <= scale <= LARGEST:
                raise ParameterError(
                    f"{height[row]:g} m is {scale:.3g} times the height of '{called}'",
                    cure=f'give {SMALLEST:g} to {LARGEST:g} times',
                )
            at = float(x[row]), float(y[row]), float(z[row])
            standing.append(
                StandTree(names[row], called, *at, scale, float(yaw[row]), fidelity[row])
            )
        except TreeSwayError as error:
            raise error.at(where) from None
    told = {'name': path.stem, 'source': str(path)} | told
    return stand_file(standing=tuple(standing), kinds=made, **told)


def _height_classes(species: list[str], heights: Floats) -> Floats:
    """Height that each tree is scaled from: the mean of its species, or of those of its class."""
    grown = np.array(heights)
    for kind in set(species):
        own = np.flatnonzero((np.array(species) == kind) & (heights > 0.0))
        if len(own):
            middle = float(np.median(heights[own]))
            steps = np.round(np.log(heights[own] / middle) / math.log(_CLASS))
            for step in np.unique(steps):
                grown[own[steps == step]] = np.exp(np.log(heights[own[steps == step]]).mean())
    return grown


def _grown(species: str, height: float, seed: int) -> StandKind:
    wood = species_named(species)
    return StandKind(grow(species, height, rng=np.random.default_rng(seed)), wood)


def _texts(table: TextTable, column: str) -> list[str]:
    """Texts of a column; an empty list if there is none of that name, an error for empty cells."""
    if column not in (each.lower() for each in table.columns):
        return []
    texts = table.cells(table.index_of(column), range(len(table.texts)))
    for row, text in enumerate(texts):
        if not text:
            raise FormatError(f'no {column}', where=table.where(row), cure='fill the cell')
    return texts


def _numbers(table: TextTable, column: str, otherwise: Floats) -> Floats:
    if column not in (each.lower() for each in table.columns):
        return otherwise
    numbers: Floats = table.strict([column])[:, 0]
    return numbers
