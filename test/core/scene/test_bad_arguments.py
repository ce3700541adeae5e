# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What every simulator refuses before a kernel runs, and after what it continues."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tree_sway_lab.bench.bench_tree import bench_tree

from tree_sway.core.fidelity.adaptive import AdaptiveSimulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.scene.simulate import simulate
from tree_sway.core.simulator.settings import Settings
from tree_sway.core.simulator.simulator import RESTARTED, SwaySimulator
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.tree.species import species_named
from tree_sway.errors import ParameterError

DT = 1.0 / 60.0
KINDS = (0, 4, 'branch', 'full', 'auto', 'forest')


def simulator(tree, kind, **changes):
    wood = species_named('broadleaf')
    if kind == 'auto':
        return AdaptiveSimulator(tree, wood, Settings(**changes))
    if kind == 'forest':
        return Scene([PlacedTree('one', tree), PlacedTree('two', tree, 3.0)]).simulator()
    return SwaySimulator(tree, wood, Settings(model=kind, **changes))


@pytest.fixture(scope='module', params=KINDS)
def sim(fork, request):
    return simulator(fork(), request.param)


def bad_blocks(n):
    whole = np.zeros((n, 7))
    return {
        'short': np.zeros((n - 1, 7)),
        'narrow': np.zeros((n, 6)),
        'turned': np.zeros((7, n)),
        'flat': np.zeros(7 * n),
        'single': np.zeros((n, 7), np.float32),
        'whole numbers': np.zeros((n, 7), np.int64),
        'swapped': np.zeros((n, 7), '>f8'),
        'by columns': np.zeros((n, 7), order='F'),
        'every second': np.zeros((2 * n, 7))[::2],
        'read only': np.broadcast_to(0.0, (n, 7)),
        'crooked': np.zeros(n * 56 + 4, np.uint8)[4:].view(np.float64).reshape(n, 7),
        'list': whole.tolist(),
    }


@pytest.mark.parametrize('bad', bad_blocks(2))
def test_an_array_that_cannot_hold_the_poses_is_refused(sim, bad):
    sim.step((5.0, 0.0, 0.0), DT)
    block = bad_blocks(sim.tree.n_segments)[bad]
    with pytest.raises(ParameterError, match=r'out: .*cannot be filled; give np.empty'):
        sim.place(block)
    if hasattr(sim, 'place_rotations'):
        with pytest.raises(ParameterError, match='out: '):
            sim.place_rotations(sim.rotations(), block)


def test_rotations_of_another_number_are_refused(sim):
    if not hasattr(sim, 'place_rotations'):
        pytest.skip('a forest has no rotations of its own')
    good = sim.rotations()
    for bad in (good[:-1], np.append(good, 0.0), good[None], ['x'] * len(good)):
        with pytest.raises(ParameterError, match='rotations: '):
            sim.place_rotations(bad)
    found = sim.place_rotations(np.repeat(good, 2)[::2].astype(np.float32))
    assert np.abs(found - sim.place_rotations(good)).max() < 1e-5


def test_placed_frames_are_kept(sim):
    sim.step((5.0, 0.0, 0.0), DT)
    first = sim.place()
    kept = first.copy()
    for _ in range(30):
        sim.step((9.0, 2.0, 0.0), DT)
    assert sim.place() is not first
    assert (first == kept).all()


def test_the_tip_is_known_without_placing(sim):
    for _ in range(20):
        sim.step((9.0, 2.0, 0.0), DT)
    found = np.array(sim.tip_displacement)
    sim.place()
    assert (found == sim.tip_displacement).all()
    assert (np.abs(found).max() > 1e-6) == (sim.model != '0')


@pytest.mark.parametrize('dt', [0.0, -DT, np.nan, np.inf])
def test_a_step_of_no_time_is_refused_at_once_and_later(fork, sim, dt):
    for one in (sim, simulator(fork(), 'branch')):
        with pytest.raises(ParameterError, match=r'step'):
            one.step((1.0, 0.0, 0.0), dt)


@pytest.mark.parametrize('name', ['leaf_mass', 'leaf_area'])
@pytest.mark.parametrize('kind', ['branch', 12])
def test_leaves_are_one_number_per_branch(fork, kind, name):
    n = fork().n_branches
    for bad in (np.zeros(n - 1), np.zeros((n, 1)), [-1.0] * n, [np.nan] * n, ['x'] * n):
        with pytest.raises(ParameterError, match=r'lea(f|ves)'):
            simulator(fork(), kind, **{name: bad})
    simulator(fork(), kind, **{name: [0.1] * n})


@pytest.mark.parametrize('model', ['branch', 12, 'full'])
def test_motion_that_is_not_finite_goes_on_from_rest(fork, model):
    sim = simulator(fork(), model)
    sim.step((5.0, 0.0, 0.0), DT)
    for array in sim.memory()[1:]:
        if array.dtype.kind == 'f':
            array.flat[0] = np.nan
    assert sim.step((5.0, 0.0, 0.0), DT) & RESTARTED
    assert sim.counts.restarted == 1
    assert np.isfinite(sim.place()).all()
    for _ in range(60):
        assert sim.step((5.0, 0.0, 0.0), DT) == 0
    assert sim.tip_displacement[0] > 0.0


@pytest.mark.parametrize('model', ['branch', 12, 'full'])
def test_an_absurd_twig_leaves_no_pose_that_is_not_finite(model):
    """Half a millimetre across and a kilometre long, with its weight left out."""
    nodes = np.array([(0, 0, 0), (0, 0, 2), (0, 0, 4), (1e3, 0, 4)], float)
    tree = tree_from_segments(
        nodes[:-1], nodes[1:], np.array([0.1, 0.08, 5e-4]), parent=np.array([-1, 0, 1])
    )
    sim = simulator(tree, model, gravity=0.0)
    for k in range(120):
        sim.step((8.0, np.sin(k), 0.0), DT)
        assert np.isfinite(sim.place()).all()


@pytest.mark.parametrize(
    'wind', [(1.0, 2.0), (1.0, 2.0, 3.0, 4.0), '123', 'abc', None, 5.0, [[1.0, 2.0, 3.0]], {}]
)
def test_a_wind_that_is_not_three_numbers_is_one_clear_error(sim, wind):
    with pytest.raises(ParameterError, match=r'wind: .*is not three numbers; give x, y and z'):
        sim.step(wind, DT)


@pytest.mark.parametrize('wind', ['wind.csv', Path('wind.csv')])
def test_the_name_of_a_record_is_no_wind_and_says_what_reads_it(wind):
    with pytest.raises(ParameterError, match=r"wind: 'wind\.csv', .*; read it: read_wind\('wind"):
        simulate(bench_tree(), wind, model=12)


def test_a_wind_of_no_numbers_is_refused():
    with pytest.raises(ParameterError, match='not an array of numbers'):
        simulate(bench_tree(), [[1.0, 2.0, 3.0], [4.0]], model=12)


@pytest.mark.parametrize('model', ['branch', 12])
@pytest.mark.parametrize('count', [0, -1, float('nan')])
def test_a_number_of_frequencies_below_one_is_refused(model, count):
    with pytest.raises(ParameterError, match=r'count: .* is out of range'):
        simulator(bench_tree(), model).frequencies(count)
