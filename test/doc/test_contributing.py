# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A newcomer's changes as CONTRIBUTING has them: in one file, taken up by the tests that stand."""

from __future__ import annotations

import os
from pathlib import Path
import re
import subprocess
import sys

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / 'CONTRIBUTING.md').read_text(encoding='utf-8')


def blocks_of(heading: str) -> list[str]:
    """Blocks of Python under a heading of the page."""
    section = PAGE.split(f'## {heading}\n')[1].split('\n## ')[0]
    return re.findall(r'^```py\n(.*?)^```$', section, re.MULTILINE | re.DOTALL)


def changed_copy(folder: Path, module: str, text: str) -> None:
    """Link package and tests into a folder, but for one module, which is written anew."""
    (folder / 'test').symlink_to(ROOT / 'test')
    (folder / 'pyproject.toml').symlink_to(ROOT / 'pyproject.toml')
    for source in sorted((ROOT / 'tree_sway_ros').rglob('*')):
        target = folder / source.relative_to(ROOT)
        if source.is_dir():
            target.mkdir(parents=True, exist_ok=True)
        elif source.suffix in ('.py', '.json', '.yaml', '.csv'):
            target.parent.mkdir(parents=True, exist_ok=True)
            target.symlink_to(source)
    (folder / module).unlink()
    (folder / module).write_text(text, encoding='utf-8')


@pytest.mark.parametrize(
    ('heading', 'module', 'before', 'tests', 'name', 'known'),
    [
        (
            'A new species', 'tree_sway_ros/core/tree/species.py',
            [r"^ +_species\('ash'"], 'test/core/tree/test_species.py', 'poplar',
            "from tree_sway_ros import species_named; print(species_named('poplar').title)",
        ),
        (
            'A new model of the wind', 'tree_sway_ros/core/wind/simulated/spectra.py',
            [r'^SPECTRA = ', r"^ +'kaimal': "], 'test/core/wind/simulated/test_spectra.py',
            'between',
            'from tree_sway_ros.ros.parameters.node_parameters import NODE_PARAMETERS as n;'
            "print(*next(p for p in n['anemometer'] if p.name == 'turbulence').choices)",
        ),
    ],
    ids=['species', 'wind'],
)  # fmt: skip
def test_it_is_one_change_in_one_file(
    tmp_path: Path, heading: str, module: str, before: list[str], tests: str, name: str, known: str
) -> None:
    text = (ROOT / module).read_text(encoding='utf-8')
    for place, block in zip(before, blocks_of(heading), strict=True):
        found = re.search(place, text, re.MULTILINE)
        assert found, place
        text = (
            text[: found.start()]
            + block
            + '\n\n' * block.startswith('def')
            + text[found.start() :]
        )
    text = text.replace(
        'import numpy as np\n', 'import numpy as np\nfrom scipy.special import beta\n'
    )
    changed_copy(tmp_path, module, text)
    told = os.environ | {'PYTHONPATH': str(tmp_path), 'TREE_SWAY_NO_NUMBA': '1'}
    words = ['-m', 'pytest', '-p', 'no:cacheprovider', '-p', 'no:xdist', tests]
    for arguments, wanted in ((['-c', known], name), ([*words, '-v'], f'[{name}]')):
        result = subprocess.run(
            [sys.executable, *arguments], cwd=tmp_path, env=told,
            capture_output=True, text=True, timeout=300, check=False,
        )  # fmt: skip
        assert result.returncode == 0, result.stdout + result.stderr
        assert wanted in result.stdout
