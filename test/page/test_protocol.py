# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The binary form: the vectors read in Python and in JavaScript, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path
import shutil
import struct
import subprocess
from typing import Any

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.model.state_basis import MARGIN
from tree_sway.errors import FormatError
from tree_sway.stream.placing import Placer
from tree_sway.stream.protocol import (
    BEYOND_SCALE,
    decode_description,
    decode_frame,
    encode_description,
    encode_frame,
    Frame,
    part_of_frame,
    quantised,
    WIND_UNIT,
)

HERE = Path(__file__).parent
VECTORS = HERE / 'vectors'


def vector(name: str) -> bytes:
    """Content of a test vector."""
    return (VECTORS / name).read_bytes()


EXPECTED: dict[str, Any] = json.loads(vector('expected.json'))


def test_a_frame_is_small() -> None:
    assert len(vector('frame0.bin')) == 28 + 2 * 15


@pytest.mark.parametrize('number', range(4))
def test_the_vectors_read_as_they_were_written(number: int) -> None:
    description = decode_description(vector('description.bin'))
    assert description.identity == EXPECTED['identity']
    frame, expected = decode_frame(vector(f'frame{number}.bin')), EXPECTED['frames'][number]
    assert frame.sequence == expected['sequence']
    assert frame.stamp == int(expected['stamp_ns'])
    assert frame.flags == expected['flags']
    np.testing.assert_allclose(frame.wind, expected['wind'], atol=0.5 * WIND_UNIT + 1e-9)
    poses, exact = (
        Placer(description).place(description.coordinates(frame)),
        np.array(expected['poses']),
    )
    np.testing.assert_allclose(poses[:, :3], exact[:, :3], atol=2e-6)
    dots = np.abs((poses[:, 3:] * exact[:, 3:]).sum(axis=1))
    np.testing.assert_allclose(dots, 1.0, atol=1e-6)


def test_javascript_reads_the_same_vectors() -> None:
    node = shutil.which('node')
    if node is None:
        pytest.skip('node is not installed here')
    command = [node, '--test', *map(str, sorted(HERE.glob('*.test.mjs')))]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_program_of_the_vectors_still_makes_such(tmp_path: Path) -> None:
    """The same arrays, whose poses are the solver's of today, whatever its law of bending."""
    source = (VECTORS / 'make_vectors.py').read_text(encoding='utf-8')
    names: dict[str, Any] = {'__file__': str(tmp_path / 'make_vectors.py'), '__name__': 'made'}
    exec(compile(source, 'make_vectors.py', 'exec'), names)
    names['main']()
    made = decode_description((tmp_path / 'description.bin').read_bytes())
    kept = decode_description(vector('description.bin'))
    assert made.header.keys() == kept.header.keys()
    assert {name: array.dtype for name, array in made.arrays.items()} == {
        name: array.dtype for name, array in kept.arrays.items()
    }
    expected = json.loads((tmp_path / 'expected.json').read_text(encoding='utf-8'))
    placer = Placer(made)
    for number, each in enumerate(expected['frames']):
        data = (tmp_path / f'frame{number}.bin').read_bytes()
        poses = placer.place(made.coordinates(decode_frame(data)))
        exact = np.array(each['poses'])
        np.testing.assert_allclose(poses[:, :3], exact[:, :3], atol=2e-6)


@given(
    wind=st.tuples(*[st.floats(-160.0, 160.0)] * 3),
    values=st.lists(st.integers(-32767, 32767), max_size=64),
    sequence=st.integers(0, 2**32 - 1),
    stamp=st.integers(-(2**63), 2**63 - 1),
)
def test_frames_come_back(
    wind: tuple[float, float, float], values: list[int], sequence: int, stamp: int
) -> None:
    frame = Frame(7, sequence, stamp, 0, np.array(wind), np.array(values, dtype='<i2'))
    back = decode_frame(encode_frame(frame))
    assert back[:4] == frame[:4]
    np.testing.assert_allclose(back.wind, wind, atol=0.5 * WIND_UNIT + 1e-9)
    np.testing.assert_array_equal(back.coordinates, values)


