# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pictures of messages: each encoding, and what is refused, with its true cause."""

from __future__ import annotations

from contextlib import suppress
import struct
from types import SimpleNamespace
from typing import Any
import zlib

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway_ros.wire.picture_messages import picture_from_message

cv2: Any = pytest.importorskip('cv2', reason='needs OpenCV: pip install .[camera]')

HIGH, WIDE = 5, 7
GREY = np.arange(HIGH * WIDE, dtype=np.uint8).reshape(HIGH, WIDE) * 7
RED = np.zeros((HIGH, WIDE, 3), dtype=np.uint8)
RED[..., 0] = 200


def image(name: str, pixels: np.ndarray, padding: int = 0, **changes: Any) -> SimpleNamespace:
    rows = pixels.reshape(HIGH, -1)
    rows = np.hstack([rows, np.full((HIGH, padding), 99, dtype=np.uint8)])
    fields: dict[str, Any] = {
        'encoding': name, 'width': WIDE, 'height': HIGH, 'step': rows.shape[1],
        'data': rows.tobytes(),
    }  # fmt: skip
    return SimpleNamespace(**fields | changes)


def compressed(kind: str, pixels: np.ndarray) -> bytes:
    return bytes(cv2.imencode(kind, pixels)[1].tobytes())


def read(message: SimpleNamespace) -> np.ndarray:
    return np.asarray(picture_from_message(cv2, message))


def test_rows_may_be_padded() -> None:
    np.testing.assert_array_equal(read(image('mono8', GREY, padding=3)), GREY)


@pytest.mark.parametrize(('encoding', 'light'), [('rgb8', 60), ('bgr8', 23), ('rgba8', 60)])
def test_colours_are_weighted_as_the_encoding_says(encoding: str, light: int) -> None:
    pixels = RED if encoding != 'rgba8' else np.concatenate([RED, RED[..., :1]], axis=2)
    found = read(image(encoding, pixels, padding=1))
    assert found.shape == (HIGH, WIDE)
    assert abs(int(found[2, 3]) - light) <= 1


@pytest.mark.parametrize('kind', ['.png', '.jpg'])
def test_compressed_pictures_are_read(kind: str) -> None:
    found = read(SimpleNamespace(data=compressed(kind, GREY) + bytes(8)))
    assert np.abs(found.astype(int) - GREY).max() <= (0 if kind == '.png' else 12)


@pytest.mark.parametrize(
    ('changes', 'cause'),
    [
        ({'encoding': 'yuv422'}, "encoding 'yuv422'; publish one of mono8"),
        ({'step': WIDE - 1}, 'with a step of 6'),
        ({'step': 2**31}, 'with a step of'),
        ({'data': b'123'}, '7 x 5 pixels of mono8 in 3 bytes'),
        ({'height': HIGH + 1}, '7 x 6 pixels of mono8 in 35 bytes'),
        ({'width': 0, 'step': 0, 'data': b''}, 'a picture of 0 x 5'),
        ({'width': 60_000, 'height': 60_000}, 'a picture of 60000 x 60000'),
    ],
)
def test_what_does_not_fit_is_refused(changes: dict[str, Any], cause: str) -> None:
    with pytest.raises(FormatError, match=cause):
        read(image('mono8', GREY, **changes))


def vast_png(side: int) -> bytes:
    """Return a PNG that claims many pixels, whose data would be valid."""
    head = struct.pack('>IIBBBBB', side, side, 8, 0, 0, 0, 0)
    chunks = [(b'IHDR', head), (b'IDAT', zlib.compress(bytes(1000))), (b'IEND', b'')]
    parts = [
        struct.pack('>I', len(data)) + name + data + struct.pack('>I', zlib.crc32(name + data))
        for name, data in chunks
    ]
    return b'\x89PNG\r\n\x1a\n' + b''.join(parts)


def vast_jpeg() -> bytes:
    """Return a JPEG that claims 65,500 rows and columns."""
    data = bytearray(compressed('.jpg', GREY))
    at = data.index(b'\xff\xc0')
    data[at + 5 : at + 9] = struct.pack('>HH', 65_500, 65_500)
    return bytes(data)


@pytest.mark.parametrize(
    ('data', 'cause'),
    [
        (b'', 'neither JPEG nor PNG'),
        (b'GIF89a....', 'neither JPEG nor PNG'),
        (compressed('.jpg', GREY)[:-70], 'cut off after'),
        (compressed('.png', GREY)[:-20], 'cut off after'),
        (vast_png(50_000), 'a picture of 50000 x 50000'),
        (vast_jpeg(), 'a picture of 65500 x 65500'),
        (b'\xff\xd8\xff\xd9', 'a picture of 0 x 0'),
        (b'\xff\xd8' + bytes(90) + b'\xff\xd9', 'a picture of 0 x 0'),
        (vast_png(30)[:60] + b'IEND', 'no picture'),
    ],
)
def test_what_is_no_picture_is_refused(data: bytes, cause: str) -> None:
    with pytest.raises(FormatError, match=cause):
        read(SimpleNamespace(data=data))


def test_damage_at_any_place_is_refused_or_read() -> None:
    rng = np.random.default_rng(5)
    for kind in ('.png', '.jpg'):
        for _ in range(150):
            data = bytearray(compressed(kind, GREY))
            for at in rng.integers(len(data), size=3):
                data[at] = rng.integers(256)
            with suppress(FormatError):
                assert read(SimpleNamespace(data=bytes(data))).ndim == 2
