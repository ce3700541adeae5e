# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The charts of the documentation show the figures beside them, and these are what is measured."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from tree_sway_ros.core.fidelity.frame_cost import frame_cost
from tree_sway_ros.core.reference.measure import frame_means
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.study.battery.work_precision import measure
from tree_sway_ros.study.chart.fidelity import climb, EXAMPLE_WOOD, FRAME, simulated_wind
from tree_sway_ros.study.example_trees import forked_tree, RATIOS
from tree_sway_ros.view.plotting import digest_of

PICTURES = Path(__file__).resolve().parents[3] / 'doc' / 'pictures'
CURE = 'run: tree-sway chart all -o doc/pictures, and tree-sway docs'


def rows(name: str) -> list[dict[str, str]]:
    with (PICTURES / f'{name}.csv').open(encoding='utf-8', newline='') as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize('name', ['fidelity', 'cost', 'methods'])
def test_a_picture_is_of_the_figures_beside_it(name: str) -> None:
    pil = pytest.importorskip('PIL.Image', reason='needs pillow')
    with pil.open(PICTURES / f'{name}.png') as picture:
        assert picture.text['Description'] == digest_of(PICTURES / f'{name}.csv'), CURE


def test_the_errors_of_the_models_are_those_of_the_code() -> None:
    tree = forked_tree(*RATIOS[2])
    told = {r['model']: float(r['error']) for r in rows('fidelity') if r['tree'] == tree.name}
    time, velocity = simulated_wind(20.0, seed=1)
    measured = climb(tree, frame_means(time, velocity, FRAME)[:1200], 9.81)
    assert {p.model: p.error for p in measured} == pytest.approx(told, rel=0.01), CURE


@pytest.mark.long
def test_the_errors_and_operations_of_the_methods_are_those_of_the_code() -> None:
    names = ('exact_foh', 'exact_zoh', 'semi_implicit_euler')
    found = {(p.method, p.system, p.wind): p for p in measure(rates=(60,), methods=names)}
    told = [row for row in rows('methods') if row['method'] in names and row['rate'] == '60']
    assert {row['method'] for row in told} == set(names)
    for row in told:
        point = found[row['method'], row['system'], row['wind']]
        error = np.nan if row['error'] == 'gone' else float(row['error'])
        assert point.error == pytest.approx(error, rel=0.01, nan_ok=True), CURE
        assert point.flops == int(row['flops']), CURE


def test_the_costs_are_those_that_the_choice_of_a_model_counts_with() -> None:
    tree = forked_tree(*RATIOS[1], segments=12)
    size = [r for r in rows('cost') if (r['n_branches'], r['segments_a_branch']) == ('40', '12')]
    of = {row['model']: row for row in size}
    for name in ('branch', 'subtree', 'modes'):
        model = SwaySimulator(tree, EXAMPLE_WOOD, model=name, twig_tolerance=-1.0)
        told = (float(of[name]['step']) + float(of[name]['place'])) / 1e3
        assert 1 / 3 < told / frame_cost(model.bank, tree) < 3, CURE
