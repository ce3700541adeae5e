# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tables of a hostile server: refused in Python and in JavaScript before a step reads them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from tree_sway.core.scene.placed_tree import PlacedTree  # noqa: E402
from tree_sway.core.scene.scene import Scene  # noqa: E402
from tree_sway.errors import FormatError, ParameterError  # noqa: E402
from tree_sway.files.trees.source import open_tree  # noqa: E402
from tree_sway.stream import check_tables  # noqa: E402
from tree_sway.stream.protocol import (  # noqa: E402
    decode_description,
    decode_tables,
    Description,
    encode_description,
    of_kinds,
    TABLES,
    Tables,
)
from tree_sway.stream.received_scene import ReceivedKind, ReceivedScene  # noqa: E402
from tree_sway.stream.scene_state import SceneState  # noqa: E402

HERE = Path(__file__).parent
STATIC = HERE.parents[1] / 'tree_sway' / 'page' / 'static'
DT = 1.0 / 60.0
FUZZED = 150


class Sound(NamedTuple):
    """A stand of two kinds, as a server describes it."""

    description: bytes
    described: Description
    tables: Tables

    def changed(self, header: Any = None, **arrays: Any) -> bytes:
        """Write the tables with entries of the header or arrays changed; None leaves one out."""
        found = {**self.tables.arrays, **arrays}
        kept = {name: array for name, array in found.items() if array is not None}
        return encode_description({**self.tables.header, **(header or {})}, kept, TABLES)

    def of_first_kind(self, **entries: Any) -> dict[str, Any]:
        """Return kinds of the header with entries of the first one changed."""
        first, *others = self.tables.header['kinds']
        return {'kinds': [{**first, **entries}, *others]}


@cache
def sound() -> Sound:
    """Describe a stand of two kinds."""
    source = open_tree(HERE.parent / 'files' / 'data' / 'seedling.yaml')
    larger = PlacedTree('other', source, scale=1.7).placed()
    trees = [
        PlacedTree('one', source),
        PlacedTree('two', source, x=3.0, yaw=0.7, scale=1.4),
        PlacedTree('three', larger, y=3.0, species=source.species),
    ]
    state = SceneState(Scene(trees).simulator(model=12))
    tables = state.tables()
    assert tables is not None
    return Sound(state.description, decode_description(state.description), decode_tables(tables))


def array_damages() -> Iterator[tuple[str, bytes]]:
    """Every array of every kind: cut, lengthened, of another type, shape or number."""
    for name, array in sound().tables.arrays.items():
        others: dict[str, Any] = {
            'missing': None,
            'empty': array[:0],
            'one row short': array[:-1],
            'one row long': np.concatenate([array, array[-1:]]),
            'one axis more': array[..., None],
            'one axis less': array.reshape(-1)[0],
            'of bytes': array.astype(np.uint8),
            'of whole numbers': array.astype(np.int32),
        }
        if array.ndim > 1:
            others['flat'] = array.ravel()
            others['one column short'] = array[:, :-1]
            if 'branch_compliance' in name:  # there may be more columns than keys
                others['one column short'] = array[:, :1]
            else:
                others['one column long'] = np.concatenate([array, array[:, -1:]], axis=1)
        if array.dtype == '<f4':
            for value in (np.nan, np.inf, -np.inf):
                wrong = array.copy()
                wrong.flat[-1] = value
                others[f'with {value}'] = wrong
        for what, other in others.items():
            yield f'{name} {what}', sound().changed(**{name: other})
    for name in ('stiffness', 'limit', 'own_damping', 'motion', 'cross_damping'):
        wrong = sound().tables.arrays[f'1/{name}'].copy()
        wrong.flat[0] = -1.0
        yield f'{name} below 0', sound().changed(**{f'1/{name}': wrong})
    levels = sound().tables.arrays['0/levels']
    yield 'levels that descend', sound().changed(**{'0/levels': levels[:, ::-1]})
    for value in (-1.0, 1e6, np.nan):
        speeds = sound().tables.arrays['tree_speed'].copy()
        speeds[1] = value
        yield f'a speed of {value}', sound().changed(tree_speed=speeds)


