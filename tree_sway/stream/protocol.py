# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The binary form of a swaying tree: a description sent once, then independent frames.

`doc/streaming.md` is the specification; ``static/protocol.js`` reads the same bytes. Everything is
little-endian. A frame has the state and the wind: some 60 bytes for any size of a tree.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
import hashlib
import json
import math
import struct
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.model import FULL_SCALE, MARGIN
from tree_sway.errors import FormatError
from tree_sway.stream.check_description import Array, Arrays, check_description, Json, TYPES
from tree_sway.stream.check_tables import check_tables
from tree_sway.stream.received_scene import ReceivedKind, ReceivedScene

_VERSION = 2
_FRAME_VERSION = 1
MAGIC, TABLES = b'TSWD', b'TSWT'
"""First bytes of a description, and of the tables by which a receiver solves it."""

_FRAME_KIND = 0x46
WIND_UNIT = 0.005
"""Unit of the wind's int16 in [m/s]."""

PAUSED, BEYOND_SCALE, RESTARTED, _PART, WIND_LOST = 1, 2, 4, 8, 16
"""
Flags of a frame: paused, a number clamped to its scale, the motion jumped, some coordinates, no
measured wind: there is no sample yet, or the last one is older than its time-out and its force
decays.

"""

_NAMES = {np.dtype(code): name for name, code in TYPES.items()}
_PREFIX = struct.Struct('<4sII')
_FRAME = struct.Struct('<BBBxIIq3hH')
_ALIGNMENT = 8
_LARGEST_SINGLE = float(np.finfo(np.float32).max)

FRAME_SIZE = _FRAME.size
"""Size of a frame of the wind only in [bytes]."""

LARGEST_DESCRIPTION = 64 * 2**20
"""Size of the message of a description in [bytes]."""

LARGEST_HEADER = 8 * 2**20
"""Size of the JSON in such a message in [bytes]."""

_WRONG_JSON = (
    ValueError, KeyError, IndexError, TypeError, AttributeError, OverflowError, RecursionError,
)  # fmt: skip
"""Errors of reading JSON of a different form."""


class Frame(NamedTuple):
    """
    One state of a tree or a scene.

    Parameters
    ----------
    identity
        First four bytes of the identity of its description.
    sequence
        Number of the frame, from 0, modulo 2^32.
    stamp
        Time of the state in [ns].
    flags
        Sum of `PAUSED`, `BEYOND_SCALE`, `RESTARTED`, `_PART`, `WIND_LOST`.
    wind
        Wind at the anemometer, blowing to, in [m/s], (3,).
    coordinates
        Coordinates as int16, (m,): full scale is `FULL_SCALE`. A frame of the wind only has none.
    first
        Number of the first coordinate.
    beyond
        Corrections of pulled branches, as pairs of the number of a key rotation among those of all
        trees and a rotation [rad], (2 k,).

    """

    identity: int
    sequence: int
    stamp: int
    flags: int
    wind: Floats
    coordinates: Array
    first: int = 0
    beyond: Floats = np.zeros(0)


@dataclass(frozen=True)
class Description:
    """
    Description of a scene, sent once.

    Parameters
    ----------
    header
        Names and numbers, as listed in ``doc/streaming.md``.
    arrays
        Arrays by name; of a kind under its number and a slash.
    identity
        SHA-256 of the content, the first 16 hexadecimal digits.

    Raises
    ------
    FormatError
        Errors of `check_description`.

    """

    header: Json
    arrays: Arrays
    identity: str

    def __post_init__(self) -> None:
        """Refuse inconsistent arrays."""
        check_description(self.header, self.kinds, self.arrays['tree_place'])

    @property
    def short_identity(self) -> int:
        """Return the part of the identity in frames."""
        return int(self.identity[:8], 16)

    @property
    def frame_size(self) -> int:
        """Size of a frame in [bytes]."""
        return _FRAME.size + 2 * len(self.scale)

    @cached_property
    def kinds(self) -> list[Arrays]:
        """Arrays of each kind by name."""
        return of_kinds(self.arrays, len(self.header['kinds']))

    @cached_property
    def scale(self) -> Floats:
        """Return the value of each coordinate of all trees at full scale, (m,)."""
        scales = [self.kinds[tree['kind']]['basis_scale'] for tree in self.header['trees']]
        return np.concatenate(scales).astype(np.float64)

    def coordinates(self, frame: Frame) -> Floats:
        """Coordinates of a frame in their own unit, (m,); else a `FormatError`."""
        if frame.identity != self.short_identity:
            what = f'a frame of description {frame.identity:08x}'
            cure = f'this one has {self.short_identity:08x}: ask for the new one'
            raise FormatError(what, where='tree state', cure=cure)
        count = len(frame.coordinates)
        most = len(self.scale)
        part = slice(frame.first, frame.first + count)
        if part.stop > most or (count not in (0, most) and not frame.flags & _PART):
            what = f'{count} coordinates where {most} are described'
            raise FormatError(what, where='tree state')
        return frame.coordinates * (self.scale[part] / FULL_SCALE)


