# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the numbers of a tree's file mean, where its format does not say: units and the axis up."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import ParameterError
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.imported_tree import TreeFile


@dataclass(frozen=True)
class FileUnits:
    """Units of positions and of diameters in [m], and the axis that points up, ``z`` or ``y``."""

    length_unit: float = 1.0
    diameter_unit: float = 1.0
    up: str = 'z'

    def __post_init__(self) -> None:
        """Refuse what is no unit and no axis."""
        units = {'length_unit': self.length_unit, 'diameter_unit': self.diameter_unit}
        for name, unit in units.items():
            if not 1e-6 <= unit <= 1e3:
                raise ParameterError(f'{name} is {unit:g} m', cure='give 0.01 for cm')
        if self.up not in ('z', 'y'):
            raise ParameterError(f"up is '{self.up}'", cure="use 'z' or 'y'")

    def of_tree(self, content: TreeFile) -> TreeFile:
        """Return the tree of a file in metres, z up."""
        if self == FileUnits():
            return content
        tree = replace(
            content.tree,
            start=self._positions(content.tree.start),
            end=self._positions(content.tree.end),
            base_diameter=self.diameter_unit * content.tree.base_diameter,
            tip_diameter=self.diameter_unit * content.tree.tip_diameter,
        )
        return replace(content, tree=tree)

    def of_cylinders(self, content: Cylinders) -> Cylinders:
        """Return the cylinders of a file in metres, z up."""
        return replace(
            content,
            start=self._positions(content.start),
            end=self._positions(content.end),
            diameter=self.diameter_unit * content.diameter,
        )

    def _positions(self, nodes: Floats) -> Floats:
        turned = np.asarray(nodes, dtype=np.float64)
        if self.up == 'y':
            turned = turned[:, [0, 2, 1]] * [1.0, -1.0, 1.0]
        return np.ascontiguousarray(self.length_unit * turned)
