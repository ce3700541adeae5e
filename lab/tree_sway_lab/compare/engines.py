# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Engines of rigid bodies that step the same tree in the same wind, 60 times per second."""

from __future__ import annotations

from collections.abc import Iterable
import importlib.util
import sys
from typing import NamedTuple

from tree_sway.core.arrays import Floats
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway_lab.compare.mujoco_tree import MujocoTree

MODULES = {'MuJoCo': 'mujoco', 'DART': 'dartpy', 'Newton': 'newton'}
"""The Python module of each engine, which is also its name in the package index."""


class EngineRun(NamedTuple):
    """Tips after each frame in [m], (t, b, 3), and CPU time per frame in [s], wind left out."""

    tips: Floats
    cost: float


def run_engines(
    tree: Tree,
    species: Species,
    damping_ratio: float,
    wind: Floats,
    *,
    gravity: float = 0.0,
    match_beam: bool = True,
    names: Iterable[str] = tuple(MODULES),
    newton_frames: int = 120,
) -> dict[str, EngineRun]:
    """
    Run engines, and report which are not installed.

    Parameters
    ----------
    tree, species, damping_ratio
        The tree, its wood, and the ratio of the first mode; above it, it grows with the frequency.
    wind
        Mean of each frame of 1/60 s in [m/s], (t, 3).
    gravity
        In [m/s^2]; DART is left out where there is any.
    match_beam
        As in `MujocoTree`.
    names
        Keys of `MODULES`.
    newton_frames
        Frames that Newton runs, the first; it takes most of the time.

    """
    twin = MujocoTree(
        tree, species, damping_ratio, even=False, match_beam=match_beam, gravity=gravity
    )
    found: dict[str, EngineRun] = {}
    for name in names:
        if importlib.util.find_spec(MODULES[name]) is None:
            print(f'without {name}: pip install {MODULES[name]}', file=sys.stderr)
        elif name == 'MuJoCo':
            found[name] = EngineRun(*twin.race(wind))
        elif name == 'Newton':
            from tree_sway_lab.compare.newton_tree import NewtonTree

            found[name] = EngineRun(*NewtonTree(twin, gravity).race(wind[:newton_frames]))
        elif gravity == 0.0:
            from tree_sway_lab.compare.dart_tree import DartTree

            found[name] = EngineRun(*DartTree(twin).race(wind))
    return found