def test_turns_of_pulled_branches_are_added_where_they_belong() -> None:
    description = decode_description(vector('description.bin'))
    counts = [len(description.kinds[tree['kind']]['basis_matrix']) for tree in
              description.header['trees']]  # fmt: skip
    rest = decode_frame(vector('frame1.bin'))
    pairs = [2.0, 0.2, 3.0, -0.1, sum(counts[:2]) + 2.0, 0.2, 7.5, 1.0, 1e6, 1.0]
    data = encode_frame(rest._replace(beyond=np.array(pairs)))
    frame, placer = decode_frame(data), Placer(description)
    np.testing.assert_allclose(frame.beyond, pairs, rtol=1e-6)
    coordinates = description.coordinates(frame)
    poses = placer.place(np.concatenate([coordinates, frame.beyond]))
    before = placer.place(coordinates)
    n = len(poses) // 3
    moved = np.abs(poses - before).max(axis=1).reshape(3, n) > 1e-6
    assert moved[0].any()
    assert not moved[1].any()  # between keys, and beyond all, there is none
    assert moved[2].any()
    node = shutil.which('node')
    if node is not None:
        static = HERE.parents[1] / 'tree_sway' / 'page' / 'static'
        program = f"""
          import {{ Placer }} from "{(static / 'placing.js').as_uri()}";
          import {{ decodeDescription, decodeFrame }} from "{(static / 'protocol.js').as_uri()}";
          let text = "";
          for await (const chunk of process.stdin) text += chunk;
          const [described, frame] = JSON.parse(text).map((each) => Uint8Array.from(each).buffer);
          const description = decodeDescription(described);
          const {{ coordinates }} = decodeFrame(frame, description);
          console.log(JSON.stringify([...new Placer(description).place(coordinates)]));
        """
        given = json.dumps([list(vector('description.bin')), list(data)])
        done = subprocess.run(
            [node, '--input-type=module', '-e', program], input=given, text=True,
            capture_output=True, check=True, timeout=60,
        )  # fmt: skip
        theirs = np.array(json.loads(done.stdout)).reshape(-1, 8)
        np.testing.assert_allclose(theirs[:, :3], poses[:, :3], atol=2e-6)
    assert len(part_of_frame(data, 0, 10**6)) == 30 + 2 * len(coordinates)
    assert len(part_of_frame(data, 0, 0)) == 28
    with pytest.raises(FormatError, match='bytes'):
        decode_frame(data[:-3])
    with pytest.raises(FormatError, match='finite'):
        decode_frame(encode_frame(rest._replace(beyond=np.array([1.0, np.nan]))))


def test_what_is_cut_is_reported() -> None:
    steps, is_cut = quantised([0.5, -3.0], [1.0, 1.0])
    assert is_cut
    assert steps.tolist() == [16384, -32767]
    storm = Frame(0, 0, 0, 0, np.array([400.0, 0.0, 0.0]), steps)
    assert decode_frame(encode_frame(storm)).flags == BEYOND_SCALE
    turned = storm._replace(wind=np.zeros(3), beyond=np.array([3.0, 1e39, 4.0, -np.inf]))
    frame = decode_frame(encode_frame(turned))
    assert frame.flags == BEYOND_SCALE
    assert frame.beyond[1] == -frame.beyond[3] == pytest.approx(3.4e38, rel=0.01)
    assert not quantised([0.1, -0.99 / MARGIN], [1.0, 1.0])[1]
    assert quantised([0.1, -1.01 / MARGIN], [1.0, 1.0])[1]


@given(st.binary(max_size=200))
def test_random_bytes_are_refused(data: bytes) -> None:
    with pytest.raises(FormatError):
        decode_description(data)
    with pytest.raises(FormatError):
        decode_frame(b'\0' + data)


def test_a_changed_or_newer_description_is_refused() -> None:
    whole = vector('description.bin')
    changed = bytearray(whole)
    changed[-20] ^= 1
    with pytest.raises(FormatError, match='identity'):
        decode_description(bytes(changed))
    newer = whole[:4] + struct.pack('<I', 3) + whole[8:]
    with pytest.raises(FormatError, match='version 3'):
        decode_description(newer)
    with pytest.raises(FormatError):
        decode_description(whole[:-9])


def test_a_frame_of_another_tree_is_refused() -> None:
    description = decode_description(vector('description.bin'))
    other = decode_frame(vector('frame0.bin'))._replace(identity=1)
    with pytest.raises(FormatError, match='description 00000001'):
        description.coordinates(other)


def test_a_description_with_an_array_missing_is_refused() -> None:
    description = decode_description(vector('description.bin'))
    arrays = {name: value for name, value in description.arrays.items() if name != '1/branch_skew'}
    with pytest.raises(FormatError, match='branch_skew'):
        Placer(decode_description(encode_description(description.header, arrays)))
