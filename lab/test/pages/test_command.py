# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tables of the pages are those of the code."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip('matplotlib', reason='matplotlib is not installed')

from tree_sway_lab.pages.command import (  # noqa: E402
    DRAWINGS,
    markdown_tables,
    PAGES,
    parameters_table,
    species_table,
    with_tables,
)

from tree_sway.commands import cli  # noqa: E402
from tree_sway.core.species.species import species_keys  # noqa: E402
from tree_sway.errors import FormatError  # noqa: E402
from tree_sway_ros.parameters import NODE_PARAMETERS  # noqa: E402
from tree_sway_ros.process import TOPICS  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
MARK = 'before\n<!-- table: {} -->\nSTALE\n<!-- end -->\nafter\n'


def test_the_pages_are_up_to_date() -> None:
    texts = [(ROOT / page).read_text(encoding='utf-8') for page in PAGES]
    for text in texts:
        assert with_tables(text) == text, 'run: tree-sway lab docs'
    assert DRAWINGS
    for name, draw in DRAWINGS.items():
        assert (ROOT / name).read_text(encoding='utf-8') == draw(), 'run: tree-sway lab docs'
    for name in markdown_tables():
        assert f'<!-- table: {name} -->' in ''.join(texts)


def test_every_species_has_a_row() -> None:
    rows = species_table().splitlines()[2:]
    assert [row.split('`')[1] for row in rows] == list(species_keys())
    assert '| 9.4 | 1010 | 0.04, 0.05 | 2.8 | 2.6575 U^-0.846 |' in next(
        row for row in rows if '`oak`' in row
    )


def test_the_table_of_a_node_has_every_parameter() -> None:
    rows = parameters_table(NODE_PARAMETERS['solver']).splitlines()
    assert len(rows) == len(NODE_PARAMETERS['solver']) + 2
    assert len({row.replace('\\|', '').count('|') for row in rows}) == 1
    assert any('| `rate` | `60.0` | Hz | 2 .. 1000 |' in row for row in rows)


def test_the_table_of_topics_has_every_one() -> None:
    text = markdown_tables()['topics']
    assert len(TOPICS) > 5
    assert all(f'`{topic.name}`' in text for topic in TOPICS)


def test_a_table_is_replaced_and_the_rest_kept() -> None:
    text = with_tables(MARK.format('solver'))
    assert text.startswith('before\n<!-- table: solver -->\n| parameter |')
    assert text.endswith('|\n<!-- end -->\nafter\n')
    assert 'STALE' not in text
    assert with_tables(text) == text
    for parameter in NODE_PARAMETERS['solver']:
        assert f'| `{parameter.name}` |' in text


def test_an_unknown_table_is_named() -> None:
    with pytest.raises(
        FormatError, match="no table is called 'sovler'; name one of: commands, topics"
    ):
        with_tables(MARK.format('sovler'))


def test_check_changes_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / 'x.md'
    path.write_text(MARK.format('wind'))
    assert cli.main(['lab', 'docs', str(path), '--check']) == 2
    assert 'not up to date; run tree-sway lab docs' in capsys.readouterr().err
    assert path.read_text() == MARK.format('wind')
    assert cli.main(['lab', 'docs', str(path)]) == 0
    assert cli.main(['lab', 'docs', str(path), '--check']) == 0
