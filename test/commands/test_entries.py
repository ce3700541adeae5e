# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Commands and what is added to them come from entry points; what is taken away is gone."""

from __future__ import annotations

from importlib.metadata import EntryPoint
from pathlib import Path
import re
import sys

import pytest

from tree_sway.commands import cli, entries
from tree_sway.commands.entries import additions, commands_called, other_groups, own_commands
from tree_sway.errors import MissingDependencyError

GONE = EntryPoint('roots', 'tree_sway.roots.commands:COMMANDS', entries.GROUP)
ROOT = Path(__file__).resolve().parents[2]


def test_every_table_of_commands_in_the_source_is_found() -> None:
    """Of an installation that is older than the source, some are not: then install it again."""
    tables = [*ROOT.glob('tree_sway/*/commands/commands.csv')]
    tables += ROOT.glob('tree_sway_ros/commands/commands.csv')
    names = {line.partition(',')[0] for each in tables for line in each.read_text().splitlines()}
    commands, missing = own_commands()
    assert {*commands} == names - {'name'}
    assert not missing
    places = [each.place for each in commands.values()]
    assert places == sorted(set(places))


def test_a_house_that_is_taken_away_takes_its_commands_along(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    kept = [each for each in entries._own() if each.name != 'growth']
    monkeypatch.setattr(entries, '_own', lambda: [*kept, GONE])
    with pytest.raises(SystemExit):
        cli.main(['--help'])
    assert ' convert ' in (listed := capsys.readouterr().out)
    assert ' grow ' not in listed
    assert cli.main(['grow', 'oak']) == 2
    assert capsys.readouterr().err == (
        'tree-sway grow: the commands of roots are missing; the installation is incomplete: '
        'install tree_sway_ros again\n'
    )


def test_without_an_installation_the_cure_is_said(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(entries, '_own', list)
    assert cli.main(['info', 'goldcrest']) == 2
    assert 'install tree_sway_ros again' in capsys.readouterr().err
    assert cli.main([]) == 2


def test_what_a_house_lacks_itself_is_a_fault_and_not_hidden(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / 'house_of_a_test.py').write_text('import tree_sway.roots')
    monkeypatch.syspath_prepend(tmp_path)
    point = EntryPoint('own', 'house_of_a_test:COMMANDS', entries.GROUP)
    monkeypatch.setattr(entries, '_own', lambda: [point])
    with pytest.raises(MissingDependencyError, match=r"'own' .* cannot be loaded .*roots"):
        own_commands()


@pytest.mark.parametrize(
    ('body', 'why'),
    [
        ('import nothing_of_this_name', 'ModuleNotFoundError: .*nothing_of_this_name'),
        ('import tree_sway.growth as COMMANDS; COMMANDS.no_such', 'AttributeError: .*no_such'),
        ('COMMANDS = ', 'SyntaxError: '),
    ],
)
def test_commands_of_another_package_that_cannot_be_loaded_are_named(
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    body: str,
    why: str,
) -> None:
    (tmp_path / 'house_of_a_guest.py').write_text(body)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, 'house_of_a_guest', raising=False)
    point = EntryPoint('guest', 'house_of_a_guest:COMMANDS', entries.GROUP)
    monkeypatch.setattr(entries, 'entry_points', lambda group: [point])
    assert cli.main(['guest', 'dance']) == 2
    said = capsys.readouterr().err
    assert said.count('\n') == 1
    assert re.search(f"'guest' of its package cannot be loaded \\({why}.*; install .* again", said)


def test_a_table_of_another_package_is_called_by_its_name(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    other = EntryPoint('other', 'tree_sway.growth.commands:COMMANDS', entries.GROUP)
    monkeypatch.setattr(entries, 'entry_points', lambda group: [*entries._own(), other])
    assert [*(commands_called('other') or ())] == ['grow']
    assert commands_called('growth') is None
    assert other_groups() == ['other']


def test_additions_come_in_the_order_of_their_names(monkeypatch: pytest.MonkeyPatch) -> None:
    points = [
        EntryPoint('wind', 'tree_sway.errors:shown', 'tree_sway.fly'),
        EntryPoint('roots', 'tree_sway.roots:Roots', 'tree_sway.fly'),
        EntryPoint('air', 'tree_sway.errors:nearest', 'tree_sway.fly'),
    ]
    monkeypatch.setattr(entries, 'entry_points', lambda group: points)
    assert [each.__name__ for each in additions('fly')] == ['nearest', 'shown']