@dataclass(frozen=True)
class Tables:
    """Tables by which a receiver solves a scene: header and arrays, as in `tables_of`."""

    header: Json
    arrays: Arrays

    def scene(self, description: Description, dt: float) -> ReceivedScene:
        """
        Return the scene at rest, for time steps of dt [s].

        Raises a `FormatError` for tables of another description, and the errors of `check_tables`.
        """
        header = self.header
        with _reading('tables'):
            if header['description'] != description.identity:
                raise FormatError('they are of a different description', cure='request both again')
            parts = of_kinds(self.arrays, len(header['kinds']))
            speeds = self.arrays['tree_speed']
            n_trees = len(description.header['trees'])
            check_tables(header, parts, speeds, description.kinds, n_trees)
        kinds = [
            ReceivedKind(numbers, arrays, numbers['drag_law'])
            for numbers, arrays in zip(header['kinds'], parts, strict=True)
        ]
        ratio = header['convection_ratio']
        return ReceivedScene(
            kinds,
            np.array([tree['kind'] for tree in description.header['trees']]),
            description.arrays['tree_place'].astype(np.float64),
            self.arrays['tree_speed'].astype(np.float64),
            dt=dt,
            anemometer=header['anemometer'],
            convection_ratio=math.inf if ratio is None else ratio,
        )


def of_kinds(arrays: Arrays, count: int) -> list[Arrays]:
    """Arrays of each kind by name, from arrays with its number and a slash before the name."""
    kinds: list[Arrays] = [{} for _ in range(count)]
    for name, array in arrays.items():
        number, is_of_kind, own = name.partition('/')
        if is_of_kind:
            kinds[int(number)][own] = array
    return kinds


def encode_description(header: Json, arrays: Arrays, magic: bytes = MAGIC) -> bytes:
    """
    Write a description, or tables.

    Parameters
    ----------
    header
        Values for JSON; `version`, `identity` and `arrays` are added.
    arrays
        Arrays of float32, int32, int16 or uint8.
    magic
        `MAGIC` or `TABLES`.

    """
    body = bytearray()
    table = {}
    for name, value in arrays.items():
        array = np.ascontiguousarray(value)
        kind = _NAMES[array.dtype.newbyteorder('<')]
        table[name] = {'type': kind, 'shape': list(array.shape), 'offset': len(body)}
        body += array.astype(TYPES[kind]).tobytes()
        body += bytes(-len(body) % _ALIGNMENT)
    content = {**header, 'version': _VERSION, 'arrays': table}
    digest = hashlib.sha256(_json(content) + body).hexdigest()
    text = _json({**content, 'identity': digest[:16]})
    text += b' ' * (-(_PREFIX.size + len(text)) % _ALIGNMENT)
    return _PREFIX.pack(magic, _VERSION, len(text)) + text + bytes(body)


def decode_description(data: bytes) -> Description:
    """
    Read a description.

    Raises
    ------
    FormatError
        Not a description, of a different version, cut short, changed in transit, or with an index
        out of range.

    """
    with _reading('tree description'):
        return Description(*_unpacked(data, MAGIC))


def decode_tables(data: bytes) -> Tables:
    """Read the tables of a description; errors are those of `decode_description`."""
    with _reading('tables'):
        return Tables(*_unpacked(data, TABLES)[:2])


@contextmanager
def _reading(what: str) -> Iterator[None]:
    """Raise errors of reading JSON or arrays of a different form as a `FormatError`."""
    try:
        yield
    except FormatError as error:
        raise error.inside(what) from None
    except _WRONG_JSON as error:
        raise FormatError(
            f'not whole: {type(error).__name__}: {error}'[:200],
            where=what,
            cure='request it again',
        ) from None


def _unpacked(data: bytes, magic: bytes) -> tuple[Json, Arrays, str]:
    """Header, arrays and identity of a message with given first bytes."""
    if len(data) < _PREFIX.size or data[:4] != magic:
        raise ValueError(f'it does not begin with {magic.decode()}')
    _, version, size = _PREFIX.unpack_from(data)
    if version != _VERSION:
        cure = f'this program reads version {_VERSION}: update the older side'
        raise FormatError(f'a message of version {version}', cure=cure)
    begin = _PREFIX.size + size
    if size > LARGEST_HEADER:
        raise ValueError(f'a header of {size} bytes; up to {LARGEST_HEADER} are read')
    body = memoryview(data)[begin:]
    header = json.loads(data[_PREFIX.size : begin])
    identity = header.pop('identity')
    table = header['arrays']
    arrays = {name: _array(body, entry) for name, entry in table.items()}
    digest = hashlib.sha256(_json(header))
    digest.update(body)
    if digest.hexdigest()[:16] != identity:
        raise ValueError('its content does not match its identity')
    del header['arrays']
    return header, arrays, identity


