# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Compiled kernels on disk: keyed by all they are made from, and never a reason to fail."""

from __future__ import annotations

from importlib import import_module
import os
from pathlib import Path
import shutil
import subprocess
import sys

import pytest

from tree_sway.cache.kernel_cache import KernelCache, ROOT, source_digest

pytest.importorskip('numba', reason='there is no cache of kernels without numba')

#: Prints what a kernel makes of the function of another file that it calls.
PROGRAM = """
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.tree.building import tree_from_segments
stem = tree_from_segments([[0.0, 0.0, 0.0]], [[0.0, 0.0, 1.0]], [0.02], species='oak')
sim = make_simulator(stem, model='branch', cache=None)
sim.step((5.0, 0.0, 0.0), 0.02)
print(sim.banks[0].oscillators.forces()[0, 0])
"""


@pytest.fixture(scope='module')
def copy(tmp_path_factory):
    """Copy the package, to be edited, and return a function that runs the program on it."""
    tmp_path = tmp_path_factory.mktemp('copy')
    shutil.copytree(ROOT, tmp_path / 'tree_sway', ignore=shutil.ignore_patterns('__pycache__'))

    def run(cache: Path | str) -> tuple[float, str]:
        environment = {**os.environ, 'PYTHONPATH': str(tmp_path), 'TREE_SWAY_CACHE': str(cache)}
        done = subprocess.run(
            [sys.executable, '-c', PROGRAM],
            env=environment, capture_output=True, text=True, check=True, cwd=tmp_path,
        )  # fmt: skip
        return float(done.stdout), done.stderr

    run.package = tmp_path / 'tree_sway'
    return run


@pytest.fixture(scope='module')
def compiled(copy, tmp_path_factory):
    """Compile all that the program needs once; return the folder, the result and what was said."""
    cache = tmp_path_factory.mktemp('kernels')
    return cache, *copy(cache)


@pytest.mark.long
def test_an_edited_callee_is_run_by_callers_in_other_files(copy, compiled):
    cache, before, _ = compiled
    assert copy(cache)[0] == before, 'compiled and cached runs give the same bits'
    assert list(cache.glob('*.kernel'))
    path = copy.package / 'core' / 'model' / 'drag_law.py'
    text = path.read_text(encoding='utf-8')
    assert '    return f * nx,' in text
    path.write_text(text.replace('return f * nx,', 'return 2.0 * f * nx,'), encoding='utf-8')
    try:
        assert copy(cache)[0] == pytest.approx(2.0 * before, rel=1e-6)
    finally:
        path.write_text(text, encoding='utf-8')


@pytest.mark.long
def test_damaged_kernels_are_compiled_again(copy, compiled, tmp_path):
    cache, before, said = compiled
    assert not said
    cache = Path(shutil.copytree(cache, tmp_path / 'kernels'))
    for path in cache.glob('*.kernel'):
        path.write_bytes(path.read_bytes()[:100])
    after, said = copy(cache)
    assert after == before
    assert said.count('\n') <= 2
    assert 'cannot be read' in said


def test_a_folder_that_cannot_be_written_is_passed_by(copy, tmp_path):
    (tmp_path / 'file').write_text('no folder')
    value, said = copy(tmp_path / 'file' / 'kernels')
    assert value > 0.0
    assert 'Traceback' not in said


def test_the_digest_follows_what_is_in_a_folder(tmp_path):
    assert source_digest(ROOT / 'nowhere') == ''
    (tmp_path / 'inside').mkdir()
    digests = set()
    for name, text in (('a.py', '1'), ('a.py', '2'), ('inside/b.py', '2'), ('c.csv', 'x,y')):
        (tmp_path / name).write_text(text)
        source_digest.cache_clear()
        digests.add(source_digest(tmp_path))
    assert len(digests) == 4
    (tmp_path / 'notes.txt').write_text('of no effect')
    source_digest.cache_clear()
    assert source_digest(tmp_path) in digests


def test_a_kernel_of_another_package_follows_all_of_that(tmp_path, monkeypatch):
    package = tmp_path / 'orchard'
    (package / 'methods').mkdir(parents=True)
    for folder in (package, package / 'methods'):
        (folder / '__init__.py').touch()
    (package / 'methods' / 'caller.py').write_text('def one():\n    return 1\n')
    monkeypatch.syspath_prepend(tmp_path)
    keys = []
    for text in ('one = 1\n', 'one = 2\n'):
        (package / 'callee.py').write_text(text)
        source_digest.cache_clear()
        keys.append(KernelCache(import_module('orchard.methods.caller').one, '')._key)
    assert keys[0] != keys[1]
