# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree whose steps stay clamped shows fewer coordinates, which is counted and said."""

from __future__ import annotations

from dataclasses import replace

import pytest
from simulators import AUTO

from tree_sway.core.run.clamp_watch import ClampWatch, fewer, FEWEST, LONGEST_CLAMPED
from tree_sway.core.run.outcome import Outcome
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene import shared_tables
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.setup.preparation import prepare

DT = 1.0 / 60.0
WIND = (9.0, 1.0, 0.0)


def clamped(model):
    """Make a model in which no energy is allowed, as of a tree that swings up by itself."""
    return replace(model, most_energy=1e-12)


def clamped_simulator(tree, model):
    made = make_simulator(tree, model=model)
    if model == 'auto':
        from tree_sway.fidelity import AdaptiveSimulator

        return AdaptiveSimulator(clamped(made.models[0]))
    return SwaySimulator(clamped(made.models[0]))


def test_a_gust_at_the_limit_is_no_tree_that_is_stuck():
    watch, n = ClampWatch(), round(LONGEST_CLAMPED / DT)
    assert not any(watch.is_stuck(4 * k, DT) for k in range(1, 20 * n))
    assert [watch.is_stuck(10**6 + k, DT) for k in range(n + 1)].count(True) == 1


def test_numbers_end_at_the_fewest():
    count, numbers = 60, []
    while not numbers or numbers[-1] != count:
        numbers.append(count)
        count = fewer(count)
    assert numbers[:4] == [60, 40, 26, 17]
    assert count == FEWEST
    assert fewer(2) == 2


@pytest.mark.parametrize('model', [12, *AUTO])
def test_it_shows_fewer_coordinates_until_it_is_reset(fork, model):
    sim = clamped_simulator(fork(), model)
    most = sim.banks[0].oscillators.shapes.shape[1]
    for _ in range(round(0.9 / DT)):
        assert sim.step(WIND, DT) == Outcome.LOAD_CLAMPED
    assert sim.counts.reduced == 0
    for _ in range(round(0.2 / DT)):
        sim.step(WIND, DT)
    assert sim.counts.reduced == 1
    assert sim.banks[0].n_shown <= fewer(most)
    if model == 'auto':
        assert sim.choice.n_coordinates <= sim.banks[0].n_shown
        assert sim.review().n_coordinates <= fewer(most)
    state, shown = sim.state(), sim.banks[0].n_shown
    sim.reset()
    assert sim.banks[0].n_shown > shown or model == 'auto'
    assert sim.counts.reduced == 1
    sim.set_state(state)
    assert sim.banks[0].n_shown == shown
    if model == 'auto':
        assert sim.review().n_coordinates <= fewer(most)


def test_a_storm_beyond_the_table_and_a_pull_take_no_coordinates(fork):
    sim = make_simulator(fork(), model=12)
    for _ in range(200):
        sim.step((80.0, 0.0, 0.0), DT)
    assert sim.counts.clamped > 0
    assert sim.counts.reduced == 0
    sim = clamped_simulator(fork(), 12)
    for _ in range(200):
        sim.push(0, (5.0, 0.0, 0.0), 1.0)
        sim.step(WIND, DT)
    assert sim.counts.reduced == 0
    assert sim.banks[0].n_shown == sim.banks[0].oscillators.shapes.shape[1]


def test_a_tree_of_a_scene_shows_fewer_and_the_others_do_not(fork, monkeypatch):
    tree = fork()
    other = fork(2)

    def prepared(asked, *arguments, **changes):
        made = prepare(asked, *arguments, **changes)
        return clamped(made) if asked.n_segments == other.n_segments else made

    monkeypatch.setattr(shared_tables, 'prepare', prepared)
    scene = Scene([PlacedTree('a', tree), PlacedTree('b', tree, 3.0), PlacedTree('c', other, 6.0)])
    sim = scene.simulator(model=12)
    kind = int(sim._sharing.tables[2])
    for _ in range(90):
        assert sim.step(WIND, DT) == Outcome.LOAD_CLAMPED
    shown = sim._shared._counted.tolist()
    assert shown[:2] == [12, 12]
    assert shown[2] == fewer(min(12, sim.banks[kind].oscillators.shapes.shape[1]))
    assert sim.counts.reduced == 1
    sim.reset()
    assert sim._shared._counted.tolist() == [12, 12, 12]
