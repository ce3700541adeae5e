# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The functions of the native core are called as its headers declare them."""

from __future__ import annotations

import ctypes
import math
import re
import zlib

from native_headers import fields_of, HEADER, LIBRARY_HEADER, NATIVE
import numpy as np
import pytest

from tree_sway.core.model.branch_blocks import BRANCH_BLOCK
from tree_sway.core.model.sway_model import MEANINGS, TYPES
from tree_sway.core.native.library import contiguous, INTERFACE, LIBRARY, SIGNATURES, VERSION
from tree_sway.core.native.model import Sizes
from tree_sway.core.native.stand import _TREE
from tree_sway.core.native.structures import Structure
from tree_sway.core.setup.wind_moments import BRANCH_LOAD, Branches

pytestmark = pytest.mark.skipif(not NATIVE.is_dir(), reason='the sources are not here')


def kind(declared: str) -> object:
    """Return the type of ctypes of a result or an argument as it is declared."""
    words = re.sub(r'\b(const|struct)\b', '', declared).strip()
    if words == 'const char *' or (words.startswith('char') and words.endswith('*')):
        return 'text'
    if '*' in words or '[' in words:
        return ctypes.c_void_p
    named = {
        'int': ctypes.c_int, 'size_t': ctypes.c_size_t, 'double': ctypes.c_double,
        'int64_t': ctypes.c_int64, 'uint32_t': ctypes.c_uint32,
    }  # fmt: skip
    return named.get(words.split()[0]) if words.split()[0] != 'void' else None


def declared() -> dict[str, tuple[object, list[object]]]:
    """Return result and arguments of every function of the headers."""
    found = {}
    pattern = r'SWAY_API\s+([\w\s*]+?)(\bsway_\w+)\(([^)]*)\)'
    for result, name, given in re.findall(pattern, HEADER + LIBRARY_HEADER):
        arguments = [] if given.strip() == 'void' else given.split(',')
        found[name] = kind(result), [kind(each) for each in arguments]
    return found


def test_every_function_is_called_as_it_is_declared() -> None:
    functions = declared()
    assert functions.keys() == SIGNATURES.keys()
    for name, (result, arguments) in functions.items():
        own_result, own_arguments = SIGNATURES[name]
        of_text = [ctypes.c_void_p if each == 'text' else each for each in arguments]
        assert list(own_arguments) == of_text, name
        assert own_result == (ctypes.c_char_p if result == 'text' else result), name


def test_a_library_of_other_headers_is_not_used() -> None:
    headers = b''.join((NATIVE / name).read_bytes() for name in ('sway.h', 'library.h'))
    assert hex(INTERFACE) == hex(zlib.crc32(headers)), 'write it to library.py, and build again'
    assert LIBRARY.sway_interface() == INTERFACE


def test_version_and_structures_are_those_of_the_header() -> None:
    assert f'#define SWAY_VERSION {VERSION}\n' in HEADER
    assert LIBRARY.sway_version() == VERSION
    body = HEADER.partition('struct sway_sizes {')[2].partition('}')[0]
    assert [name for name, _ in Sizes._fields_] == re.findall(r'int64_t (\w+);', body)
    body = HEADER.partition('struct sway_tree {')[2].partition('}')[0]
    assert list(_TREE.names or ()) == re.findall(r'\b(\w+)(?:\[3\])?;', body)
    assert _TREE.itemsize == 8 * 7


def test_structures_of_branches_are_those_of_the_header() -> None:
    number = r'(?:int64_t|double) \*?(\w+)((?:\[\d+\])*);'
    for name, layout in (('branch_load', BRANCH_LOAD), ('branch_block', BRANCH_BLOCK)):
        body = LIBRARY_HEADER.partition(f'struct sway_{name} {{')[2].partition('}')[0]
        fields = re.findall(number, body)
        assert [field for field, _ in fields] == list(layout.names or ())
        sizes = [math.prod(map(int, re.findall(r'\d+', size))) for _, size in fields]
        assert sizes == [layout[field].itemsize // 8 for field, _ in fields]
    body = LIBRARY_HEADER.partition('struct sway_branches {')[2].partition('}')[0]
    assert [field for field, _ in re.findall(number, body)] == [
        field for field, _ in Branches._fields_
    ]


def test_structures_are_those_of_the_header() -> None:
    structures = Structure.__subclasses__()
    assert len(structures) == 8
    for each in structures:
        name = each.__name__.replace('Native', 'sway_').lower()
        own = [(field, kind is ctypes.c_double, 1) for field, kind in each._fields_]
        assert own == fields_of(name), name


def test_the_list_of_arrays_is_that_of_the_model() -> None:
    text = (NATIVE / 'arrays.inc').read_text(encoding='utf-8')
    rows = re.findall(r'SWAY_ARRAY\((\w+), (\w+), (\w+), ([^)]*)\)', text)
    listed = {name: (of, sizes.split(', ')) for of, name, group, sizes in rows}
    named = {'double': 'float64', 'float': 'float32', 'int64_t': 'int64'}
    for name, meaning in MEANINGS.items():
        of, sizes = listed[name]
        assert named[of] == TYPES[name].__name__
        assert len(sizes) == len(meaning.shape)
        for size, wanted in zip(sizes, meaning.shape, strict=True):
            if size != 'SIZE_any':
                own = size.removeprefix('SIZE_').replace('_plus_', ' + ')
                assert own == str(wanted), name


def test_a_history_without_room_is_left_alone() -> None:
    wanted, wind, out = np.ones(2), np.ones(3), np.full((2, 3), 7.0)
    past = np.full(2, 5.0)
    LIBRARY.sway_past_winds(
        contiguous(past), 0, 0.0, contiguous(wanted), contiguous(wanted.copy()), 2, 1.0,
        contiguous(wind), 0.02, contiguous(out),
    )  # fmt: skip
    assert (past == 5.0).all()
    assert (out == 7.0).all()


@pytest.mark.parametrize('array', [np.zeros((4, 4))[:, :2], np.zeros((2, 4))])
def test_an_array_that_is_not_in_a_row_or_of_another_shape_is_refused(array) -> None:
    with pytest.raises(ValueError, match='an array of shape'):
        contiguous(array, (4, 2))
