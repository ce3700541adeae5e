# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A kernel that several processes need at once is compiled by one of them."""

from __future__ import annotations

from pathlib import Path
import subprocess
import sys
import threading

import pytest

from tree_sway.cache import kernel_claim
from tree_sway.cache.kernel_claim import KernelClaim

pytestmark = pytest.mark.skipif(sys.platform == 'win32', reason='there are no such locks')

SMALL = """
from tree_sway.cache.kernel_cache import KernelCache
from tree_sway.core.kernel import kernel


@kernel
def one_more(number):
    return number + 1


@kernel
def two_more(number):
    return one_more(one_more(number))


save, saved = KernelCache.save_overload, []
KernelCache.save_overload = lambda self, *given: (saved.append(self._name), save(self, *given))
two_more(1)
print(*saved)
"""
"""Prints the names of the kernels that this process compiled."""


def test_a_second_process_waits_for_the_first(tmp_path: Path) -> None:
    first, made = KernelClaim(tmp_path / 'one.kernel'), []
    other = threading.Thread(target=lambda: made.append(KernelClaim(tmp_path / 'one.kernel')))
    other.start()
    KernelClaim(tmp_path / 'two.kernel').release()  # of other kernels nobody waits
    other.join(timeout=0.1)
    assert other.is_alive()
    first.release()
    other.join(timeout=20.0)
    assert not other.is_alive()
    made[0].release()
    assert not list(tmp_path.iterdir())


def test_a_process_that_is_killed_holds_up_nobody(tmp_path: Path) -> None:
    program = (
        'import sys; from pathlib import Path\n'
        'from tree_sway.cache.kernel_claim import KernelClaim\n'
        'claim = KernelClaim(Path(sys.argv[1])); print("claimed", flush=True); sys.stdin.read()\n'
    )
    command = [sys.executable, '-c', program, str(tmp_path / 'one.kernel')]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        assert process.stdout.readline() == b'claimed\n'
        process.kill()
    KernelClaim(tmp_path / 'one.kernel').release()


def test_a_claim_that_never_ends_is_waited_for_no_longer_than_allowed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(kernel_claim, 'LONGEST_WAIT', 0.05)
    first = KernelClaim(tmp_path / 'one.kernel')
    KernelClaim(tmp_path / 'one.kernel').release()
    first.release()
    KernelClaim(tmp_path / 'no folder' / 'one.kernel').release()


def test_processes_that_start_at_once_compile_each_kernel_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip('numba', reason='there is nothing to compile without numba')
    kernels = tmp_path / 'kernels'
    monkeypatch.setenv('TREE_SWAY_CACHE', str(kernels))
    program = tmp_path / 'small.py'
    program.write_text(SMALL, encoding='utf-8')
    command = [sys.executable, program]
    processes = [
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for _ in range(2)
    ]
    compiled: list[str] = []
    for process in processes:
        printed, said = process.communicate(timeout=120.0)
        assert process.returncode == 0, said
        compiled += printed.split()
    assert sorted(compiled) == ['__main__.one_more', '__main__.two_more']
    assert len(list(kernels.iterdir())) == 2
