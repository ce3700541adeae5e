# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Make the test vectors that Python and JavaScript both read: a description, frames, what they say.

    python test/page/vectors/make_vectors.py

The scene is small but has all that placing knows: enriched branches with further shapes and
twists, a tree whose twigs move with their parents as one body, deep bending, two trees. The poses
are placed by the solver from key rotations, not by a decoder of frames.

"""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from tree_sway_ros.core.leaves.foliage import leaf_clusters
from tree_sway_ros.core.scene.placed_tree import joined
from tree_sway_ros.core.simulator.assembly import CalibratedTree
from tree_sway_ros.core.simulator.partly_frozen import PartlyFrozenTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.building import tree_from_segments
from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.page.description import describe_scene
from tree_sway_ros.page.protocol import PAUSED, Frame, decode_description, encode_frame, quantised

HERE = Path(__file__).parent
N_COORDINATES = 5
SETTINGS = Settings(model="coupled", enrich="all")


def small_tree(name: str, x: float) -> Tree:
    """A stem, two branches and a twig on one of them; its root node at (x, 0, 0)."""
    start: list[Any] = []
    end: list[Any] = []
    parent: list[int] = []
    diameter: list[float] = []

    def chain(step: tuple[float, float, float], count: int, on: int, thick: float) -> None:
        at = np.array([x, 0.0, 0.0]) if on < 0 else end[on]
        for i in range(count):
            start.append(at)
            at = at + np.array(step) + [0.0, 0.01 * i, -0.004 * i]
            end.append(at)
            parent.append(on)
            diameter.append(thick * (1.0 - 0.12 * i))
            on = len(start) - 1

    chain((0.02, 0.0, 0.2), 5, -1, 0.02)
    chain((-0.12, 0.05, 0.08), 4, 2, 0.009)
    chain((0.02, 0.1, 0.06), 3, 6, 0.004)
    chain((0.11, -0.06, 0.07), 4, 3, 0.007)
    return tree_from_segments(start, end, diameter, parent=parent, name=name)


def scene() -> Any:
    """Two trees: one that moves all over, one whose twig is frozen."""
    first, second = small_tree("left", 0.0), small_tree("right", 1.5)
    species = species_named(first.species)
    frozen = np.array([name == second.branch_names[-1] for name in second.branch_names])
    part = PartlyFrozenTree(CalibratedTree(second, species, SETTINGS), frozen)
    simulators = (
        SwaySimulator(first, species, SETTINGS),
        SwaySimulator(second, species, SETTINGS, calibrated=part),
    )
    return SimpleNamespace(tree=joined([first, second]), simulators=simulators)


def rotations_of(simulator: Any) -> int:
    """How many key rotations a tree has."""
    return int(simulator.joints["n_coordinates"].sum())


def placed(simulator: Any, rotations: Any) -> Any:
    """Poses of one tree by the solver's kernels."""
    return simulator.place_rotations(rotations)


def main() -> None:
    """Write the files beside this one."""
    rng = np.random.default_rng(7)
    both = scene()
    bases = [
        SimpleNamespace(
            matrix=rng.normal(0.0, 0.1, (rotations_of(each), N_COORDINATES)).astype(np.float32),
            scale=rng.uniform(0.5, 3.0, N_COORDINATES).astype(np.float32),
            error=SimpleNamespace(greatest=0.001),
            frames=each.joints["frame"],
            per_key=lambda branch, turns: turns,
        )
        for each in both.simulators
    ]
    leaves = leaf_clusters(both.simulators[0].tree, np.random.default_rng(0), count=6)
    data = describe_scene(both, both.simulators, bases, frame_id="map", leaves=leaves)
    description = decode_description(data)
    (HERE / "description.bin").write_bytes(data)
    scale = np.concatenate([basis.scale for basis in bases]).astype(np.float64)
    expected = []
    for number, size in enumerate((0.0, 0.3, 0.9, 3.0)):
        values = size * scale * rng.uniform(-1.0, 1.0, len(scale))
        steps, _ = quantised(values, scale)
        wind = 4.0 * number * np.array([1.0, -0.5, 0.05])
        flags = PAUSED if number == 1 else 0
        stamp = 1_700_000_000_000_000_000 + 16_666_667 * number
        frame = Frame(description.short_identity, 2**32 - 2 + number, stamp, flags, wind, steps)
        (HERE / f"frame{number}.bin").write_bytes(encode_frame(frame))
        told = steps * (scale / 32767)
        poses = [
            placed(each, np.asarray(basis.matrix, dtype=np.float64) @ part)
            for each, basis, part in zip(both.simulators, bases, np.split(told, 2), strict=True)
        ]
        expected.append(
            {
                "sequence": (2**32 - 2 + number) % 2**32,
                "stamp_ns": str(stamp),
                "flags": flags,
                "wind": wind.tolist(),
                "coordinates": np.round(told, 9).tolist(),
                "poses": np.round(np.vstack(poses), 7).tolist(),
            }
        )
    content = {"identity": description.identity, "frames": expected}
    (HERE / "expected.json").write_text(json.dumps(content, indent=None) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
