# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The report: what it prints, writes and returns."""

from __future__ import annotations

import json

import pytest
from tree_sway_lab.battery.report import CASES, load_case, run_battery
from tree_sway_lab.battery.row import fails, holds

from tree_sway.commands import cli
from tree_sway.errors import ParameterError


def test_rows_know_whether_they_are_good():
    assert holds('a', 'b', 'c', True).good
    assert not holds('a', 'b', 'c', False).good
    assert fails('a', 'b', 'c', True).verdict == 'failure reproduced'
    assert not fails('a', 'b', 'c', False).good


def test_all_cases_are_there():
    assert list(CASES) == [*(f'T{k}' for k in range(1, 19)), 'goals']
    assert all(load_case(name).TITLE for name in CASES)


def test_the_report_in_terminal_and_json(tmp_path, capsys):
    file = tmp_path / 'battery.json'
    assert run_battery(json=file, only=['T5', 'T14']) == 0
    printed = capsys.readouterr().out
    assert 'failure reproduced' in printed
    assert '4 of 4 rows as they should be' in printed
    document = json.loads(file.read_text())
    assert [case['case'] for case in document['cases']] == ['T5', 'T14']
    assert [row['good'] for case in document['cases'] for row in case['rows']] == [True] * 4


def test_a_row_that_fails_gives_exit_code_one(monkeypatch):
    monkeypatch.setattr(load_case('T5'), 'run', lambda full: [holds('x', 'y', 'z', False)])
    assert run_battery(only=['T5']) == 1


def test_a_case_without_rows_has_shown_nothing(monkeypatch):
    monkeypatch.setattr(load_case('T5'), 'run', lambda full: [])
    assert run_battery(only=['T5']) == 1


def test_no_report_is_written_over_in_silence(tmp_path, capsys):
    file = tmp_path / 'battery.json'
    file.write_text('{}')
    assert cli.main(['lab', 'battery', 'T5', '--json', str(file)]) == 2
    assert 'exists' in capsys.readouterr().err
    assert cli.main(['lab', 'battery', 'T5', '--json', str(file), '--force']) == 0
    assert 'T5' in file.read_text()


@pytest.mark.parametrize('name', ['T4', 'T04', 't4'])
def test_a_case_is_found_with_or_without_a_zero(name):
    assert load_case(name) is load_case('T4')


def test_an_unknown_case_is_named():
    with pytest.raises(ParameterError, match="unknown case 'T19'"):
        run_battery(only=['T19'])
