# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""ament's linters, where they are installed, by their own rules but for E203 (setup.cfg)."""

import importlib.util
from pathlib import Path

import pytest

from tree_sway_ros.licence_header import APACHE_BY_SPDX

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = (
    'tree_sway',
    'tree_sway_ros',
    'lab',
    'test',
    'launch',
    'examples',
    'setup.py',
    '.ci/in_venv.py',
)
PATHS = [str(ROOT / name) for name in (*FOLDERS, 'setup.py', '.ci/in_venv.py')]


def test_the_header_is_that_of_this_file():
    (header,) = APACHE_BY_SPDX.file_headers
    own = Path(__file__).read_text(encoding='utf-8').splitlines()[1].lstrip('# ')
    assert header.split('\n')[1] == own


def linter(name):
    if importlib.util.find_spec(name) is None:
        pytest.skip(f'{name} is not installed')
    return importlib.import_module(f'{name}.main').main


def test_ament_copyright():
    main = linter('ament_copyright')
    from ament_copyright import get_licenses

    if APACHE_BY_SPDX not in get_licenses().values():
        pytest.skip('this package is not installed, so ament_copyright does not know its header')
    assert main(argv=[*PATHS, str(ROOT / 'CONTRIBUTING.md'), str(ROOT / 'LICENSE')]) == 0


def test_ament_flake8():
    main = linter('ament_flake8')
    assert main(argv=['--config', str(ROOT / 'setup.cfg'), *PATHS]) == 0


def test_ament_pep257():
    main = linter('ament_pep257')
    assert main(argv=PATHS) == 0