def encode_frame(frame: Frame) -> bytes:
    """Write a frame; a wind or a turn beyond the range of its type is clamped and flagged."""
    wind = np.rint(np.asarray(frame.wind) / WIND_UNIT)
    cut = np.clip(wind, -FULL_SCALE, FULL_SCALE)
    beyond = np.clip(frame.beyond, -_LARGEST_SINGLE, _LARGEST_SINGLE)
    is_cut = bool((cut != wind).any() or (np.abs(frame.beyond) > _LARGEST_SINGLE).any())
    flags = frame.flags | (BEYOND_SCALE if is_cut else 0)
    x, y, z = cut.astype(int).tolist()
    coordinates = np.asarray(frame.coordinates, dtype='<i2')
    return (
        _FRAME.pack(
            _FRAME_KIND, _FRAME_VERSION, flags, frame.identity, frame.sequence & 0xFFFFFFFF,
            frame.stamp, x, y, z, len(coordinates),
        )
        + coordinates.tobytes() + beyond.astype('<f4').tobytes()
    )  # fmt: skip


def encode_state(
    description: Description,
    sequence: int,
    stamp: int,
    wind: Floats,
    coordinates: ArrayLike,
    flags: int = 0,
) -> bytes:
    """Write the frame of `SceneState.coordinates`; other fields are as in `Frame`."""
    own, beyond = np.split(np.asarray(coordinates), [len(description.scale)])
    steps, is_cut = quantised(own, description.scale)
    head = description.short_identity, sequence, stamp, flags | BEYOND_SCALE * is_cut, wind
    return encode_frame(Frame(*head, steps, beyond=beyond))


def decode_frame(data: bytes) -> Frame:
    """
    Read a frame.

    Raises
    ------
    FormatError
        Not a frame, of a different version, or of a wrong length.

    """
    if len(data) < _FRAME.size or data[0] != _FRAME_KIND:
        raise FormatError(
            'not a frame', where='tree state', cure='send frames of doc/streaming.md'
        )
    _, version, flags, identity, sequence, stamp, x, y, z, count = _FRAME.unpack_from(data)
    begin = _FRAME.size + 2 * bool(flags & _PART)
    size = begin + 2 * count
    if version != _FRAME_VERSION or len(data) < size or (len(data) - size) % 8:
        what = f'a frame of version {version}, {count} coordinates and {len(data)} bytes'
        cure = f'send version {_FRAME_VERSION}, {begin} bytes and 2 per coordinate'
        raise FormatError(what, where='tree state', cure=cure)
    coordinates = np.frombuffer(data, dtype='<i2', count=count, offset=begin)
    beyond = np.frombuffer(data, dtype='<f4', offset=size).astype(np.float64)
    if not np.isfinite(beyond).all():
        raise FormatError('a frame that is not finite', where='tree state')
    first = int.from_bytes(data[begin - 2 : begin], 'little') if flags & _PART else 0
    wind = WIND_UNIT * np.array([x, y, z])
    return Frame(identity, sequence, stamp, flags, wind, coordinates, first, beyond)


def part_of_frame(frame: bytes, first: int, count: int) -> bytes:
    """Return a frame with some of the coordinates of one; with the wind only if the count is 0."""
    size = _FRAME.size
    head = bytearray(frame[:size])
    count = min(count, int.from_bytes(head[-2:], 'little') - first)
    head[-2:] = count.to_bytes(2, 'little')
    if count == 0:
        return bytes(head)
    head[2] |= _PART
    part = frame[size + 2 * first : size + 2 * (first + count)]
    return bytes(head) + first.to_bytes(2, 'little') + part


def quantised(values: ArrayLike, scale: ArrayLike) -> tuple[Array, bool]:
    """
    Coordinates as int16.

    Parameters
    ----------
    values, scale
        Coordinates, and their values at full scale, (m,).

    Returns
    -------
    tuple
        Coordinates as int16 (m,), clamped to full scale, and whether any is beyond the range of
        the error of the description.

    """
    exact = np.rint(np.asarray(values) * (FULL_SCALE / np.asarray(scale)))
    cut = np.clip(exact, -FULL_SCALE, FULL_SCALE)
    return cut.astype('<i2'), bool((np.abs(exact) > FULL_SCALE / MARGIN).any())


def _json(content: Json) -> bytes:
    text = json.dumps(content, sort_keys=True, separators=(',', ':'), allow_nan=False)
    return text.encode()


def _array(body: memoryview, entry: Json) -> Array:
    shape = tuple(int(size) for size in entry['shape'])
    if any(size < 0 for size in shape):
        raise ValueError(f'a shape of {shape}')
    count = math.prod(shape)
    flat = np.frombuffer(body, dtype=TYPES[entry['type']], count=count, offset=entry['offset'])
    return flat.reshape(shape)
