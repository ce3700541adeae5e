# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Descriptions with one number wrong: refused in Python and in JavaScript before any placing."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
import resource
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

from tree_sway.core.species.species import species_keys, species_named
from tree_sway.errors import FormatError
from tree_sway.stream.placing import Placer
from tree_sway.stream.protocol import decode_description, encode_description

HERE = Path(__file__).parent
STATIC = HERE.parents[1] / 'tree_sway' / 'page' / 'static'
WHOLE = decode_description((HERE / 'vectors' / 'description.bin').read_bytes())
LIMIT_TIME, LIMIT_MEMORY = 5.0, 2**30
"""What reading a hostile description may cost in [s] and [bytes]."""

INDICES = (
    'branch_parent', 'branch_base_segment', 'branch_first', 'branch_coordinate',
    'branch_base_turn', 'branch_turn', 'leaf_segment',
)  # fmt: skip


def damaged(name: str, array: Any) -> bytes:
    """Describe the same trees with another array under a name."""
    return encode_description(WHOLE.header, {**WHOLE.arrays, name: array})


def with_value(name: str, value: float) -> bytes:
    """Describe the same trees with one number of an array changed."""
    array = WHOLE.arrays[name].copy()
    array.reshape(len(array), -1)[1, 0] = value
    return damaged(name, array)


def with_header(**changes: Any) -> bytes:
    """Describe the same trees with entries of the header changed."""
    return encode_description({**WHOLE.header, **changes}, WHOLE.arrays)


def damages() -> Iterator[tuple[str, bytes]]:
    """Every damage by name."""
    for name, array in WHOLE.arrays.items():
        yield f'{name} is one row short', damaged(name, array[:-1])
        yield f'{name} has one axis more', damaged(name, array[..., None])
        yield f'{name} of another type', damaged(name, array.astype(np.int16))
        if array.dtype == '<f4':
            for value in (np.nan, np.inf):
                yield f'{name} of {value}', with_value(name, value)
    for name in INDICES:
        for value in (2**31 - 1, -(2**31), -1, 100_000):
            yield f'{name} of {value}', with_value(f'0/{name}', value)
    for value in (0, 1, 255):
        yield f'branch_keys of {value}', with_value('0/branch_keys', value)
    # As many rows as the other array has ends, no more, whoever points into it.
    for name, value in (
        ('branch_turn', 139),
        ('branch_base_turn', 139),
        ('branch_coordinate', 27),
    ):
        yield f'{name} just beyond', with_value(f'0/{name}', value)
    yield 'a branch that carries itself', with_value('0/branch_parent', 1)
    yield (
        'branches that carry each other',
        damaged('0/branch_parent', np.array([-1, 2, 1, 0], dtype=np.int32)),
    )
    yield (
        'a branch without segments',
        damaged('0/branch_first', np.array([0, 5, 5, 12, 16], dtype=np.int32)),
    )
    yield 'a tree of no size', damaged('tree_place', 0.0 * WHOLE.arrays['tree_place'])
    yield 'a scale of 0', with_value('0/basis_scale', 0.0)
    others: tuple[Any, ...] = (-1, 2, 2**31, 0.5, True, None, '0', [], 10**400)
    for kind in others:
        trees = [{'name': 'tree', 'kind': kind}] * 3
        yield f'a tree of kind {str(kind)[:9]}', with_header(trees=trees)
    others = (None, 1, [], {}, [[]], [None])
    for name in ('name', 'frame_id', 'kinds', 'trees'):
        for other in others:
            yield f'{name} of {other!r}', with_header(**{name: other})
    kinds = WHOLE.header['kinds']
    others = (None, [1], 10**400)
    for name in kinds[0]:
        for other in others:
            entry: Any = {**kinds[0], name: other}
            yield f'{name} of {str(other)[:9]}', with_header(kinds=[entry, kinds[1]])
    oak = species_named('oak')
    look = oak.look.described(oak.leaves, oak.habit)
    for name in ('green', 'leaf_size', 'spray', 'has_needles'):
        for other in others:
            entry = {**kinds[0], 'look': {**look, name: other}}
            yield f'look with {name} of {str(other)[:9]}', with_header(kinds=[entry, kinds[1]])
    yield 'leaves without a law', with_header(flutter={'gain': None})


def of_still_trees() -> bytes:
    """Describe trees that do not move: no coordinates, no leaves, no turns of the first kind."""
    arrays = {}
    for name, array in WHOLE.arrays.items():
        if name.endswith('basis_matrix'):
            arrays[name] = array[:, :0]
        elif name.endswith('basis_scale'):
            arrays[name] = array[:0]
        elif 'leaf' not in name:
            arrays[name] = array
    return encode_description(WHOLE.header, arrays)


DAMAGES = dict(damages())
_LOOKS = [species_named(key) for key in species_keys()]
SOUND = {
    'trees that do not move': of_still_trees(),
    **{
        f'a look of {each.key}': with_header(
            kinds=[
                {**kind, 'look': each.look.described(each.leaves, each.habit)}
                for kind in WHOLE.header['kinds']
            ]
        )
        for each in _LOOKS
    },
}


