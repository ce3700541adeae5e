# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Make the test vectors that Python and JavaScript both read: a description, frames, what they say.

    python test/page/vectors/make_vectors.py

The scene is small but has all that placing knows: enriched branches with further shapes and
twists, a tree whose branches bend by their slopes alone, deep bending, two kinds, of one of which
a second tree is turned and scaled. The poses are placed by the solver from key rotations, not by a
decoder of frames.

"""

from __future__ import annotations

from dataclasses import replace
import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.core.leaves.foliage import leaf_clusters
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.settings import Settings
from tree_sway.core.species.species import species_named
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.tree.tree import Tree
from tree_sway.stream.description import describe_scene
from tree_sway.stream.protocol import (
    decode_description,
    encode_frame,
    Frame,
    PAUSED,
    quantised,
    WIND_LOST,
)

HERE = Path(__file__).parent
N_COORDINATES = 5
SETTINGS = Settings(model='full', enrich='all')
TREES = (
    ('left', 0, (0.0, 0.0, 0.0, 0.0, 1.0)),
    ('right', 1, (1.5, 0.0, 0.0, 0.0, 1.0)),
    ('turned', 0, (-2.0, 1.0, 0.25, 2.2, 1.4)),
)
"""Name, kind and place of each tree."""


def small_tree(name: str, x: float) -> Tree:
    """Make a stem, two branches and a twig on one of them; its root node at (x, 0, 0)."""
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


def simulators() -> list[SwaySimulator]:
    """Make a tree all of whose branches bend in further shapes, and one whose stem alone does."""
    first, second = small_tree('left', 0.0), small_tree('right', 1.5)
    species = species_named(first.species)
    return [
        make_simulator(first, species, SETTINGS),
        make_simulator(second, species, replace(SETTINGS, enrich='stem')),
    ]


def placed(kind: Any, coordinates: Any, place: tuple[float, ...]) -> Any:
    """Poses of one tree: of its kind by the native core, then scaled, turned and moved."""
    x, y, z, yaw, scale = np.float32(place).astype(np.float64).tolist()
    poses = kind.simulator.place_rotations(kind.basis.matrix.astype(np.float64) @ coordinates)
    turn = Rotation.from_rotvec([0.0, 0.0, yaw])
    away = turn.apply(scale * (poses[:, :3] - kind.simulator.tree.start[0]))
    poses[:, :3] = away + np.array([x, y, z])
    poses[:, 3:] = (turn * Rotation.from_quat(poses[:, 3:])).as_quat()
    return poses


def main() -> None:
    """Write the files beside this one."""
    rng = np.random.default_rng(7)
    kinds = []
    for simulator in simulators():
        size = int(simulator.banks[0].branches['n_coordinates'].sum()), N_COORDINATES
        basis = SimpleNamespace(
            matrix=rng.normal(0.0, 0.1, size).astype(np.float32),
            scale=rng.uniform(0.5, 3.0, N_COORDINATES).astype(np.float32),
            error=0.001,
        )
        kinds.append(SimpleNamespace(simulator=simulator, basis=basis, numbers=[], places=[]))
    for number, (_, kind, place) in enumerate(TREES):
        kinds[kind].numbers.append(number)
        kinds[kind].places.append(place)
    leaves = leaf_clusters(kinds[0].simulator.tree, np.random.default_rng(0), count=6)
    names = [name for name, _, _ in TREES]
    data = describe_scene('forest', kinds, names, leaves=[leaves, None])  # type: ignore[arg-type]
    description = decode_description(data)
    (HERE / 'description.bin').write_bytes(data)
    scale = np.concatenate([kinds[kind].basis.scale for _, kind, _ in TREES]).astype(np.float64)
    expected = []
    for number, size in enumerate((0.0, 0.3, 0.9, 3.0)):
        values = size * scale * rng.uniform(-1.0, 1.0, len(scale))
        steps, _ = quantised(values, scale)
        wind = 4.0 * number * np.array([1.0, -0.5, 0.05])
        flags = (0, PAUSED, WIND_LOST, 0)[number]
        stamp = 1_700_000_000_000_000_000 + 16_666_667 * number
        frame = Frame(description.short_identity, 2**32 - 2 + number, stamp, flags, wind, steps)
        (HERE / f'frame{number}.bin').write_bytes(encode_frame(frame))
        sent = steps * (scale / 32767)
        poses = [
            placed(kinds[kind], part, place)
            for (_, kind, place), part in zip(TREES, np.split(sent, len(TREES)), strict=True)
        ]
        expected.append(
            {
                'sequence': (2**32 - 2 + number) % 2**32,
                'stamp_ns': str(stamp),
                'flags': flags,
                'wind': wind.tolist(),
                'coordinates': np.round(sent, 9).tolist(),
                'poses': np.round(np.vstack(poses), 7).tolist(),
            }
        )
    content = {'identity': description.identity, 'frames': expected}
    (HERE / 'expected.json').write_text(json.dumps(content, indent=None) + '\n', encoding='utf-8')


if __name__ == '__main__':
    main()
