# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway plot study.csv``: the cases of a study over the wind."""

from __future__ import annotations

from pathlib import Path

import pytest

from tree_sway.commands.cli import main

pytest.importorskip('matplotlib', reason='needs matplotlib')

HEADER = 'tree_name,wind_mean [m/s],tip_largest [m],base_moment_largest [N m]\n'


def test_its_cases_are_drawn(tmp_path: Path) -> None:
    table, picture = tmp_path / 'oaks.csv', tmp_path / 'oaks.png'
    table.write_text(HEADER + 'oak,4,0.1,20\noak,8,0.3,80\nbirch,4,0.2,10\nbirch,8,0.5,40\n')
    assert main(['plot', str(table), '-o', str(picture)]) == 0
    assert picture.stat().st_size > 10_000


@pytest.mark.parametrize('row', ['oak,4,much,20', 'oak,4'])
def test_a_damaged_table_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], row: str
) -> None:
    table = tmp_path / 'oaks.csv'
    table.write_text(f'{HEADER}{row}\n')
    assert main(['plot', str(table), '-o', str(tmp_path / 'a.png')]) == 2
    assert 'oaks.csv: not the table of a study' in capsys.readouterr().err
