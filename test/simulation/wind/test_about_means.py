# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Turbulence about means of days: bounded memory, and no seam where blocks meet."""

from __future__ import annotations

import tracemalloc

import numpy as np

from tree_sway.simulation.wind import about_means
from tree_sway.simulation.wind.about_means import turbulence_about_means


def test_weeks_of_means_take_little_more_memory_than_the_result() -> None:
    time = 3600.0 * np.arange(24 * 5)
    mean = np.tile([8.0, 0.0, 0.0], (len(time), 1))
    tracemalloc.start()
    fine, wind = turbulence_about_means(time, mean, None, np.random.default_rng(0))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 4.0 * (fine.nbytes + wind.nbytes)


def test_blocks_meet_without_a_seam() -> None:
    """Deviation and increments of the samples where two blocks meet are those of all samples."""
    time = 600.0 * np.arange(24 * 6)
    mean = np.tile([8.0, 0.0, 0.0], (len(time), 1))
    block, fade = about_means._BLOCK, about_means._FADE
    seams, others = [], []
    for seed in range(6):
        _, wind = turbulence_about_means(time, mean, None, np.random.default_rng(seed))
        assert len(wind) > 6 * (block - fade)
        for first in range(block - fade, len(wind) - block, block - fade):
            seams.append(wind[first : first + fade])
            others.append(wind[first + fade : first + 2 * fade])
    at_seams, elsewhere = np.array(seams), np.array(others)
    for axis in range(3):
        spread = at_seams[..., axis].std() / elsewhere[..., axis].std()
        assert 0.95 < spread < 1.05
        steps = [np.abs(np.diff(each[..., axis], axis=1)).mean() for each in (at_seams, elsewhere)]
        assert 0.97 < steps[0] / steps[1] < 1.03
