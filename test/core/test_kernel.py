# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How hot functions are compiled: numpy's division, the plain function kept."""

from __future__ import annotations

import gc
import threading

import numpy as np
import pytest

from tree_sway.core.kernel import entry_of, fused, kernel


@kernel
def ratio(a, b):
    return a / b


@pytest.mark.compiled
@pytest.mark.parametrize('compiled', [ratio, fused(ratio.py_func)])
def test_division_by_zero_is_infinite_as_in_numpy(compiled):
    assert compiled(1.0, 0.0) == np.inf
    assert np.isnan(compiled(0.0, 0.0))


def test_plain_functions_stay_reachable():
    with pytest.raises(ZeroDivisionError):
        ratio.py_func(1.0, 0.0)
    assert ratio(6.0, 3.0) == ratio.py_func(6.0, 3.0) == 2.0


@pytest.mark.compiled
def test_threads_that_compile_at_once_leave_the_collector_as_it_was():
    before, first_is_in = gc.get_threshold(), threading.Event()
    seconds_turn = threading.Event()

    class SlowKernel:
        """Two calls that overlap if nothing keeps them apart, the first to end first."""

        def get_overload(self, types):
            return ratio

        def compile(self, types):
            if threading.current_thread().name == 'first':
                first_is_in.set()
                seconds_turn.wait(0.5)
            else:
                seconds_turn.set()
                threads[0].join(0.5)

    slow = SlowKernel()
    threads = [
        threading.Thread(target=entry_of, args=(slow, 1.0), name=name)
        for name in ('first', 'second')
    ]
    threads[0].start()
    assert first_is_in.wait(10.0)
    threads[1].start()
    for thread in threads:
        thread.join(10.0)
    after = gc.get_threshold()
    gc.set_threshold(*before)
    assert after == before
