# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The pages, as written: commands run, Python runs, links lead somewhere.

A block marked ``sh`` or ``python`` is run where the repository's folders are, in the order of the
page; of a block marked ``bash`` or ``py``, which needs a machine that a test has not, the commands
are read.

"""

from __future__ import annotations

import argparse
from collections.abc import Callable
import os
from pathlib import Path
import re
import shlex
import subprocess
import sys

import pytest

from tree_sway.commands import cli
from tree_sway_ros.parameters import ANNEXES

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / 'README.md', ROOT / 'CONTRIBUTING.md', *sorted((ROOT / 'doc').rglob('*.md'))]
BLOCK = re.compile(r'^```(\w+)\n(.*?)^```$', re.MULTILINE | re.DOTALL)
LINK = re.compile(r'(?<!`)\[[^\]\n]+\]\(([^)\s]+)\)')
#: A path of the repository or of the package.
NAMED = re.compile(
    r'`((?:test|lab|tree_sway|tree_sway_ros|config|doc|core|files|ros|nodes|launch|examples|\.ci)/[\w./-]*\w/?)`'
)
SHELL = 'set -eu; tree-sway() { "$PYTHON" -m tree_sway "$@"; }\n'
FOLDERS = ('config', 'doc', 'examples', 'launch', 'test')
DEADLINE = 300.0


def name(page: Path) -> str:
    """Path of a page in the repository."""
    return str(page.relative_to(ROOT))


def blocks(page: Path, *languages: str) -> list[tuple[str, str]]:
    """Language and text of the blocks of a page."""
    found = BLOCK.findall(page.read_text(encoding='utf-8'))
    return [(language, text) for language, text in found if language in languages]


LONG = ('calibration', 'integrate', 'tree_as_a_file', 'trees')
"""Pages whose commands take longer; `.ci/run` runs them, too."""


def runnable() -> list[object]:
    """Pages with something to run."""
    own = ROOT / 'doc' / 'tutorials'  # run as typed in a fresh environment (test_tutorials.py)
    found = [page for page in PAGES if page.parent != own and blocks(page, 'sh', 'python')]
    return [
        pytest.param(page, id=name(page), marks=[pytest.mark.long] if page.stem in LONG else [])
        for page in found
    ]


@pytest.mark.parametrize('page', runnable())
def test_it_runs_as_written(
    page: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    request: pytest.FixtureRequest,
) -> None:
    for folder in FOLDERS:
        if (ROOT / folder).is_dir():
            (tmp_path / folder).symlink_to(ROOT / folder)
    monkeypatch.chdir(tmp_path)
    environment = {'PYTHON': sys.executable}
    paths = os.pathsep.join([str(ROOT), os.environ.get('PYTHONPATH', '')])
    for language, text in blocks(page, 'sh', 'python'):
        if language == 'python':
            exec(compile(text, name(page), 'exec'), {'__name__': '__page__'})
            assert capsys.readouterr().out
            continue
        if 'tree-sway demo' in text:
            environment |= request.getfixturevalue('ros_environment')
        result = subprocess.run(
            ['bash', '-c', SHELL + text],
            env=os.environ | environment | {'PYTHONPATH': paths},
            capture_output=True,
            text=True,
            timeout=DEADLINE,
            check=False,
        )
        assert result.returncode == 0, f'{text}\n{result.stderr}'


def commands() -> list[tuple[str, str]]:
    """Every command line of ours in a shell block of a page, with the page."""
    lines = []
    for page in PAGES:
        for _, text in blocks(page, 'sh', 'bash'):
            for line in text.splitlines():
                before, found, words = line.partition('tree-sway ')
                is_question = words.startswith('--')  # of the version or the help
                if found and not is_question and before.strip() in ('', 'python3 .ci/in_venv.py'):
                    lines.append((name(page), words.split(' # ')[0].split(' | ')[0].strip()))
    return lines


@pytest.mark.parametrize(('page', 'line'), commands())
def test_its_commands_are_commands(page: str, line: str, installed: Callable[..., None]) -> None:
    words = shlex.split(line)
    if words[0].isupper():
        pytest.fail(f"{page}: no command in '{line}'")
    if '--help' not in words:
        installed(*words)
        table, group = cli._table(words[0])
        words = words[bool(group) :]
        assert cli._parser(words[0], table, group).parse_args(words).command == words[0]


@pytest.mark.parametrize('page', PAGES, ids=name)
def test_its_commands_can_be_typed_as_they_stand(page: Path) -> None:
    lines = [line for _, text in blocks(page, 'sh', 'bash') for line in text.splitlines()]
    assert [line for line in lines if re.search(r'<[A-Za-z][\w ./-]*>', line)] == []


def test_the_first_picture_leads_to_the_file_that_a_release_has() -> None:
    text = (ROOT / 'README.md').read_text(encoding='utf-8')
    asset = re.search(r'^\[!\[.*\]\(../../releases/latest/download/(\S+)\)$', text, re.MULTILINE)
    assert asset is not None
    writes = f'tree-sway convert broadleaf -o {asset[1]}'
    release = (ROOT / '.github' / 'workflows' / 'release.yml').read_text(encoding='utf-8')
    assert f'- run: {writes}\n' in release
    assert re.search(rf'gh release create .* {asset[1]} ', release)
    assert f'python3 .ci/in_venv.py {writes}`' in text
    words = shlex.split(writes)[1:]
    assert cli._parser('convert', cli._table('')[0], '').parse_args(words).output == asset[1]


@pytest.mark.parametrize('page', PAGES, ids=name)
def test_its_links_lead_somewhere(page: Path) -> None:
    text = re.sub(r'^```.*?^```$', '', page.read_text(encoding='utf-8'), flags=re.M | re.S)
    for link in LINK.findall(text):
        path, _, heading = link.partition('#')
        if '://' in link or link.startswith('../../releases/'):
            continue
        target = (page.parent / path) if path else page
        assert target.exists(), f'{link} in {name(page)}'
        if heading:
            headings = re.findall(r'^#+ (.*)$', target.read_text(encoding='utf-8'), re.MULTILINE)
            slugs = {re.sub(r'[^\w -]', '', h).strip().lower().replace(' ', '-') for h in headings}
            assert heading in slugs, f'{link} in {name(page)}'


LAUNCHED = re.compile(r'sway\.launch\.py(.*)|launch_arguments=\{(.*?)\}')


@pytest.mark.parametrize('page', [p for p in PAGES if LAUNCHED.search(p.read_text())], ids=name)
def test_its_launch_arguments_are_arguments(page: Path) -> None:
    declared = (ROOT / 'launch' / 'sway.launch.py').read_text(encoding='utf-8')
    known = set(re.findall(r"^    \(\s*'(\w+)',\s*'", declared, re.MULTILINE))
    of_parameters = declared.partition('OF_PARAMETERS = {')[2].partition('\n}')[0]
    known |= set(re.findall(r"^    '(\w+)': \(", of_parameters, re.MULTILINE))
    known |= {each.name for table in ANNEXES.values() for each in table}
    assert {'tree', 'pose', 'imu'} <= known
    for typed, included in LAUNCHED.findall(page.read_text(encoding='utf-8')):
        given = {*re.findall(r'(\w+):=', typed), *re.findall(r'"(\w+)":', included)}
        assert given <= known, typed or included


def test_files_that_the_pages_name_are_there() -> None:
    named = [(page, path) for page in PAGES for path in NAMED.findall(page.read_text('utf-8'))]
    assert len(named) > 40
    roots = (ROOT, ROOT / 'tree_sway')
    assert not [each for each in named if not any((root / each[1]).exists() for root in roots)]


def test_every_page_is_in_the_index_and_every_claim_in_the_validation() -> None:
    doc = ROOT / 'doc'
    index, claims = ((doc / each).read_text('utf-8') for each in ('index.md', 'validation.md'))
    missing = [
        name(page) for page in PAGES[2:]
        if str(page.relative_to(doc)) not in (claims if doc / 'proof' in page.parents else index)
    ]  # fmt: skip
    assert missing in ([], ['doc/index.md'])


SPAN = re.compile(r'`tree-sway ([a-z][^`]*)`')


@pytest.mark.parametrize('page', [p for p in PAGES if SPAN.search(p.read_text('utf-8'))], ids=name)
def test_no_sentence_names_a_command_or_an_option_that_is_not_there(
    page: Path, installed: Callable[..., None]
) -> None:
    for span in SPAN.findall(page.read_text(encoding='utf-8')):
        words = shlex.split(span)
        table, group = cli._table(words[0])
        words = words[bool(group) :]
        if not words:
            continue
        installed(*shlex.split(span))
        assert words[0] in table, span
        parser = argparse.ArgumentParser()
        cli._module(table[words[0]]).add_arguments(parser)
        known = {'--quiet', *parser._option_string_actions}
        assert {word.split('=')[0] for word in words if word.startswith('--')} <= known, span
