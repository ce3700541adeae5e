# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
ament's linters, where they are installed, by the rules that setup.cfg and this file name.

The code is formatted by ruff, whose quotes, slices and order of imports `ament_flake8` would have
otherwise. Of `ament_pep257` the first line of a docstring may be longer than a line (D200, D205,
D400, D415), and a noun (D401, D403); a signature may begin it (D402), and parameters may be called
`notes` (D405, D407, D410, D411, D414, D417).

"""

import importlib.util
from pathlib import Path

import pytest

from tree_sway_ros.licence_header import APACHE_BY_SPDX

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ('tree_sway_ros', 'test', 'launch', 'examples', 'setup.py', '.ci/in_venv.py')
PATHS = [str(ROOT / name) for name in FOLDERS]
LEFT_OUT = (200, 205, 400, 401, 402, 403, 405, 407, 410, 411, 414, 415, 417)


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
    ignored = [f'D{number}' for number in LEFT_OUT]
    assert main(argv=['--add-ignore', *ignored, '--', *PATHS]) == 0
