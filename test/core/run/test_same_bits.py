# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The same poses bit for bit in every process: compiling or not, on one thread or on two."""

from __future__ import annotations

import os
import subprocess
import sys
import threading

import pytest

from tree_sway.core.setup.threads import _switches, one_thread

#: Prints a digest of the poses of each model; the tree has enough branches for threads to matter.
PROGRAM = """
import hashlib
import numpy as np
from tree_sway.growth.builtin import builtin_tree
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.make import make_simulator
tree = builtin_tree("benjamina")
for model in ("branch", 20):
    sim, digest = make_simulator(tree, model=model), hashlib.blake2b(digest_size=8)
    for wind in np.random.default_rng(1).normal(4.0, 2.0, (100, 3)):
        sim.step(wind, 1.0 / 60.0)
        digest.update(sim.place().tobytes())
    print(model, digest.hexdigest())
"""


def digests(threads, **environment):
    done = subprocess.run(
        [sys.executable, '-c', PROGRAM],
        env={**os.environ, 'OPENBLAS_NUM_THREADS': str(threads), **environment},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    return done.stdout


@pytest.mark.long
def test_two_processes_give_the_same_bits_on_any_number_of_threads():
    first = digests(2)
    assert first.count('\n') == 2
    assert digests(1) == first


def test_what_is_within_runs_on_one_thread_and_the_number_comes_back():
    if not _switches():
        pytest.skip('numpy and scipy are linked with another BLAS')
    before = [get() for _, get in _switches()]
    with one_thread():
        assert [get() for _, get in _switches()] == [1] * len(before)
    assert [get() for _, get in _switches()] == before
    with pytest.raises(ZeroDivisionError), one_thread():
        raise ZeroDivisionError
    assert [get() for _, get in _switches()] == before


def test_blocks_that_overlap_all_run_on_one_thread_and_the_number_comes_back():
    if not _switches():
        pytest.skip('numpy and scipy are linked with another BLAS')
    given = [get() for _, get in _switches()]
    for put, _ in _switches():
        put(2)
    seen, is_open, may_end = [], threading.Event(), threading.Event()

    def first():
        with one_thread():
            is_open.set()
            may_end.wait(10.0)

    thread = threading.Thread(target=first)
    thread.start()
    try:
        assert is_open.wait(10.0)
        with one_thread():
            may_end.set()
            thread.join(10.0)
            assert not thread.is_alive()
            seen = [get() for _, get in _switches()]
        after = [get() for _, get in _switches()]
    finally:
        for (put, _), count in zip(_switches(), given, strict=True):
            put(count)
    assert seen == [1] * len(given)
    assert after == [2] * len(given)
