# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Stands of the native core: any wind, any history, copies, threads, and the end of Python."""

from __future__ import annotations

import copy
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

from drawn_trees import weeping
import numpy as np
import pytest

from tree_sway.core.native.library import address, Opened
from tree_sway.core.native.model import AT_POSE, bytes_of, NativeModel
from tree_sway.core.native.stand import NativeStand
from tree_sway.core.scene.make import make_simulator
from tree_sway.errors import ParameterError


def stand_of(model, *, yaw=0.5, speed=1.0):
    """Return a stand of one tree, whose steps are those of a frame."""
    own = NativeModel(bytes_of(model.native_arrays()))
    place = np.array([[0.0, 0.0, 0.0, yaw, 1.0]])
    stand = NativeStand([own], np.zeros(1, dtype=np.int64), place, np.array([speed]))
    stand.set_step(1 / 60)
    return stand


@pytest.fixture(scope='module')
def model(fork):
    return make_simulator(fork(), model=6, crown_coherence=0.5).models[0]


@pytest.fixture(scope='module')
def hanging():
    return make_simulator(weeping(twigs=3), model=6).models[0]


@pytest.mark.parametrize(
    ('wind', 'speed'),
    [
        ((1.7e308, -1.7e308, 0.0), 1.0),  # its sum is finite
        ((1e200, 1e200, 0.0), 1.0),
        ((1e20, 0.0, 0.0), 1e300),
        ((np.nan, 0.0, 0.0), 1.0),
        ((0.0, 0.0, -np.inf), 1.0),
    ],
)
def test_a_wind_whose_square_is_not_finite_is_calm(model, hanging, wind, speed):
    for each in (model, hanging):
        stand = stand_of(each, yaw=np.pi / 4, speed=speed)
        assert stand.step(np.array([wind])) == (0, 0)
        assert not stand.states.wind.any()
        assert np.isfinite(stand.states.history).all()


@pytest.mark.parametrize('number', [0.0, 1e15, -1e308, np.inf, np.nan])
def test_a_tree_goes_on_from_any_history_of_the_wind(model, number):
    stand = stand_of(model)
    history = stand.states.history[0]
    history[:2] = 200.0
    history[2::4] = 0.0
    with np.errstate(all='ignore'):
        history[3::4] = np.arange(len(history[3::4])) * number
    for _ in range(3):
        assert stand.step(np.array([[5.0, 0.0, 0.0]]))[1] == 0
    assert np.isfinite(stand.states.wind).all()


def test_nothing_that_holds_native_memory_is_copied_with_it(model):
    simulator = make_simulator(model.tree, model=6)
    for each in (simulator, stand_of(model), address(np.zeros(1))):
        with pytest.raises(ParameterError, match='cannot be copied'):
            copy.deepcopy(each)
    with pytest.raises(ParameterError, match='cannot be copied'):
        copy.copy(simulator)
    for each in (address(np.zeros(1)), Opened(0, lambda _: None)):
        with pytest.raises(ParameterError, match='cannot be copied'):
            pickle.dumps(each)


