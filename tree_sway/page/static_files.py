# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The files of the page, read and packed once: no other file can be asked for."""

from __future__ import annotations

from dataclasses import dataclass
import gzip
import hashlib
from importlib import resources
import mimetypes
from pathlib import Path

from aiohttp import web

_INDEX = 'index.html'


@dataclass(frozen=True)
class _File:
    plain: bytes
    packed: bytes
    kind: str
    tag: str


class StaticFiles:
    """What ``static/`` holds, by its path in there."""

    def __init__(self) -> None:
        folder = Path(str(resources.files('tree_sway.page') / 'static'))
        paths = [path for path in folder.rglob('*') if path.is_file()]
        self._files = {path.relative_to(folder).as_posix(): _read(path) for path in paths}

    async def index(self, request: web.Request) -> web.Response:
        """Answer with the page."""
        return _answer(self._files[_INDEX], request)

    async def serve(self, request: web.Request) -> web.Response:
        """Answer with a file, packed where the browser can unpack it."""
        found = self._files.get(request.match_info['name'])
        if found is None:
            raise web.HTTPNotFound
        return _answer(found, request)


def _read(path: Path) -> _File:
    plain = path.read_bytes()
    kind = mimetypes.types_map.get(path.suffix, 'application/octet-stream')
    kind = 'text/javascript' if path.suffix == '.js' else kind
    return _File(
        plain, gzip.compress(plain, mtime=0), kind, hashlib.sha256(plain).hexdigest()[:16]
    )


def _answer(file: _File, request: web.Request) -> web.Response:
    headers = {'ETag': f'"{file.tag}"', 'Vary': 'Accept-Encoding'}
    if request.headers.get('If-None-Match') == headers['ETag']:
        return web.Response(status=304, headers=headers)
    if 'gzip' not in request.headers.get('Accept-Encoding', ''):
        return web.Response(
            body=file.plain, content_type=file.kind, charset='utf-8', headers=headers
        )
    headers['Content-Encoding'] = 'gzip'
    return web.Response(body=file.packed, content_type=file.kind, charset='utf-8', headers=headers)
