# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Placing on several threads: the same poses, each block after its parents."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.motion.threaded_placing import waves
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.study.bench.bench_tree import bench_tree


@pytest.fixture(scope="module")
def tree():
    return bench_tree(60)


@pytest.mark.parametrize("threads", [2, 3])
def test_the_poses_are_those_of_one_thread(tree, threads):
    one, many = (SwaySimulator(tree, model="subtree", gravity=0.0, threads=n) for n in (1, threads))
    for k in range(5):
        for sim in (one, many):
            sim.step((7.0, np.sin(k), 0.0), 1 / 60)
        assert np.abs(one.place() - many.place()).max() < 4e-15
    poses = [many.place() for _ in range(20)]
    assert len({pose.tobytes() for pose in poses}) == 1


def test_no_block_of_a_wave_sits_on_another(tree):
    heads = SwaySimulator(tree, model="subtree", gravity=0.0).bank.heads
    found = waves(heads)
    assert [first for first, _ in found] == [0, *(end for _, end in found[:-1])]
    assert found[-1][1] == len(heads) - 1
    assert len(found) >= 4  # stem, limbs, their branches and twigs
    for first, end in found:
        own = heads["branch"][first:end]
        assert not np.isin(heads["parent"][first:end], own[own > 0]).any()


def test_a_number_of_threads_that_is_none_is_refused(tree):
    with pytest.raises(ParameterError, match="threads"):
        SwaySimulator(tree, threads=0)
