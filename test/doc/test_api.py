# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The page of the library: every public name, from the docstring where it lives."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
import re
import subprocess
import sys

import pytest

import tree_sway

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / 'doc' / 'api.md').read_text(encoding='utf-8')
ENTRIES = re.findall(r'^\.\. auto(\w+):: (\S+)$', PAGE, re.MULTILINE)


def test_no_public_name_is_missing() -> None:
    documented = {entry for _, entry in ENTRIES}
    names = {*tree_sway.__all__} - {'__version__', 'TreeSwayError'}
    wanted = {f'{getattr(tree_sway, name).__module__}.{name}' for name in names - {'Simulator'}}
    assert wanted - documented == set()
    assert ('module', 'tree_sway.errors') in ENTRIES


@pytest.mark.parametrize(('kind', 'entry'), ENTRIES)
def test_every_entry_is_there_and_says_what_it_is(kind: str, entry: str) -> None:
    if kind == 'module':
        assert import_module(entry).__doc__
        return
    module, name = entry.rsplit('.', 1)
    found = getattr(import_module(module), name)
    if kind != 'data':
        assert found.__module__ == module
        assert found.__doc__.strip()


@pytest.mark.long
def test_the_pages_build_without_a_warning(tmp_path: Path) -> None:
    pytest.importorskip('sphinx', reason='needs sphinx')
    pytest.importorskip('myst_parser', reason='needs myst-parser')
    words = ['-W', '--keep-going', '-q', '-b', 'html', '-d', str(tmp_path / 'd'), 'doc']
    result = subprocess.run(
        [sys.executable, '-m', 'sphinx', *words, str(tmp_path / 'html')],
        cwd=ROOT, capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    assert result.returncode == 0, result.stderr
    page = (tmp_path / 'html' / 'api.html').read_text(encoding='utf-8')
    missing = [
        entry for kind, entry in ENTRIES if kind != 'module' and f'id="{entry}"' not in page
    ]
    assert not missing
