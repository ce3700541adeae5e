# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Prepared models as files: whole, refused where damaged, opened wherever a tree is."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
import json
import math
import zipfile

import numpy as np
import pytest

from tree_sway.commands.cli import main
from tree_sway.core.model.model_cache import PREPARED, PreparedModels
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup import make_model
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.species.species import species_named
from tree_sway.core.tree_state import digest_of
from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.models import model_file
from tree_sway.files.models.model_file import read_model, VERSION
from tree_sway.files.models.model_writer import write_model, write_native_model
from tree_sway.files.trees.source import open_scene, open_tree


@pytest.fixture
def file(fork, tmp_path):
    path = tmp_path / 'fork.npz'
    write_model(path, prepare(fork(), species_named('oak'), in_leaf=True, root_stiffness=math.inf))
    return path


def rewritten(path, **changes):
    """Change arrays of a file; None takes one out."""
    with np.load(path) as file:
        arrays = dict(file) | changes
    np.savez(path, **{name: each for name, each in arrays.items() if each is not None})


def edited(path, name, index, value):
    """Change one element of an array of a file."""
    with np.load(path) as file:
        array = file[name].copy()
    array[index] = value
    rewritten(path, **{name: array})


def with_about(path, **changes):
    with np.load(path) as file:
        about = json.loads(str(file['about']))
    rewritten(path, about=np.array(json.dumps(about | changes)))


def test_a_file_reads_back_bit_for_bit(fork, file):
    before = prepare(fork(), species_named('oak'), in_leaf=True, root_stiffness=math.inf)
    model = read_model(file)
    assert model.digest() == before.digest()
    assert digest_of(model.tree, model.species, model.settings) == digest_of(
        before.tree, before.species, before.settings
    )
    assert model.tree.branch_names == before.tree.branch_names
    assert model.tree.name == before.tree.name


@pytest.mark.parametrize('model', [0, 'branch', 'full'])
def test_every_model_can_be_written(fork, tmp_path, model):
    before = prepare(fork(), model=model, crown_coherence=0.4)
    write_model(tmp_path / 'a.npz', before)
    assert read_model(tmp_path / 'a.npz').digest() == before.digest()


def test_an_opened_file_is_not_set_up_again(file, monkeypatch):
    monkeypatch.setattr(PREPARED, 'behind', None)
    monkeypatch.setattr(PREPARED, '_given', {})
    opened = open_scene(file)
    assert 'prepared on model 60, in leaf' in opened.notes[0]
    monkeypatch.setattr(make_model, 'make_model', lambda *_: pytest.fail('set up'))
    simulator = opened.simulator(in_leaf=True, root_stiffness=math.inf)
    simulator.step((6.0, 0.0, 0.0), 1 / 60)
    assert simulator.models[0].species.key == 'oak'


def test_another_species_is_set_up_anew(file):
    spruce = open_tree(file, species='spruce')
    simulator = make_simulator(spruce, model=4)
    assert simulator.models[0].species.key == 'spruce'
    assert simulator.models[0].n_coordinates == 4


@pytest.mark.parametrize(
    ('damage', 'named'),
    [
        (lambda path: path.write_bytes(path.read_bytes()[:900]), 'zip'),
        (lambda path: path.write_text('hello'), 'zip'),
        (lambda path: rewritten(path, mass=np.array('x')), 'settings or arrays'),
        (lambda path: rewritten(path, mass=np.array(1j)), 'settings or arrays'),
        (lambda path: rewritten(path, drag_law=np.full(3, 1j)), 'settings or arrays'),
        (lambda path: rewritten(path, drag_law=np.ones((1, 3))), 'settings or arrays'),
        (lambda path: rewritten(path, branch_keys=np.array(['x'] * 5)), 'settings or arrays'),
        (lambda path: rewritten(path, stiffness=np.array(1.0)), 'settings or arrays'),
        (lambda path: edited(path, 'tree_start', 2, 1e300), 'tree_start has a number'),
        (lambda path: with_about(path, species=None), 'or arrays: None in place'),
        (lambda path: with_about(path, settings={'profile': 3}), 'or arrays: 3 in place'),
        (lambda path: with_about(path, settings={'max_wind': True}), 'max_wind is True'),
        (lambda path: with_about(path, settings={'gravity': 10**400}), 'too large'),
        (lambda path: rewritten(path, about=None), 'no JSON'),
        (lambda path: rewritten(path, about=np.ones(2)), 'no text about it'),
        (lambda path: with_about(path, format='glTF'), 'another format'),
        (lambda path: with_about(path, version=VERSION + 1), f'version {VERSION + 1}'),
        (lambda path: with_about(path, species={'key': 3}), 'tree, settings or arrays'),
        (lambda path: with_about(path, settings={'gravity': -1.0}), 'gravity'),
        (lambda path: with_about(path, branch_names=['stem']), 'branch names'),
        (lambda path: with_about(path, digest='0' * 16), 'not those that were written'),
        (lambda path: rewritten(path, stiffness=None), "'stiffness': missing"),
        (lambda path: rewritten(path, tree_start=None), 'tree_start'),
        (lambda path: rewritten(path, tree_branch_first=np.array([0, 3])), 'without segments'),
        (lambda path: edited(path, 'tree_branch_first', 1, 0), 'without segments'),
        (lambda path: edited(path, 'tree_start', 2, np.nan), 'tree_start has a number'),
        (lambda path: edited(path, 'tree_end', slice(None), 0.0), 'segments without length'),
        (lambda path: edited(path, 'tree_tip_diameter', 0, 0.0), 'tree_tip_diameter has a number'),
        (lambda path: edited(path, 'tree_segment_parent', 0, 1), 'segments .* depth-first order'),
        (lambda path: edited(path, 'tree_segment_parent', 2, 3), 'segments .* depth-first order'),
        (lambda path: edited(path, 'tree_segment_parent', -1, -2), 'segments .* depth-first'),
        (lambda path: rewritten(path, tree_segment_parent=np.zeros(3)), 'segment_parent is float'),
        (lambda path: rewritten(path, tree_branch_first=np.zeros(0, dtype=int)), 'out of bounds'),
        (lambda path: rewritten(path, stiffness=np.ones(25)), 'not those that were written'),
        (lambda path: rewritten(path, extra=np.array([{}], dtype=object)), 'no prepared model'),
    ],
)  # fmt: skip
def test_a_damaged_file_is_refused(file, damage, named):
    damage(file)
    with pytest.raises(FormatError, match=named):
        read_model(file)


