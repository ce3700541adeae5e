# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import io
import struct

import numpy as np
import pytest
from scipy.io import savemat
from scipy.sparse import csr_matrix

from tree_sway.errors import FormatError
from tree_sway.files.trees.cylinders.mat_file import numbers, read_mat


@pytest.fixture
def file(tmp_path):
    return tmp_path / 'a.mat'


def mat_bytes(content, compressed=False):
    stream = io.BytesIO()
    savemat(stream, content, do_compression=compressed)
    return stream.getvalue()


@pytest.mark.parametrize('compressed', [False, True])
def test_numbers_and_structs(file, compressed):
    arrays = {kind: np.arange(6).reshape(2, 3).astype(kind)
              for kind in ('f8', 'f4', 'u1', 'i2', 'u4', 'i8')}  # fmt: skip
    inside = {'field': arrays['f8'], 'other': 'y'}
    content = {**arrays, 'text': 'x', 's': inside, 'cells': np.array([inside, inside])}
    savemat(file, content, do_compression=compressed)
    variables = read_mat(file)
    assert list(variables) == [*arrays, 's', 'cells']
    for kind, array in arrays.items():
        np.testing.assert_array_equal(numbers(variables[kind], kind), array.astype(float))
    np.testing.assert_array_equal(variables['s']['field'], arrays['f8'])
    np.testing.assert_array_equal(variables['cells']['1']['field'], arrays['f8'])
    with pytest.raises(FormatError, match="'s' is not numeric"):
        numbers(variables['s'], 's')


def test_what_is_not_read_is_passed_over(file):
    sparse = csr_matrix(np.eye(3))
    savemat(file, {'s': sparse, 'a': np.ones(2), 'b': {'s': sparse, 'c': np.ones(3)}})
    variables = read_mat(file)
    assert list(variables) == ['a', 'b']
    assert list(variables['b']) == ['c']


def damaged():
    struct_of = {'s': {'a': np.arange(3.0), 'b': np.arange(3.0)}}
    complex_in_part = bytearray(mat_bytes(struct_of))
    at = complex_in_part.index(struct.pack('<4I', 6, 8, 6, 0))
    complex_in_part[at + 9] = 0x08
    whole, packed = mat_bytes(struct_of), mat_bytes(struct_of, compressed=True)
    return {
        'complex without its second part': bytes(complex_in_part),
        'cut': whole[:200],
        'cut when packed': packed[:-20],
        'a header alone': whole[:128][:100],
        'text': b'x' * 200,
    }


@pytest.mark.parametrize('name', damaged())
def test_a_damaged_file_ends_another_process_at_most(file, name):
    """Some of them end the process that scipy reads them in."""
    file.write_bytes(damaged()[name])
    with pytest.raises(FormatError, match='not a MATLAB file that can be read'):
        read_mat(file)


def test_cells_in_cells_without_end(file):
    def element(kind, body):
        return struct.pack('<II', kind, len(body)) + body + b'\0' * (-len(body) % 8)

    def array(kind, inside, name=b'', count=1):
        head = element(6, struct.pack('<II', kind, 0)) + element(5, struct.pack('<2i', 1, count))
        return element(14, head + element(1, name) + inside)

    inside = leaf = array(6, element(9, bytes(8)))
    for _ in range(200):
        inside = array(1, inside + leaf, count=2)
    file.write_bytes(mat_bytes({})[:128] + array(1, inside, b'QSM'))
    with pytest.raises(FormatError, match='nested deeper than 8'):
        read_mat(file)
