# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The door of the native core: damaged bytes of a model are refused, by the name of an array."""

from __future__ import annotations

import os
import struct

from drawn_trees import weeping
import numpy as np
import pytest

from tree_sway.core.native.model import AT_POSE, bytes_of, NativeModel
from tree_sway.core.native.stand import NativeStand
from tree_sway.core.scene.make import make_simulator
from tree_sway.errors import FormatError, ParameterError

TRIALS = int(os.environ.get('TREE_SWAY_TRIALS', '3000'))
"""Damaged models of a run, both layouts and seeds together; each that is read is stepped."""


@pytest.fixture(scope='module', params=['by a table', 'at its pose'])
def arrays(fork, request):
    tree = fork() if request.param == 'by a table' else weeping(twigs=3)
    found = make_simulator(tree, model=6, crown_coherence=0.5).models[0].native_arrays()
    is_stepped = NativeModel(bytes_of(found)).sizes.is_stepped
    assert is_stepped == (1 if request.param == 'by a table' else AT_POSE)
    return found


def stepped(content):
    """Step and place a model of bytes; an error of the door is what it may raise."""
    model = NativeModel(content)
    place = np.array([[0.0, 0.0, 0.0, 0.5, 1.1]])
    stand = NativeStand([model], np.zeros(1, dtype=np.int64), place, np.ones(1))
    stand.set_step(1 / 60)
    poses = np.zeros((model.sizes.segments, 7))
    keys = np.zeros(model.sizes.keys)
    for wind in ([5.0, 1.0, 0.3], [80.0, -3.0, 60.0]):
        stand.step(np.array([wind]))
        stand.place_first(poses)
        stand.keys(0, keys)
        stand.place_keys(0, keys, poses)
    return poses


def test_a_sound_model_is_stepped_and_placed(arrays):
    assert np.isfinite(stepped(bytes_of(arrays))).all()


@pytest.mark.parametrize('seed', [3, 4])  # two processes share the many trials of a sanitizer
def test_damaged_bytes_are_refused_or_stepped_within_their_memory(arrays, seed):
    sound, rng, refused = bytes_of(arrays), np.random.default_rng(seed), 0
    header = 16 + 72 * len(arrays)
    for trial in range(TRIALS // 4):
        content = bytearray(sound)
        # Headers, indices and numbers alike.
        end = header if trial % 3 == 0 else len(content)
        for _ in range(int(rng.integers(1, 4))):
            content[int(rng.integers(0, end))] = int(rng.integers(0, 256))
        if trial % 10 == 0:
            del content[int(rng.integers(0, len(content))) :]
        try:
            stepped(bytes(content))
        except FormatError as refusal:
            reason = str(refusal)
            refused += 1
        else:
            continue
        assert "array '" in reason
    assert 0.05 * TRIALS < refused < TRIALS // 4


@pytest.mark.parametrize('bad', [np.nan, np.inf, -np.inf, 1e308])
def test_a_number_that_no_tree_has_is_refused_by_the_name_of_its_array(arrays, bad):
    for name, array in arrays.items():
        if array.dtype != np.float64 or not array.size:
            continue
        other = array.copy()
        other.flat[array.size // 2] = bad
        with pytest.raises(FormatError, match=f"array '{name}': a number that no tree has"):
            NativeModel(bytes_of({**arrays, name: other}))


@pytest.mark.parametrize('bad', [-(2**63), -2, 10**6, 2**62])
def test_an_index_that_does_not_exist_is_refused(arrays, bad):
    for name, array in arrays.items():
        if array.dtype != np.int64:
            continue
        other = array.copy()
        other.flat[-1] = bad
        with pytest.raises(FormatError, match="array '"):
            NativeModel(bytes_of({**arrays, name: other}))


def test_sizes_of_which_one_is_zero_name_no_numbers(arrays):
    content = bytearray(bytes_of(arrays))
    entry = 16 + 72 * list(arrays).index('branch_keys')
    struct.pack_into('<I4Q', content, entry + 28, 2, len(content), 0, 0, 0)
    with pytest.raises(FormatError, match="'branch_keys': of another shape"):
        NativeModel(bytes(content))


def test_another_version_is_refused(arrays):
    content = bytearray(bytes_of(arrays))
    struct.pack_into('<I', content, 8, 999)
    with pytest.raises(FormatError, match='another version'):
        NativeModel(bytes(content))


@pytest.mark.parametrize(
    'place', [[np.nan, 0, 0, 0, 1], [0, 0, 0, np.inf, 1], [0, 0, 0, 0, 0], [0, 0, 0, 0, -1.0]]
)
def test_a_tree_that_stands_nowhere_is_refused(arrays, place):
    model = NativeModel(bytes_of(arrays))
    for kind in (0, 1, -1):
        with pytest.raises(ParameterError, match=r'not finite|does not exist'):
            NativeStand([model], np.array([kind]), np.array([place], dtype=float), np.ones(1))


def test_a_model_without_any_one_of_its_arrays_is_refused_or_stepped(arrays):
    refused = set()
    for name in arrays:
        try:
            stepped(bytes_of({other: arrays[other] for other in arrays if other != name}))
        except FormatError:
            refused.add(name)
    assert {'tree_start', 'branch_keys'} <= refused
    assert ('shapes' in refused) == ('turning' in arrays)