def test_two_threads_that_step_a_limp_tree_stay_within_its_memory(hanging):
    stand = stand_of(hanging)
    assert stand.models[0].sizes.is_stepped == AT_POSE
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)

    def run():
        for i in range(4000):
            stand.set_step((1.0 + i % 3 * 0.1) / 60)
            stand.step(np.array([[5.0, 0.0, 0.0]]))

    threads = [threading.Thread(target=run) for _ in range(3)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    sys.setswitchinterval(before)
    assert np.isfinite(stand.states.eta).all()


def forest_of(models, count, **how):
    """Return a stand of many trees of some models, and where it places them."""
    rng = np.random.default_rng(1)
    places = np.column_stack([rng.uniform(0.0, 9.0, (count, 4)), rng.uniform(0.7, 1.3, count)])
    own = [NativeModel(bytes_of(each.native_arrays())) for each in models]
    kinds = np.arange(count) % len(own)
    stand = NativeStand(own, kinds, places, np.ones(count), **how)
    stand.set_step(1 / 60)
    sizes = np.array([each.sizes.segments for each in own])[kinds]
    return stand, np.stack([np.arange(count), np.cumsum(sizes) - sizes], axis=1), sizes.sum()


def moved(stand, rows, size):
    """Return states and poses after some steps, and what the steps counted."""
    rng = np.random.default_rng(2)
    poses = np.zeros((size, 7))
    counted = []
    for _ in range(4):
        winds = rng.normal(0.0, 5.0, (len(rows), 3))
        winds[::5] = 1e9  # clamped
        stand.states.eta[1::7] = np.nan  # goes on from rest
        counted.append(stand.step(winds))
        stand.place(rows, poses)
    return [each.tobytes() for each in (poses, *stand.states)], counted


def n_threads():
    """Return the number of threads of this process."""
    return len(os.listdir('/proc/self/task'))


threads_are_counted = pytest.mark.skipif(
    not os.path.isdir('/proc/self/task'), reason='threads are counted on Linux alone'
)


def test_the_number_of_threads_changes_no_bit(model, hanging):
    expected = moved(*forest_of([model, hanging], 61, threads=1))
    assert all(clamped >= 10 and restarted >= 8 for clamped, restarted in expected[1])
    for threads in (2, 3, 64):
        assert moved(*forest_of([model, hanging], 61, threads=threads)) == expected


@threads_are_counted
@pytest.mark.filterwarnings('ignore:.*multi-threaded:DeprecationWarning')
def test_a_process_that_was_forked_has_threads_of_its_own(model):
    forest = forest_of([model], 300, threads=3)
    expected = moved(*forest_of([model], 300, threads=1))
    child = os.fork()
    if child == 0:
        signal.alarm(60)  # ends it if it waits for threads that it does not have
        before = n_threads()
        os._exit(0 if moved(*forest) == expected and n_threads() == before + 2 else 1)
    assert os.waitpid(child, 0)[1] == 0
    assert moved(*forest) == expected


@threads_are_counted
def test_threads_sleep_between_calls_and_end_with_the_stand(model):
    before = n_threads()
    forest = forest_of([model], 300, threads=4)
    assert n_threads() == before + 3
    moved(*forest)
    spent = time.process_time()
    threading.Event().wait(0.2)
    assert time.process_time() - spent < 0.1
    assert n_threads() == before + 3
    del forest
    assert n_threads() == before


def test_a_stand_beyond_the_caches_is_placed_as_each_of_its_trees(model, hanging):
    sizes = [each.tree.n_segments for each in (model, hanging)]
    count = 200_000 // sum(sizes) + 2
    stand, rows, n_poses = forest_of([model, hanging], count)
    rng = np.random.default_rng(2)
    for _ in range(3):
        assert stand.step(rng.normal(0.0, 5.0, (count, 3))) == (0, 0)
    for first in (0, 1):  # poses begin at any number of a line
        poses = np.zeros((n_poses + 1, 7))[first:]
        stand.place(rows, poses)
        for tree in [*range(0, count, 97), count - 1]:
            kind = tree % 2
            keys = np.zeros(stand.models[kind].sizes.keys)
            expected = np.zeros((sizes[kind], 7))
            stand.keys(tree, keys)
            stand.place_keys(tree, keys, expected)
            assert np.array_equal(poses[rows[tree, 1] :][: sizes[kind]], expected)
        assert not poses[n_poses:].any()


AT_EXIT = """
import atexit
import numpy as np
simulators = []
def last():
    taken = [np.ones(3000) for _ in range(3000)]
    for _ in range(100):
        simulators[0].step((5.0, 0.0, 0.0), 1 / 60)
    print(np.isfinite(simulators[0].place()).all())
atexit.register(last)
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.tree.building import tree_from_segments
ends = np.outer(np.arange(4), [0.0, 0.0, 0.5])
tree = tree_from_segments(ends[:-1], ends[1:], [0.03, 0.02, 0.01], parent=[-1, 0, 1])
simulators.append(make_simulator(tree, model=4))
"""


def test_a_tree_may_be_stepped_until_the_very_end_of_python():
    run = subprocess.run([sys.executable, '-c', AT_EXIT], capture_output=True, text=True)
    assert (run.returncode, run.stdout) == (0, 'True\n'), run.stderr
