# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A scene as one HTML file that sways by itself: the page, its modules, a description, its tables.

``static/boot.js`` unpacks the modules under their names, without other files.
`doc/tree_as_a_file.md` is for its users.
"""

from __future__ import annotations

import base64
import gzip
from importlib import resources
import json
import math
from pathlib import Path
import posixpath
import re
import struct

import numpy as np

from tree_sway.core.scene import Simulator
from tree_sway.stream import SceneState, why_no_tables

_IMPORT = re.compile(r'(\bfrom\s+|\bimport[\s(]+)"(\.[^"]+)"')
_COMMENT = re.compile(r'^ *(?://.*|/\*\*(?:[^*]|\*(?!/))*\*/ *)\n', re.MULTILINE)
_LEAVES = 1000
"""Number of clusters of leaves, as in `SceneState`."""

_BOOT = 'boot.js'
_CORE = 'sway.wasm'
_BITS = 14
"""Bits of the fraction of each number: errors of drawing are some hundredths of a millimetre."""


def page_of_scene(simulator: Simulator) -> str:
    """
    Return the HTML of a scene at rest that sways in wind.

    Parameters
    ----------
    simulator
        A tree or a scene on a number of coordinates.

    Raises
    ------
    TreeSwayError
        A tree that has no table, such as one on a model that is not a number of coordinates; see
        `why_no_tables`.

    """
    return page_of_state(SceneState(simulator, _LEAVES))


def page_of_state(scene: SceneState, script: str = '') -> str:
    """Return the HTML of a described scene, with a module of the page that runs last."""
    tables = scene.tables()
    if tables is None:
        reason = why_no_tables(scene.kinds)
        assert reason is not None
        raise reason
    planes = [_in_planes(message) for message in (scene.description, tables)]
    packed = _packed(struct.pack('<I', len(planes[0])) + b''.join(planes))
    folder = Path(str(resources.files('tree_sway.page') / 'static'))
    page = (folder / 'index.html').read_text(encoding='utf-8')
    style = (folder / 'style.css').read_text(encoding='utf-8')
    boot = (folder / _BOOT).read_text(encoding='utf-8')
    core = _packed((folder / _CORE).read_bytes())
    parts = {
        '<link rel="stylesheet" href="static/style.css" />': f'<style>\n{style}</style>',
        '<script type="module" src="static/app.js"></script>': (
            f'<script type="text/plain" id="modules">{_packed(_modules(folder))}</script>\n'
            f'    <script type="text/plain" id="core">{core}</script>\n'
            f'    <script type="text/plain" id="scene">{packed}</script>'
        ),
        '</body>': (
            f'<script>\n{boot}</script>\n{_module(folder, script) if script else ""}  </body>'
        ),
    }
    for place, part in parts.items():
        page = page.replace(place, part)
    return page


def _module(folder: Path, name: str) -> str:
    return f'<script type="module">{(folder / name).read_text(encoding="utf-8")}</script>\n'


def _packed(data: bytes) -> str:
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode()


def _in_planes(message: bytes) -> bytes:
    """Round the numbers of a message, and group bytes of equal significance."""
    begin = 12 + int.from_bytes(message[8:12], 'little')
    header = json.loads(message[12:begin])
    body = bytearray(message[begin:])
    is_table = header['format'] == 'tree_sway tables'
    for entry in header['arrays'].values():
        size = int(entry['type'][1:]) // 8  # its name ends with its bits
        first = entry['offset']
        part = slice(first, first + size * math.prod(entry['shape']))
        values = np.frombuffer(bytes(body[part]), dtype=np.uint8).reshape(-1, size)
        if entry['type'] == 'f32' and not is_table:
            lost = 1 << (23 - _BITS)
            bits = values.view('<u4').astype(np.uint64) + lost // 2
            values = (bits // lost * lost).astype('<u4').view(np.uint8).reshape(-1, size)
        body[part] = values.T.tobytes()
    return message[:begin] + bytes(body)


def _modules(folder: Path) -> bytes:
    """All modules and the files that they read, by name, as JSON."""
    modules = {}
    files = {}
    for path in sorted(folder.rglob('*.*')):
        name = path.relative_to(folder)
        if path.suffix in ('.json', '.glsl'):
            files[name.as_posix()] = path.read_text(encoding='utf-8')
        elif path.suffix == '.js' and path.name not in (_BOOT, 'film.js'):
            text = path.read_text(encoding='utf-8')
            modules[f'tree-sway/{name.as_posix()}'] = _with_full_names(text, name.parent)
    return json.dumps({'modules': modules, 'files': files}).encode()


def _with_full_names(text: str, folder: Path) -> str:
    """Source of a module of a folder without comments, with full names of its imports."""

    def full(found: re.Match[str]) -> str:
        return f'{found[1]}"tree-sway/{posixpath.normpath((folder / found[2]).as_posix())}"'

    return _IMPORT.sub(full, _COMMENT.sub('', text))
