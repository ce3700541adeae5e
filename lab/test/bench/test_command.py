# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The benchmark's tree, and that a race is refused where the two sides disagree."""

from __future__ import annotations

import json

import numpy as np
import pytest
from tree_sway_lab.bench import step as bench_step
from tree_sway_lab.bench.bench_tree import bench_tree
from tree_sway_lab.example_trees import branch_order

from tree_sway.commands import cli


def test_the_tree_is_the_one_that_is_claimed() -> None:
    tree = bench_tree()
    assert (tree.n_branches, tree.n_segments) == (121, 726)
    assert np.bincount(branch_order(tree)).tolist() == [1, 12, 36, 72]
    lengths = np.array([6.0, 2.2, 0.9, 0.4])[branch_order(tree)]
    assert tree.branch_length == pytest.approx(lengths)
    assert tree.base_diameter[0] == pytest.approx(0.120)
    assert tree.tip_diameter.min() == pytest.approx(0.008)
    directions = tree.direction
    firsts = directions[tree.branch_first[:-1]].round(6)
    assert len(np.unique(firsts, axis=0)) == tree.n_branches


@pytest.mark.parametrize('segments', [3, 12])
def test_the_tree_keeps_its_shape_however_it_is_cut(segments: int) -> None:
    coarse, fine = bench_tree(segments), bench_tree(6)
    assert coarse.n_segments == 121 * segments
    assert coarse.height == pytest.approx(fine.height)
    assert coarse.volume.sum() == pytest.approx(fine.volume.sum())


@pytest.mark.parametrize('model', ['branch', 60, 'full'])
def test_a_step_is_timed(model: int | str) -> None:
    timing = bench_step.time_steps(bench_tree(), model, 1)
    assert 0.0 < timing.minimum <= timing.median


def test_the_command_prints_what_a_program_can_read(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(['lab', 'bench', 'step', '--rounds', '1', '--json']) == 0
    found = json.loads(capsys.readouterr().out)
    assert found['segments'] == 726
    assert [row['model'] for row in found['timings']] == ['branch', '60', 'full']
    assert all(row['minimum'] <= row['median'] for row in found['timings'])
