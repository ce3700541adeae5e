import io
import zlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import savemat

from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.trees.cylinders import mat5
from tree_sway_ros.files.trees.cylinders.mat5 import read_mat5


def mat_bytes(content, compressed=False):
    stream = io.BytesIO()
    savemat(stream, content, do_compression=compressed)
    return stream.getvalue()


@pytest.mark.parametrize("compressed", [False, True])
@settings(deadline=None, max_examples=40)
@given(
    kind=st.sampled_from(["f8", "f4", "u1", "i1", "u2", "i2", "u4", "i4", "i8", "u8"]),
    shape=st.lists(st.integers(1, 4), min_size=2, max_size=3),
    seed=st.integers(0, 1000),
)
def test_what_scipy_writes_is_read(compressed, kind, shape, seed):
    array = np.random.default_rng(seed).uniform(0, 100, shape).astype(kind)
    content = mat_bytes({"a": array, "text": "x", "s": {"field": array, "other": "y"}}, compressed)
    variables = read_mat5(content)
    assert list(variables) == ["a", "text", "s"]
    np.testing.assert_array_equal(variables["a"].numbers(), array.astype(float))
    (fields,) = variables["s"].structs()
    np.testing.assert_array_equal(fields["field"].numbers(), array.astype(float))
    assert list(variables["a"].structs()) == []


def test_big_endian():
    little = mat_bytes({"a": np.array([[1.5, -2.0]])})
    words = np.frombuffer(little[128:], dtype="<u4").copy()
    big = bytearray(little[:124] + b"\x01\x00MI")
    # Tag, flags, shape and tags are words; the name is bytes; the numbers are of eight.
    big += words[:10].astype(">u4").tobytes()
    big += (1 << 16 | 1).to_bytes(4, "big") + b"a\0\0\0"
    big += words[12:14].astype(">u4").tobytes() + np.array([1.5, -2.0], dtype=">f8").tobytes()
    np.testing.assert_array_equal(read_mat5(bytes(big))["a"].numbers(), [[1.5, -2.0]])


@pytest.mark.parametrize("compressed", [False, True])
def test_cut_anywhere(compressed):
    content = mat_bytes({"s": {"a": np.arange(3.0), "b": "x"}}, compressed)
    for end in range(129, len(content)):
        with pytest.raises(FormatError):
            _ = [
                field.numbers()
                for s in read_mat5(content[:end])["s"].structs()
                for field in s.values()
            ]


def test_other_files_and_other_classes():
    with pytest.raises(FormatError, match="no header of a MATLAB file"):
        read_mat5(b"x" * 200)
    with pytest.raises(FormatError, match="'text' is not numeric"):
        read_mat5(mat_bytes({"text": "x"}))["text"].numbers()


def test_a_bomb_is_not_unpacked(monkeypatch):
    monkeypatch.setattr(mat5, "MAX_BYTES", 1 << 20)
    header = mat_bytes({})[:128]
    bomb = zlib.compress(b"\0" * (8 << 20))
    content = header + np.array([15, len(bomb)], dtype="<u4").tobytes() + bomb
    with pytest.raises(FormatError, match="a variable larger than 1 MiB"):
        read_mat5(content)
