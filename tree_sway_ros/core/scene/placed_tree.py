# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees that stand in one place: each has a name, a place, and a way in which it is turned."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
import math

import numpy as np

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.simulator.season import is_in_leaf
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.tree.grown_tree import tree_and_species
from tree_sway_ros.core.tree.species import Species, species_named
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import ParameterError, TreeError


def refuse_nowhere(name: str, x: float, y: float, z: float, yaw: float) -> None:
    """Raise a `ParameterError` for a tree whose place or heading is not finite."""
    if not all(map(math.isfinite, (x, y, z, yaw))):
        raise ParameterError(
            f'a pose of ({x}, {y}, {z}) m and {yaw} rad', where=name, cure='give finite numbers'
        )


@dataclass(frozen=True)
class PlacedTree:
    """
    A tree of a forest.

    Parameters
    ----------
    name
        Its name in the forest.
    tree
        The tree, in a frame of its own; one with its species, as `open_tree` gives, is taken
        apart.
    x, y, z
        Where its root node stands in [m].
    yaw
        How far it is turned about the vertical, counterclockwise seen from above, in [rad].
    species
        Its wood, damping and drag; looked up by the tree's own species if None.
    settings
        How it is modelled; as the forest if None.
    leaf_on
        Whether it bears leaves; as the forest, or as its species, if None.

    Raises
    ------
    ParameterError
        If position or yaw is not finite, or the tree is something else.

    """

    name: str
    tree: Tree
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    yaw: float = 0.0
    species: Species | None = None
    settings: Settings | None = None
    leaf_on: bool | None = None

    def __post_init__(self) -> None:
        """Refuse what is no tree, and what is nowhere."""
        if self.species is not None or not isinstance(self.tree, Tree):
            tree, species = tree_and_species(self.tree, self.species)
            object.__setattr__(self, 'tree', tree)
            object.__setattr__(self, 'species', species)
        refuse_nowhere(self.name, self.x, self.y, self.z, self.yaw)

    def placed(self) -> Tree:
        """Return the tree where it stands in the forest's frame, under its name there."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        root, here = self.tree.start[0], np.array([self.x, self.y, self.z])

        def moved(nodes: Floats) -> Floats:
            out: Floats = here + (nodes - root) @ turn.T
            return out

        return replace(
            self.tree, start=moved(self.tree.start), end=moved(self.tree.end), name=self.name
        )

    def settings_where_it_stands(self, forest: Settings) -> Settings:
        """
        Return its settings, the ground of the wind profile raised to where it stands.

        Parameters
        ----------
        forest
            Settings of trees that have none of their own.

        """
        settings = self.settings if self.settings is not None else forest
        if self.leaf_on is not None:
            settings = replace(settings, in_leaf=self.leaf_on, leaf_mass=None, leaf_area=None)
        raised = self.z - float(self.tree.start[0, 2])
        return replace(
            settings, profile=replace(settings.profile, ground=settings.profile.ground + raised)
        )

    def bears_leaves(self, told: bool | None = None) -> bool:
        """Whether it bears leaves, where trees that do not say are told to or not."""
        species = self.species if self.species is not None else species_named(self.tree.species)
        return is_in_leaf(species, told if self.leaf_on is None else self.leaf_on)


def joined(trees: Sequence[Tree], name: str = 'forest') -> Tree:
    """
    Join trees in one frame to one record, to be described or drawn as one; a `TreeError` if none.

    Segments are one tree after another, names ``tree/branch``. It has several roots, so it cannot
    be solved.
    """
    if not trees:
        raise TreeError('no trees', where=name, cure='give at least one')
    segment = np.cumsum([0, *(tree.n_segments for tree in trees)]).tolist()
    branch = np.cumsum([0, *(tree.n_branches for tree in trees)]).tolist()
    species = {tree.species for tree in trees}
    first = [tree.branch_first[:-1] + at for tree, at in zip(trees, segment[:-1], strict=True)]
    end = [tree.subtree_end + at for tree, at in zip(trees, branch[:-1], strict=True)]
    return Tree(
        start=np.concatenate([tree.start for tree in trees]),
        end=np.concatenate([tree.end for tree in trees]),
        base_diameter=np.concatenate([tree.base_diameter for tree in trees]),
        tip_diameter=np.concatenate([tree.tip_diameter for tree in trees]),
        segment_parent=_moved_on([tree.segment_parent for tree in trees], segment),
        branch_first=np.concatenate([*first, [segment[-1]]]),
        branch_parent=_moved_on([tree.branch_parent for tree in trees], branch),
        subtree_end=np.concatenate(end),
        source_index=np.concatenate([tree.source_index for tree in trees]),
        branch_names=tuple(f'{tree.name}/{each}' for tree in trees for each in tree.branch_names),
        name=name,
        species=species.pop() if len(species) == 1 else 'mixed',
    )


def _moved_on(columns: list[Ints], by: list[int]) -> Ints:
    """Join indices of each tree; those of roots stay -1."""
    moved = [np.where(c < 0, -1, c + at) for c, at in zip(columns, by[:-1], strict=True)]
    return np.concatenate(moved)
