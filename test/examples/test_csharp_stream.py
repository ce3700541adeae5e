# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The reader of the stream in C# places trees where the Python client has them, frame by frame.

A damaged message is refused by name.
"""

from __future__ import annotations

from pathlib import Path
import shutil
import subprocess
import threading
import time

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway.core.native.library import FILE  # noqa: E402
from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.stream.client import StreamClient  # noqa: E402
from tree_sway.stream.placing import Placer  # noqa: E402
from tree_sway.stream.protocol import (  # noqa: E402
    decode_description,
    encode_description,
    encode_frame,
    Frame,
    part_of_frame,
    PAUSED,
    RESTARTED,
)

ROOT = Path(__file__).parents[2]
SOURCES = (
    ROOT / 'examples' / 'native' / 'SwayStream.cs',
    Path(__file__).with_name('stubs') / 'stream.cs',
)
VECTORS = ROOT / 'test' / 'page' / 'vectors'
DESCRIPTION = (VECTORS / 'description.bin').read_bytes()
TREES = decode_description(DESCRIPTION)
COUNT = 40
"""Frames that the program reads."""
DEADLINE = 60.0


@pytest.fixture(scope='module')
def program(tmp_path_factory):
    """Compile the reader, and return the command that runs it and its folder."""
    compiler, runtime = shutil.which('mcs'), shutil.which('mono')
    if compiler is None or runtime is None:
        pytest.skip('no Mono')
    if not SOURCES[0].is_file():
        pytest.skip('the examples are not here')
    folder = tmp_path_factory.mktemp('stream')
    shutil.copy(FILE, folder / 'libsway.so')
    made = folder / 'program.exe'
    command = [compiler, '-warnaserror', *map(str, SOURCES), f'-out:{made}']
    subprocess.run(command, check=True, timeout=120)
    return [runtime, str(made)], folder


def answer_of(program, *arguments):
    """Run the program, and return its lines."""
    command, folder = program
    environment = {'LD_LIBRARY_PATH': str(folder), 'PATH': '/usr/bin:/bin'}
    done = subprocess.run(
        [*command, *arguments], env=environment, capture_output=True, text=True, timeout=DEADLINE
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def frame_of(number, flags=0):
    """Return a frame of trees that sway, and are pulled at in every second one."""
    n = len(TREES.scale)
    steps = np.rint(9000.0 * np.sin(0.2 * number + np.arange(n))).astype(np.int16)
    pulls = np.array([3.0, 0.2, 41.0, -0.1, 70.0, 0.3]) if number % 2 else np.zeros(0)
    wind = np.array([3.0, 0.0, 0.0])
    head = TREES.short_identity, number, time.time_ns(), flags, wind, steps
    return encode_frame(Frame(*head, beyond=pulls))


def test_poses_are_those_of_the_python_client(program):
    server = PageServer(PageSettings(port=0))
    server.start()
    server.describe(DESCRIPTION)
    ended = threading.Event()

    def send():
        number = 0
        while not ended.wait(1.0 / 60.0):
            server.publish(frame_of(number, RESTARTED if number % 5 == 0 else 0))
            number += 1

    sender = threading.Thread(target=send, daemon=True)
    sender.start()
    frames = {}

    def note(frame, _):
        frames[frame.sequence] = frame

    try:
        with StreamClient(server.url, rate=60.0, on_frame=note) as client:
            client.wait(DEADLINE)
            lines = answer_of(program, server.url.replace('http', 'ws') + 'stream', str(COUNT))
            description = client.description
    finally:
        ended.set()
        sender.join()
        server.close()
    assert description is not None
    placer = Placer(description)
    assert len(lines) == COUNT
    numbers, moved = [], []
    for line in lines:
        sequence, stamp, flags, *poses = line.split()
        frame = frames.get(int(sequence))
        numbers.append(int(sequence))
        if frame is None:
            continue
        assert (int(stamp), int(flags)) == (frame.stamp, frame.flags)
        coordinates = np.concatenate([description.coordinates(frame), frame.beyond])
        found = np.array(poses, dtype=float).reshape(-1, 7)
        exact = placer.place(coordinates)
        np.testing.assert_allclose(found, exact, atol=1e-5)
        moved.append(found)
    assert (np.diff(numbers) > 0).all()
    assert len(moved) >= 30
    assert np.ptp(np.array(moved), axis=0).max() > 0.1


def changed(name, row, value):
    """Describe the trees with one number of an array changed."""
    array = TREES.arrays[name].copy()
    array.reshape(len(array), -1)[row, 0] = value
    return encode_description(TREES.header, {**TREES.arrays, name: array})


def damages():
    """Yield messages that are not sound, each with what its refusal names."""
    least, most = -(2**31), 2**31 - 1
    for name, values in {
        'branch_parent': (least, -1, 1, most),
        'branch_base_segment': (least, -1, 15, most),
        'branch_first': (least, 0, 100, most),
        'branch_coordinate': (least, -1, 27, most),
        'branch_base_turn': (least, -1, 139, most),
        'branch_turn': (least, -2, 139, most),
        'branch_keys': (0, 1),
        'branch_frame': (np.nan, np.inf, 1e19),
        'segment_rest': (np.nan, -np.inf),
        'turn': (np.nan,),
        'basis_matrix': (np.inf,),
        'basis_scale': (0.0, -1.0, np.nan),
    }.items():
        for value in values:
            yield name, changed(f'0/{name}', 1, value)
    # No longer as many keys as rows of the basis.
    yield 'basis_matrix', changed('0/branch_keys', 1, 255)
    yield 'tree_place', changed('tree_place', 0, np.nan)
    still = TREES.arrays['tree_place'] * np.float32(0.0)
    yield 'tree', encode_description(TREES.header, {**TREES.arrays, 'tree_place': still})
    # Of two arrays that disagree either is named: both are of branches, segments or the basis.
    for name, array in TREES.arrays.items():
        group = name.rpartition('/')[2].partition('_')[0]
        for other in (array[:-1], array[..., None], array.astype(np.int16), array[:0]):
            if group != 'leaf' and (name, other.dtype) != ('1/turn', np.int16):
                groups = {'branch': ('branch', 'basis'), 'segment': ('segment', 'branch')}
                message = encode_description(TREES.header, {**TREES.arrays, name: other})
                yield groups.get(group, group), message
    for kind in (-1, 2, 2**31, 0.5, True, None, '0', []):
        header = {**TREES.header, 'trees': [{'name': 'tree', 'kind': kind}] * 3}
        yield 'tree', encode_description(header, TREES.arrays)
    head = DESCRIPTION[:8]
    yield 'beginning', b'TSWX' + DESCRIPTION[4:]
    yield 'beginning', DESCRIPTION[:11]
    yield 'version', head[:4] + b'\3' + DESCRIPTION[5:]
    for size in (b'\xff\xff\xff\xff', b'\xff\xff\xff\x7f', b'\0\0\0\1'):
        yield 'size of a header', head + size + DESCRIPTION[12:]
    yield 'identity', head + b'\0\0\0\0' + DESCRIPTION[12:]
    for size in (12, 200, 2000, len(DESCRIPTION) // 2, len(DESCRIPTION) - 20):
        yield ': ', DESCRIPTION[:size]


def refused_frames():
    """Yield frames that do not belong to the trees, each with what its refusal names."""
    whole = frame_of(1)
    yield 'version', whole[:1] + b'\2' + whole[2:]
    yield 'length', whole[:-1]
    yield 'length', whole[:40]
    yield 'length', whole[:26] + b'\xff\xff' + whole[28:]
    yield 'length', whole[:26] + b'\1\0' + whole[28:30]
    yield 'rotation', whole[:-4] + np.array(np.nan, dtype='<f4').tobytes()


def test_a_damaged_message_is_refused_by_name(program, tmp_path):
    wanted = []

    def add(message, answer):
        (tmp_path / f'{len(wanted):04}').write_bytes(message)
        wanted.append((answer,) if isinstance(answer, str) else answer)

    for name, message in damages():
        add(message, name)
        # Nothing is placed by what was refused.
        add(frame_of(0), 'False')
    add(DESCRIPTION, 'False')
    for name, message in refused_frames():
        add(message, name)
        add(DESCRIPTION, 'False')
    add(part_of_frame(frame_of(0), 2, 3), 'False')
    add(part_of_frame(frame_of(0), 0, 0), 'False')
    add(frame_of(0)[:4] + b'\0\0\0\0' + frame_of(0)[8:], 'False')
    # Numbers of keys that no tree has, as for the Python client, pull at nothing.
    add(frame_of(1)[:-8] + np.array([9e9, 1.0], dtype='<f4').tobytes(), 'True')
    add(frame_of(0, PAUSED), 'True')
    lines = answer_of(program, str(tmp_path))
    assert len(lines) == len(wanted) > 100
    for line, answers in zip(lines, wanted, strict=True):
        assert any(answer in line for answer in answers), (line, answers)
        is_refusal = answers[0] not in {'True', 'False'}
        assert is_refusal is not line.endswith((' True', ' False'))


def test_no_flipped_bits_end_the_program(program, tmp_path):
    rng = np.random.default_rng(4)
    for number in range(200):
        message = bytearray(DESCRIPTION if number % 2 else DESCRIPTION[:6000])
        for place in rng.integers(12, len(message), 3):
            message[place] ^= 1 << rng.integers(8)
        (tmp_path / f'{number:04}a').write_bytes(message)
        (tmp_path / f'{number:04}b').write_bytes(frame_of(number))
    assert len(answer_of(program, str(tmp_path))) == 400
