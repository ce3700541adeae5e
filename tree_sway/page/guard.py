# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The guard of the page's server: which requests it answers, and how it refuses the others.

`access` has the rules; this file applies them to the requests of the HTTP server.
"""

from __future__ import annotations

from html import escape
from importlib import resources
import math
from pathlib import Path
import time

from aiohttp import web
from aiohttp.typedefs import Handler

from tree_sway.doorkeeper import Doorkeeper
from tree_sway.page.access import (
    Access,
    access_of,
    cookie_token,
    given_token,
    Guesses,
    refusal,
    viewers_token,
    WRONG_TOKEN,
)
from tree_sway.page.page_settings import PageSettings
from tree_sway.page.refusals import Refusals

STATIC = Path(str(resources.files('tree_sway.page'))) / 'static'
"""Folder of the page's files."""

_HEADERS = {
    'Content-Security-Policy': (
        "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; img-src 'self' data:; "
        "frame-ancestors 'none'"
    ),
    'X-Content-Type-Options': 'nosniff',
    'Referrer-Policy': 'no-referrer',
    'Permissions-Policy': 'camera=(self), microphone=(), geolocation=()',
    'Cache-Control': 'no-cache',
}
_LONGEST_PATH = 100


class Guard:
    """
    Check of every request: its token, its origin, and that it asks for something there is.

    Parameters
    ----------
    settings
        Address and access.
    doors
        Told of the requests that have the token.
    refusals
        Counter of what is refused.

    Raises
    ------
    ParameterError
        A token file that cannot be used, or an address of others without a token.

    """

    def __init__(self, settings: PageSettings, doors: Doorkeeper, refusals: Refusals) -> None:
        self._settings = settings
        self._doors = doors
        self._refusals = refusals
        self._token = settings.required_token()
        self._guesses = Guesses()
        self.port = settings.port or 0
        """Port that the server is bound to."""

    @property
    def viewers_token(self) -> str:
        """Token of links to look only; empty without a token."""
        return viewers_token(self._token)

    def may_control(self, request: web.Request) -> bool:
        """Whether a request may change the wind and the tree."""
        return access_of(self._given(request), self._token) is Access.CONTROL

    @web.middleware
    async def check(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        """Pass a request on, or refuse it."""
        refused = self._checked_token(request)
        if refused is not None:
            return refused
        if request.can_read_body:
            return self.refused(413, 'requests have no body')
        try:
            why = self._why_refused(request)
        except ValueError as error:
            return self.refused(400, f'not understood: {error}')
        if why is not None:
            return self.refused(403, why, with_page=request.path == '/')
        response: web.StreamResponse = await handler(request)
        if isinstance(response, web.FileResponse) and _takes_packed(request):
            response.enable_compression(web.ContentCoding.gzip)
        return response

    def refused(
        self, status: int, why: str, *, with_page: bool = False, retry_after: float = 0.0
    ) -> web.Response:
        """
        Return the answer to a refused request, and count it.

        Parameters
        ----------
        status
            Status of HTTP.
        why
            Reason, for whoever asked.
        with_page
            Whether the answer is a page that says what to do.
        retry_after
            Time until the request may succeed [s]; not said if 0.

        """
        self._refusals.note(f'a request was refused: {why!a}')
        text = f'refused: {why}\n'
        kind = 'text/plain'
        if with_page:
            text = _refusal_page(why)
            kind = 'text/html'
        answer = web.Response(status=status, text=text, content_type=kind)
        if retry_after:
            answer.headers['Retry-After'] = str(math.ceil(retry_after))
        answer.force_close()
        return answer

    def hide_token(self, request: web.Request, answer: web.StreamResponse) -> None:
        """Put the token of an address into a cookie, so that the page can drop it."""
        if 'token' not in request.query or not self._token:
            return
        answer.set_cookie(
            self._cookie,
            cookie_token(self._token) if self.may_control(request) else self.viewers_token,
            httponly=True,
            samesite='Strict',
            secure=bool(self._settings.certificate),
        )

    def _checked_token(self, request: web.Request) -> web.Response | None:
        """Count a wrong token and refuse whoever guesses; tell the doors who has the right one."""
        given = self._given(request)
        address = request.remote or ''
        now = time.monotonic()
        if given and self._token:
            wait = self._guesses.waiting_time(address, now)
            if wait > 0.0:
                slow = 'too many wrong tokens: wait a moment'
                return self.refused(429, slow, with_page=request.path == '/', retry_after=wait)
        is_known = access_of(given, self._token) is not Access.NONE
        if given and not is_known:
            self._guesses.note(address, given, now)
        self._doors.let_in(request.transport, is_known=is_known)
        return None

    def _why_refused(self, request: web.Request) -> str | None:
        """Return why the rules of access refuse a request; raises a `ValueError` for nonsense."""
        if len(request.path) > _LONGEST_PATH:
            raise ValueError('a path of no file')
        if request.path == '/healthz' or request.path.startswith('/static/'):
            return None
        return refusal(
            request.headers,
            self._given(request),
            address=self._settings.address,
            token=self._token,
            origins=self._settings.origins,
        )

    @property
    def _cookie(self) -> str:
        """Name of the cookie with the token; cookies are common to all ports of a machine."""
        return f'tree_sway_{self.port}'

    def _given(self, request: web.Request) -> str:
        return given_token(request.headers, request.query, self._cookie)


async def add_headers(_request: web.Request, response: web.StreamResponse) -> None:
    """Add the headers that every answer has."""
    response.headers.update(_HEADERS)


def _refusal_page(why: str) -> str:
    """Return the page of a refusal: why, and what to do."""
    page = (STATIC / 'refused.html').read_text(encoding='utf-8')
    kind = 'token' if why == WRONG_TOKEN else 'other'
    return page.replace('{why}', escape(why)).replace('{kind}', kind)


def _takes_packed(request: web.Request) -> bool:
    """Whether a file may be packed; not where it may be missing, as aiohttp packs that as well."""
    headers = request.headers
    is_sent = request.method == 'GET' and not {'If-None-Match', 'If-Modified-Since'} & {*headers}
    return is_sent and 'gzip' in headers.get('Accept-Encoding', '')
