# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree of a scene: its name, kind, place, size and yaw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
import math
from typing import Any, NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.checks import number_of, one_of, refuse_other_kind, within
from tree_sway.core.rotation import about_up
from tree_sway.core.settings import model_of, Settings
from tree_sway.core.setup import is_in_leaf
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree, tree_and_species
from tree_sway.errors import inside, ParameterError, TreeError

SCALES = 0.2, 5.0
"""Smallest and largest scale of a placed tree."""

MOST_SEGMENTS = 5_000_000
"""Largest number of segments in one record of all trees of a scene, some 1 GB."""


@dataclass(frozen=True, slots=True)
class PlacedTree:
    """
    A tree of a scene. Trees given the same `Tree` and species are of one kind and share it.

    Parameters
    ----------
    name
        Name in the scene.
    tree
        Tree in its own frame, with or without its species.
    x, y, z
        Place of the root node in [m].
    scale
        Height over that of `tree`.
    yaw
        Rotation about the vertical, counterclockwise seen from above, in [rad].
    species
        Species for wood, damping and drag; the tree's own if None.
    model
        Model, as in `Settings`; the scene's if None.
    leaf_on
        Whether it bears leaves; if None, by the scene or by its species.
    learned
        What is known of this very tree, which its species already has, as a `LearnedTree` of the
        house `twin`; carried along, None without.

    Raises
    ------
    ParameterError
        A number that is not finite, a scale out of its range, an unknown model, or no tree.
    SpeciesError
        A species that no table knows.

    """

    name: str
    tree: Tree
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    scale: float = 1.0
    yaw: float = 0.0
    species: Species = None  # type: ignore[assignment]
    model: int | str | None = None
    leaf_on: bool | None = None
    learned: Any = None

    def __post_init__(self) -> None:
        """Check the values."""
        refuse_other_kind('name', self.name, str, 'give the name of the tree')
        tree, species = tree_and_species(self.tree, self.species)
        object.__setattr__(self, 'tree', tree)
        object.__setattr__(self, 'species', species)
        pose = (self.x, self.y, self.z, self.yaw)
        numbers = [number_of(f'{self.name}: pose', each) for each in pose]
        if not all(map(math.isfinite, numbers)):
            what = f'a pose of {pose[:3]} m and {self.yaw} rad'
            raise ParameterError(what, where=self.name, cure='give finite numbers')
        within(f'{self.name}: scale', self.scale, *SCALES)
        one_of(f'leaf_on of {self.name}', self.leaf_on, (True, False, None))
        if self.model is not None:
            with inside(self.name):
                object.__setattr__(self, 'model', model_of(self.model))

    def __repr__(self) -> str:
        """Return name, tree and place on one line."""
        return (
            f'PlacedTree {self.name!r} at ({self.x:.4g}, {self.y:.4g}, {self.z:.4g}) m, '
            f'scale {self.scale:.3g}: {self.tree!r}'
        )

    @property
    def kind(self) -> Kind:
        """Objects that it shares with the trees of its kind."""
        return Kind(self.tree, self.species, self.leaf_on)

    def placed(self) -> Tree:
        """Return the tree in the scene's frame, under its name there."""
        tree = self.tree
        root = tree.start[0]
        here = np.array([self.x, self.y, self.z])
        if (self.scale, self.yaw) == (1.0, 0.0) and (root == here).all():
            return replace(tree, name=self.name)
        turn = self.scale * about_up(self.yaw)

        def moved(nodes: Floats) -> Floats:
            return np.asarray(here + (nodes - root) @ turn.T)

        return replace(
            tree,
            start=moved(tree.start),
            end=moved(tree.end),
            base_diameter=self.scale * tree.base_diameter,
            tip_diameter=self.scale * tree.tip_diameter,
            name=self.name,
        )

    def settings_where_it_stands(self, scene: Settings) -> Settings:
        """Return its settings in a scene: with model, leaves, and ground of the profile."""
        raised = scene.profile.ground + self.z - float(self.tree.start[0, 2])
        profile = replace(scene.profile, ground=raised)
        return replace(self.kind.settings(scene), profile=profile, model=self.model or scene.model)

    def bears_leaves(self, otherwise: bool | None = None) -> bool:
        """Whether it bears leaves; ``otherwise`` where this is not determined."""
        return is_in_leaf(self.species, otherwise if self.leaf_on is None else self.leaf_on)


class Kind(NamedTuple):
    """Objects that the trees of one kind share."""

    tree: Tree
    species: Species
    leaf_on: bool | None

    def settings(self, scene: Settings) -> Settings:
        """Return the scene's settings with the leaves of this kind."""
        if self.leaf_on is None:
            return scene
        return replace(scene, in_leaf=self.leaf_on, leaf_mass=None, leaf_area=None)


def joined(trees: Sequence[Tree], name: str = 'scene') -> Tree:
    """
    Join trees in one frame to one record, to be described or drawn as one; a `TreeError` if none.

    Segments are one tree after another, names ``tree/branch``. The record has several roots, so it
    cannot be solved.
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
    """Join the indices of trees; those of roots stay -1."""
    moved = [np.where(c < 0, -1, c + at) for c, at in zip(columns, by[:-1], strict=True)]
    return np.concatenate(moved)
