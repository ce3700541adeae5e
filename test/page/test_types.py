# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The page's modules under the TypeScript compiler, where npm can bring it."""

from __future__ import annotations

import os
from pathlib import Path
import shutil
import subprocess

import pytest

HERE = Path(__file__).parent


def compiled(*files: str) -> subprocess.CompletedProcess[str]:
    """Run the compiler, from npm's store if it is there."""
    npx = shutil.which('npx')
    if npx is None:
        pytest.skip('npx is not installed here')
    command = [npx, '--yes', '-p', 'typescript', 'tsc', *files]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, check=False, timeout=180,
            env={**os.environ, 'npm_config_update_notifier': 'false'},
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        pytest.skip('npm does not answer')
    if 'npm ERR!' in done.stderr or 'npm error' in done.stderr:
        pytest.skip('npm cannot bring the compiler here')
    return done


def test_the_modules_keep_their_types() -> None:
    done = compiled('-p', str(HERE / 'jsconfig.json'))
    assert done.returncode == 0, done.stdout


def test_the_compiler_sees_what_is_wrong(tmp_path: Path) -> None:
    wrong = tmp_path / 'wrong.js'
    wrong.write_text('/** @type {number} */\nexport const x = "text";\n', encoding='utf-8')
    done = compiled('--checkJs', '--allowJs', '--noEmit', '--strict', str(wrong))
    assert 'TS2322' in done.stdout