def header_damages() -> Iterator[tuple[str, bytes]]:
    """Numbers of the header: missing, of another type or length, not finite, out of range."""
    others: tuple[Any, ...] = (
        None, [], [1.0], [1.0, 0.5], [1.0, 0.5, 0.1, 0.2], [1.0, 0.5, None], [1.0, 0.5, '0'],
        [1.0, 0.5, True], [1.0, 10**400, 0.1], '123', {'length': 3}, 3.0,
    )  # fmt: skip
    for law in others:
        yield f'a law of {str(law)[:20]}', sound().changed(sound().of_first_kind(drag_law=law))
    for name in ('most_pressure', 'most_energy'):
        others = (None, 0.0, -1.0, '5', True, [1.0], 10**400)
        for value in others:
            entries = sound().of_first_kind(**{name: value})
            yield f'{name} of {str(value)[:9]}', sound().changed(entries)
    others = ([], [1.0], [1.0, 2.0], [1.0, 2.0, None], '123', 5, {}, [1.0, 2.0, True])
    for place in others:
        yield f'anemometer at {place}', sound().changed({'anemometer': place})
    others = (0, 0.05, -1.0, '1', True, [], 10**400)
    for ratio in others:
        yield f'convection ratio {str(ratio)[:9]}', sound().changed({'convection_ratio': ratio})
    first, second = sound().tables.header['kinds']
    others = ([], [first], [first, second, first], [first, None], None, {}, 'ab')
    for number, kinds in enumerate(others):
        yield f'kinds {number}', sound().changed({'kinds': kinds})
    others = ('0' * 16, None, 5, [])
    for identity in others:
        yield f'tables of description {identity}', sound().changed({'description': identity})


def too_large() -> bytes:
    """Make tables of more coordinates than are unpacked, consistent in themselves."""
    m = 700
    forms = check_tables._FORMS
    sizes = {'m': m, 'm m': m * m, 'n': 16, 'keys': 27, 'keys of a branch': 2}
    arrays = {
        f'{kind}/{name}': np.ones(
            [each if isinstance(each, int) else sizes.get(each, 1) for each in axes], dtype=dtype
        )
        for kind in range(2)
        for name, (dtype, axes) in forms.items()
    }
    return sound().changed(**arrays)


@cache
def damages() -> dict[str, bytes]:
    """Return damaged tables by what is wrong with them."""
    return {**dict(array_damages()), **dict(header_damages()), 'tables too large': too_large()}


def solved(data: bytes) -> ReceivedScene:
    """Read tables, and step the scene in a wind."""
    scene = decode_tables(data).scene(sound().described, DT)
    for _ in range(5):
        scene.step((8.0, 2.0, 1.0))
    return scene


def refusals(javascript: Callable[..., Any], tables: list[bytes], folder: Path) -> list[str]:
    """Return the reason for which JavaScript refuses each of some tables; empty if it does not."""
    (folder / 'description.bin').write_bytes(sound().description)
    for number, data in enumerate(tables):
        (folder / f'{number}.bin').write_bytes(data)
    program = f"""
      import {{ readFileSync }} from "node:fs";
      const {{ decodeDescription, ProtocolError }} =
        await import("{(STATIC / 'protocol.js').as_uri()}");
      const {{ decodeTables, Stand }} = await import("{(STATIC / 'sway.js').as_uri()}");
      const read = (name) => {{
        const bytes = readFileSync(`{folder}/${{name}}.bin`);
        return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
      }};
      const description = decodeDescription(read("description"));
      const answers = [];
      for (let i = 0; i < {len(tables)}; i++) {{
        try {{
          const stand = new Stand(decodeTables(read(i)), description);
          for (let k = 0; k < 5; k++) stand.step(8, 2, 1);
          answers.push("");
        }} catch (error) {{
          answers.push(error instanceof ProtocolError ? error.message : `raw ${{error.stack}}`);
        }}
      }}
      console.log(JSON.stringify(answers));
    """
    answers: list[str] = javascript(program)
    return answers