@pytest.fixture(scope='module')
def answers(
    javascript: Callable[..., Any], tmp_path_factory: pytest.TempPathFactory
) -> dict[str, str]:
    """Return what JavaScript says of each."""
    folder = tmp_path_factory.mktemp('damaged')
    for number, data in enumerate([*DAMAGES.values(), *SOUND.values()]):
        (folder / f'{number}.bin').write_bytes(data)
    program = f"""
      import {{ readFileSync }} from "node:fs";
      import {{ decodeDescription, ProtocolError }} from "{(STATIC / 'protocol.js').as_uri()}";
      const answers = [];
      for (let i = 0; i < {len(DAMAGES) + len(SOUND)}; i++) {{
        const bytes = readFileSync(`{folder}/${{i}}.bin`);
        try {{
          decodeDescription(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
          answers.push("");
        }} catch (error) {{
          answers.push(error instanceof ProtocolError ? error.message : `raw ${{error.stack}}`);
        }}
      }}
      console.log(JSON.stringify(answers));
    """
    return dict(zip([*DAMAGES, *SOUND], javascript(program), strict=True))


def is_read(data: bytes) -> bool:
    """Whether a description is read, and not refused."""
    try:
        decode_description(data)
    except FormatError:
        return False
    return True


def test_a_damaged_description_is_refused() -> None:
    assert [damage for damage, data in DAMAGES.items() if is_read(data)] == []


def test_a_damaged_description_is_refused_in_javascript(answers: dict[str, str]) -> None:
    said = {damage: answers[damage] for damage in DAMAGES}
    assert {damage: why for damage, why in said.items() if not why or why.startswith('raw')} == {}


@pytest.mark.parametrize('name', SOUND)
def test_a_sound_description_is_read_in_both(name: str, answers: dict[str, str]) -> None:
    description = decode_description(SOUND[name])
    assert np.isfinite(Placer(description).place(description.scale)).all()
    assert answers[name] == ''


def test_every_array_is_checked_for_its_numbers() -> None:
    """No index is left out, should one be added to the format."""
    found = {name for name, array in WHOLE.arrays.items() if array.dtype == '<i4'}
    assert {name.partition('/')[2] for name in found} == set(INDICES)


def chain_of_branches(count: int) -> bytes:
    """Describe a tree whose branches each carry the next: records of its own for each."""
    one = {name[2:]: array for name, array in WHOLE.arrays.items() if name.startswith('1/')}
    row = np.arange(count, dtype=np.int32)
    arrays = {
        name: np.zeros((count, *array.shape[1:]), dtype=array.dtype)
        for name, array in one.items()
        if name.startswith(('branch', 'segment'))
    }
    arrays |= {
        'branch_parent': row - 1,
        'branch_base_segment': row - 1,
        'branch_first': np.arange(count + 1, dtype=np.int32),
        'branch_coordinate': np.full(count, -1, dtype=np.int32),
        'branch_base_turn': np.full(count, -1, dtype=np.int32),
        'branch_turn': np.full(count, -1, dtype=np.int32),
        'turn': np.zeros((0, 3), dtype=np.float32),
        'basis_matrix': one['basis_matrix'],
        'basis_scale': one['basis_scale'],
    }
    kind: Any = {**WHOLE.header['kinds'][1], 'branch_names': [''] * count}
    header = {**WHOLE.header, 'kinds': [kind], 'trees': [{'name': 't', 'kind': 0}]}
    place = np.array([[0.0, 0.0, 0.0, 0.0, 1.0]], dtype=np.float32)
    return encode_description(
        header, {'tree_place': place, **{f'0/{name}': array for name, array in arrays.items()}}
    )


def with_json(text: bytes) -> bytes:
    """Make a description of any header."""
    return b'TSWD' + (2).to_bytes(4, 'little') + len(text).to_bytes(4, 'little') + text


def many_trees(count: int) -> bytes:
    trees = [{'name': 't', 'kind': 0}] * count
    place = np.ones((count, 5), dtype=np.float32)
    header = {**WHOLE.header, 'trees': trees}
    return encode_description(header, {**WHOLE.arrays, 'tree_place': place})


BOMBS = {
    'a chain of branches': lambda: chain_of_branches(300_000),
    'brackets within brackets': lambda: with_json(b'[' * 200_000),
    'a header of lists': lambda: with_json(b'[' + b'[],' * 2_700_000 + b'[]]'),
    'a header too large': lambda: with_json(b'[' + b'[],' * 20_000_000 + b'[]]'),
    'more trees than a frame counts': lambda: many_trees(100_000),
    'a shape beyond counting': lambda: with_json(
        b'{"identity":"","kinds":[],"arrays":{"a":{"type":"f32","offset":0,"shape":[%b]}}}'
        % b','.join([b'4294967296'] * 8)
    ),
    'a size of many digits': lambda: with_json(b'{"identity":%b}' % (b'9' * 100_000)),
}


def read_bomb(path: str) -> None:
    """Read a file within the memory that is allowed; run in a process of its own."""
    data = Path(path).read_bytes()
    pages = int(Path('/proc/self/statm').read_text(encoding='ascii').split()[0])
    limit = pages * resource.getpagesize() + LIMIT_MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    resource.setrlimit(resource.RLIMIT_CPU, (int(time_used() + LIMIT_TIME),) * 2)
    try:
        Placer(decode_description(data))
    except FormatError as error:
        print(f'refused: {error}')


def time_used() -> float:
    """Return the time that this process has computed [s], whole seconds upwards."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return -(-(usage.ru_utime + usage.ru_stime) // 1.0)


@pytest.mark.parametrize('bomb', BOMBS)
def test_a_bomb_is_refused_within_time_and_memory(bomb: str, tmp_path: Path) -> None:
    path = tmp_path / 'bomb.bin'
    path.write_bytes(BOMBS[bomb]())
    command = [sys.executable, __file__, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr[-800:]
    assert done.stdout.startswith('refused: tree description'), done.stdout


def test_a_described_tree_still_places_after_all_checks() -> None:
    assert np.isfinite(Placer(WHOLE).place(WHOLE.scale)).all()


if __name__ == '__main__':
    read_bomb(sys.argv[1])
