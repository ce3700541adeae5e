# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import io
import os
import struct
import zlib

import numpy as np
import pytest
from scipy.io import savemat
from scipy.sparse import csr_matrix

from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.trees.cylinders import mat_file
from tree_sway_ros.files.trees.cylinders.mat_file import numbers, read_mat


@pytest.fixture
def file(tmp_path):
    return tmp_path / 'a.mat'


def mat_bytes(content, compressed=False):
    stream = io.BytesIO()
    savemat(stream, content, do_compression=compressed)
    return stream.getvalue()


@pytest.mark.parametrize('compressed', [False, True])
@pytest.mark.parametrize('kind', ['f8', 'f4', 'u1', 'i2', 'u4', 'i8'])
def test_numbers_and_structs(file, compressed, kind):
    array = np.random.default_rng(1).uniform(0, 100, (2, 3)).astype(kind)
    inside = {'field': array, 'other': 'y'}
    savemat(file, {'a': array, 'text': 'x', 's': inside, 'cells': np.array([inside, inside])},
            do_compression=compressed)  # fmt: skip
    variables = read_mat(file)
    assert list(variables) == ['a', 'text', 's', 'cells']
    np.testing.assert_array_equal(numbers(variables['a'], 'a'), array.astype(float))
    np.testing.assert_array_equal(variables['s']['field'], array)
    np.testing.assert_array_equal(variables['cells'][1]['field'], array)
    with pytest.raises(FormatError, match="'text' is not numeric"):
        numbers(variables['text'], 'text')


def test_what_is_not_read_is_passed_over(file):
    sparse = csr_matrix(np.eye(3))
    savemat(file, {'s': sparse, 'a': np.ones(2), 'b': {'s': sparse, 'c': np.ones(3)}})
    variables = read_mat(file)
    assert list(variables) == ['a', 'b']
    assert variables['b']['s'].size == 0
    np.testing.assert_array_equal(variables['b']['c'], [[1, 1, 1]])


def test_a_complex_array_without_its_second_part(file):
    """On which scipy reads a type that it has no table for, and ends the process."""
    content = bytearray(mat_bytes({'s': {'a': np.arange(3.0), 'b': np.arange(3.0)}}))
    at = content.index(struct.pack('<4I', 6, 8, 6, 0))
    content[at + 9] = 0x08
    file.write_bytes(bytes(content))
    with pytest.raises(FormatError, match='numbers that are not 3 of a known type'):
        read_mat(file)


@pytest.mark.parametrize('compressed', [False, True])
def test_cut_anywhere(file, compressed):
    content = mat_bytes({'s': {'a': np.arange(3.0), 'b': 'x'}}, compressed)
    for end in range(129, len(content)):
        file.write_bytes(content[:end])
        with pytest.raises(FormatError, match='not a MATLAB file that can be read'):
            read_mat(file)


def test_other_files(file):
    file.write_bytes(b'x' * 200)
    with pytest.raises(FormatError, match='no header of a MATLAB file'):
        read_mat(file)


def test_a_bomb_is_not_unpacked(file, monkeypatch):
    monkeypatch.setattr(mat_file, 'MAX_BYTES', 1 << 20)
    bomb = zlib.compress(b'\0' * (8 << 20))
    file.write_bytes(mat_bytes({})[:128] + struct.pack('<II', 15, len(bomb)) + bomb)
    with pytest.raises(FormatError, match='variables larger than 1 MiB'):
        read_mat(file)


def element(kind, body):
    return struct.pack('<II', kind, len(body)) + body + b'\0' * (-len(body) % 8)


def array(kind, shape, name, inside):
    head = element(6, struct.pack('<II', kind, 0)) + element(5, struct.pack('<2i', *shape))
    return element(14, head + element(1, name) + inside)


@pytest.mark.parametrize('shape', [(1 << 15, 1 << 15), (-1, 4), (1 << 30, 1)])
def test_a_claim_of_a_thousand_million_cells(file, shape):
    cells = array(1, shape, b'models', array(6, (1, 1), b'', element(9, bytes(8))))
    file.write_bytes(mat_bytes({})[:128] + cells)
    with pytest.raises(FormatError, match=r'an array of -?[0-9]+ elements in 112 bytes'):
        read_mat(file)


def test_cells_in_cells_without_end(file):
    inside = array(6, (1, 1), b'', element(9, bytes(8)))
    for _ in range(5000):
        inside = array(1, (1, 1), b'', inside)
    file.write_bytes(mat_bytes({})[:128] + inside)
    with pytest.raises(FormatError, match='nested deeper than 8'):
        read_mat(file)


class TestVersion73:
    """Files of version 7.3, which are HDF5."""

    @pytest.fixture
    def h5py(self):
        return pytest.importorskip('h5py', reason='h5py is not installed')

    def test_two_kilobytes_that_claim_gigabytes(self, h5py, file):
        with h5py.File(file, 'w') as stream:
            stream.create_dataset('QSM/cylinder/radius', (530_000_000,), 'f8')  # never written
        assert file.stat().st_size < 4096
        with pytest.raises(FormatError, match='530000000 values, more than the file can hold'):
            read_mat(file)

    def test_many_names_of_one_dataset(self, h5py, file):
        with h5py.File(file, 'w') as stream:
            stream.create_dataset('a', data=np.zeros(100_000), chunks=True, compression='gzip')
            for i in range(200):
                stream[f'b{i}'] = stream['a']
        with pytest.raises(FormatError, match='more than the file can hold'):
            read_mat(file)

    def test_another_file_is_not_followed(self, h5py, file, tmp_path):
        (tmp_path / 'secret').write_bytes(np.arange(4.0).tobytes())
        with h5py.File(file, 'w') as stream:
            stream.create_dataset('a', (4,), 'f8', external=[(str(tmp_path / 'secret'), 0, 32)])
        with pytest.raises(FormatError, match='/a is stored in another file'):
            read_mat(file)
        with h5py.File(tmp_path / 'other.h5', 'w') as stream:
            stream['b'] = np.ones(3)
        with h5py.File(file, 'w') as stream:
            stream['link'] = h5py.ExternalLink(os.fspath(tmp_path / 'other.h5'), 'b')
            stream['own'] = np.ones(3)
        assert list(read_mat(file)) == ['own']

    def test_a_group_inside_itself(self, h5py, file):
        with h5py.File(file, 'w') as stream:
            group = stream.create_group('a')
            group['a'] = group
        with pytest.raises(FormatError, match='nested deeper than 8'):
            read_mat(file)
