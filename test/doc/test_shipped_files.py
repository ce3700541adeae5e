# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every file that a user starts from passes the checks of what reads it, notes in it included."""

from __future__ import annotations

from collections.abc import Iterator
import json
from pathlib import Path
import re
import runpy
from types import SimpleNamespace

import pytest
import yaml

from tree_sway import open_scene
from tree_sway.core.settings import model_of, Settings
from tree_sway.forest.plan import read_study

HERE = Path(__file__).parent
pages = SimpleNamespace(**runpy.run_path(str(HERE / 'test_pages.py')))
ROOT: Path = pages.ROOT
NODES = ('anemometer', 'player', 'sensor', 'solver', 'viewer', 'wind')
SCENES = ('forest', 'stand')
WRITTEN = re.compile(r"cat > (\S+) <<'?END'?\n(.*?)^END$", re.MULTILINE | re.DOTALL)
TYPED = re.compile(
    r'(?:--model[ =]|\bmodel(?:: |:=|=|\\?": ?|\': ?))(?:\\?["\'])?([\w.-]+)',
)
"""A model where a user would type one, in a shell, a launch file, YAML or Python."""
CODE = re.compile(r'^```\w*\n.*?^```$|`[^`\n]+`', re.MULTILINE | re.DOTALL)
EXAMPLE = re.compile(r'^ *(?:>>>|\.\.\.) .*$', re.MULTILINE)


def to_copy() -> Iterator[str]:
    """Yield what a user copies: code in pages and docstrings, whole files and examples."""
    for page in pages.PAGES:
        yield from CODE.findall(page.read_text(encoding='utf-8'))
    kinds = ('.yaml', '.py', '.ipynb', '.js', '.html', '.json')
    for folder in ('config', 'examples', 'launch'):
        for path in sorted((ROOT / folder).rglob('*')):
            if path.suffix in kinds and 'node_modules' not in path.parts:
                yield path.read_text(encoding='utf-8')
    for path in sorted((ROOT / 'tree_sway').rglob('*.py')):
        yield from EXAMPLE.findall(path.read_text(encoding='utf-8'))
    yield (HERE / 'test_on_a_machine.py').read_text(encoding='utf-8')


def with_its_notes(text: str) -> str:
    """Uncomment what is offered in the file of a node: ``# rate: 4.0``."""
    return re.sub(r'^(\s+)# (\w+: )', r'\1\2', text.replace('{}', ''), flags=re.MULTILINE)


@pytest.mark.parametrize('name', NODES)
def test_what_the_file_of_a_node_offers_is_taken_by_the_node(name: str) -> None:
    from tree_sway_ros.parameters.node_parameters import NODE_PARAMETERS

    table = {each.name: each for each in NODE_PARAMETERS[name]}
    text = with_its_notes((ROOT / 'config' / f'{name}.yaml').read_text(encoding='utf-8'))
    offered = yaml.safe_load(text)[f'/**/{name}']['ros__parameters']
    assert offered
    for key, value in offered.items():
        table[key].checked(value)


def test_every_file_of_config_is_tried() -> None:
    tried = {f'{name}.yaml' for name in (*NODES, *SCENES)}
    assert {path.name for path in (ROOT / 'config').glob('*.yaml')} == tried


@pytest.mark.parametrize('name', SCENES)
def test_a_scene_can_be_opened(name: str) -> None:
    assert len(open_scene(ROOT / 'config' / f'{name}.yaml').trees) >= 3


@pytest.mark.parametrize(
    'path', sorted((ROOT / 'config' / 'examples').glob('*.yaml')), ids=lambda path: path.name
)
def test_a_study_has_cases_that_can_be_computed(path: Path) -> None:
    for settings in {json.dumps(case.settings) for case in read_study(path)}:
        Settings(**json.loads(settings))


@pytest.mark.parametrize('page', [*pages.PAGES, HERE / 'test_on_a_machine.py'], ids=pages.name)
def test_so_has_a_study_that_a_page_writes(page: Path, tmp_path: Path) -> None:
    for name, text in WRITTEN.findall(page.read_text(encoding='utf-8')):
        if 'winds:' in text:
            path = tmp_path / name
            path.write_text(text, encoding='utf-8')
            assert read_study(path)


def test_every_model_that_is_written_somewhere_exists() -> None:
    found = [word for text in to_copy() for word in TYPED.findall(text)]
    assert len(found) > 5
    for word in found:
        model_of(word)
