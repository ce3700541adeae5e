# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A solver with a single tree of a forest, beside solvers with several."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')

from tree_sway.core.settings import Settings  # noqa: E402
from tree_sway_ros.solver import scene_of  # noqa: E402

FOREST = """\
trees:
- {name: a, tree: goldcrest, x: 0, y: 0}
- {name: b, tree: goldcrest, x: 30, y: 0}
- {name: c, tree: goldcrest, x: 60, y: 0}
"""
WIND = (6.0, 1.0, 0.0)


@pytest.mark.parametrize('shards', [2, 3])
def test_one_tree_of_a_forest_is_not_apart_from_the_first(tmp_path: Path, shards: int) -> None:
    path = tmp_path / 'row.yaml'
    path.write_text(FOREST)
    values: dict[str, Any] = {
        'tree': str(path), 'species': '', 'leaves': 'auto', 'pose': [0.0, 0.0, 0.0, 0.0],
        'shard.index': shards - 1, 'shard.count': shards,
    }  # fmt: skip
    shard = scene_of(values)
    assert [each.name for each in shard.trees] == ['c']
    assert any('the only tree of its shard' in note for note in shard.notes)
    settings = Settings(model='20')
    assert not shard.settings_of(0, settings).is_far
    whole = scene_of(values | {'shard.index': 0, 'shard.count': 1})
    alone, all_of_them = shard.simulator(settings), whole.simulator(settings)
    for _ in range(60):
        alone.step(WIND, 1.0 / 60.0)
        all_of_them.step(WIND, 1.0 / 60.0)
    # Where no gust passes, a steady wind moves it as in the whole.
    n = shard.trees[0].tree.n_segments
    assert np.abs(alone.place()[:, :3] - all_of_them.place()[-n:, :3]).max() < 0.05
