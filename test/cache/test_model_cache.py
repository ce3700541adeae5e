# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Prepared models of trees on disk: the same bits, and never a reason to fail."""

import os
import re

import numpy as np
import pytest

from tree_sway.cache import model_cache
from tree_sway.cache.model_cache import ModelFiles
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup import make_model

WIND = (6.0, 3.0, 0.5)


@pytest.fixture
def kept(tmp_path):
    return ModelFiles(tmp_path)


@pytest.fixture
def files(tmp_path):
    """Return the files that there are."""
    return lambda: sorted(tmp_path.iterdir())


def poses_of(simulator):
    """Poses of a second in the wind, half of it with more stiffness and less weight."""
    poses = []
    for frame in range(60):
        if frame == 30:
            simulator.tune(stiffness_factor=1.5, gravity=5.0)
        simulator.step(WIND, 1 / 60)
        poses.append(simulator.place())
    return np.array(poses).tobytes()


@pytest.fixture
def none_is_made(monkeypatch):
    """Fail where a tree is reduced, or asked for its loads, after all."""

    def start():
        monkeypatch.setattr(make_model, 'make_model', lambda *_: pytest.fail('made again'))

    return start


@pytest.mark.parametrize('model', ['full', 12])
def test_a_set_up_that_is_kept_gives_the_same_bits(fork, kept, files, none_is_made, model):
    alone, first = (make_simulator(fork(), model=model, cache=each) for each in (None, kept))
    assert len(files()) == 1
    none_is_made()
    second = make_simulator(fork(), model=model, cache=kept)
    assert poses_of(alone) == poses_of(first) == poses_of(second)
    assert second.mass == alone.mass
    assert second.frequencies().tobytes() == alone.frequencies().tobytes()
    assert len(files()) == 1


def test_another_tree_or_setting_has_another_set_up(fork, stem, kept, files):
    for count, (tree, given) in enumerate(
        [
            (fork(), {}),
            (fork(2), {}),
            (stem(), {}),
            (fork(), {'gravity': 0.0}),
            (fork(), {'in_leaf': True}),
            (fork(), {'model': 4}),
            (fork(), {'model': 'full'}),
        ],
        start=1,
    ):
        make_simulator(tree, cache=kept, **given)
        assert len(files()) == count


def test_a_set_up_of_other_source_is_not_taken(fork, kept, files, monkeypatch):
    make_simulator(fork(), cache=kept)
    monkeypatch.setattr(model_cache, 'source_digest', lambda _path: 'of an edited file')
    make_simulator(fork(), cache=kept)
    assert len(files()) == 2


def pickled(path):
    """Write arrays of objects, which only a pickle holds."""
    with path.open('wb') as file:
        np.savez(file, circular=np.array([{}], dtype=object))


def one_array(path):
    """Write what is no archive of arrays."""
    with path.open('wb') as file:
        np.save(file, np.zeros(3))


@pytest.mark.parametrize(
    'damage',
    [
        lambda path: path.write_bytes(b''),
        lambda path: path.write_bytes(b'no archive at all'),
        lambda path: path.write_bytes(path.read_bytes()[:-500]),
        lambda path: path.write_bytes(re.sub(b'[\x3f\x40]', b'\x41', path.read_bytes())),
        pickled,
        one_array,
    ],
    ids=['empty', 'text', 'cut off', 'altered', 'pickle', 'one array'],
)
def test_a_damaged_set_up_is_made_again(fork, kept, files, none_is_made, damage):
    expected = poses_of(make_simulator(fork(), cache=kept))
    (path,) = files()
    damage(path)
    assert poses_of(make_simulator(fork(), cache=kept)) == expected
    none_is_made()
    assert poses_of(make_simulator(fork(), cache=kept)) == expected


def test_a_set_up_under_the_name_of_another_is_not_taken(fork, stem, kept, files):
    make_simulator(fork(), cache=kept)
    (one,) = files()
    make_simulator(stem(), cache=kept)
    (other,) = set(files()) - {one}
    one.replace(other)
    assert poses_of(make_simulator(stem(), cache=kept)) == poses_of(make_simulator(stem()))


def test_what_cannot_be_written_is_left(fork, tmp_path):
    nowhere = ModelFiles(tmp_path / 'is not there')
    assert poses_of(make_simulator(fork(), cache=nowhere)) == poses_of(make_simulator(fork()))


def test_what_is_too_large_is_not_written(fork, kept, files, monkeypatch):
    monkeypatch.setattr(model_cache, 'LARGEST', 1 << 16)
    make_simulator(fork(), cache=kept)
    assert not files()
    kept.write('small', {'number': np.zeros(8)})
    assert len(files()) == 1


@pytest.mark.parametrize('bound', ['files', 'bytes'])
def test_the_oldest_go_first(kept, files, monkeypatch, bound):
    if bound == 'files':
        kept.most = 2
    else:
        monkeypatch.setattr(model_cache, 'MOST_BYTES', 1300)
    for age, digest in enumerate(('one', 'two', 'three')):
        kept.write(digest, {'number': np.array(age)})
        for path in files():
            os.utime(path, ns=(0, path.stat().st_mtime_ns - 10**9))
    assert kept.read('one') is None
    assert [int(kept.read(each)['number']) for each in ('two', 'three')] == [1, 2]


def test_what_is_used_stays(kept, files):
    kept.most = 2

    def age():
        """Make all a second older, as files of one tick of the clock are of one time."""
        for path in files():
            os.utime(path, ns=(0, path.stat().st_mtime_ns - 10**9))

    kept.write('daily', {'number': np.zeros(1)})
    for other in ('one', 'two', 'three'):
        age()
        kept.write(other, {'number': np.zeros(1)})
        age()
        assert kept.read('daily') is not None
