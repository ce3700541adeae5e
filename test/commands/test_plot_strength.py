# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway plot --strength``: the share of its strength that a tree uses over wind speed."""

from __future__ import annotations

import json
from pathlib import Path
import re

import pytest

from tree_sway.commands.cli import main

pytest.importorskip('matplotlib', reason='needs matplotlib')


def test_a_curve_is_drawn_and_printed(tmp_path, capsys):
    picture = tmp_path / 'strength.png'
    tree = 'test/files/data/fork.simpleforest.csv'
    options = ['--strength', '--species', 'oak', '--model', '6', '--speed', '12']
    assert main(['plot', tree, *options, '-o', str(picture)]) == 0
    assert picture.stat().st_size > 10_000
    text = capsys.readouterr().out
    shares = [float(share) for share in re.findall(r'wood ([\d.e+-]+) %', text)]
    assert len(shares) == 6
    assert shares == sorted(shares)
    assert shares[0] > 0.0


def test_a_stand_has_a_curve_of_each_kind(tmp_path, capsys):
    stand = tmp_path / 'stand.yaml'
    fork = Path('test/files/data/fork.simpleforest.csv').resolve()
    kinds = ''.join(f'  - {{species: {each}, tree: {fork}}}\n' for each in ('oak', 'ash'))
    stand.write_text(f'stand: trees.csv\nkinds:\n{kinds}')
    rows = ('low,0,0,oak,4', 'high,9,0,oak,5', 'other,0,9,ash,4')
    (tmp_path / 'trees.csv').write_text('\n'.join(['name,x,y,species,height', *rows]))
    options = ['--strength', '--model', '6', '--speed', '12', '-o', str(tmp_path / 'a.png')]
    assert main(['plot', str(stand), *options]) == 0
    said = capsys.readouterr().out
    assert [said.count(f'{name} in ') for name in ('low', 'high', 'other')] == [0, 6, 6]


def test_info_says_the_share_and_where_if_a_speed_is_given(capsys):
    tree = ['info', 'test/files/data/fork.simpleforest.csv', '--species', 'oak', '--json']
    assert main(tree) == 0
    assert json.loads(capsys.readouterr().out)['strength'] is None
    assert main([*tree, '--speed', '12']) == 0
    facts = json.loads(capsys.readouterr().out)
    share, least, most = facts['strength']['wood']
    assert 0.0 < least < share < most
    assert len(facts['strength']['roots']) == 3
    assert facts['strength']['branch'] in {mode['branch'] for mode in facts['modes']}
    assert 'in gusts of a mean wind of 12 m/s, strength used: wood' in facts['notes'][-1]
    assert 'not included' in facts['notes'][-1]
    assert main([*tree, '--speed', '-3']) == 2
