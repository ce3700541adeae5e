# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a tree did in a wind, as arrays over time: tips, the moment and the strain at its base."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway_ros.core.arrays import Floats, Ints


@dataclass(frozen=True, eq=False)
class SwayRecord:
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
        Branches whose tips are told, (k,).
    branch_names
        Their names.
    tips
        Displacement of each of these tips from rest in [m], east, north, up, (t, k, 3).
    base_moment
        Bending moment that the wood carries at the base of the stem, beyond that at rest, in
        [N m], (t, 3): the moment on the stem about the x, y and z axis.
    base_strain
        Strain of the outermost fibre at the base of the stem, beyond that at rest, on its east
        and on its north side [-], (t, 2); positive where the fibre is drawn out.

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

    def to_csv(self) -> str:
        """Return the record as comma-separated values under one line of names."""
        columns = [self.time[:, None], self.wind, self.base_moment, self.base_strain]
        columns.append(self.tips.reshape(len(self.time), -1))
        names = ['time', 'wind_x', 'wind_y', 'wind_z', 'moment_x', 'moment_y', 'moment_z']
        names += ['strain_east', 'strain_north']
        names += [f'{name}_{axis}' for name in self.branch_names for axis in 'xyz']
        head = ','.join(f'"{name}"' if ',' in name else name for name in names)
        rows = (','.join(f'{value:.9g}' for value in row) for row in np.hstack(columns))
        return '\n'.join((head, *rows, ''))
