# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Figures of benchmarks: printed, saved, and compared with an earlier file."""

from __future__ import annotations

import json

import pytest
from tree_sway_lab.bench.listener import stamp_of
from tree_sway_lab.bench.measured import as_json, Measured, read_baseline, table
from tree_sway_lab.bench.sizes import time_sizes
from tree_sway_lab.bench.stand import time_stand

from tree_sway.commands import cli
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.scene.scene_simulator import SceneSimulator
from tree_sway.core.settings import Settings
from tree_sway.errors import FormatError

ROWS = [Measured('solve', 2.0, 'ms'), Measured('place', 3.0, 'ms'), Measured('lost', 0.0, '-')]


def test_figures_are_read_back_and_reported_as_ratios(tmp_path):
    stored = tmp_path / 'stored.json'
    stored.write_text(as_json([Measured('solve', 4.0, 'ms'), ROWS[2]]), encoding='utf-8')
    solve, place, lost = table(ROWS, read_baseline(stored)).splitlines()
    assert '0.50 of the baseline' in solve
    assert 'baseline' not in place + lost


@pytest.mark.parametrize('text', ['', '{}', '[]', '{"measured": [{"name": "a"}]}', '\x00'])
def test_a_file_without_figures_is_no_baseline(tmp_path, text):
    stored = tmp_path / 'stored.json'
    stored.write_text(text, encoding='utf-8')
    with pytest.raises(FormatError):
        read_baseline(stored)


def test_a_stand_is_timed(stem):
    tree = stem()
    trees = [PlacedTree(f't{i}', tree, x=3.0 * i) for i in range(5)]
    rows = time_stand(lambda: SceneSimulator(Scene(trees), Settings()), frames=3)
    assert rows[0].name == 'solve 5 trees, 30 segments'
    assert {'set-up, CPU'} <= {row.name for row in rows}
    assert all(row.value > 0.0 for row in rows)
    assert rows[2].value == pytest.approx(rows[0].value + rows[1].value)


def test_sizes_are_timed(stem, fork):
    rows = {row.name: row.value for row in time_sizes([stem(), fork()])}
    assert rows['native step, 4 branches'] > 0.0
    assert rows['native step, most over least'] >= 1.0


def test_the_stamp_of_a_message_is_read_from_its_bytes():
    assert stamp_of(b'\0\1\0\0' + (7).to_bytes(4, 'little') + (9).to_bytes(4, 'little')) == (
        7_000_000_009
    )


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        (['stand', '--size', '0'], '--size: 0'),
        (['stream', '--seconds', 'nan'], '--seconds: nan'),
        (['stand', '--tree', 'benjamina'], 'no stand'),
        (['sizes', '--tree', 'benjamin'], 'benjamina'),
        (['sizes', '--baseline', 'nowhere.json'], 'nowhere.json'),
    ],
)
def test_bad_arguments_are_refused(capsys, arguments, message):
    assert cli.main(['lab', 'bench', *arguments]) == 2
    assert message in capsys.readouterr().err


def test_figures_are_reported_as_json_and_drawn(tmp_path, monkeypatch, capsys):
    pytest.importorskip('matplotlib')
    from tree_sway_lab.bench import command

    monkeypatch.setitem(command._FIGURES, 'stand', lambda arguments: ROWS)
    chart = tmp_path / 'chart.png'
    assert cli.main(['lab', 'bench', 'stand', '--json', '--chart', str(chart)]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert [row['value'] for row in printed['measured']] == [2.0, 3.0, 0.0]
    assert chart.stat().st_size > 1000
