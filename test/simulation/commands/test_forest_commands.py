# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Commands that take a forest as they take a tree, and options of readers."""

from __future__ import annotations

from collections.abc import Callable
import json
from pathlib import Path
import time
from typing import Any

import pytest

from tree_sway.commands import cli
from tree_sway.files.trees.source import open_scene
from tree_sway.simulation.commands import info
from tree_sway.simulation.commands.mode_table import mode_table

SEEDLING = Path(__file__).parents[2] / 'files' / 'data' / 'seedling.yaml'
SEGMENTS = SEEDLING.with_name('segments.csv')
SCAN = SEEDLING.parent / 'fork.treeqsm23.txt'


@pytest.fixture
def forest(tmp_path: Path) -> str:
    path = tmp_path / 'glade.yaml'
    path.write_text(
        f'trees:\n- {{name: a, tree: {SEEDLING}, leaf_on: true}}\n- {{name: b, tree: {SEEDLING}, '
        f'x: 3, species: birch}}\n'
    )
    return str(path)


def test_info_sums_up(forest: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(['info', forest, '--json']) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts['segments'] == sum(tree['segments'] for tree in facts['trees']) == 12
    assert facts['mass'] == pytest.approx(sum(tree['mass'] for tree in facts['trees']))
    assert [tree['in_leaf'] for tree in facts['trees']] == [True, False]
    assert [tree['species'] for tree in facts['trees']] == ['oak', 'birch']
    assert facts['trees'][1]['place'] == {'x': 3.0, 'y': 0.0, 'z': 0.0, 'yaw': 0.0}
    assert cli.main(['info', forest]) == 0
    text = capsys.readouterr().out
    assert '2 trees of 2 kinds, 8 branches, 12 segments' in text
    assert text.count(' Hz') == 2


def test_a_thousand_trees_of_one_kind_are_worked_out_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = ''.join(f'{3 * i},0,fig,{0.4 + 0.001 * i}\n' for i in range(1000))
    (tmp_path / 'plot.csv').write_text(f'x,y,species,height\n{rows}')
    kinds = f'kinds:\n  - {{species: fig, tree: {SEEDLING}}}\n'
    (tmp_path / 'hall.yaml').write_text(f'stand: plot.csv\n{kinds}')
    asked, counted = [], []

    def table(*given: Any) -> Any:
        asked.append(given)
        return mode_table(*given)

    def bar(items: Any, what: str) -> Any:
        counted.append((len(items), what))
        return items

    monkeypatch.setattr(info, 'mode_table', table)
    monkeypatch.setattr(info, 'bar', bar)
    began = time.monotonic()
    assert cli.main(['info', str(tmp_path / 'hall.yaml'), '--json']) == 0
    assert time.monotonic() - began < 10.0
    assert len(asked) == 1
    assert counted == [(1, 'computing the modes')]
    facts = json.loads(capsys.readouterr().out)
    assert len(facts['trees']) == 1000
    slow, fast = facts['trees'][-1], facts['trees'][0]
    assert slow['height'] == pytest.approx(1.399)
    assert slow['frequencies'][0] < fast['frequencies'][0]


@pytest.mark.parametrize(
    'arguments', [['--portrait', '{}'], ['{}', '--seconds', '1', '--model', 'branch']]
)
def test_plot_draws_it(
    forest: str, tmp_path: Path, arguments: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip('matplotlib')
    monkeypatch.setattr('tree_sway.pictures.commands.plot._SETTLING', 2.0)
    picture = tmp_path / 'glade.png'
    glade = Path(forest)
    glade.write_text(glade.read_text().replace(str(SEEDLING), str(SEGMENTS)))
    arguments = [each.format(forest) for each in arguments]
    assert cli.main(['plot', *arguments, '--leaves', '-o', str(picture)]) == 0
    assert picture.stat().st_size > 5000


def test_convert_names_objects_as_the_description(forest: str, tmp_path: Path) -> None:
    out = tmp_path / 'glade.glb'
    assert cli.main(['convert', forest, '-o', str(out)]) == 0
    size = int.from_bytes(out.read_bytes()[12:16], 'little')
    document = json.loads(out.read_bytes()[20 : 20 + size])
    names = [document['nodes'][joint]['name'] for joint in document['skins'][0]['joints']]
    assert names == list(open_scene(forest).tree.segment_names)


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        (['convert', '{}', '-o', 'x.yaml'], 'a forest as the YAML of one tree'),
        (['info', '{}', '--modulus', '1e9'], 'modulus or density for a whole forest'),
        (['info', '{}', '--option', 'twig_diameter=1'], "option 'twig_diameter' for a forest"),
        (['lab', 'compare', '{}'], 'a forest, where one tree is expected'),
        (['info', str(SCAN), '--option', 'up'], 'write NAME=VALUE'),
        (
            ['info', str(SCAN), '--option', 'twig_diameter=x'],
            "twig_diameter: 'x' is not a number; use 0 to 0.1 m",
        ),
        (['info', str(SCAN), '--option', 'tapper=true'], "no option 'tapper'; it has: "),
        (['info', 'benjamina', '--option', 'up=z'], "option 'up' for a built-in tree"),
    ],
)
def test_what_cannot_be_says_why(
    forest: str, arguments: list[str], message: str, capsys: pytest.CaptureFixture[str],
    installed: Callable[..., None],
) -> None:  # fmt: skip
    installed(*arguments)
    assert cli.main([each.format(forest) for each in arguments]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count('\n') == 1


def test_twigs_of_a_scan_are_made_thin(capsys: pytest.CaptureFixture[str]) -> None:
    volumes = []
    for options in (['twig_diameter=0'],
                    ['twig_diameter=0.001', 'species=oak', 'trusted_diameter=0.2']):  # fmt: skip
        given = [word for option in options for word in ('--option', option)]
        assert cli.main(['info', str(SCAN), '--json', *given]) == 0
        facts = json.loads(capsys.readouterr().out)
        volumes.append(facts['volume'])
    assert facts['species'] == 'oak'
    assert any('are made 1 mm thick' in note for note in facts['notes'])
    assert volumes[1] < volumes[0]