def test_branches_in_another_order_are_refused(tmp_path):
    path = tmp_path / 'goldcrest.npz'
    tree = open_tree('goldcrest').tree
    write_model(path, prepare(tree, model=0))
    last = tree.n_branches - 1
    # The last branch is put on one whose subtree ends before it.
    far = next(b for b in range(1, last) if tree.subtree_end[b] < last)
    edited(path, 'tree_segment_parent', tree.branch_first[last], tree.branch_first[far])
    with pytest.raises(FormatError, match='branches that are not in depth-first order'):
        read_model(path)


def test_a_file_that_would_fill_the_memory_is_refused(tmp_path, monkeypatch, little_effort):
    monkeypatch.setattr(model_file, 'LARGEST', 1 << 26)
    path = tmp_path / 'bomb.npz'
    header = {'descr': '<f8', 'fortran_order': False, 'shape': (1 << 24,)}
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        with archive.open('zeros.npy', 'w') as entry:
            np.lib.format.write_array_header_1_0(entry, header)
            for _ in range(128):
                entry.write(bytes(1 << 20))
    with pytest.raises(FormatError, match='128 MiB of arrays'):
        read_model(path)


def test_convert_writes_a_model_that_commands_open(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(['convert', 'benjamina', '-o', 'b.npz', '--model', '12']) == 0
    for name, more in (('b.npz', ['--model', '12']), ('benjamina', ['--model', '12'])):
        out = f'{name}.csv'
        assert main(['simulate', name, '--seconds', '0.5', '-o', out, *more]) == 0
    assert (tmp_path / 'b.npz.csv').read_text() == (tmp_path / 'benjamina.csv').read_text()
    capsys.readouterr()
    assert main(['info', 'b.npz']) == 0
    said = capsys.readouterr()
    assert 'prepared on model 12' in said.out
    assert 'benjamina' in said.out


def test_the_newest_models_of_files_are_kept(fork):
    models, arrays = PreparedModels(), prepare(fork(), model=4).arrays()
    for number in range(40):
        models.add(str(number), arrays)
    assert models.read('0') is None
    assert models.read('39') is arrays


def test_a_file_with_any_damaged_byte_is_refused_or_the_same(file):
    whole = file.read_bytes()
    rest = make_simulator(read_model(file)).place()
    for position in range(0, len(whole), len(whole) // 120):
        damaged = bytearray(whole)
        damaged[position] ^= 1 << (position % 8)
        file.write_bytes(damaged)
        with suppress(FormatError):
            assert (make_simulator(read_model(file)).place() == rest).all()


@pytest.mark.parametrize('name', ['branch_offset', 'segment_rest', 'stiffness', 'mass'])
def test_numbers_that_no_tree_has_are_refused_with_a_right_digest(fork, tmp_path, name):
    model = prepare(fork(), species_named('oak'))
    value = getattr(model, name)
    great = 1e308 if name == 'mass' else np.full_like(value, 1e308)
    write_model(tmp_path / 'a.npz', replace(model, **{name: great}))
    with pytest.raises(FormatError, match=f"'{name}': a number that no tree has"):
        read_model(tmp_path / 'a.npz')


def test_a_model_without_a_table_has_no_native_file(fork, tmp_path):
    with pytest.raises(ParameterError, match='has no table'):
        write_native_model(tmp_path / 'x.sway', make_simulator(fork(), model='branch').models[0])


def test_a_tree_is_no_model_to_write(fork, tmp_path):
    with pytest.raises(ParameterError, match='model'):
        write_model(tmp_path / 'tree.npz', fork())