def test_damaged_tables_are_refused() -> None:
    read = []
    for damage, data in damages().items():
        with suppress(FormatError):
            decode_tables(data).scene(sound().described, DT)
            read.append(damage)
    assert read == []


def test_damaged_tables_are_refused_in_javascript(
    javascript: Callable[..., Any], tmp_path: Path
) -> None:
    answers = refusals(javascript, list(damages().values()), tmp_path)
    said = zip(damages(), answers, strict=True)
    assert {what: why for what, why in said if not why or why.startswith('raw')} == {}


def test_every_array_has_a_form() -> None:
    """No array is left out, should one be added to the format."""
    for arrays in of_kinds(sound().tables.arrays, 2):
        assert set(arrays) == set(check_tables._FORMS)


def test_sound_tables_are_solved_in_both(javascript: Callable[..., Any], tmp_path: Path) -> None:
    changes: list[dict[str, Any]] = [
        {}, {'anemometer': [0.0, 1.0, 2]}, {'convection_ratio': 1.8}, {'convection_ratio': None}
    ]  # fmt: skip
    tables = [sound().changed(header) for header in changes]
    for data in tables:
        assert np.isfinite(solved(data).state()).all()
    assert refusals(javascript, tables, tmp_path) == [''] * len(tables)


def test_random_numbers_are_refused_or_solved_in_both(
    javascript: Callable[..., Any], tmp_path: Path
) -> None:
    rng = np.random.default_rng(4)
    names = list(sound().tables.arrays)
    fuzzed = []
    for _ in range(FUZZED):
        name = names[rng.integers(len(names))]
        array = sound().tables.arrays[name].copy()
        raw = array.reshape(-1).view(np.uint8)
        raw[rng.integers(len(raw), size=8)] = rng.integers(256, size=8)
        fuzzed.append(sound().changed(**{name: array}))
    refused = []
    for data in fuzzed:
        try:
            assert np.isfinite(solved(data).stand.states.eta).all()
            refused.append(False)
        except FormatError:
            refused.append(True)
    found = refusals(javascript, fuzzed, tmp_path)
    assert not [reason for reason in found if reason.startswith('raw')]
    assert [bool(reason) for reason in found] == refused
    assert 0 < sum(refused) < FUZZED


@pytest.mark.parametrize(
    ('name', 'damage'),
    [
        ('kind_of', lambda given: given | {'kind_of': np.array([0, 0, 2])}),
        ('kind_of', lambda given: given | {'kind_of': np.array([0, -1, 1])}),
        ('places', lambda given: given | {'places': np.ones((2, 5))}),
        ('speeds', lambda given: given | {'speeds': np.ones(2)}),
        ('drag_law', lambda given: given | {'kinds': [shorter(given['kinds'][0])] * 2}),
    ],
)
def test_a_scene_is_not_made_of_arrays_that_do_not_fit(
    name: str, damage: Callable[[dict[str, Any]], dict[str, Any]]
) -> None:
    parts = of_kinds(sound().tables.arrays, 2)
    entries = sound().tables.header['kinds']
    kinds = [
        ReceivedKind(entry, arrays, entry['drag_law'])
        for entry, arrays in zip(entries, parts, strict=True)
    ]
    places = np.ones((3, 5))
    given = {
        'kinds': kinds,
        'kind_of': np.array([0, 0, 1]),
        'places': places,
        'speeds': np.ones(3),
    }
    ReceivedScene(**given, dt=DT).step((8.0, 2.0, 1.0))  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match=name):
        ReceivedScene(**damage(given), dt=DT)


def shorter(kind: ReceivedKind) -> ReceivedKind:
    """Return a kind whose drag law has two numbers."""
    return ReceivedKind(kind.numbers, kind.arrays, kind.drag_law[:2])
