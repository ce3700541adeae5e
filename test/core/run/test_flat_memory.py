# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A step takes no memory, and a million steps take none either."""

from __future__ import annotations

from pathlib import Path
import sys

from drawn_trees import SETTINGS, weeping, WOOD
import numpy as np
import pytest
from simulators import FULL

from tree_sway.core.scene.make import make_simulator

DT = 1.0 / 60.0
WINDS = [(5.0 + np.sin(0.1 * k), np.cos(0.07 * k), 0.1) for k in range(200)]
MODELS = (12, 'branch', *FULL)


def resident():
    """Memory of this process in [kB]."""
    status = Path('/proc/self/status')
    if not status.exists():
        pytest.skip('memory is reported by /proc alone')
    return next(int(line.split()[1]) for line in status.read_text().split('\n') if 'VmRSS' in line)


def sway(simulator, out, rounds):
    for _ in range(rounds):
        for wind in WINDS:
            simulator.step(wind, DT)
        simulator.place(out)


@pytest.mark.parametrize('model', MODELS)
def test_no_step_asks_for_memory(fork, model):
    simulator = make_simulator(fork(), model=model)
    out = np.zeros((simulator.tree.n_segments, 7))
    sway(simulator, out, 2)
    blocks = sys.getallocatedblocks()
    for wind in WINDS * 5:
        simulator.step(wind, DT)
    assert sys.getallocatedblocks() - blocks < 50


def test_no_step_of_a_limp_tree_asks_for_memory():
    simulator = make_simulator(weeping(), WOOD, SETTINGS, model=24)
    assert simulator.models[0].is_limp
    out = np.zeros((simulator.tree.n_segments, 7))
    sway(simulator, out, 2)
    blocks = sys.getallocatedblocks()
    for wind in WINDS:
        simulator.step(wind, DT)
    assert sys.getallocatedblocks() - blocks < 50


@pytest.mark.long
def test_a_million_steps_take_no_memory(fork):
    simulator = make_simulator(fork(), model=20)
    out = np.zeros((simulator.tree.n_segments, 7))
    sway(simulator, out, 50)
    before = resident()
    sway(simulator, out, 1_000_000 // len(WINDS))
    assert resident() - before < 512
    assert np.isfinite(out).all()
