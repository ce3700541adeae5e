# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Who may connect: the token, the Origin of a page, the Host that a browser believes it talks to.

A server on this machine's own address needs no token, but a page from elsewhere must not reach it
through the visitor's browser: its Origin, or its Host after a change of DNS, tells.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import hmac
import ipaddress
from urllib.parse import urlsplit

from tree_sway_ros.errors import ParameterError

_OWN_NAMES = ('localhost',)


def is_loopback(address: str) -> bool:
    """Whether an address to bind to is this machine's own alone."""
    if address in _OWN_NAMES:
        return True
    try:
        return ipaddress.ip_address(address.strip('[]')).is_loopback
    except ValueError:
        return False


def require_token(address: str, token: str) -> None:
    """
    Refuse to serve others without a token.

    Raises
    ------
    ParameterError
        Another address than this machine's own, and no token of at least 8 characters.

    """
    if not is_loopback(address) and len(token) < 8:
        raise ParameterError(
            f'address {address} without a token of at least 8 characters',
            where='page',
            cure='give a token, or keep the address 127.0.0.1',
        )


def refusal(
    headers: Mapping[str, str],
    given_token: str,
    *,
    address: str,
    token: str,
    origins: Sequence[str] = (),
) -> str | None:
    """
    Why a request is refused; None if it is not.

    Parameters
    ----------
    headers
        Of the request.
    given_token
        The token that came with it; may be empty.
    address, token
        What the server is bound to and asks for.
    origins
        Other origins whose pages may follow the stream.

    """
    host = headers.get('Host', '')
    if is_loopback(address) and not is_loopback(_name_of(host)):
        return f"host '{host}' is not this machine"
    origin = headers.get('Origin')
    if origin is not None and origin not in origins and urlsplit(origin).netloc != host:
        return f"origin '{origin}' is not this server"
    if token and not hmac.compare_digest(given_token.encode(), token.encode()):
        return 'the token is missing or wrong'
    return None


def _name_of(host: str) -> str:
    """Return a Host header without its port."""
    if host.startswith('['):
        return host.partition(']')[0].lstrip('[')
    return host.rpartition(':')[0] or host
