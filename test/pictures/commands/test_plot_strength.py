# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway plot --strength``: the share of its strength that a tree uses over wind speed."""

from __future__ import annotations

import json
import math
from pathlib import Path
import re

import pytest

from tree_sway.commands.cli import main

pytest.importorskip('matplotlib', reason='needs matplotlib')
pytestmark = pytest.mark.usefixtures('short_storms')


def test_a_curve_is_drawn_and_printed(tmp_path, capsys):
    picture = tmp_path / 'strength.svg'
    tree = 'test/files/data/fork.simpleforest.csv'
    options = ['--strength', '--species', 'oak', '--model', '6', '--speed', '12']
    assert main(['plot', tree, *options, '-o', str(picture)]) == 0
    drawn = picture.read_text(encoding='utf-8')
    assert '<!-- fork.simpleforest, in the open, wind at 2.3 m -->' in drawn
    text = capsys.readouterr().out
    shares = [float(share) for share in re.findall(r'wood ([\d.e+-]+) %', text)]
    assert len(shares) == 6
    assert shares == sorted(shares)
    assert shares[0] > 0.0


def test_what_is_unknown_is_said_in_the_picture(tmp_path):
    picture = tmp_path / 'strength.svg'
    tree = ['benjamina', '--model', '6', '--speed', '12']  # in a pot
    assert main(['plot', *tree, '--strength', '-o', str(picture)]) == 0
    text = picture.read_text(encoding='utf-8')
    assert text.count(': unknown -->') == 1
    assert text.count('<!-- of 80 % of such trees -->') == 1


def test_a_picture_of_a_stand_says_where_the_tree_stands_and_leaves_no_neighbour_out(tmp_path):
    picture = tmp_path / 'strength.svg'
    tree = ['test/files/data/fork.simpleforest.csv', '--model', '6', '--speed', '12']
    words = ['plot', *tree, '--strength', '--exposure', 'stand', '-o', str(picture)]
    assert main(words) == 0
    text = picture.read_text(encoding='utf-8')
    assert 'in a stand, trees 0.41 m apart, wind at 2.3 m -->' in text
    assert 'neighbours' not in text


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
    said = facts['notes'][-1]
    assert 'in the open; mean wind 2.3 m above the ground, of 12 m/s: strength used' in said
    assert 'not included' in facts['notes'][-1]
    assert main([*tree, '--speed', '-3']) == 2


def test_a_pole_that_has_less_than_the_published_moment_is_not_called_sheltered(tmp_path, capsys):
    pole = tmp_path / 'pole.yaml'
    stem = '{name: stem, nodes: [[0, 0, 0, 0.2], [0, 0, 8, 0.1]]}'
    pole.write_text(f'name: pole\nspecies: spruce\nbranches:\n  - {stem}\n')
    assert main(['info', str(pole), '--speed', '10', '--leaves', 'off']) == 0
    said = capsys.readouterr().out
    assert 'outside that band: one of the two is wrong for this tree' in said


@pytest.mark.parametrize('anemometer', [10.0, 20.0, 40.0])
def test_the_published_moment_is_of_the_wind_at_the_top(tmp_path, capsys, anemometer):
    """Hale et al. (2012): 111.7 d^2 h U^2."""
    pole = tmp_path / 'pole.yaml'
    stem = '{name: stem, nodes: [[0, 0, 0, 0.3], [0, 0, 20, 0.3]]}'
    pole.write_text(f'name: pole\nspecies: spruce\nbranches:\n  - {stem}\n')
    words = ['info', str(pole), '--speed', '10', '--anemometer-height', str(anemometer), '--json']
    assert main(words) == 0
    at_top = 10.0 * math.log(20.0 / 0.03) / math.log(anemometer / 0.03)
    published = json.loads(capsys.readouterr().out)['published_moment']
    assert published == pytest.approx(111.7 * 0.3**2 * 20.0 * at_top**2)


def figures(capsys, *command):
    """Return the printed figures of wood, with their seasons."""
    assert main([str(word) for word in command]) == 0
    return re.findall(r'wood ([\d.e+-]+) %.*?; (in leaf|bare)', capsys.readouterr().out)


def test_one_tree_in_one_season_has_one_figure_in_all_commands(tmp_path, capsys):
    tree = ['test/files/data/fork.simpleforest.csv', '--species', 'oak']
    info = figures(capsys, 'info', *tree, '--speed', '12')
    curve = figures(capsys, 'plot', *tree, '--strength', '--speed', '12', '-o', tmp_path / 'a.png')
    table = tmp_path / 'sway.csv'
    gusts = ['--speed', '12', '--seconds', '60', '--rate', '30']
    record = figures(capsys, 'simulate', *tree, *gusts, '-o', table)
    assert info == record == [curve[-1]]
    assert info[0][1] == 'bare'
    picture = tmp_path / 'b.png'
    leafy = ['--leaves', 'on', '--speed', '12']
    curve = figures(capsys, 'plot', *tree, '--strength', *leafy, '-o', picture)
    assert figures(capsys, 'info', *tree, *leafy) == [curve[-1]]
    assert curve[-1][1] == 'in leaf'
    assert curve[-1] != info[0]


def test_a_turned_tree_has_the_same_figure_named_by_the_tallest_of_its_kind(tmp_path, capsys):
    found = []
    for each in (0.0, 0.7):
        stand = tmp_path / f'{each}.csv'
        stand.write_text(
            f'name,x,y,species,height,yaw\nlow,0,0,oak,5,{each}\nhigh,9,0,oak,5.2,{each}\n'
        )
        assert main(['info', str(stand), '--speed', '12']) == 0
        said = capsys.readouterr().out
        assert 'note       high: in the open; mean wind' in said
        found += re.findall(r'wood [^;]*; roots [^;]*; bare', said)
    assert len(found) == 2
    assert found[0] == found[1]


STAND = """\
name,x,y,species,height,dbh
low,0,0,oak,8,20
high,9,0,oak,9,24
"""


def test_each_tree_of_an_inventory_is_grown_by_itself_if_asked(tmp_path, capsys):
    stand = tmp_path / 'stand.csv'
    stand.write_text(STAND)
    command = ['info', stand, '--count', '1', '--json']
    assert main([str(word) for word in command]) == 0
    assert len(json.loads(capsys.readouterr().out)['kinds']) == 1
    assert main([*map(str, command), '--exact']) == 0
    found = json.loads(capsys.readouterr().out)
    heights = [kind['height'] for kind in found['kinds']]
    stems = [kind['breast_height_diameter'] for kind in found['kinds']]
    assert heights == pytest.approx([8.0, 9.0], rel=1e-6)
    assert stems == pytest.approx([0.20, 0.24], rel=1e-3)
    assert found['trees'][1]['height'] == pytest.approx(9.0, rel=1e-6)


@pytest.mark.parametrize(
    ('words', 'said'),
    [
        (['info', '--spacing', '3'], '--spacing: it would change nothing'),
        (['info', '--speed', '9', '--spacing', '3'], 'in a street have no spacing'),
        (['info', '--anemometer-height', '20'], '--anemometer-height: it would change nothing'),
        (['plot', '--exposure', 'edge', '-o', 'x.png'], '--exposure: it would change nothing'),
        (['simulate', '--spacing', '3', '-o', 'x.csv'], 'in a street have no spacing'),
    ],
)
def test_an_exposure_that_would_change_nothing_is_refused(words, said, tmp_path, capsys):
    command, *options = words
    if '-o' in options:
        options[-1] = str(tmp_path / options[-1])
    assert main([command, 'test/files/data/fork.simpleforest.csv', *options]) == 2
    assert said in capsys.readouterr().err
