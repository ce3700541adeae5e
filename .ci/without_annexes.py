#!/usr/bin/env python3
# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Run the suite of the core in a copy of this checkout from which every annex is deleted.

    python3 .ci/in_venv.py python .ci/without_annexes.py [arguments of pytest]

What passes without all of them passes without each. An annex that is installed beside is not
found there either. Coverage of the core is that of this run.
"""

import os
from pathlib import Path
import shutil
import subprocess
import sys
import tempfile

ROOT = Path(__file__).resolve().parent.parent
ANNEXES = (
    'fidelity', 'identification', 'twin', 'simulation', 'files', 'live', 'stream', 'page',
    'forest', 'pictures', 'commands',
)  # fmt: skip
NOT_FOUND = ('tree_sway_ros', 'tree_sway_lab', *(f'tree_sway.{name}' for name in ANNEXES))
"""Modules that an installation beside would offer all the same."""

#: What the suite reads beside its own folders: sources and pages that it compares with the code.
COPIED = (
    'conftest.py', 'pyproject.toml', 'native', 'doc/sway_model.md', 'examples/native', 'tree_sway',
    'test/core', 'test/growth', 'test/kit', 'test/golden/pyconturb',
)  # fmt: skip
NOT_THERE = """import sys
sys.modules.update(dict.fromkeys({names!r}))
"""


def copy_to(folder):
    """Copy what remains of the checkout without its annexes."""
    left_out = shutil.ignore_patterns('__pycache__', '*.pyc')
    for name in COPIED:
        source, copy = ROOT / name, folder / name
        copy.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, copy, ignore=left_out)
        else:
            shutil.copy2(source, copy)
    for name in ANNEXES:
        shutil.rmtree(folder / 'tree_sway' / name)
    # Python runs it at its start, in workers and in programs that tests start as well.
    text = NOT_THERE.format(names=NOT_FOUND)
    (folder / 'sitecustomize.py').write_text(text, encoding='utf-8')


def main(arguments):
    """Run pytest there, and return its exit status."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / 'core'
        copy_to(folder)
        environment = {**os.environ, 'PYTHONPATH': str(folder)}
        command = [sys.executable, '-m', 'pytest', 'test/core', 'test/growth', *arguments]
        return subprocess.run(command, cwd=folder, env=environment).returncode


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
