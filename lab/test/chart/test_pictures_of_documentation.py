# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The charts of the documentation show the figures beside them, and these are what is measured."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from tree_sway_lab.battery.work_precision import measure
from tree_sway_lab.chart.fidelity import KINDS, points_of

from tree_sway.pictures.plotting import digest_of

PICTURES = Path(__file__).resolve().parents[3] / 'doc' / 'pictures'
CURE = 'run: tree-sway lab chart all -o doc/pictures, and tree-sway lab docs'


def rows(name: str) -> list[dict[str, str]]:
    with (PICTURES / f'{name}.csv').open(encoding='utf-8', newline='') as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize('name', ['fidelity', 'cost', 'methods'])
def test_a_picture_is_of_the_figures_beside_it(name: str) -> None:
    pil = pytest.importorskip('PIL.Image', reason='needs pillow')
    with pil.open(PICTURES / f'{name}.png') as picture:
        assert picture.text['Description'] == digest_of(PICTURES / f'{name}.csv'), CURE


@pytest.mark.long
@pytest.mark.parametrize(
    ('kind', 'models'),
    [(KINDS[0], ('20', 'full', 'branch')), *((each, ('60',)) for each in KINDS)],
)
def test_the_errors_of_the_models_are_those_of_the_code(
    kind: str, models: tuple[str, ...]
) -> None:
    figures = {
        row['model']: (float(row['error']), float(row['roughness']))
        for row in rows('fidelity')
        if row['tree'] == kind and row['model'] in models
    }
    assert set(figures) == set(models)
    for point in points_of(kind, models):
        drawn = figures[point.model]
        assert (point.error, point.roughness) == pytest.approx(drawn, rel=0.01), CURE


@pytest.mark.long
def test_the_errors_and_operations_of_the_methods_are_those_of_the_code() -> None:
    names = ('exact_foh', 'exact_zoh', 'semi_implicit_euler')
    found = {(p.method, p.system, p.wind): p for p in measure(rates=(60,), methods=names)}
    recorded = [row for row in rows('methods') if row['method'] in names and row['rate'] == '60']
    assert {row['method'] for row in recorded} == set(names)
    for row in recorded:
        point = found[row['method'], row['system'], row['wind']]
        error = np.nan if row['error'] == 'gone' else float(row['error'])
        assert point.error == pytest.approx(error, rel=0.01, nan_ok=True), CURE
        assert point.flops == int(row['flops']), CURE
