# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The charts of the ladder of models: what they measure, write and draw."""

import csv

import numpy as np
import pytest

from tree_sway_ros.study.bench.frame_time import frame_times
from tree_sway_ros.study.chart.cost import chart_cost
from tree_sway_ros.study.chart.fidelity import chart_fidelity, LADDER
from tree_sway_ros.study.example_trees import forked_tree

pytest.importorskip('matplotlib', reason='pictures need matplotlib')


def read(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def test_fidelity_falls_up_the_ladder_and_is_written(tmp_path):
    time = np.arange(41) / 20.0
    velocity = np.stack([6 + 2 * np.sin(3 * time), 2 * np.cos(2 * time), 0 * time], axis=1)
    tree = forked_tree(0.65, 0.6, generations=2)
    points = chart_fidelity(tmp_path, wind=(time, velocity), duration=2.0, trees=[tree])
    error = {point.model: point.error for point in points}
    assert list(error) == [*LADDER, 'segments']
    assert error['branch'] > error['subtree'] > error['coupled']
    assert error['segments'] < 0.05
    assert [row['model'] for row in read(tmp_path / 'fidelity.csv')] == list(error)
    assert (tmp_path / 'fidelity.png').stat().st_size > 10_000


def test_cost_is_written_for_every_model_and_size(tmp_path):
    points = chart_cost(tmp_path, cuts=(6,), generations=(2, 3), frames=40)
    sizes = {(p.n_branches, p.segments_a_branch) for p in points}
    assert sizes == {(40, 6), (4, 6), (13, 6)}
    assert all(p.step > 0.0 and p.place > 0.0 for p in points)
    assert len(read(tmp_path / 'cost.csv')) == len(points) == 4 * len(sizes)
    assert (tmp_path / 'cost.png').stat().st_size > 10_000


def test_frame_times_keep_models_apart():
    class Busy:
        """A simulator that takes as long as its work."""

        def __init__(self, work):
            self.work = work

        def step(self, wind, dt):
            sum(range(self.work))

        def place(self, out):
            out[:] = 0.0

    tree = forked_tree(0.5, 0.6, generations=1)
    times = frame_times(
        {'idle': Busy(1), 'busy': Busy(20_000)}, tree, np.zeros((1, 3)), 0.1, frames=40
    )
    assert times['busy'].step > 10.0 * times['idle'].step
