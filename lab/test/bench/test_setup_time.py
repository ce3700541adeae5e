# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""That set-ups are timed from nothing, each on its model."""

from __future__ import annotations

import pytest
from tree_sway_lab.bench import setup_time as bench_setup
from tree_sway_lab.bench.bench_tree import bench_tree


def test_every_model_is_set_up_from_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    built = []
    honest = bench_setup.make_simulator

    def noted(tree, **settings):
        simulator = honest(tree, **settings)
        built.append((tree.n_branches, simulator.model))
        return simulator

    monkeypatch.setattr(bench_setup, 'make_simulator', noted)
    times = bench_setup.time_setups(bench_tree(3, (4, 2)), ('branch', 20))
    assert [each for each in built if each[0] == 13] == [(13, 'branch'), (13, '20')]
    assert list(times) == ['branch', 20]
    assert all(spent > 0.0 for spent in times.values())
