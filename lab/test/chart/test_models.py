# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The charts of models: what they measure, write and draw."""

import csv

import numpy as np
import pytest
from tree_sway_lab.bench.frame_time import frame_times
from tree_sway_lab.chart.cost import chart_cost
from tree_sway_lab.chart.fidelity import chart_fidelity
from tree_sway_lab.example_trees import forked_tree
from tree_sway_lab.validation.truth import QUICK

pytest.importorskip('matplotlib', reason='pictures need matplotlib')


def read(path):
    with path.open() as file:
        return list(csv.DictReader(file))


@pytest.mark.long
def test_fidelity_grows_with_the_dial_and_is_written(tmp_path):
    points = chart_fidelity(
        tmp_path, kinds=['limbs8'], models=('3', 'full', 'branch'), engines=(), fineness=QUICK
    )
    error = {point.model: point.error for point in points}
    assert error['full'] < min(error['3'], error['branch'])
    assert [row['model'] for row in read(tmp_path / 'fidelity.csv')] == list(error)
    assert (tmp_path / 'fidelity.png').stat().st_size > 10_000


@pytest.mark.long
def test_cost_is_written_for_every_model_and_size(tmp_path):
    points = chart_cost(tmp_path, cuts=(6,), generations=(2, 3), frames=40, models=['full'])
    sizes = {(p.n_branches, p.segments_a_branch) for p in points}
    assert sizes == {(40, 6), (4, 6), (13, 6)}
    assert all(p.step > 0.0 and p.place > 0.0 for p in points)
    assert len(read(tmp_path / 'cost.csv')) == len(points) == 2 * len(sizes)
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
