# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway plot --strength``: the share of its strength that a tree uses over wind speed."""

from __future__ import annotations

import re

import pytest

from tree_sway.commands.cli import main

pytest.importorskip('matplotlib', reason='needs matplotlib')


def test_a_curve_is_drawn_and_told(tmp_path, capsys):
    picture = tmp_path / 'strength.png'
    tree = 'test/files/data/fork.simpleforest.csv'
    options = ['--strength', '--species', 'oak', '--model', '6', '--speed', '12']
    assert main(['plot', tree, *options, '-o', str(picture)]) == 0
    assert picture.stat().st_size > 10_000
    told = capsys.readouterr().out
    shares = [float(share) for share in re.findall(r'wood ([\d.e+-]+) %', told)]
    assert len(shares) == 6
    assert shares == sorted(shares)
    assert shares[0] > 0.0


def test_a_stand_is_refused(capsys):
    assert main(['plot', 'config/stand.yaml', '--strength', '-o', 'a.png']) == 2
    assert '--strength: 1000 trees; give 12 or fewer' in capsys.readouterr().err
