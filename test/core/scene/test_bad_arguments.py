# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What every simulator refuses before a step, and after what it continues."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from simulators import AUTO, FULL, MODELS, OBSERVED, swaying

from tree_sway.core.checks import LONGEST_STEP
from tree_sway.core.run.outcome import Outcome
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.settings import Settings
from tree_sway.core.species.species import species_named
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.wind.averaging import WindAverage
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.errors import ParameterError, StateError, TreeError
from tree_sway.growth.growing import grow

DT = 1.0 / 60.0
KINDS = (0, 4, 'branch', *AUTO, 'forest', *FULL, *OBSERVED)


def simulator(tree, kind, **changes):
    wood = species_named('broadleaf')
    if kind == 'auto':
        return make_simulator(tree, wood, Settings(**(changes | {'model': 'auto'})))
    if kind == 'observed':
        return swaying(tree, kind, **changes)
    if kind == 'forest':
        return Scene([PlacedTree('one', tree), PlacedTree('two', tree, 3.0)]).simulator()
    return make_simulator(tree, wood, Settings(model=kind, **changes))


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


@pytest.mark.parametrize('model', ['branch', 12, *FULL])
def test_motion_that_is_not_finite_goes_on_from_rest(fork, model):
    sim = simulator(fork(), model)
    sim.step((5.0, 0.0, 0.0), DT)
    for array in sim.banks[0].oscillators.memory():
        if array.dtype.kind == 'f':
            array.flat[0] = np.nan
    assert sim.step((5.0, 0.0, 0.0), DT) & Outcome.RESTARTED
    assert sim.counts.restarted == 1
    assert np.isfinite(sim.place()).all()
    for _ in range(60):
        assert sim.step((5.0, 0.0, 0.0), DT) == 0
    assert sim.tip_displacement[0] > 0.0


@pytest.mark.parametrize('model', ['branch', 12, *FULL])
def test_an_absurd_twig_leaves_no_pose_that_is_not_finite(model):
    """Half a millimetre across and 240 m long, with its weight left out."""
    nodes = np.array([(0, 0, 0), (0, 0, 2), (0, 0, 4), (240.0, 0, 4)], float)
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


@pytest.mark.parametrize('count', [0, -1, np.nan, 'all', 2.5, True])
def test_a_count_of_frequencies_is_one_at_least(fork, count):
    for model in (2, 'branch'):
        with pytest.raises(ParameterError, match='count'):
            simulator(fork(), model).frequencies(count)


@pytest.mark.parametrize('wrong', ['start', 'end', 'diameter'])
@pytest.mark.parametrize('value', ['wind', [['a', 'b', 'c']], [[0.0, 0.0], [1.0]], {'x': 1}])
def test_segments_that_are_no_numbers_are_one_clear_error(wrong, value):
    given = {'start': [[0.0, 0.0, 0.0]], 'end': [[0.0, 0.0, 1.0]], 'diameter': [0.1]}
    with pytest.raises(TreeError, match=f'{wrong}: not an array of numbers'):
        tree_from_segments(**(given | {wrong: value}))


@pytest.mark.parametrize('value', [3.0, None])
def test_a_number_in_place_of_segments_is_one_clear_error(value):
    with pytest.raises(TreeError):
        tree_from_segments(value, [[0.0, 0.0, 1.0]], [0.1])


@pytest.mark.parametrize('model', [4, *MODELS])
def test_a_tree_without_any_drag_stays_at_rest(fork, model):
    wood = replace(species_named('broadleaf'), bare_drag_coefficient=0.0)
    sim = make_simulator(fork(), wood, Settings(model=model, gravity=0.0))
    rest = sim.place().copy()
    for _ in range(60):
        assert sim.step((9.0, 4.0, 1.0), DT) == 0
    assert sim.place() == pytest.approx(rest, abs=1e-12)


NO_NUMBERS = ('3', None, b'3', [1.0], {}, 1j)


@pytest.mark.parametrize('value', NO_NUMBERS, ids=repr)
def test_what_is_no_number_is_named(fork, value):
    sim = simulator(fork(), 2)
    place = PlacedTree('one', fork())
    for call in (
        lambda: sim.step((1.0, 2.0, 3.0), value),
        lambda: grow('oak', value, rng=5),
        lambda: simulate_turbulence(value, rate=10.0, duration=5.0, rng=5),
        lambda: simulate_turbulence(5.0, rate=value, duration=5.0, rng=5),
        lambda: Settings(gravity=value),
        lambda: Settings(max_wind=value),
        lambda: replace(place, x=value),
        lambda: replace(place, scale=value),
        lambda: Scene([place]).moved(value),
        lambda: WindAverage().add(value, (1.0, 2.0, 3.0)),
        lambda: WindAverage().mean(value, 2.0),
    ):
        with pytest.raises(ParameterError, match='is not a number'):
            call()


@pytest.mark.parametrize('rng', [None, 'a', -1, 1.5, True, [1], np.random.RandomState(1)])
def test_randomness_comes_of_a_generator_or_its_seed(rng):
    for call in (
        lambda: grow('oak', 3.0, rng=rng),
        lambda: simulate_turbulence(5.0, rate=10.0, duration=5.0, rng=rng),
    ):
        with pytest.raises(ParameterError, match=r'rng: .*give numpy.random.default_rng\(5\)'):
            call()


def test_a_seed_is_its_generator():
    of_seed = simulate_turbulence(5.0, rate=10.0, duration=5.0, rng=5)
    of_generator = simulate_turbulence(5.0, rate=10.0, duration=5.0, rng=np.random.default_rng(5))
    assert (of_seed == of_generator).all()
    one = grow('oak', 3.0, rng=np.int64(5))
    assert (one.start == grow('oak', 3.0, rng=np.random.default_rng(5)).start).all()


@pytest.mark.parametrize('state', [None, 'a', 3, np.zeros(4)])
def test_what_is_no_state_is_refused(sim, state):
    with pytest.raises(StateError, match='where a TreeState is expected'):
        sim.set_state(state)


def test_what_is_of_another_type_is_named(fork):
    place = PlacedTree('one', fork())
    for call in (
        lambda: Settings(in_leaf='no'),
        lambda: Settings(profile=None),
        lambda: replace(place, leaf_on=-1),
        lambda: replace(place, name=None),
        lambda: Scene(None),
    ):
        with pytest.raises(ParameterError):
            call()


def test_numbers_beyond_floats_are_refused(fork):
    sim = simulator(fork(), 2)
    for call in (lambda: sim.step((1.0, 2.0, 3.0), 10**400), lambda: grow('oak', 10**400, rng=1)):
        with pytest.raises(ParameterError, match=r'time step of 1000|height nan'):
            call()


@pytest.mark.parametrize('kind', KINDS)
def test_a_step_beyond_the_longest_is_refused_and_changes_nothing(fork, kind):
    sim = simulator(fork(), kind)
    sim.step((5.0, 0.0, 0.0), LONGEST_STEP)
    before = sim.state().values
    with pytest.raises(ParameterError, match=r'up to 0\.5 s: take several for more'):
        sim.step((25.0, 0.0, 0.0), 10.0)
    assert (sim.state().values == before).all()


@pytest.mark.parametrize('value', [np.nan, np.inf, 1e308])
def test_a_state_with_numbers_that_no_tree_has_is_refused(fork, value):
    sim = make_simulator(fork(), model=4)
    state = sim.state()
    with pytest.raises(StateError, match='a number that no tree has'):
        sim.set_state(replace(state, values=np.full_like(state.values, value)))
    assert (sim.state().values == state.values).all()
