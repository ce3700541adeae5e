# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The ring of samples: compiled and plain agree, and its memory is bounded."""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.observe.sample_ring import empty_ring, keep_sample, KEPT, read_samples

DT = 1.0 / 60.0
ALL = np.ones(9, dtype=np.bool_)


def test_compiled_and_plain_keep_and_read_the_same() -> None:
    plain_keep: Any = keep_sample
    plain_read: Any = read_samples
    rng = np.random.default_rng(3)
    times = np.cumsum(rng.uniform(-0.004, 0.03, 600))
    times[200:210] += 3.0  # a jump of the clock, and back
    times[400:] += 2.0  # a gap
    values = np.round(rng.normal(0.0, 12.0, (600, 9)), 0)
    values[300:310] = 16.0  # stuck at a limit
    values[50, 4] = np.nan
    rings = empty_ring(), empty_ring()
    found = np.zeros((2, 9))
    outcomes = set()
    for time, sample in zip(times.tolist(), values, strict=True):
        outcome = keep_sample(rings[0], time, sample, ALL)
        assert outcome == plain_keep.py_func(rings[1], time, sample, ALL)
        outcomes.add(outcome)
        is_read = read_samples(rings[0], time - 0.02, DT, found[0])
        assert is_read == plain_read.py_func(rings[1], time - 0.02, DT, found[1])
        np.testing.assert_allclose(found[0], found[1], rtol=1e-12, atol=1e-15)
    assert outcomes == {0, 1, 3, 4, 5}


def test_the_oldest_samples_make_room() -> None:
    ring, found = empty_ring(), np.zeros(9)
    count = ring['time'].shape[1] + 100
    for k in range(count):
        assert keep_sample(ring, float(k), np.full(9, k % 7, dtype=float), ALL) == KEPT
    assert not read_samples(ring, 99.0, DT, found)
    assert read_samples(ring, float(count - 1), DT, found)
    np.testing.assert_array_equal(found, (count - 1) % 7)
