# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Addresses of HTTP, and its failures, without the query, which may have a key in it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from urllib.parse import urlsplit

import aiohttp


def without_query(url: str) -> str:
    """Return an address without its query, its user and its password."""
    parts = urlsplit(url)
    return f'{parts.scheme}://{parts.netloc.rpartition("@")[2]}{parts.path}'


@contextmanager
def failure_without_address() -> Iterator[None]:
    """Raise a `ConnectionError` in place of errors whose text has the whole address."""
    try:
        yield
    except aiohttp.TooManyRedirects:
        raise ConnectionError('it redirects again and again; give the final address') from None
    except aiohttp.WSServerHandshakeError as error:
        raise ConnectionError(f'HTTP {error.status} where a WebSocket is expected') from None
    except aiohttp.ClientResponseError as error:
        reason = error.message.split('\n')[0].rstrip(':')
        raise ConnectionError(f'its answer is not HTTP ({reason})') from None
    except (aiohttp.ClientConnectionError, aiohttp.ClientPayloadError):
        raise  # their text has the host alone
    except aiohttp.ClientError:
        raise ConnectionError('its address, or the one it redirects to, is not HTTP') from None
