# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the spikes of a wet sensor do to a tree behind the gate."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.scene import make_simulator, Run
from tree_sway.core.tree import tree_from_segments
from tree_sway.core.wind import WindGate, WindIntake
from tree_sway.simulation.wind import AnemometerModel, SensorFaults

SECOND = 10**9
PERIOD = round(1e9 / 60)
START = 1_700_000_000 * 10**9 // PERIOD * PERIOD
TREE = tree_from_segments(
    [[0, 0, 0], [0, 0, 1], [0, 0, 2]], [[0, 0, 1], [0, 0, 2], [0, 0, 3]], [0.05, 0.04, 0.03]
)


def largest_moves(seed, gate):
    """Largest move of the tip per frame [m] in and after a spike of a second, and the winds."""
    sensor, faults = AnemometerModel(6.0, rate=20.0, seed=seed), SensorFaults('spike', 15.0, 1.0)
    simulator, tips, winds = make_simulator(TREE, model=12, damping_ratio=0.05), [], []

    def note(end, wind):
        tips.append(simulator.tip_displacement)
        winds.append(wind)

    made = Run(simulator, intake=WindIntake(gate=gate), stepped=note)
    made.advance(START)
    for tick in range(round(20 * 20.0)):
        at = tick / 20.0
        for sample in faults.sent(at, START + round(at * SECOND), sensor.sample(tick)):
            made.offer(sample.stamp, tuple(sample.vector))
        made.advance(START + round(at * SECOND), may_join=False)
    assert made.counts.forced == (gate.counts.spike > 0)
    return np.linalg.norm(np.diff(tips, axis=0), axis=1)[14 * 60 :].max(), np.array(winds)


@pytest.mark.parametrize('seed', [0, 1, 2])
def test_a_spike_of_a_second_jerks_no_tree(seed):
    moved, winds = largest_moves(seed, WindGate())
    through, _ = largest_moves(seed, WindGate(max_rate=1e4))
    print(f'largest move per frame {1e3 * moved:.1f} mm, ungated {1e3 * through:.1f} mm')
    assert moved < 0.5 * through
    assert moved < 5e-3
    assert np.linalg.norm(np.diff(winds[300:], axis=0), axis=1).max() * 60.0 < 45.0
