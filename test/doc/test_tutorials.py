# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tutorials as a new user types them: in a clone, in the environment of its first command.

The tests' own environment has every part of the package, and cannot show that a tutorial lacks
one. Each block marked ``sh`` or ``python`` is run in the order of its page, and of one marked
``bash`` the pages that it shows, for a moment and in no browser. The clone has only what is
committed.

"""

from __future__ import annotations

from importlib.util import find_spec
import os
from pathlib import Path
import re
import runpy
import subprocess
from types import SimpleNamespace

import pytest

pages = SimpleNamespace(**runpy.run_path(str(Path(__file__).with_name('test_pages.py'))))
ROOT = pages.ROOT
TUTORIALS = [
    page for page in pages.PAGES
    if page.parent.name == 'tutorials' and pages.blocks(page, 'sh', 'python')
]  # fmt: skip
SHOWN = re.compile(r'^(tree-sway show .*?)(?: --open)?$', re.MULTILINE)
"""A page of a ``bash`` block, which a user ends by Ctrl-C."""
FIRST = 'python3 .ci/in_venv.py tree-sway --version'
"""Makes the environment as the README's first command does, without its page."""
ACTIVATE = 'source .venv/bin/activate\n'
DEADLINE = 600.0
NOT_OF_A_NEW_USER = (
    'TREE_SWAY_VENV', 'TREE_SWAY_UV', 'VIRTUAL_ENV', 'PYTHONPATH', 'AMENT_PREFIX_PATH',
)  # fmt: skip

pytestmark = [pytest.mark.long, pytest.mark.ros, pytest.mark.xdist_group('tutorials')]


@pytest.fixture(scope='module')
def clone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Clone the repository and make its environment, once for all tutorials."""
    if find_spec('ensurepip') is None:
        pytest.skip('this Python cannot make environments')
    folder = tmp_path_factory.mktemp('new') / 'tree_sway_ros'
    subprocess.run(['git', 'clone', '-q', str(ROOT), str(folder)], check=True)
    typed(FIRST, folder, dict(os.environ))
    return folder


def typed(text: str, folder: Path, environment: dict[str, str]) -> str:
    """Type lines into a shell that ends at the first error; return what is printed."""
    own = {key: each for key, each in environment.items() if key not in NOT_OF_A_NEW_USER}
    ended = subprocess.run(
        ['bash', '-euc', text], cwd=folder, env=own, capture_output=True, text=True,
        timeout=DEADLINE,
    )  # fmt: skip
    assert ended.returncode == 0, f'{text}\n{ended.stdout}\n{ended.stderr}'
    return ended.stdout + ended.stderr


@pytest.mark.parametrize('page', TUTORIALS, ids=lambda page: page.stem)
def test_it_runs_as_typed(page: Path, clone: Path, ros_environment: dict[str, str]) -> None:
    for language, text in pages.blocks(page, 'sh', 'python', 'bash'):
        if language == 'bash':
            for line in SHOWN.findall(text):
                seen = typed(f'{ACTIVATE}{line} --seconds 1', clone, ros_environment)
                assert 'http://127.0.0.1:' in seen
            continue
        lines = f"python3 - <<'END_OF_PAGE'\n{text}END_OF_PAGE\n" if language == 'python' else text
        printed = typed(f'{ACTIVATE}{lines}', clone, ros_environment)
        assert printed or language == 'sh'
        for suffix in ('png', 'gif', 'csv'):
            for written in re.findall(rf'-o (\S+\.{suffix})\b', text):
                assert (clone / written).stat().st_size > 100
