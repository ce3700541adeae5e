# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Sway of a tree in a wind as arrays over time: tips, moment and strain at the base."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.drawn import Drawn
from tree_sway.errors import MissingDependencyError
from tree_sway.simulation.strength_use import StrengthUse
from tree_sway.twin import LearnedTree

_SIDES = ('east', 'north')


@dataclass(frozen=True, eq=False, repr=False)
class SwayRecord(Drawn):
    """
    The sway of one tree; every array has one row per step.

    Parameters
    ----------
    tree
        Name of the tree.
    model
        Model at the end.
    time
        End of each step in [s], (t,).
    wind
        Mean wind over each step in [m/s], (t, 3).
    branches
        Branches whose tips are recorded, (k,).
    branch_names
        Names of these branches.
    tips
        Displacement of each of these tips from rest in [m], east, north, up, (t, k, 3).
    base_moment
        Change of the bending moment in the wood at the base of the stem from rest in [N m], (t,
        3): the moment on the stem about the x, y and z axis.
    base_strain
        Strain of the outermost fibre at the base of the stem, beyond that at rest, on its east and
        on its north side [-], (t, 2); positive in tension.
    strain
        Largest strain of a fibre along each of these branches, beyond that at rest [-], (t, k).
    strength
        Largest used share of the strength of the tree.
    notes
        Doubts about the motion, one sentence each: steps that were clamped, coordinates that were
        left out, restarts.
    tip_band, moment_band
        Bounds within which the real tree is for 80 % of the time, lower and upper, of ``tips``,
        (t, 2, k, 3), and of ``base_moment``, (t, 2, 3); None where they were not asked for.
    learned
        Findings of motion sensors; None without them, or before the first fit.

    """

    tree: str
    model: str
    time: Floats
    wind: Floats
    branches: Ints
    branch_names: tuple[str, ...]
    tips: Floats
    base_moment: Floats
    base_strain: Floats
    strain: Floats
    strength: StrengthUse
    notes: tuple[str, ...] = ()
    tip_band: Floats | None = None
    moment_band: Floats | None = None
    learned: LearnedTree | None = None

    def columns(self) -> dict[str, Floats]:
        """Return every column, (t,), under its name with its unit, such as ``time [s]``."""
        vectors = [('wind', 'm/s', self.wind), ('moment', 'N m', self.base_moment)]
        for k, name in enumerate(self.branch_names):
            vectors.append((f'{name} tip', 'm', self.tips[:, k]))
        for i, end in enumerate(('low', 'high')):
            if self.moment_band is not None:
                vectors.append((f'moment {end}', 'N m', self.moment_band[:, i]))
            if self.tip_band is not None:
                for k, name in enumerate(self.branch_names):
                    vectors.append((f'{name} tip {end}', 'm', self.tip_band[:, i, k]))
        found = {'time [s]': self.time}
        for name, unit, rows in vectors:
            found |= {f'{name}_{axis} [{unit}]': rows[:, i] for i, axis in enumerate('xyz')}
        found |= {f'strain_{s} [-]': self.base_strain[:, i] for i, s in enumerate(_SIDES)}
        names = enumerate(self.branch_names)
        return found | {f'{name} largest strain [-]': self.strain[:, k] for k, name in names}

    def to_dataframe(self) -> Any:
        """Return the columns as a data frame of pandas; a `MissingDependencyError` without it."""
        try:
            pandas = import_module('pandas')
        except ModuleNotFoundError as error:
            what = "No module named 'pandas'"
            raise MissingDependencyError(what, cure='install it: pip install pandas') from error
        return pandas.DataFrame(self.columns())

    def to_csv(self) -> str:
        """Return the record as comma-separated values under one line of names and units."""
        columns = self.columns()
        head = ','.join(f'"{name}"' if ',' in name else name for name in columns)
        rows = np.stack([*columns.values()], axis=1)
        return '\n'.join([head, *(','.join(f'{x:.9g}' for x in row) for row in rows), ''])

    def __repr__(self) -> str:
        """Say what `str` does, and each note on a line of its own."""
        return '\n'.join([str(self), *(f'note: {each}' for each in self.notes)])

    def __str__(self) -> str:
        """Name tree, model, length, wind and the largest motion of the first tip on one line."""
        speed = float(np.linalg.norm(self.wind, axis=1).mean())
        said = (
            f'SwayRecord of {self.tree}, {self.strength.season}, model {self.model}: '
            f'{len(self.time)} steps, '
            f'{self.time[-1]:.4g} s, mean wind {speed:.3g} m/s'
        )
        if not self.branch_names:
            return said
        largest = float(np.linalg.norm(self.tips[:, 0], axis=1).max())
        return f'{said}, tip of {self.branch_names[0]} up to {largest:.3g} m'
