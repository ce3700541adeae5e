# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Write a tree as USD with its pictures: beside an ``.usda``, or with it in an ``.usdz``.

A ``.usdz`` is a zip whose files are stored as they are, each from a multiple of 64 bytes on.
"""

from __future__ import annotations

from contextlib import ExitStack
import io
from pathlib import Path
import struct
import tempfile
import zipfile

from tree_sway.core.leaves import LeafClusters
from tree_sway.core.run import SwaySimulator
from tree_sway.core.species import look_of
from tree_sway.files.atomic_file import whole_file
from tree_sway.files.export.breeze import SPEED
from tree_sway.files.export.spray_pictures import bark_picture, leaf_picture
from tree_sway.files.export.usd_tree import usd_of_tree

_ALIGNED = 64
_HEADER = 30
_PADDING_ID = 0x1986


def write_usd(
    path: str | Path,
    simulator: SwaySimulator,
    leaves: LeafClusters | None = None,
    speed: float = SPEED,
) -> None:
    """Write ``.usda`` with its pictures beside it, or ``.usdz``; see `usd_of_tree`."""
    path = Path(path)
    species = simulator.tree.species
    stem = path.stem
    pictures = {f'{stem}_bark.png': bark_picture(look_of(species).bark_pattern)}
    if leaves is not None:
        pictures[f'{stem}_leaves.png'] = leaf_picture(species)
    text = usd_of_tree(simulator, leaves, f'{stem}_', speed)
    if path.suffix.lower() == '.usdz':
        with whole_file(path) as partial:
            partial.write_bytes(_packed({**_layer(stem, text), **pictures}))
        return
    # All of them or none: each is put in its place when the last has been written.
    with ExitStack() as files:
        for name, data in {**pictures, path.name: text.encode()}.items():
            partial = files.enter_context(whole_file(path.with_name(name)))
            partial.write_bytes(data)


def _layer(stem: str, text: str) -> dict[str, bytes]:
    """Return the layer as a binary one, a third as large, where Pixar's library is installed."""
    try:
        from pxr import Sdf  # type: ignore[import-untyped]
    except ImportError:
        return {f'{stem}.usda': text.encode()}
    layer = Sdf.Layer.CreateAnonymous('.usda')
    layer.ImportFromString(text)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f'{stem}.usdc'
        layer.Export(str(path))
        return {path.name: path.read_bytes()}


def _packed(files: dict[str, bytes]) -> bytes:
    """Zip files without compression, each aligned by a field of padding in its header."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, 'w') as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name)
            begin = packed.tell() + _HEADER + len(name.encode()) + 4
            padding = -begin % _ALIGNED
            entry.extra = struct.pack('<HH', _PADDING_ID, padding) + bytes(padding)
            archive.writestr(entry, data)
    return packed.getvalue()
