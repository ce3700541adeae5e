# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Units and the axis up of a file that does not say them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import ParameterError, TreeError
from tree_sway.files.trees.source import open_tree

DATA = Path(__file__).parents[1] / 'data'
HEADER = 'segment,parent,x0,y0,z0,x1,y1,z1,d0,d1'


def table(tmp_path: Path, length: float, diameter: float, up: str = 'z') -> Path:
    """Make a stem of 6 m and a twig, as a file in these units has them."""
    rows = [HEADER]
    for start, end, d, parent in (
        ((0.0, 0.0, 0.0), (0.0, 0.0, 3.0), 0.12, -1),
        ((0.0, 0.0, 3.0), (0.0, 0.1, 6.0), 0.09, 0),
        ((0.0, 0.0, 3.0), (0.5, 0.0, 3.5), 0.01, 0),
    ):
        nodes = [(x, z, -y) if up == 'y' else (x, y, z) for x, y, z in (start, end)]
        cells = [len(rows) - 1.0, parent, *(length * c for node in nodes for c in node)]
        cells += [diameter * d, diameter * d]
        rows.append(','.join(f'{cell:g}' for cell in cells))
    path = tmp_path / 'tree.csv'
    path.write_text('\n'.join(rows) + '\n', encoding='utf-8')
    return path


@pytest.mark.parametrize(
    ('length', 'diameter', 'up', 'options'),
    [
        (100.0, 1.0, 'z', {'length_unit': 0.01}),
        (1.0, 1000.0, 'z', {'diameter_unit': 0.001}),
        (1000.0, 1000.0, 'z', {'length_unit': 0.001, 'diameter_unit': 0.001}),
        (1.0, 1.0, 'y', {'up': 'y'}),
    ],
)
def test_the_option_that_the_error_names_mends_it(tmp_path, length, diameter, up, options):
    path = table(tmp_path, length, diameter, up)
    if up == 'z':
        with pytest.raises(TreeError) as refused:
            open_tree(path)
        for name in options:
            assert f'--option {name}=' in refused.value.cure
    else:
        assert any('--option up=y' in oddity for oddity in open_tree(path).warnings)
    mended, meant = open_tree(path, **options), open_tree(table(tmp_path, 1.0, 1.0))
    np.testing.assert_allclose(mended.tree.end, meant.tree.end, atol=1e-12)
    np.testing.assert_allclose(mended.tree.base_diameter, meant.tree.base_diameter)
    assert mended.warnings == meant.warnings == ()


def test_units_that_cannot_be_are_refused(tmp_path):
    with pytest.raises(ParameterError, match=r'length_unit: 0\.0 is out .* \(0\.01 is 1 cm\)'):
        open_tree(table(tmp_path, 1.0, 1.0), length_unit=0.0)
    with pytest.raises(ParameterError, match="unknown up 'x'; use one of: z, y"):
        open_tree(table(tmp_path, 1.0, 1.0), up='x')


def test_cylinders_are_scaled_before_anything_is_done_to_them():
    file, chosen = DATA / 'forest.treefile.txt', {'tree': 1, 'twig_diameter': 0.0}
    plain = open_tree(file, **chosen)
    scaled = open_tree(file, length_unit=0.5, diameter_unit=0.5, **chosen)
    np.testing.assert_allclose(scaled.tree.end, 0.5 * plain.tree.end, atol=1e-12)
    np.testing.assert_allclose(scaled.tree.tip_diameter, 0.5 * plain.tree.tip_diameter)
    np.testing.assert_allclose(scaled.origin, 0.5 * np.array(plain.origin))


def test_a_twig_of_three_metres_is_refused():
    with pytest.raises(ParameterError, match=r'twig_diameter: 3\.0 is out .*; use 0 to 0\.1 m'):
        open_tree(DATA / 'forest.treefile.txt', tree=1, twig_diameter=3.0)


def test_what_a_scan_could_not_see_is_grown_on_request_and_said():
    scan = Path(__file__).parents[3] / 'examples' / 'data' / 'forest_tree.treeqsm.txt'
    found = open_tree(scan, beyond_scan='grow')
    assert found.tree.n_branches > open_tree(scan).tree.n_branches
    assert any('is grown beyond it' in note for note in found.notes)
    with pytest.raises(ParameterError, match='beyond_scan'):
        open_tree(scan, beyond_scan='all')


def test_that_nothing_is_grown_is_said_too():
    whole = open_tree(DATA / 'seedling.yaml', beyond_scan='grow')
    assert any('give the diameter of its twigs' in note for note in whole.notes)
    whole = open_tree(DATA / 'seedling.yaml', beyond_scan='grow', twig_diameter=0.003)
    assert any('no end is thicker than two twigs of 3 mm' in note for note in whole.notes)
