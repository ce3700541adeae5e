# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Poses of the built-in trees are those that were recorded, within rounding, on any machine."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).resolve().parent
WITHIN = 1e-7
"""[m] Another processor's BLAS has moved a pose of goldcrest by 9e-9 m after 10 s."""
MAKER = importlib.util.spec_from_file_location('make_golden', FOLDER / 'make_golden.py')


@pytest.fixture(scope='module')
def maker():
    module = importlib.util.module_from_spec(MAKER)
    MAKER.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ('tree_name', 'model'),
    [
        *((name, model) for name in ('goldcrest', 'broadleaf') for model in ('branch', 12)),
        pytest.param('goldcrest', 'full', marks=pytest.mark.long),
        pytest.param('broadleaf', 'full', marks=pytest.mark.long),
    ],
)
def test_ten_seconds_of_wind_end_where_they_did(maker, tree_name, model):
    golden = np.load(FOLDER / 'golden.npz')[f'{tree_name}_{model}']
    _, found = maker.run(tree_name, model, seconds=10)
    assert len(found) == 1
    assert np.abs(found[0] - golden[0]).max() < WITHIN
